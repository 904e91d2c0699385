// SPDX-License-Identifier: Apache-2.0
#include "spectral_ref/scene_fixture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace metamer::spectral_ref {

Scene sceneOf(const std::string& text) {
  return parseScene(text, "scene.yaml", {}, spectral::testLibrary());
}

Film rendered(const Scene& scene, std::uint64_t samples, const RenderOptions& options, int threads) {
  Renderer renderer(scene, options, 0, threads);
  renderer.render(samples, std::numeric_limits<double>::infinity());
  return renderer.film();
}

std::vector<unsigned char> stateOf(const Renderer& renderer) {
  std::vector<unsigned char> state;
  renderer.writeState([&](const void* bytes, std::size_t size) {
    const auto* first = static_cast<const unsigned char*>(bytes);
    state.insert(state.end(), first, first + size);
  });
  return state;
}

void restoreFrom(Renderer& renderer, const std::vector<unsigned char>& state) {
  std::size_t place = 0;
  const auto take = [&](void* bytes, std::size_t size) {
    std::copy_n(state.data() + place, size, static_cast<unsigned char*>(bytes));
    place += size;
  };
  renderer.restore({take, state.size()}, "checkpoint");
}

AreaMean luminanceOver(const Film& film, int x, int y, int width, int height) {
  AreaMean result;
  double variance = 0;
  for (int row = y; row < y + height; ++row) {
    const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(film.format().width);
    for (int column = x; column < x + width; ++column) {
      const Estimate estimate = film.luminance(first + static_cast<std::size_t>(column));
      result.mean += estimate.mean;
      variance += estimate.variance;
    }
  }
  const double pixels = static_cast<double>(width) * height;
  result.mean /= pixels;
  result.error = std::sqrt(variance) / pixels;
  return result;
}

double meanRadiance(const Film& film, int bin) {
  double sum = 0;
  for (std::size_t i = 0; i < film.format().pixels(); ++i) {
    sum += film.radiance(i, bin);
  }
  return sum / static_cast<double>(film.format().pixels());
}

std::string chartScene(int wavelengths, const std::string& lamp, int width, int height) {
  return "metamer_scene: 1\n"
         "film: {width: " +
         std::to_string(width) + ", height: " + std::to_string(height) +
         "}\n"
         "camera: {origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 34}\n"
         "integrator: {max_depth: 2, wavelengths: " +
         std::to_string(wavelengths) +
         "}\n"
         "spectra: {lamp: {illuminant: " +
         lamp +
         ", scale: 0.5}}\n"
         "shapes:\n"
         "  - chart: {set: colorchecker, center: [0, 0, 0], half_u: [3, 0, 0], half_v: [0, 2, 0]}\n"
         "  - rectangle: {center: [-3, 4, 6], half_u: [0.3, 0, 0], half_v: [0, 0, 0.3]}\n"
         "    emission: lamp\n";
}

}  // namespace metamer::spectral_ref
