// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "metamer/spectral/uplift.h"

namespace metamer::spectral {

/// A table of data/uplifts.
struct UpliftBasis {
  std::vector<double> wavelengthsNm;
  /// A row of what the file has under "selector"; none of most.
  std::vector<std::vector<double>> selector;
  std::vector<std::string> names;
  /// One column a name.
  Eigen::MatrixXd curves;

  /// @throws InputError where there is none
  Eigen::VectorXd curve(const std::string& name) const;
  std::string where;
};

/// @param name  "smits", "mallett", "otsu"
/// @throws InputError where the table is missing or malformed
UpliftBasis readUpliftBasis(const DataLibrary& library, const std::string& name);

/// The weights that are left out in makeUplift.
UpliftWeights exactUpliftWeights(const DataLibrary& library, const std::vector<double>& wavelengthsNm);

/// Those given, checked, or the exact ones.
UpliftWeights upliftWeightsOr(const std::optional<UpliftWeights>& given, const DataLibrary& library,
                              const std::vector<double>& wavelengthsNm);

/// Uplift::xyzFromRgb() by weights.
Eigen::Matrix3d upliftXyzFromRgb(const DataLibrary& library, const UpliftWeights& weights);

}  // namespace metamer::spectral
