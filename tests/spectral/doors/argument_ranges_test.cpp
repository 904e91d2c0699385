// SPDX-License-Identifier: Apache-2.0
// Every public function of spectral that has a range, with arguments just outside it and just inside.
#include <gtest/gtest.h>

#include <limits>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/chromatic_adaptation.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/illuminants.h"
#include "metamer/spectral/missing_file_error.h"
#include "metamer/spectral/observer_of_curves.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/quantile.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"
#include "metamer/spectral/yaml_value.h"
#include "spectral/refusals.h"
#include "spectral/temporary_folder.h"

namespace metamer::spectral {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr auto kPower = SpectralQuantity::SpectralPowerDistribution;

std::vector<Spectrum> flat(int count) {
  return std::vector<Spectrum>(static_cast<std::size_t>(count), Spectrum("flat", kPower, {380, 780}, {1, 1}));
}

TEST(SpectralRanges, ChecksThemselves) {
  EXPECT_TAKEN((requireWithin("x", 1, 1, 2), requireWithin("x", 2, 1, 2), 0));
  EXPECT_REFUSED("x '0.5': must be from 1 to 2", (requireWithin("x", 0.5, 1, 2), 0));
  EXPECT_REFUSED("x '2.5'", (requireWithin("x", 2.5, 1, 2), 0));
  EXPECT_REFUSED("x 'nan'", (requireWithin("x", kNotANumber, 1, 2), 0));
  EXPECT_TAKEN((requireAbove("x", 1e-300, 0), 0));
  EXPECT_REFUSED("x '0': must be above 0", (requireAbove("x", 0, 0), 0));
  EXPECT_REFUSED("x 'inf'", (requireAbove("x", kInfinite, 0), 0));
  EXPECT_TAKEN((requireAsMany("x", 3, "y", 3), 0));
  EXPECT_REFUSED("x '2': must be as many as y, 3", (requireAsMany("x", 2, "y", 3), 0));
  EXPECT_TAKEN((requirePixels(8), 0));
  EXPECT_REFUSED("pixels '9'", (requirePixels(9), 0));
}

TEST(SpectralRanges, Quantiles) {
  EXPECT_EQ(quantile({}, 0.5), 0);
  EXPECT_EQ(quantile({3, 1, 2, 4}, 1), 4);
  EXPECT_EQ(quantile({3, 1, 2, 4}, 0.75), 3);
  EXPECT_EQ(quantile({3, 1, 2, 4}, 0.7501), 4);
  EXPECT_EQ(quantile({3, 1, 2, 4}, 1e-300), 1);
  EXPECT_REFUSED("part '0'", quantile({1}, 0));
  EXPECT_REFUSED("part '1.5'", quantile({1}, 1.5));
  EXPECT_REFUSED("part 'nan'", quantile({1}, kNotANumber));
}

TEST(SpectralRanges, Spectra) {
  EXPECT_TAKEN(Spectrum("s", kPower, {380, 381}, {0, 1}));
  EXPECT_REFUSED("at least two", Spectrum("s", kPower, {380}, {1}));
  EXPECT_REFUSED("values", Spectrum("s", kPower, {380, 381}, {1}));
  EXPECT_REFUSED("380", Spectrum("s", kPower, {380, 380}, {1, 1}));
  EXPECT_REFUSED("-", Spectrum("s", kPower, {380, 381}, {1, -1e-9}));
  EXPECT_REFUSED("s", Spectrum("s", kPower, {0, 381}, {1, 1}));
  EXPECT_REFUSED("s", Spectrum("s", kPower, {380, kInfinite}, {1, 1}));
  EXPECT_REFUSED("s", Spectrum("s", kPower, {380, 381}, {1, kNotANumber}));
  EXPECT_TAKEN(Spectrum("s", SpectralQuantity::Sensitivity, {380, 381}, {1, -1e-9}));
}

TEST(SpectralRanges, Lights) {
  EXPECT_TAKEN(blackbody(500));
  EXPECT_TAKEN(blackbody(100000));
  EXPECT_REFUSED("499", blackbody(499));
  EXPECT_REFUSED("100001", blackbody(100001));
  EXPECT_TAKEN(daylight(4000, flat(3)));
  EXPECT_TAKEN(daylight(25000, flat(3)));
  EXPECT_REFUSED("3999", daylight(3999, flat(3)));
  EXPECT_REFUSED("25001", daylight(25001, flat(3)));
  EXPECT_REFUSED("daylight basis '2'", daylight(6500, flat(2)));
  EXPECT_REFUSED("daylight basis '4'", daylight(6500, flat(4)));
}

TEST(SpectralRanges, Observers) {
  EXPECT_TAKEN(observerOfCurves("o", flat(3)));
  EXPECT_REFUSED("curves '2'", observerOfCurves("o", flat(2)));
  EXPECT_REFUSED("curves '4'", observerOfCurves("o", flat(4)));
}

TEST(SpectralRanges, Colours) {
  EXPECT_TAKEN(xyzFromChromaticity({0.3, 1e-9}));
  EXPECT_REFUSED("chromaticity '0.3 0'", xyzFromChromaticity({0.3, 0}));
  EXPECT_REFUSED("chromaticity", xyzFromChromaticity({kNotANumber, 0.3}));
  const auto method = ChromaticAdaptation::VonKries;
  EXPECT_REFUSED("white", adaptXyz(method, {0, 0, 0}, {1, 1, 1}));
  EXPECT_REFUSED("white", adaptXyz(method, {1, 1, 1}, {1, -1, 1}));
  EXPECT_REFUSED("cat02", chromaticAdaptationFromName("cat03"));
  const Spectrum dark("dark", kPower, {900, 950}, {1, 1});
  EXPECT_REFUSED("no response", tristimulus(flat(1).front(), dark, testLibrary().observer("CIE 1931 2")));
}

TEST(SpectralRanges, DataLibrary) {
  const DataLibrary& library = testLibrary();
  EXPECT_REFUSED("near names", library.illuminant("D6"));
  EXPECT_REFUSED("blackbody", library.illuminant("499 K"));
  EXPECT_REFUSED("daylight", library.illuminant("daylight 3999 K"));
  EXPECT_REFUSED("near names", library.observer("CIE 1932 2"));
  EXPECT_REFUSED("unknown", library.filter("Wratten"));
  EXPECT_REFUSED("near names", library.reflectances("colourchecker"));
  EXPECT_REFUSED("near names", library.colourSpace("ACEScb"));
  EXPECT_REFUSED("D6", library.provenance("illuminants", "D6"));
  EXPECT_REFUSED("unknown", library.provenance("lights", "D65"));
  const TemporaryFolder folder;
  EXPECT_REFUSED("manifest", DataLibrary::open(folder.path()));
}

TEST(SpectralRanges, Files) {
  const TemporaryFolder folder;
  EXPECT_THROW(readTextFile(folder / "none.csv"), MissingFileError);
  EXPECT_REFUSED("none.csv", readSpectralFile(folder / "none.csv", kPower));
  EXPECT_REFUSED("folder", readTextFile(folder.path()));
  EXPECT_REFUSED("rows", readCsv("", "x.csv", kPower));
  EXPECT_REFUSED("columns", readCsv("380\n390\n", "x.csv", kPower));
  EXPECT_REFUSED("x.csv", readCsv("380 1\n380 1\n", "x.csv", kPower));
  EXPECT_REFUSED("x.spdx", readSpdx("<none/>", "x.spdx", kPower));
  EXPECT_REFUSED("x.json", readRawtoacesJson("{}", "x.json", kPower));
  EXPECT_REFUSED("UTF-16", checkedUtf8("\xFF\xFEx", "x.csv"));
  EXPECT_REFUSED("output", PendingFile(folder / "none" / "a.txt"));
  EXPECT_REFUSED("output", (writeWholeFile(folder / "none" / "a.txt", "x"), 0));
}

TEST(SpectralRanges, Yaml) {
  YamlForm form;
  form.deepest = 2;
  EXPECT_TAKEN(parseYaml("a: 1", "x.yaml", form));
  EXPECT_REFUSED("x.yaml", parseYaml("a: {b: {c: 1}}", "x.yaml", form));
  form = {};
  form.mostNodes = 3;
  EXPECT_REFUSED("x.yaml", parseYaml("[1, 2, 3, 4]", "x.yaml", form));
  EXPECT_REFUSED("empty", parseYaml("", "x.yaml"));
  const YamlValue value = YamlValue::parse("a: 1.5", "x.yaml");
  EXPECT_REFUSED("a", YamlMap(value, {"b"}));
  const YamlMap section(value, {"a", "b"});
  EXPECT_TAKEN(section.require("a", "is missing").number(1.5, 1.5));
  EXPECT_REFUSED("a", section.require("a", "is missing").number(1.6, 2));
  EXPECT_REFUSED("a", section.require("a", "is missing").number(1, 1.4));
  EXPECT_REFUSED("a", section.require("a", "is missing").integer(1, 2));
  EXPECT_REFUSED("is missing", section.require("b", "is missing"));
}

}  // namespace
}  // namespace metamer::spectral
