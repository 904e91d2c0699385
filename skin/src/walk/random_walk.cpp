// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/random_walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "metamer/spectral/argument_checks.h"
#include "transport/layer_checks.h"

namespace metamer::skin {
namespace {

class Random {
 public:
  explicit Random(std::uint64_t seed) : m_bits(seed) {}
  /// Above 0, up to 1.
  double unit() { return (static_cast<double>(m_bits() >> 11U) + 1) * 0x1p-53; }

 private:
  std::mt19937_64 m_bits;
};

/// A direction in space as far as depth needs it: its cosine with the inward normal.
class SpatialDirection {
 public:
  explicit SpatialDirection(Random& random) : m_cosine(std::sqrt(random.unit())) {}
  double cosine() const { return m_cosine; }

  void scatter(double anisotropy, Random& random) {
    const double term = (1 - anisotropy * anisotropy) / (1 - anisotropy + 2 * anisotropy * random.unit());
    const double turn = anisotropy < 1e-6
                            ? 2 * random.unit() - 1
                            : std::clamp((1 + anisotropy * anisotropy - term * term) / (2 * anisotropy), -1.0, 1.0);
    const double sines = std::sqrt(std::max(0.0, (1 - turn * turn) * (1 - m_cosine * m_cosine)));
    m_cosine = std::clamp(m_cosine * turn + sines * std::cos(2 * std::numbers::pi * random.unit()), -1.0, 1.0);
  }

 private:
  double m_cosine;
};

/// A direction in the plane: its angle with the inward normal.
class PlanarDirection {
 public:
  explicit PlanarDirection(Random& random) : m_angle(std::asin(2 * random.unit() - 1)) {}
  double cosine() const { return std::cos(m_angle); }

  void scatter(double anisotropy, Random& random) {
    m_angle += 2 * std::atan((1 - anisotropy) / (1 + anisotropy) * std::tan(std::numbers::pi * (random.unit() - 0.5)));
  }

 private:
  double m_angle;
};

/// How long a straight path from one depth to another is inside the epidermis, as a share.
double shareInEpidermis(double from, double to, double thickness) {
  const double low = std::min(from, to);
  const double high = std::max(from, to);
  if (high <= thickness) {
    return 1;
  }
  return low >= thickness ? 0 : (thickness - low) / (high - low);
}

/// What comes back of a photon.
template <typename Direction>
double walk(const LayerOptics& layers, Random& random) {
  constexpr double kLow = 0.02;
  constexpr double kSurvival = 0.2;
  const double bottom = layers.epidermisThicknessCm + layers.dermisThicknessCm;
  Direction direction(random);
  double depth = 0;
  double weight = 1;
  while (weight > 0) {
    double length = -std::log(random.unit()) / layers.scattering;
    double next = depth + length * direction.cosine();
    const bool isOut = next <= 0;
    const bool isThrough = next >= bottom;
    if (isOut) {
      length = depth / -direction.cosine();
      next = 0;
    }
    const double share = shareInEpidermis(depth, next, layers.epidermisThicknessCm);
    weight *= std::exp(-length * (share * layers.epidermisAbsorption + (1 - share) * layers.dermisAbsorption));
    if (isOut) {
      return weight;
    }
    if (isThrough) {
      return 0;
    }
    if (weight < kLow) {
      weight = random.unit() <= kSurvival ? weight / kSurvival : 0;
    }
    depth = next;
    direction.scatter(layers.anisotropy, random);
  }
  return 0;
}

template <typename Direction>
WalkedAlbedo mean(const LayerOptics& layers, std::int64_t paths, std::uint64_t seed) {
  Random random(seed);
  double sum = 0;
  double squares = 0;
  for (std::int64_t path = 0; path < paths; ++path) {
    const double value = walk<Direction>(layers, random);
    sum += value;
    squares += value * value;
  }
  const auto count = static_cast<double>(paths);
  const double albedo = sum / count;
  return {albedo, std::sqrt(std::max(0.0, squares / count - albedo * albedo) / (count - 1))};
}

}  // namespace

WalkedAlbedo walkedAlbedo(const LayerOptics& layers, WalkSpace space, std::int64_t paths, std::uint64_t seed) {
  requireLayers(layers);
  spectral::requireWithin("paths", static_cast<double>(paths), 2, 1e9);
  return space == WalkSpace::Three ? mean<SpatialDirection>(layers, paths, seed)
                                   : mean<PlanarDirection>(layers, paths, seed);
}

}  // namespace metamer::skin
