// SPDX-License-Identifier: Apache-2.0
// What is taken and what is refused at the edges of the layouts; whole files are in tests/oracle/test_spectra_files.py.
#include <gtest/gtest.h>

#include <fstream>

#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "spectral/fixture.h"
#include "spectral/temporary_folder.h"

namespace metamer::spectral {
namespace {

using Values = std::vector<double>;
constexpr SpectralQuantity kPower = SpectralQuantity::SpectralPowerDistribution;

std::vector<Spectrum> read(const std::string& text, SpectralQuantity quantity = kPower) {
  return readCsv(text, "lamp.csv", quantity);
}

TEST(LayoutsTest, ManyLampsNamedByNumbersAreColumns) {
  const std::vector<Spectrum> lamps = read("nm,400,500,600,700,800\n380,1,2,3,4,5\n580,1,2,3,4,5\n780,1,2,3,4,5\n");
  ASSERT_EQ(lamps.size(), 5U);
  EXPECT_EQ(lamps[4].values(), (Values{5, 5, 5}));
  EXPECT_EQ(lamps[0].name(), "400");
}

TEST(LayoutsTest, ColumnsWhoseValuesRiseAreNoRowOfWavelengths) {
  const std::vector<Spectrum> lamps =
      read("380,390,400,410,420,430\n400,390,400,410,420,430\n420,390,400,410,420,430\n440,390,400,410,420,431\n");
  ASSERT_EQ(lamps.size(), 5U);
  EXPECT_EQ(lamps[0].wavelengthsNm(), (Values{380, 400, 420, 440}));
}

TEST(LayoutsTest, RowsOfCurvesWithMeasuresBefore) {
  const std::vector<Spectrum> lamps =
      read("No.,Data Name,Ev,380[nm],480[nm],580[nm],680[nm],780[nm]\n1,key,30.1,1,2,3,4,5\n2,fill,20.2,5,4,3,2,1\n");
  ASSERT_EQ(lamps.size(), 2U);
  EXPECT_EQ(lamps[0].name(), "key");
  EXPECT_EQ(lamps[1].values(), (Values{5, 4, 3, 2, 1}));
  EXPECT_EQ(errorOf([] { read("name,380,480,580,680,780\nkey,1,2,3,x,5\n"); }),
            "lamp.csv: 680 nm: value 'x': must be a number such as 0.25 or 2.5e-1");
}

TEST(LayoutsTest, LabelledBlocksOfOneMeterGiveTheFinest) {
  std::string text = "Title,lamp\n";
  for (int nm = 380; nm <= 780; nm += 100) {
    text += "Spectral Data " + std::to_string(nm) + "[nm],1\n";
  }
  for (int nm = 380; nm <= 780; nm += 50) {
    text += "Spectral Data " + std::to_string(nm) + "[nm],2\n";
  }
  ASSERT_EQ(read(text).size(), 1U);
  EXPECT_EQ(read(text)[0].values(), (Values(9, 2.0)));
}

TEST(LayoutsTest, ATypingErrorIsReportedNotSkipped) {
  EXPECT_EQ(errorOf([] { read("nm,a\n380,1\n48O,2\n580,3\n"); }),
            "lamp.csv:3: wavelength '48O': must be a number such as 0.25 or 2.5e-1");
  EXPECT_EQ(errorOf([] { read("nm,a\n380,1\n480,2\n58O,3\n"); }),
            "lamp.csv:4: wavelength '58O': must be a number such as 0.25 or 2.5e-1");
  EXPECT_EQ(errorOf([] { read("nm;a\n380;1\n;2\n580;3\n"); }),
            "lamp.csv:3: wavelength: is empty; give a number or remove the row");
}

TEST(LayoutsTest, NumberedFiguresAreNoCurves) {
  EXPECT_EQ(read("R,value\n1,97\n2,93\n3,91\nnm,power\n380,1\n780,2\nTM-30 bin,Rf\n1,80\n2,81\n")[0].values(),
            (Values{1, 2}));
}

TEST(LayoutsTest, CommentsOfEveryKind) {
  for (const char* const mark : {"#", ";", "//", "%", "!"}) {
    const std::string line = std::string(mark) + " 400,9\n";
    EXPECT_EQ(read(line + "380,1\n" + line + "780,2\n" + line)[0].values(), (Values{1, 2})) << mark;
  }
  EXPECT_EQ(read("380 1 # first\n780 2 // last\n")[0].values(), (Values{1, 2}));
}

TEST(LayoutsTest, CgatsThatIsCutShort) {
  const std::string head = "SPECT\nBEGIN_DATA_FORMAT\nSPEC_380 SPEC_580 SPEC_780\nEND_DATA_FORMAT\nBEGIN_DATA\n";
  EXPECT_EQ(read(head + "1 2 3\nEND_DATA\n")[0].values(), (Values{1, 2, 3}));
  EXPECT_EQ(errorOf([&] { read(head + "1 2\n"); }),
            "lamp.csv:6: BEGIN_DATA '2 values': are no whole sets of 3 fields; the file is cut short or broken");
  EXPECT_EQ(errorOf([&] { read(head + "1 x 3\nEND_DATA\n"); }),
            "lamp.csv: 580 nm: value 'x': must be a number such as 0.25 or 2.5e-1");
  EXPECT_EQ(
      errorOf([] { read("CTI3\nBEGIN_DATA_FORMAT\nRGB_R RGB_G\nEND_DATA_FORMAT\nBEGIN_DATA\n1 2\nEND_DATA\n"); }),
      "lamp.csv: BEGIN_DATA_FORMAT: has no spectral fields such as SPEC_380, or no sets; export the file with its "
      "spectra");
}

TEST(LayoutsTest, NormOfCgatsIsItsScale) {
  const auto text = [](const char* norm, const char* value) {
    return std::string("CTI3\nSPECTRAL_NORM \"") + norm +
           "\"\nBEGIN_DATA_FORMAT\nSPEC_380 SPEC_780\nEND_DATA_FORMAT\n" + "BEGIN_DATA\n" + value + " 1\nEND_DATA\n";
  };
  EXPECT_EQ(read(text("100.0", "50"), SpectralQuantity::Reflectance)[0].values(), (Values{0.5, 0.01}));
  EXPECT_EQ(read(text("1.0", "0.5"), SpectralQuantity::Reflectance)[0].values(), (Values{0.5, 1}));
}

TEST(LayoutsTest, BandsOfCgatsLieWhereTheHeaderSays) {
  const auto table = [](const std::string& end) {
    return "SPECT\n\nSPECTRAL_BANDS \"4\"\nSPECTRAL_START_NM \"380\"\nSPECTRAL_END_NM \"" + end +
           "\"\nBEGIN_DATA_FORMAT\nSPEC_380 SPEC_383 SPEC_387 SPEC_390\nEND_DATA_FORMAT\nBEGIN_DATA\n1 2 3 4\n"
           "END_DATA\n";
  };
  EXPECT_NEAR(read(table("390"))[0].wavelengthsNm()[1], 383.0 + 1.0 / 3, 1e-9);
  EXPECT_NEAR(read(table("390"))[0].wavelengthsNm()[2], 386.0 + 2.0 / 3, 1e-9);
  // As the fields do, for the tables behind.
  const std::vector<Spectrum> two = read(table("390") + "BEGIN_DATA\n5 6 7 8\nEND_DATA\n");
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[1].wavelengthsNm(), two[0].wavelengthsNm());
  // A header of other bands than the fields': the fields.
  EXPECT_EQ(read(table("420"))[0].wavelengthsNm(), (Values{380, 383, 387, 390}));
}

TEST(LayoutsTest, NoiseOfFivePercentIsTheMost) {
  EXPECT_EQ(read("380,1\n480,-0.05\n780,1\n")[0].values(), (Values{1, 0, 1}));
  EXPECT_EQ(
      errorOf([] { read("380,1\n480,-0.051\n780,1\n"); }),
      "lamp.csv:2: spectral power distribution '-0.051': must not be negative; set measurement noise below zero to "
      "0");
}

/// As a spectrometer's program writes what it measured beside what it made of it.
constexpr const char* kSpectrometer =
    "Averaging Nr. [scans]: 10\n"
    "Wave   ;Sample   ;Dark     ;Reflectance;Share\n"
    "[nm]   ;[counts] ;[counts] ;[%];\n\n"
    " 379.50;   17.000;  -50.000;20.000;0.1\n"
    " 580.00;  100.000;  -14.500;50.000;0.5\n"
    " 780.50;   15.000;   -7.000;1.000;0.9\n";

TEST(LayoutsTest, OneColumnIsReadWhateverTheOthersHold) {
  const std::string file = utf8(scratchFile("avantes.dat"));
  std::ofstream(file) << kSpectrometer;
  EXPECT_NE(errorOf([&] { readSpectralFile(file, SpectralQuantity::Reflectance); }).find("must not be negative"),
            std::string::npos);
  const std::vector<Spectrum> chosen = readSpectralFile(file + ":reflectance", SpectralQuantity::Reflectance);
  ASSERT_EQ(chosen.size(), 1U);
  EXPECT_EQ(chosen[0].name(), "Reflectance");
  EXPECT_EQ(chosen[0].values()[1], 0.5);
  EXPECT_EQ(readSpectralFile(file + ":1", SpectralQuantity::SpectralPowerDistribution)[0].name(), "Sample");
  EXPECT_EQ(
      errorOf([&] { readSpectralFile(file + ":gloss", SpectralQuantity::Reflectance); }),
      file + ": column 'gloss': is not there; give a name or a number from 1 of: Sample, Dark, Reflectance, Share");
}

TEST(LayoutsTest, PercentCountsForItsColumnAlone) {
  const std::vector<Spectrum> apart = read("nm,a (%),b\n380,0.5,0.5\n780,0.5,0.5\n", SpectralQuantity::Reflectance);
  EXPECT_EQ(apart[0].values()[0], 0.005);
  EXPECT_EQ(apart[1].values()[0], 0.5);
  // A heading over several columns stands over the first.
  const std::vector<Spectrum> over = read("nm,a,b\n,%,\n380,0.5,0.5\n780,0.5,0.5\n", SpectralQuantity::Reflectance);
  EXPECT_EQ(over[1].values()[0], 0.005);
}

TEST(LayoutsTest, FilesAndTheirColumns) {
  EXPECT_EQ(spectralFileName("a/lamps.csv:warm").column, "warm");
  EXPECT_EQ(spectralFileName("a/lamps.csv:20 W: warm").column, "20 W: warm");
  EXPECT_EQ(spectralFileName("C:\\lamps.csv").column, "");
  EXPECT_EQ(spectralFileName("D65:2").file, "D65:2");
  EXPECT_TRUE(looksLikeSpectralFile("lamps.ti3:4"));
}

}  // namespace
}  // namespace metamer::spectral
