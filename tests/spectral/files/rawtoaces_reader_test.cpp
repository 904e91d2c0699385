// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "metamer/spectral/spectral_files.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

using Quantity = SpectralQuantity;

std::string document(const std::string& units, const std::string& names, const std::string& rows) {
  return R"({"header": {"schema_version": "1.0.0", "license": null}, "spectral_data": {"units": )" + units +
         R"(, "index": {"main": [)" + names + R"(]}, "data": {"main": {)" + rows + "}}}}";
}

std::vector<Spectrum> read(const std::string& text, Quantity quantity = Quantity::Sensitivity) {
  return readRawtoacesJson(text, "camera.json", quantity);
}

const std::string kRgb = R"("R","G","B")";
const std::string kRows = R"("380": [0.1, 0.2, 0.3], "385": [1, 2, 3])";

TEST(RawtoacesReaderTest, ReadsColumnsInTheOrderOfTheIndex) {
  const std::vector<Spectrum> spectra = read(document("\"relative\"", kRgb, kRows));
  ASSERT_EQ(spectra.size(), 3U);
  EXPECT_EQ(spectra[1].name(), "G");
  EXPECT_EQ(spectra[1].wavelengthsNm(), (std::vector<double>{380, 385}));
  EXPECT_EQ(spectra[1].values(), (std::vector<double>{0.2, 2}));
}

TEST(RawtoacesReaderTest, MembersAreSortedAsNumbers) {
  const std::vector<Spectrum> spectra = read(document("null", "\"power\"", R"("1000": [3], "380": [1], "400.5": [2])"));
  EXPECT_EQ(spectra[0].wavelengthsNm(), (std::vector<double>{380, 400.5, 1000}));
  EXPECT_EQ(spectra[0].values(), (std::vector<double>{1, 2, 3}));
}

TEST(RawtoacesReaderTest, UnitsMustFit) {
  const std::string text = document("\"reflectance\"", "\"patch\"", R"("380": [0.5], "400": [0.25])");
  EXPECT_NO_THROW(read(text, Quantity::Reflectance));
  EXPECT_EQ(errorOf([&] { read(text, Quantity::SpectralPowerDistribution); }),
            "camera.json: spectral_data.units 'reflectance': a spectral power distribution is needed here");
  const std::string percent = document("\"percent\"", "\"patch\"", R"("380": [0.5], "400": [1.5])");
  EXPECT_EQ(read(percent, Quantity::Reflectance)[0].values(), (std::vector<double>{0.005, 0.015}));
}

TEST(RawtoacesReaderTest, RefusesMalformedFiles) {
  struct Case {
    const char* name;
    std::string text;
    std::string error;
  };
  const std::vector<Case> cases{
      {"empty", "", "camera.json: JSON: malformed at byte 1; the file may be cut short"},
      {"not an object", "[1]", "camera.json: spectral_data: is missing; a rawtoaces measurement file holds it"},
      {"no spectral data", "{}", "camera.json: spectral_data: is missing; a rawtoaces measurement file holds it"},
      {"no index", R"({"spectral_data": {}})",
       "camera.json: spectral_data.index.main 'null': must be a list of names, one a column"},
      {"a number as name", document("null", "1", kRows),
       "camera.json: spectral_data.index.main '1': must be text in quotes"},
      {"a number as units", document("1", kRgb, kRows), "camera.json: units '1': must be text in quotes"},
      {"no rows", document("null", kRgb, ""),
       "camera.json: spectral_data.data.main: must be an object with one member a wavelength"},
      {"one row", document("null", kRgb, R"("380": [1, 2, 3])"),
       "camera.json: rows: only one row of numbers; a spectrum needs at least two"},
      {"one column too few", document("null", kRgb, R"("380": [1, 2, 3], "385": [1, 2])"),
       "camera.json: 385 nm: values '[1,2]': must be a list of 3, one a name of the index"},
      {"text as value", document("null", kRgb, R"("380": [1, 2, 3], "385": [1, 2, "3"])"),
       "camera.json: 385 nm: value '3': must be a number"},
      {"text as wavelength", document("null", kRgb, R"("a": [1, 2, 3])"),
       "camera.json: wavelength 'a': must be a number such as 0.25 or 2.5e-1"},
      {"duplicate key", document("null", kRgb, R"("380": [1, 2, 3], "380": [1, 2, 3])"),
       "camera.json: JSON key '380': appears twice in one object; keep one"},
      {"duplicate wavelength", document("null", kRgb, R"("380": [1, 2, 3], "380.0": [1, 2, 3])"),
       "camera.json: 380 nm: wavelength '380': appears twice; keep one row"},
      {"NaN", document("null", kRgb, R"("380": [NaN, 2, 3])"),
       "camera.json: JSON: malformed at byte 151; the file may be cut short"},
      {"out of range", document("null", kRgb, R"("380": [1e999, 2, 3])"),
       "camera.json: JSON: holds a number out of range"},
      {"Latin-1", document("\"\xE9\"", kRgb, kRows),
       "camera.json: text encoding: byte 86 is not UTF-8 (Latin-1?); save the file as UTF-8"},
  };
  for (const Case& c : cases) {
    EXPECT_EQ(errorOf([&] { read(c.text); }), c.error) << c.name;
  }
  EXPECT_EQ(errorOf([] { read(document("null", "\"p\"", R"("380": [-1], "385": [1])"), Quantity::Transmittance); }),
            "camera.json: 380 nm: transmittance '-1': must not be negative; set measurement noise below zero to 0");
  const std::string whole = document("\"relative\"", kRgb, kRows);
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_NE(errorOf([&] { read(whole.substr(0, length)); }), "no InputError") << length;
  }
}

TEST(RawtoacesReaderTest, DeepNestingIsRefused) {
  std::string arrays;
  std::string objects;
  for (int i = 0; i < 1'000'000; ++i) {
    arrays += "[";
    objects += "{\"a\":";
  }
  EXPECT_EQ(errorOf([&] { read(arrays); }), "camera.json: JSON: is nested deeper than 32");
  EXPECT_EQ(errorOf([&] { read(objects); }), "camera.json: JSON: is nested deeper than 32");
}

}  // namespace
}  // namespace metamer::spectral
