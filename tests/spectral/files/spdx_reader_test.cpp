// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "metamer/spectral/spectral_files.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

using Quantity = SpectralQuantity;

std::string document(const std::string& quantity, const std::string& samples) {
  return "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<IESTM2714 xmlns=\"iestm2714\" version=\"1.0\">\n"
         "<Header><Description>LED panel</Description></Header>\n<SpectralDistribution>\n<SpectralQuantity>" +
         quantity + "</SpectralQuantity>\n<BandwidthFWHM>2.0</BandwidthFWHM>\n" + samples +
         "</SpectralDistribution>\n</IESTM2714>\n";
}

std::string sample(const std::string& wavelength, const std::string& value) {
  return "<SpectralData wavelength=\"" + wavelength + "\">" + value + "</SpectralData>\n";
}

const std::string kTwo = sample("400.0", "0.25") + sample("410.0", " 0.5 ");

std::vector<Spectrum> read(const std::string& text, Quantity quantity = Quantity::SpectralPowerDistribution) {
  return readSpdx(text, "panel.spdx", quantity);
}

TEST(SpdxReaderTest, ReadsNameAndSamples) {
  const std::vector<Spectrum> spectra = read(document("relative", kTwo));
  ASSERT_EQ(spectra.size(), 1U);
  EXPECT_EQ(spectra[0].name(), "LED panel");
  EXPECT_EQ(spectra[0].wavelengthsNm(), (std::vector<double>{400, 410}));
  EXPECT_EQ(spectra[0].values(), (std::vector<double>{0.25, 0.5}));
}

TEST(SpdxReaderTest, NamespacePrefixesAndCase) {
  const std::string text =
      "\xEF\xBB\xBF<ies:iesTM2714 xmlns:ies=\"x\"><ies:SpectralDistribution><ies:SpectralQuantity>Radiance"
      "</ies:SpectralQuantity><ies:SpectralData wavelength=\"400\">1</ies:SpectralData>"
      "<ies:SpectralData wavelength=\"390\">2</ies:SpectralData></ies:SpectralDistribution></ies:iesTM2714>";
  const Spectrum spectrum = read(text).at(0);
  EXPECT_EQ(spectrum.name(), "panel");
  EXPECT_EQ(spectrum.values(), (std::vector<double>{2, 1}));  // falling order turned round
}

TEST(SpdxReaderTest, QuantityMustFit) {
  struct Case {
    const char* stated;
    Quantity asked;
    bool fits;
  };
  const std::vector<Case> cases{
      {"flux", Quantity::SpectralPowerDistribution, true},
      {"intensity", Quantity::SpectralPowerDistribution, true},
      {"irradiance", Quantity::SpectralPowerDistribution, true},
      {"exitance", Quantity::SpectralPowerDistribution, true},
      {"other", Quantity::SpectralPowerDistribution, true},
      {"absorptance", Quantity::SpectralPowerDistribution, false},
      {"transmittance", Quantity::SpectralPowerDistribution, false},
      {"transmittance", Quantity::Transmittance, true},
      {"T-Values", Quantity::Transmittance, true},
      {"absorptance", Quantity::Transmittance, false},
      {"reflectance", Quantity::Transmittance, false},
      {"reflectance", Quantity::Reflectance, true},
      {"R-Values", Quantity::Reflectance, true},
      {"relative", Quantity::Reflectance, false},
      {"relative", Quantity::Sensitivity, true},
      {"flux", Quantity::Sensitivity, false},
  };
  for (const Case& c : cases) {
    const bool fits = errorOf([&] { read(document(c.stated, kTwo), c.asked); }) == "no InputError";
    EXPECT_EQ(fits, c.fits) << c.stated;
  }
  EXPECT_EQ(errorOf([] { read(document("reflectance", kTwo)); }),
            "panel.spdx: SpectralQuantity 'reflectance': a spectral power distribution is needed here");
}

TEST(SpdxReaderTest, PercentTransmittance) {
  const std::string samples = sample("400", "25") + sample("410", "50");
  EXPECT_EQ(read(document("transmittance", samples), Quantity::Transmittance)[0].values(),
            (std::vector<double>{0.25, 0.5}));
}

TEST(SpdxReaderTest, RefusesMalformedFiles) {
  const std::string laughs =
      "<?xml version=\"1.0\"?><!DOCTYPE lolz [<!ENTITY lol \"lol\"><!ENTITY lol2 "
      "\"&lol;&lol;&lol;&lol;&lol;&lol;&lol;&lol;&lol;&lol;\">]><IESTM2714>&lol2;</IESTM2714>";
  const std::string whole = document("relative", kTwo);
  struct Case {
    const char* name;
    std::string text;
    std::string error;
  };
  const std::vector<Case> cases{
      {"empty", "", "panel.spdx: XML: No document element found at byte 1"},
      {"billion laughs", laughs, "panel.spdx: XML 'DOCTYPE': document types are not read; remove it"},
      {"another document", "<html/>", "panel.spdx: root element 'html': must be IESTM2714 (IES TM-27-14)"},
      {"no distribution", "<IESTM2714/>", "panel.spdx: SpectralDistribution: is missing"},
      {"no quantity", "<IESTM2714><SpectralDistribution/></IESTM2714>",
       "panel.spdx: SpectralQuantity: is missing; TM-27 asks for it"},
      {"no samples", document("relative", ""),
       "panel.spdx: rows: no rows of numbers; a wavelength and a value a row are needed"},
      {"one sample", document("relative", sample("400", "1")),
       "panel.spdx: rows: only one row of numbers; a spectrum needs at least two"},
      {"no wavelength", document("relative", "<SpectralData>1</SpectralData>"),
       "panel.spdx: sample 1: wavelength: is empty; give a number or remove the row"},
      {"duplicate", document("relative", kTwo + sample("410", "1")),
       "panel.spdx: sample 3: wavelength '410': appears twice; keep one row"},
      {"not monotonic", document("relative", kTwo + sample("405", "1")),
       "panel.spdx: sample 3: wavelength '405': breaks the order of the rows before it; sort the rows by wavelength"},
      {"NaN", document("relative", kTwo + sample("420", "NaN")),
       "panel.spdx: sample 3: value 'NaN': must be a finite number; remove the row or give its value"},
      {"decimal comma", document("relative", kTwo + sample("420", "0,5")),
       "panel.spdx: sample 3: value '0,5': must be a number such as 0.25 or 2.5e-1"},
      {"negative power", document("relative", kTwo + sample("420", "-1")),
       "panel.spdx: sample 3: spectral power distribution '-1': must not be negative; set measurement noise below zero "
       "to 0"},
      {"Latin-1", document("relative", "<!-- \xE9 -->" + kTwo),
       "panel.spdx: text encoding: byte 247 is not UTF-8 (Latin-1?); save the file as UTF-8"},
      {"UTF-16", "\xFE\xFF", "panel.spdx: text encoding 'UTF-16': save the file as UTF-8"},
  };
  for (const Case& c : cases) {
    EXPECT_EQ(errorOf([&] { read(c.text); }), c.error) << c.name;
  }
  // Cut anywhere before the root element closes.
  for (std::size_t length = 0; length + 2 < whole.size(); ++length) {
    EXPECT_NE(errorOf([&] { read(whole.substr(0, length)); }), "no InputError") << length;
  }
}

TEST(SpdxReaderTest, DeepNestingIsHarmless) {
  std::string text = "<IESTM2714>";
  for (int i = 0; i < 1'000'000; ++i) {
    text += "<a>";
  }
  EXPECT_NE(errorOf([&] { read(text); }), "no InputError");
}

}  // namespace
}  // namespace metamer::spectral
