// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "metamer/spectral_ref/film.h"
#include "metamer/spectral_ref/renderer.h"
#include "metamer/spectral_ref/scene_reader.h"
#include "spectral/fixture.h"

namespace metamer::spectral_ref {

/// A scene from YAML text; names come from the source tree's data.
Scene sceneOf(const std::string& text);

/// The film of a scene after some samples a pixel.
Film rendered(const Scene& scene, std::uint64_t samples, const RenderOptions& options = {}, int threads = 0);

/// All bytes of a renderer's state.
std::vector<unsigned char> stateOf(const Renderer& renderer);
/// Restores a renderer from them.
void restoreFrom(Renderer& renderer, const std::vector<unsigned char>& state);

/// Mean of Y over a rectangle of pixels and its standard error, from the pixels' variances.
struct AreaMean {
  double mean = 0;
  double error = 0;
};
AreaMean luminanceOver(const Film& film, int x, int y, int width, int height);

/// Mean radiance of a bin over the whole film.
double meanRadiance(const Film& film, int bin);

/// A chart under a small lamp, direct light alone; what the analytic integral is known for.
std::string chartScene(int wavelengths, const std::string& lamp, int width = 96, int height = 64);

}  // namespace metamer::spectral_ref
