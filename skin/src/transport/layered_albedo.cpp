// SPDX-License-Identifier: Apache-2.0
// Directions of four Gauss points a hemisphere. Intensities are scaled by sqrt(weight * cosine), so that all matrices
// are symmetric. With s and d the sum and difference of the downward and upward intensities, s' = -P d and d' = -Q s.
// A slab is described by what its surfaces show under light from both sides: d = Y s where it is equal, s = X d where
// it is opposite; Y = h Q tanhc(h^2 P Q), X = tanhc(h^2 P Q) h P for a half thickness of h, tanhc(x^2) = tanh(x) / x.
#include "metamer/skin/layered_albedo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "transport/layer_checks.h"
#include "transport/small_matrix.h"

// The widest vectors that the machine has; the same sums in the same order, so the same bits.
#if defined(__linux__) && defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define METAMER_FOR_EACH_PROCESSOR [[gnu::target_clones("arch=skylake-avx512", "avx2", "default")]]
#else
#define METAMER_FOR_EACH_PROCESSOR
#endif

namespace metamer::skin {
namespace {

constexpr std::size_t kStreams = 4;
static_assert(kStreams == kStreamsPerHemisphere);
constexpr std::size_t kMoments = 2 * kStreams;
constexpr int kEpidermisDoublings = 3;
constexpr int kDermisDoublings = 3;
/// A dermis of more than that many mean free paths is taken for one of the second number, and doubled more often.
constexpr double kDeep = 128;
constexpr double kInfiniteDepth = 4096;
constexpr int kInfiniteDoublings = 10;
/// Through an absorption of that optical depth nothing comes; a deeper layer is cut there, where its start is fine
/// enough.
constexpr double kOpaqueDepth = 25;

/// Cosines, what scales intensities, and Legendre polynomials at the cosines, scaled alike.
struct Directions {
  std::array<double, kStreams> perCosine{};
  std::array<double, kStreams> scale{};  ///< sqrt(weight * cosine)
  /// (2k + 1) P_k(cosine i) P_k(cosine j) sqrt(weight i weight j / (cosine i cosine j)), by k, i and j.
  std::array<std::array<std::array<double, kStreams>, kStreams>, kMoments> products{};

  Directions() {
    const double outer = std::sqrt(3.0 / 7 + 2.0 / 7 * std::sqrt(1.2));
    const double inner = std::sqrt(3.0 / 7 - 2.0 / 7 * std::sqrt(1.2));
    const double lightOuter = (18 - std::sqrt(30.0)) / 72;
    const double lightInner = (18 + std::sqrt(30.0)) / 72;
    const std::array<double, kStreams> cosine = {(1 - outer) / 2, (1 - inner) / 2, (1 + inner) / 2, (1 + outer) / 2};
    const std::array<double, kStreams> weight = {lightOuter, lightInner, lightInner, lightOuter};
    std::array<std::array<double, kStreams>, kMoments> polynomial{};
    for (std::size_t i = 0; i < kStreams; ++i) {
      perCosine[i] = 1 / cosine[i];
      scale[i] = std::sqrt(weight[i] * cosine[i]);
      double before = 0;
      double value = 1;
      for (std::size_t k = 0; k < kMoments; ++k) {
        const auto order = static_cast<double>(k);
        polynomial[k][i] = std::sqrt((2 * order + 1) * weight[i] / cosine[i]) * value;
        const double next = ((2 * order + 1) * cosine[i] * value - order * before) / (order + 1);
        before = value;
        value = next;
      }
    }
    for (std::size_t k = 0; k < kMoments; ++k) {
      for (std::size_t i = 0; i < kStreams; ++i) {
        for (std::size_t j = 0; j < kStreams; ++j) {
          products[k][i][j] = polynomial[k][i] * polynomial[k][j];
        }
      }
    }
  }
};

/// The scattering of a wavelength, scaled by delta-M, as what it takes from P (odd moments) and from Q (even ones).
struct Scattering {
  Lanes extinction;
  Matrix4 odd;
  Matrix4 even;
};

using LaneValues = std::array<double, kLanes>;

METAMER_INLINE void load(const LaneValues& values, Lanes& result) {
  for (std::size_t i = 0; i < kLanes; ++i) {
    result[i] = values[i];
  }
}

METAMER_FOR_EACH_PROCESSOR
void describe(const Directions& at, const LaneValues& coefficients, const LaneValues& anisotropies,
              Scattering& result) {
  Lanes coefficient;
  Lanes anisotropy;
  load(coefficients, coefficient);
  load(anisotropies, anisotropy);
  std::array<Lanes, kMoments> moment;
  Lanes power = coefficient;
  for (std::size_t k = 0; k < kMoments; ++k) {
    moment[k] = power;
    power = power * anisotropy;
  }
  for (Lanes& one : moment) {
    one = one - power;
  }
  result.extinction = moment[0];
  for (std::size_t i = 0; i < kStreams; ++i) {
    for (std::size_t j = i; j < kStreams; ++j) {
      Lanes even{};
      Lanes odd{};
      for (std::size_t k = 0; k < kMoments; k += 2) {
        even = even + moment[k] * at.products[k][i][j];
        odd = odd + moment[k + 1] * at.products[k + 1][i][j];
      }
      result.even(i, j) = result.even(j, i) = even;
      result.odd(i, j) = result.odd(j, i) = odd;
    }
  }
}

/// depth * (diag(extinction / cosine) - scattering).
METAMER_INLINE void growth(const Directions& at, const Lanes& extinction, const Matrix4& scattering, const Lanes& depth,
                           Matrix4& result) {
  for (std::size_t i = 0; i < 16; ++i) {
    result.m[i] = -depth * scattering.m[i];
  }
  for (std::size_t i = 0; i < kStreams; ++i) {
    result(i, i) = result(i, i) + depth * extinction * at.perCosine[i];
  }
}

/// Reflection and transmission of a slab.
struct Slab {
  Matrix4 reflection;
  Matrix4 transmission;
};

/// A layer of one scattering, in each lane.
struct Layers {
  LaneValues absorption{};
  LaneValues thickness{};
};

METAMER_FOR_EACH_PROCESSOR
void solveSlab(const Directions& at, const Scattering& scattering, const Layers& layers, int doublings, Slab& slab) {
  Lanes absorption;
  Lanes thickness;
  load(layers.absorption, absorption);
  load(layers.thickness, thickness);
  const Lanes half = thickness * (0.5 / static_cast<double>(1 << doublings));
  const Lanes extinction = absorption + scattering.extinction;
  Matrix4 p;
  Matrix4 q;
  growth(at, extinction, scattering.odd, half, p);
  growth(at, extinction, scattering.even, half, q);
  // tanhc by its Pade approximant [2/2]. Any function of P Q keeps the directions in which light dies out, so that a
  // thick layer's reflection is exact however coarse the start.
  Matrix4 square;
  Matrix4 fourth;
  multiply(p, q, square);
  multiply(square, square, fourth);
  Matrix4 above;
  Matrix4 below;
  for (std::size_t i = 0; i < 16; ++i) {
    above.m[i] = 105.0 * square.m[i] + fourth.m[i];
    below.m[i] = 420.0 * square.m[i] + 15.0 * fourth.m[i];
  }
  scaleAndShift(above, 1, 945, above);
  scaleAndShift(below, 1, 945, below);
  Matrix4 factor;
  Matrix4 ratio;
  invert(below, factor);
  multiply(factor, above, ratio);
  Matrix4 x;
  Matrix4 y;
  multiplySymmetric(ratio, p, x);
  multiplySymmetric(q, ratio, y);
  for (int i = 0; i < doublings; ++i) {
    // tanh(2 a) = 2 tanh(a) / (1 + tanh(a)^2).
    Matrix4 product;
    multiply(x, y, product);
    scaleAndShift(product, 0.5, 0.5, product);
    invert(product, factor);
    multiplySymmetric(factor, x, product);
    x = product;
    multiplySymmetric(y, factor, product);
    y = product;
  }
  // Equal light from both sides comes out by (1 - Y) / (1 + Y), opposite light by (X - 1) / (X + 1).
  Matrix4 equal;
  Matrix4 opposite;
  scaleAndShift(y, 1, 1, y);
  invert(y, equal);
  scaleAndShift(x, 1, 1, x);
  invert(x, opposite);
  for (std::size_t i = 0; i < 16; ++i) {
    slab.reflection.m[i] = equal.m[i] - opposite.m[i];
    slab.transmission.m[i] = equal.m[i] + opposite.m[i];
  }
  scaleAndShift(slab.transmission, 1, -1, slab.transmission);
}

/// The albedos of epidermes on dermes.
METAMER_FOR_EACH_PROCESSOR
void addSlabs(const Directions& at, const Slab& epidermis, const Slab& dermis, LaneValues& albedos) {
  // R e + T (1 - D R)^-1 D T e, e the diffuse light; the albedo is the flux of that, over 1/2.
  Vector4 light;
  for (std::size_t i = 0; i < kStreams; ++i) {
    light[i] = Lanes{} + at.scale[i];
  }
  Matrix4 between;
  Matrix4 bounces;
  multiply(dermis.reflection, epidermis.reflection, between);
  scaleAndShift(between, -1, 1, between);
  invert(between, bounces);
  Vector4 through;
  Vector4 below;
  Vector4 up;
  Vector4 reflected;
  multiply(epidermis.transmission, light, through);
  multiply(dermis.reflection, through, below);
  multiply(bounces, below, up);
  multiply(epidermis.transmission, up, below);
  multiply(epidermis.reflection, light, reflected);
  Lanes albedo{};
  for (std::size_t i = 0; i < kStreams; ++i) {
    albedo = albedo + 2.0 * at.scale[i] * (reflected[i] + below[i]);
  }
  for (std::size_t i = 0; i < kLanes; ++i) {
    albedos[i] = albedo[i];
  }
}

/// What delta-M leaves of the scattering.
double scaledScattering(double scattering, double anisotropy) {
  return scattering * (1 - std::pow(anisotropy, static_cast<double>(kMoments)));
}

double epidermisThickness(double cm, double absorption) {
  // Where nothing is absorbed, 25 / 0 is infinite.
  return std::min(cm, kOpaqueDepth / absorption);
}

double dermisThickness(double cm, double absorption, double scaled) {
  return std::min({cm, kInfiniteDepth / (scaled + absorption), kOpaqueDepth / absorption});
}

int dermisDoublings(bool isDeep) {
  return isDeep ? kInfiniteDoublings : kDermisDoublings;
}

void requireAlbedos(std::size_t albedos, std::size_t layers) {
  if (albedos != layers) {
    throw spectral::InputError("", "albedos", std::to_string(albedos),
                               "must be as many as the layers, " + std::to_string(layers));
  }
}

const Directions& directions() {
  static const Directions at;
  return at;
}

/// Layers of a grid, kLanes a slab; the last one again where they do not come out even.
template <typename Thickness>
std::vector<Slab> solveSlabs(const Scattering& scattering, const std::vector<double>& absorptions, int doublings,
                             const Thickness& thickness) {
  std::vector<Slab> slabs((absorptions.size() + kLanes - 1) / kLanes);
  for (std::size_t i = 0; i < slabs.size(); ++i) {
    Layers layers;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      layers.absorption[lane] = absorptions[std::min(i * kLanes + lane, absorptions.size() - 1)];
      layers.thickness[lane] = thickness(layers.absorption[lane]);
    }
    solveSlab(directions(), scattering, layers, doublings, slabs[i]);
  }
  return slabs;
}

/// One lane of a slab in all of them.
Slab everywhere(const Slab& slab, std::size_t lane) {
  Slab result;
  for (std::size_t i = 0; i < 16; ++i) {
    result.reflection.m[i] = Lanes{} + slab.reflection.m[i][lane];
    result.transmission.m[i] = Lanes{} + slab.transmission.m[i][lane];
  }
  return result;
}

}  // namespace

void layeredAlbedos(std::span<const LayerOptics> layers, std::span<double> albedos) {
  requireAlbedos(albedos.size(), layers.size());
  for (const LayerOptics& one : layers) {
    requireLayers(one);
  }
  for (std::size_t first = 0; first < layers.size(); first += kLanes) {
    LaneValues coefficients;
    LaneValues anisotropies;
    Layers epidermes;
    Layers dermes;
    bool isDeep = false;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const LayerOptics& one = layers[std::min(first + lane, layers.size() - 1)];
      const double scaled = scaledScattering(one.scattering, one.anisotropy);
      isDeep |= one.dermisThicknessCm * scaled > kDeep;
      coefficients[lane] = one.scattering;
      anisotropies[lane] = one.anisotropy;
      epidermes.absorption[lane] = one.epidermisAbsorption;
      epidermes.thickness[lane] = epidermisThickness(one.epidermisThicknessCm, one.epidermisAbsorption);
      dermes.absorption[lane] = one.dermisAbsorption;
      dermes.thickness[lane] = dermisThickness(one.dermisThicknessCm, one.dermisAbsorption, scaled);
    }
    Scattering scattering;
    Slab epidermis;
    Slab dermis;
    LaneValues values;
    describe(directions(), coefficients, anisotropies, scattering);
    solveSlab(directions(), scattering, epidermes, kEpidermisDoublings, epidermis);
    solveSlab(directions(), scattering, dermes, dermisDoublings(isDeep), dermis);
    addSlabs(directions(), epidermis, dermis, values);
    for (std::size_t lane = 0; lane < kLanes && first + lane < layers.size(); ++lane) {
      albedos[first + lane] = values[lane];
    }
  }
}

void layeredAlbedoGrid(const LayerGrid& grid, std::span<double> albedos) {
  const std::size_t dermes = grid.dermisAbsorptions.size();
  requireAlbedos(albedos.size(), grid.epidermisAbsorptions.size() * dermes);
  for (const double epidermis : grid.epidermisAbsorptions) {
    requireLayers({epidermis, 0, grid.scattering, grid.anisotropy, grid.epidermisThicknessCm, grid.dermisThicknessCm});
  }
  for (const double dermis : grid.dermisAbsorptions) {
    requireLayers({0, dermis, grid.scattering, grid.anisotropy, grid.epidermisThicknessCm, grid.dermisThicknessCm});
  }
  const double scaled = scaledScattering(grid.scattering, grid.anisotropy);
  LaneValues coefficients;
  LaneValues anisotropies;
  coefficients.fill(grid.scattering);
  anisotropies.fill(grid.anisotropy);
  Scattering scattering;
  describe(directions(), coefficients, anisotropies, scattering);
  const std::vector<Slab> above =
      solveSlabs(scattering, grid.epidermisAbsorptions, kEpidermisDoublings,
                 [&](double absorption) { return epidermisThickness(grid.epidermisThicknessCm, absorption); });
  const std::vector<Slab> below =
      solveSlabs(scattering, grid.dermisAbsorptions, dermisDoublings(grid.dermisThicknessCm * scaled > kDeep),
                 [&](double absorption) { return dermisThickness(grid.dermisThicknessCm, absorption, scaled); });
  for (std::size_t i = 0; i < grid.epidermisAbsorptions.size(); ++i) {
    const Slab epidermis = everywhere(above[i / kLanes], i % kLanes);
    for (std::size_t first = 0; first < dermes; first += kLanes) {
      LaneValues values;
      addSlabs(directions(), epidermis, below[first / kLanes], values);
      std::copy_n(values.begin(), std::min(kLanes, dermes - first), &albedos[i * dermes + first]);
    }
  }
}

double layeredAlbedo(const LayerOptics& layers) {
  double albedo = 0;
  layeredAlbedos({&layers, 1}, {&albedo, 1});
  return albedo;
}

}  // namespace metamer::skin
