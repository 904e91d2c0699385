// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "metamer/skin/layered_albedo.h"

namespace metamer::skin {

/// The space that photons walk in.
enum class WalkSpace {
  Three,  ///< the world's: Henyey and Greenstein's phase function, Lambertian entry; judges adding-doubling
  Two,    ///< the chapter's (section 3.4): flatland, with the phase function's 2-D form (d'Eon 2021)
};

struct WalkedAlbedo {
  double albedo = 0;
  double standardError = 0;  ///< of the mean, from the spread of the paths
};

/// The albedo under diffuse light as the mean over random walks. It shares nothing with layeredAlbedo: exponential free
/// paths, absorption as a weight along them, Russian roulette.
/// @param paths  2 ... 1e9
/// @param seed   the same seed gives the same walks
/// @throws spectral::InputError outside those ranges and those of LayerOptics
WalkedAlbedo walkedAlbedo(const LayerOptics& layers, WalkSpace space, std::int64_t paths, std::uint64_t seed);

}  // namespace metamer::skin
