// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/data_library.h"

namespace metamer::sip {

/// How far a recipe is from the truth on one measured set of reflectances, and how far simpler transforms are: mean
/// CIEDE2000 against what the output side makes of the spectra themselves. The set, and what of the others is within
/// an rms of 0.02 of one of it, was left out of the scene, the training and the polynomial.
struct HeldOutSet {
  std::string name;
  std::size_t count = 0;      ///< reflectances
  double engine = 0;          ///< the recipe's transform
  double adaptation = 0;      ///< plain chromatic adaptation, a matrix
  double rootPolynomial = 0;  ///< square roots of products of two channels, 18 numbers (Finlayson, Mackiewicz and
                              ///< Hurlbert 2015), by least squares over the other sets
};

/// Every set of the library in turn but virtual skins. A recipe that does nothing, and a set that a scene has nothing
/// beside, give none.
/// @param parallelFor  runs the sets
std::vector<HeldOutSet> heldOutErrors(const TransformSpec& spec, const spectral::DataLibrary& library,
                                      const ParallelFor& parallelFor = inOrder);

}  // namespace metamer::sip
