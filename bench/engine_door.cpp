// SPDX-License-Identifier: Apache-2.0
// A C door to the engine at any number of bands and to its map at any tolerance, instruction set and precision.
#include <hwy/targets.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <memory>

#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/recipe.h"
#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/input_error.h"
#include "vector/instruction_sets.h"

using namespace metamer;

namespace {

struct BuiltMap {
  sip::HomogeneousMap map;
  double buildSeconds = 0;
};

/// The map's tables evaluated pixel by pixel in another arithmetic: what float32 alone costs.
template <typename T>
std::array<T, 3> evaluate(const sip::HomogeneousMap& map, const float* rgb) {
  using Map = sip::HomogeneousMap;
  const auto row = [rgb](const float* matrix) {
    return T(matrix[0]) * T(rgb[0]) + T(matrix[1]) * T(rgb[1]) + T(matrix[2]) * T(rgb[2]);
  };
  bool linear = map.linearNormalCount > 0;
  for (std::ptrdiff_t i = 0; i < map.linearNormalCount; ++i) {
    linear = linear && row(map.linearNormals.data() + 3 * i) >= T(0);
  }
  if (linear) {
    return {row(map.linearMatrix.data()), row(map.linearMatrix.data() + 3), row(map.linearMatrix.data() + 6)};
  }
  std::array<T, 3> p{};
  std::size_t axis = 2;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = row(map.cubeFromRgb.data() + 3 * k);
  }
  for (std::size_t k = 0; k < 2; ++k) {
    axis = std::abs(p[k]) > std::abs(p[axis]) ? k : axis;
  }
  const T length = std::abs(p[axis]);
  if (!(length > T(0))) {
    return {};
  }
  const std::size_t face = 2 * axis + (p[axis] > T(0) ? 0 : 1);
  if (face == Map::kFrontFace) {
    const auto fine = [&](std::size_t k) { return (p[k] / length + T(1)) * T(Map::kFineSide) / T(2); };
    const auto cellOf = [](T at) { return std::clamp(static_cast<int>(at), 0, Map::kFineSide - 1); };
    const int column = cellOf(fine(0));
    const int line = cellOf(fine(1));
    const auto node = [&](int i, int j) {
      return map.fine.data() + std::ptrdiff_t{4} * ((line + j) * (Map::kFineSide + 1) + column + i);
    };
    if (node(0, 0)[3] == 0.0F) {
      const T u = fine(0) - T(column);
      const T v = fine(1) - T(line);
      std::array<T, 3> sum{};
      for (std::size_t k = 0; k < 3; ++k) {
        sum[k] = length * ((T(1) - v) * ((T(1) - u) * T(node(0, 0)[k]) + u * T(node(1, 0)[k])) +
                           v * ((T(1) - u) * T(node(0, 1)[k]) + u * T(node(1, 1)[k])));
      }
      return sum;
    }
  }
  const int side = 1 << Map::kRootBits[face];
  const int cells = side << Map::kMaximumDepth;
  const auto scaled = [&](std::size_t k) { return (p[k % 3] / length + T(1)) * T(cells) / T(2); };
  const T u = scaled(axis + 1);
  const T v = scaled(axis + 2);
  const int cellU = std::clamp(static_cast<int>(u), 0, cells - 1);
  const int cellV = std::clamp(static_cast<int>(v), 0, cells - 1);
  constexpr int kMask = (1 << Map::kMaximumDepth) - 1;
  constexpr std::uint32_t kDepthMask = (1U << Map::kDepthBits) - 1U;
  const std::uint32_t root =
      map.roots[map.faceOffset[face] +
                static_cast<std::uint32_t>((cellV >> Map::kMaximumDepth) * side + (cellU >> Map::kMaximumDepth))];
  const int depth = static_cast<int>(root & kDepthMask);
  const int shift = Map::kMaximumDepth - depth;
  const Map::Patch& found =
      map.patches[map.patchIndex[(root >> Map::kDepthBits) +
                                 static_cast<std::uint32_t>((((cellV & kMask) >> shift) << depth) +
                                                            ((cellU & kMask) >> shift))]];
  const T localU = T(found.scale) * (u / T(cells) - T(0.5)) + T(found.offset[0]);
  const T localV = T(found.scale) * (v / T(cells) - T(0.5)) + T(found.offset[1]);
  const auto& patch = found.coefficients;
  // Powers of u and v of a patch's terms.
  constexpr std::array<std::array<int, 2>, 12> kPowers = {
      {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {0, 1}, {1, 1}, {2, 1}, {3, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}}};
  const auto power = [](T x, int exponent) {
    T product = 1;
    for (; exponent > 0; --exponent) {
      product *= x;
    }
    return product;
  };
  std::array<T, 3> sum{};
  for (std::size_t term = 0; term < kPowers.size(); ++term) {
    const T weight = length * power(localU, kPowers[term][0]) * power(localV, kPowers[term][1]);
    for (std::size_t k = 0; k < 3; ++k) {
      sum[k] += weight * T(patch[3 * term + k]);
    }
  }
  return sum;
}

}  // namespace

/// The transform between two lights of data/ in ACEScg at `bands`; null where the engine refuses it.
/// @param scene  "natural", "skin", "smooth" or "dataset", with a set or a strength where it has one
extern "C" void* metamerEngine(const char* input, const char* output, int bands, const char* scene, const char* set,
                               double strength) {
  try {
    const auto library = spectral::DataLibrary::openDefault();
    sip::Recipe recipe;
    recipe.input.illuminant = input;
    recipe.output.illuminant = output;
    recipe.scene = {sip::sceneKindFromName(scene), set, strength};
    return std::make_unique<sip::SpectralTransform>(sip::resolve(recipe, library), bands).release();
  } catch (const spectral::InputError&) {
    return nullptr;
  }
}

/// Known reflectances (401 doubles each, 380 ... 780 nm): what the input pipeline makes of them in RGB, and what the
/// output pipeline does. Transforms of two CIE 1931 observers only.
extern "C" void metamerKnown(void* engine, const char* input, const char* output, const double* reflectances,
                             std::size_t count, double* given, double* wanted) {
  const auto* transform = static_cast<sip::SpectralTransform*>(engine);
  const auto library = spectral::DataLibrary::openDefault();
  const auto observer = library.observer("CIE 1931 2");
  const auto source = sip::prepare({library.illuminant(input), {}, observer}, {}, observer);
  const auto destination = sip::prepare({library.illuminant(output), {}, observer}, {}, observer);
  const Eigen::Matrix3d rgbFromResponse =
      transform->responseFromRgb().inverse() * source.white.cwiseInverse().asDiagonal();
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Map<const spectral::DomainSamples> reflectance(reflectances + spectral::kDomainSize * i);
    Eigen::Map<Eigen::Vector3d>(given + 3 * i) =
        rgbFromResponse * (source.curves.transpose() * source.light.cwiseProduct(reflectance));
    Eigen::Map<Eigen::Vector3d>(wanted + 3 * i) =
        transform->rgbFromOutputResponse() *
        (destination.curves.transpose() * destination.light.cwiseProduct(reflectance));
  }
}

extern "C" void metamerEngineClose(void* engine) {
  delete static_cast<sip::SpectralTransform*>(engine);
}

/// Doubles in and out, three a colour. Returns the seconds it took.
extern "C" double metamerEngineApply(void* engine, const double* rgb, double* result, std::size_t count) {
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Map<Eigen::Vector3d>(result + 3 * i) =
        static_cast<sip::SpectralTransform*>(engine)->apply(Eigen::Map<const Eigen::Vector3d>(rgb + 3 * i));
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Condition number of the input weights, relaxation, largest singular value of the linear piece.
extern "C" void metamerEngineDiagnostics(void* engine, double* three) {
  const auto* transform = static_cast<sip::SpectralTransform*>(engine);
  const auto diagnostics = transform->diagnostics();
  three[0] = diagnostics.conditionNumber;
  three[1] = diagnostics.relaxation;
  three[2] = transform->linearMatrix().operatorNorm();
}

/// The same three for an observer of data/ under a light of data/, towards CIE 1931 under D65; false where the engine
/// refuses the two.
extern "C" int metamerObserverDiagnostics(const char* observer, const char* light, double* three) {
  static const auto kLibrary = spectral::DataLibrary::openDefault();
  try {
    sip::Recipe recipe;
    recipe.input.illuminant = light;
    recipe.input.observer = observer;
    recipe.output.illuminant = "D65";
    sip::SpectralTransform transform(sip::resolve(recipe, kLibrary));
    metamerEngineDiagnostics(&transform, three);
    return 1;
  } catch (const spectral::InputError&) {
    return 0;
  }
}

/// Largest singular value of the derivative over colours, over that of the linear piece.
extern "C" double metamerEngineLargestGain(void* engine, const double* rgb, std::size_t count) {
  const auto* transform = static_cast<sip::SpectralTransform*>(engine);
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    largest =
        std::max(largest, transform->linearise(Eigen::Map<const Eigen::Vector3d>(rgb + 3 * i)).matrix.operatorNorm());
  }
  return largest / transform->linearMatrix().operatorNorm();
}

/// Share of colours where the map of chromaticities turns over (negative determinant: it folds), and the largest gain.
extern "C" double metamerEngineFolds(void* engine, const double* rgb, std::size_t count) {
  const auto* transform = static_cast<sip::SpectralTransform*>(engine);
  std::size_t folds = 0;
  for (std::size_t i = 0; i < count; ++i) {
    folds += transform->linearise(Eigen::Map<const Eigen::Vector3d>(rgb + 3 * i)).matrix.determinant() < 0.0 ? 1 : 0;
  }
  return static_cast<double>(folds) / static_cast<double>(count);
}

extern "C" void* metamerBuildMap(void* engine, double tolerance) {
  auto built = std::make_unique<BuiltMap>();
  const auto start = std::chrono::steady_clock::now();
  built->map = sip::buildHomogeneousMap(*static_cast<sip::SpectralTransform*>(engine), tolerance);
  built->buildSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return built.release();
}

extern "C" void metamerMapClose(void* map) {
  delete static_cast<BuiltMap*>(map);
}

/// Seconds of the build, patches, bytes of all tables.
extern "C" void metamerMapSize(void* map, double* three) {
  const auto& [built, seconds] = *static_cast<BuiltMap*>(map);
  three[0] = seconds;
  three[1] = static_cast<double>(built.patches.size());
  three[2] = static_cast<double>(built.patches.size() * sizeof(built.patches[0]) +
                                 (built.patchIndex.size() + built.roots.size()) * sizeof(std::uint32_t) +
                                 built.fine.size() * sizeof(float));
}

extern "C" void metamerMapApply(void* map, const float* source, float* destination, std::size_t pixels) {
  static_cast<BuiltMap*>(map)->map.apply({source, 4 * pixels}, {destination, 4 * pixels});
}

/// The map in double (`precision` 64) or long double (80): three doubles a pixel.
extern "C" void metamerMapEvaluate(void* map, int precision, const float* rgba, double* rgb, std::size_t pixels) {
  const auto& tables = static_cast<BuiltMap*>(map)->map;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (precision == 64) {
      const auto value = evaluate<double>(tables, rgba + 4 * i);
      std::copy(value.begin(), value.end(), rgb + 3 * i);
    } else {
      const auto value = evaluate<long double>(tables, rgba + 4 * i);
      std::transform(value.begin(), value.end(), rgb + 3 * i, [](long double x) { return static_cast<double>(x); });
    }
  }
}

/// Instruction sets that this machine and build have, as Highway's bits.
extern "C" std::int64_t metamerTargets() {
  return sip::instructionSets();
}
extern "C" const char* metamerTargetName(std::int64_t target) {
  return hwy::TargetName(target);
}
/// Runs the kernel on one of them alone from now on; 0: on the best again.
extern "C" void metamerUseTarget(std::int64_t target) {
  sip::allowInstructionSets(target);
}
