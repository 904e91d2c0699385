// SPDX-License-Identifier: Apache-2.0
#include "captured_wall.h"

#include "metamer/stage/emitter_model.h"
#include "metamer/stage/stage_geometry.h"
#include "metamer/stage/wall_spectra.h"
#include "spectral/fixture.h"

namespace metamer::stage {
namespace {

struct Led {
  double peakNm;
  double widthNm;
};
constexpr std::array<std::array<Led, 3>, 3> kWalls = {
    {{{{628, 14}, {525, 24}, {460, 16}}}, {{{620, 10}, {535, 20}, {450, 12}}}, {{{640, 12}, {517, 18}, {470, 14}}}}};

}  // namespace

WallCapture capturedWall(const std::string& camera, const std::string& target, int wall,
                         const std::string& reflectances) {
  const auto& library = spectral::testLibrary();
  WallSpectra spectra;
  for (std::size_t k = 0; k < 3; ++k) {
    const Led& led = kWalls.at(static_cast<std::size_t>(wall))[k];
    spectra.emitters[k] = ledModel(led.peakNm, led.widthNm).onDomain();
  }
  spectra.camera = library.observer(camera).onDomain();
  spectra.reflectances = library.reflectances(reflectances).samples;
  spectra.target = library.illuminant(target).onDomain();
  spectra.beta = calibrationSquareBeta(1, 1, 1);
  return captureOf(spectra);
}

std::optional<ChartExpectation> expectedChart(const WallCapture& capture) {
  return expectationOf(capture.patchNames, spectral::testLibrary().reflectances("colorchecker"), 6, 4);
}

WallCapture withNoise(const WallCapture& capture, double relative, std::uint64_t seed) {
  IntervalOptions options;
  options.noise.relative = relative;
  options.seed = seed;
  return noisyCapture(capture, options, 1'000'000);
}

}  // namespace metamer::stage
