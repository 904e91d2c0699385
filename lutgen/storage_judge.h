// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::lutgen {

/// CIEDE2000 between spectra and what became of them.
struct StorageError {
  double mean = 0;
  double worst = 0;  ///< the largest mean of one spectrum
  std::string worstName;
  double largest = 0;
  std::string largestWhere;
};

/// Judges what storage costs (CIE 1931 2 degree observer): reflectances under lights; lights by the ColorChecker under
/// them, at one exposure.
class StorageJudge {
 public:
  /// @param lightNames  names or files; for lights none are needed
  /// @throws spectral::InputError
  StorageJudge(const spectral::DataLibrary& library, const std::vector<std::string>& lightNames);

  StorageError ofReflectances(const std::vector<std::string>& names, const std::vector<spectral::DomainSamples>& before,
                              const std::vector<spectral::DomainSamples>& after) const;
  StorageError ofLights(const std::vector<std::string>& names, const std::vector<spectral::DomainSamples>& before,
                        const std::vector<spectral::DomainSamples>& after) const;

 private:
  Eigen::Matrix<double, spectral::kDomainSize, 3> m_curves;
  std::vector<std::string> m_lightNames;
  std::vector<Eigen::Matrix3Xd> m_lights;  ///< XYZ from a reflectance, Y = 1 of the perfect reflector
  std::vector<std::string> m_patchNames;
  std::vector<spectral::DomainSamples> m_patches;
};

}  // namespace metamer::lutgen
