// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/representation.h"

#include <cassert>
#include <optional>
#include <span>
#include <vector>

#include "matrix_operator.h"
#include "metamer/ocio/exposure_invariant_chain.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/sip/homogeneous_map.h"
#include "parallel.h"

namespace metamer::ocio {

namespace {

/// Cubes of at least this size take their nodes from the homogeneous map: its build then costs less than the nodes'
/// own solves, and its error is far below the lattice's.
constexpr int kMapFromSize = 40;

}  // namespace

std::string nameOf(Representation representation) {
  switch (representation) {
    case Representation::Identity:
      return "identity";
    case Representation::Matrix:
      return "matrix";
    case Representation::LogCube:
      return "log cube";
    case Representation::ExposureInvariantChain:
      return "exposure-invariant chain";
  }
  return {};
}

OCIO::Lut3DTransformRcPtr logCube(const sip::SpectralTransform& transform, const Signal& signal, int size) {
  assert(size >= kSmallestTable && size <= kLargestTable);
  const PixelProcessor toEngine(signal.toEngine);
  const PixelProcessor fromEngine(signal.fromEngine);
  std::optional<sip::HomogeneousMap> map;
  if (size >= kMapFromSize) {
    map = sip::buildHomogeneousMap(transform);
  }
  const auto count = static_cast<std::size_t>(size);
  std::vector<float> nodes(4 * count * count * count);
  const auto at = [size](int k) { return static_cast<float>(static_cast<double>(k) / (size - 1)); };
  parallelFor(size, [&](int blue) {
    const std::span<float> plane(nodes.data() + 4 * count * count * static_cast<std::size_t>(blue), 4 * count * count);
    float* node = plane.data();
    for (int green = 0; green < size; ++green) {
      for (int red = 0; red < size; ++red, node += 4) {
        node[0] = at(red);
        node[1] = at(green);
        node[2] = at(blue);
        node[3] = 1.0F;
      }
    }
    toEngine.apply(plane);
    if (map) {
      map->apply(plane);
    } else {
      transform.apply(plane);
    }
    fromEngine.apply(plane);
  });
  auto table = OCIO::Lut3DTransform::Create(static_cast<unsigned long>(size));
  table->setInterpolation(OCIO::INTERP_TETRAHEDRAL);
  const float* node = nodes.data();
  for (unsigned long blue = 0; blue < count; ++blue) {
    for (unsigned long green = 0; green < count; ++green) {
      for (unsigned long red = 0; red < count; ++red, node += 4) {
        table->setValue(red, green, blue, node[0], node[1], node[2]);
      }
    }
  }
  return table;
}

OCIO::GroupTransformRcPtr engineOperators(Representation representation, const sip::TransformSpec& spec,
                                          const sip::SpectralTransform& transform, int size) {
  auto group = OCIO::GroupTransform::Create();
  switch (representation) {
    case Representation::Identity:
      break;
    case Representation::Matrix:
      group->appendTransform(matrixOperator(transform.unconstrainedMatrix()));
      break;
    case Representation::ExposureInvariantChain:
      return exposureInvariantChain(spec, transform, {.size = size});
    case Representation::LogCube:
      assert(false);
      break;
  }
  return group;
}

}  // namespace metamer::ocio
