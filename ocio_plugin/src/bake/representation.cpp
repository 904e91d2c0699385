// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/representation.h"

#include "metamer/ocio/exposure_invariant_chain.h"
#include "metamer/spectral/input_error.h"
#include "operators/matrix_operator.h"

namespace metamer::ocio {
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
    case Representation::HomogeneousMap:
      return "homogeneous map";
  }
  return {};
}

OCIO::GroupTransformRcPtr engineOperators(Representation representation, const sip::TransformSpec& spec,
                                          const sip::SpectralTransform& transform, int size) {
  auto group = OCIO::GroupTransform::Create();
  switch (representation) {
    case Representation::Identity:
      break;
    case Representation::Matrix:
      group->appendTransform(matrixOperator(transform.linearMatrix()));
      break;
    case Representation::ExposureInvariantChain:
      return exposureInvariantChain(spec, transform, {.size = size});
    case Representation::LogCube:
      throw spectral::InputError("", "representation", nameOf(representation), "works on a signal, not on linear RGB");
    case Representation::HomogeneousMap:
      throw spectral::InputError("", "representation", nameOf(representation),
                                 "is no OCIO operators; write a shader file");
  }
  return group;
}

}  // namespace metamer::ocio
