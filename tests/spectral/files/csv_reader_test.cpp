// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "metamer/spectral/spectral_files.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

using Quantity = SpectralQuantity;
using Values = std::vector<double>;

std::vector<Spectrum> read(const std::string& text, Quantity quantity = Quantity::SpectralPowerDistribution) {
  return readCsv(text, "lamp.csv", quantity);
}

TEST(CsvReaderTest, AnyDelimiterDecimalSignLineEndAndOrder) {
  struct Case {
    const char* name;
    std::string text;
  };
  const std::vector<Case> cases{
      {"comma", "400,0.5\n410,1.5\n"},
      {"comma and space", "400, 0.5\n410, 1.5\n"},
      {"comma, no last line end", "400,0.5\n410,1.5"},
      {"semicolon", "400;0.5\n410;1.5\n"},
      {"tab", "400\t0.5\n410\t1.5\n"},
      {"spaces", "  400   0.5\n  410   1.5  \n"},
      {"decimal comma and semicolon", "400,0;0,5\n410,0;1,5\n"},
      {"decimal comma and tab", "400\t0,5\n410\t1,5\n"},
      {"comma padded by tabs", "nm,\tpower\t\n400,\t0.5\t\n410, \t1.5\n"},
      {"decimal comma and space", "400 0,5\n410 1,5\n"},
      {"carriage returns", "400,0.5\r\n410,1.5\r\n"},
      {"old carriage returns", "400,0.5\r410,1.5\r"},
      {"byte order mark",
       "\xEF\xBB\xBF"
       "400,0.5\n410,1.5\n"},
      {"comments", "# lamp\n400,0.5\n# middle\n\n410,1.5\n#\n"},
      {"header", "wavelength,power\n400,0.5\n410,1.5\n"},
      {"quoted header", "\"wavelength, nm\",\"a, \"\"b\"\"\"\n400,0.5\n410,1.5\n"},
      {"quoted numbers", "\"400\",\"0.5\"\n\"410\",\"1.5\"\n"},
      {"falling", "410,1.5\n400,0.5\n"},
      {"empty cells at the end", "w,p,,\n400,0.5,,\n410,1.5,\n"},
      {"exponent and plus", "4e2,+5E-1\n+410,.15e1\n"},
      {"micrometre", "wavelength_um,power\n0.4,0.5\n0.41,1.5\n"},
      {"micro sign", "\u00b5m;power\n0,4;0,5\n0,41;1,5\n"},
      {"angstrom", "Wavelength (Angstrom),power\n4000,0.5\n4100,1.5\n"},
      {"angstrom, one letter", "Wavelength (A),power\n4000,0.5\n4100,1.5\n"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    std::vector<Spectrum> spectra;
    ASSERT_NO_THROW(spectra = read(c.text));
    ASSERT_EQ(spectra.size(), 1U);
    ASSERT_EQ(spectra[0].wavelengthsNm().size(), 2U);
    // Units are one multiplication.
    EXPECT_NEAR(spectra[0].wavelengthsNm()[0], 400, 1e-12);
    EXPECT_NEAR(spectra[0].wavelengthsNm()[1], 410, 1e-12);
    EXPECT_EQ(spectra[0].values(), (Values{0.5, 1.5}));
  }
}

TEST(CsvReaderTest, NamesComeFromTheHeader) {
  const std::vector<Spectrum> spectra = read("wavelength_nm,\"Key, left\",,B\n400,1,2,3\n410,4,5,6\n");
  ASSERT_EQ(spectra.size(), 3U);
  EXPECT_EQ(spectra[0].name(), "Key, left");
  EXPECT_EQ(spectra[1].name(), "column 3");
  EXPECT_EQ(spectra[2].name(), "B");
  EXPECT_EQ(spectra[2].values(), (Values{3, 6}));
  EXPECT_EQ(read("400,1\n410,2\n")[0].name(), "lamp");
}

TEST(CsvReaderTest, PercentAndUnity) {
  struct Case {
    std::string text;
    Values expected;
  };
  const std::vector<Case> cases{
      {"400,0.5\n410,1.0\n", {0.5, 1.0}},
      {"400,0.5\n410,1.2\n", {0.5, 1.2}},
      {"400,0.5\n410,2.5\n", {0.005, 0.025}},
      {"400,50\n410,100\n", {0.5, 1.0}},
      {"nm,T (%)\n400,0.5\n410,1.5\n", {0.005, 0.015}},
      {"nm,percent\n400,0.5\n410,0.25\n", {0.005, 0.0025}},
      {"nm,50% grey\n400,0.5\n410,0.25\n", {0.5, 0.25}},  // a name, not a unit
  };
  for (const Case& c : cases) {
    for (const Quantity quantity : {Quantity::Reflectance, Quantity::Transmittance}) {
      EXPECT_EQ(read(c.text, quantity)[0].values(), c.expected) << c.text;
    }
  }
  EXPECT_EQ(read("400,50\n410,100\n")[0].values(), (Values{50, 100}));  // power has no percent
  EXPECT_EQ(errorOf([] { read("400,0.5\n410,1.5\n", Quantity::Reflectance); }),
            "lamp.csv:2: reflectance '1.5': could be a ratio or percent; scale it to 0 to 1, or write % in the header");
  EXPECT_EQ(errorOf([] { read("400,0.5\n410,5000\n", Quantity::Transmittance); }),
            "lamp.csv:2: transmittance '5000': is neither a ratio of 0 to 1 nor percent");
}

TEST(CsvReaderTest, NegativeSensitivityIsAllowed) {
  EXPECT_EQ(read("400,-1\n410,2\n", Quantity::Sensitivity)[0].values(), (Values{-1, 2}));
}

TEST(CsvReaderTest, RefusesMalformedFiles) {
  struct Case {
    const char* name;
    std::string text;
    std::string error;
  };
  const std::string order = "breaks the order of the rows before it; sort the rows by wavelength";
  const std::string finite = "must be a finite number; remove the row or give its value";
  const std::string number = "must be a number such as 0.25 or 2.5e-1";
  const std::string none = "lamp.csv: rows: no rows of numbers; a wavelength and a value a row are needed";
  const std::vector<Case> cases{
      {"empty", "", none},
      {"white space", " \n\t\r\n", none},
      {"remarks alone", "  396 0\x8d+.3 -\n85\t0.2e\t0e\t", none},
      {"comments", "# a\n#b", none},
      {"header only", "wavelength,power\n", none},
      {"byte order mark only", "\xEF\xBB\xBF", none},
      {"one row", "400,1\n", "lamp.csv: rows: only one row of numbers; a spectrum needs at least two"},
      {"one column", "400\n410\n",
       "lamp.csv:1: columns '400': only one; a wavelength and one or more values a row are needed"},
      {"not monotonic", "400,1\n410,1\n405,1\n", "lamp.csv:3: wavelength '405': " + order},
      {"falling, then rising", "410,1\n400,1\n405,1\n", "lamp.csv:3: wavelength '405': " + order},
      {"duplicate", "400,1\n410,1\n410,1\n", "lamp.csv:3: wavelength '410': appears twice; keep one row"},
      {"duplicate at once", "400,1\n400,1\n", "lamp.csv:2: wavelength '400': appears twice; keep one row"},
      {"NaN", "400,1\n410,NaN\n", "lamp.csv:2: value 'NaN': " + finite},
      {"NaN first", "nan,1\n410,1\n", "lamp.csv:1: wavelength 'nan': " + finite},
      {"infinity", "400,1\n410,-inf\n", "lamp.csv:2: value '-inf': " + finite},
      {"overflow", "400,1\n410,1e999\n", "lamp.csv:2: value '1e999': " + number},
      {"hexadecimal", "400,1\n410,0x10\n", "lamp.csv:2: value '0x10': " + number},
      {"text after a number", "400,1\n410,1W\n", "lamp.csv:2: value '1W': " + number},
      {"typing error in the first row", "40o,1\n410,1\n", "lamp.csv:1: wavelength '40o': " + number},
      {"empty cell", "400,1,2\n410,,2\n", "lamp.csv:2: value: is empty; give a number or remove the row"},
      {"ragged", "400,1\n410,1,2\n",
       "lamp.csv:2: columns '3': the first row has 2; give every row as many, and separate columns by ';' where commas "
       "are decimal"},
      {"decimal commas between commas", "wavelength,power\n400,0,5\n410,1,5\n",
       "lamp.csv: columns '3': the header has 2; give both as many, and separate columns by ';' where commas are "
       "decimal"},
      {"thousands", "400;1.234,5\n410;1\n", "lamp.csv:1: value '1.234,5': " + number},
      {"negative power", "400,1\n410,-0.5\n",
       "lamp.csv:2: spectral power distribution '-0.5': must not be negative; set measurement noise below zero to 0"},
      {"wavelength of zero", "0,1\n410,1\n", "lamp.csv:1: wavelength '0': must be above 0"},
      {"negative wavelength", "-400,1\n410,1\n", "lamp.csv:1: wavelength '-400': must be above 0"},
      {"micrometre without saying so", "0.4,1\n0.7,1\n",
       "lamp.csv: wavelengths '0.4 to 0.7': no part lies within 380 to 780 nm; name the unit in the header where it is "
       "um or angstrom"},
      {"UTF-16, one column",
       std::string("\xFF\xFE"
                   "4\0"
                   "0\0",
                   6),
       "lamp.csv:1: columns '40': only one; a wavelength and one or more values a row are needed"},
      {"UTF-16 cut within a character",
       std::string("\xFF\xFE"
                   "4\0"
                   "0",
                   5),
       "lamp.csv: text encoding 'UTF-16': byte 5 is no character; save the file as UTF-8"},
      {"UTF-16, half a pair",
       std::string("\xFE\xFF"
                   "\xD8\x3D"
                   "\0,",
                   6),
       "lamp.csv: text encoding 'UTF-16': byte 3 is no character; save the file as UTF-8"},
      {"UTF-16 without a mark",
       std::string("4\0"
                   "0\0",
                   4),
       "lamp.csv: text encoding: byte 2 is NUL: UTF-16 or not text; save the file as UTF-8"},
      {"UTF-32", std::string("\xFF\xFE\0\0", 4), "lamp.csv: text encoding 'UTF-16': save the file as UTF-8"},
      {"spreadsheet", "PK\x03\x04 sheet",
       "lamp.csv: format 'spreadsheet': is a spreadsheet program's own file; save the sheet as CSV"},
      {"older spreadsheet", "\xD0\xCF\x11\xE0\xA1\xB1",
       "lamp.csv: format 'spreadsheet': is a spreadsheet program's own file; save the sheet as CSV"},
      {"truncated row", "400,1\n410,",
       "lamp.csv:2: columns '410,': only one; a wavelength and one or more values a row are needed"},
      {"XML in a .csv", "<IESTM2714>\n</IESTM2714>\n", none},
  };
  for (const Case& c : cases) {
    EXPECT_EQ(errorOf([&] { read(c.text); }), c.error) << c.name;
  }
}

TEST(CsvReaderTest, TenMillionRowsAreRefused) {
  std::string text;
  text.reserve(100'000'000);
  for (int i = 0; i < 10'000'000; ++i) {
    text += "400.5,1\n";
  }
  EXPECT_EQ(errorOf([&] { read(text); }), "lamp.csv: rows: more than one million; resample to a wider interval");
}

TEST(CsvReaderTest, OneMillionRowsAreRead) {
  std::string text = "wavelength,power\n";
  for (int i = 0; i < 1'000'000; ++i) {
    text += std::to_string(380'000'000 + 400 * i) + "e-6,1\n";
  }
  EXPECT_EQ(read(text)[0].values().size(), 1'000'000U);
  EXPECT_EQ(errorOf([&] { read(text + "781,1\n"); }),
            "lamp.csv: rows: more than one million; resample to a wider interval");
}

TEST(CsvReaderTest, TooManyColumnsAreRefused) {
  std::string row = "400";
  for (int i = 0; i < 20'000; ++i) {
    row += ",1";
  }
  EXPECT_EQ(errorOf([&] { read(row + "\n"); }), "lamp.csv:1: columns: more than 10000; split the file");
}

}  // namespace
}  // namespace metamer::spectral
