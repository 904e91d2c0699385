// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "metamer/spectral/uplift.h"
#include "soft_bound/soft_bound_solver.h"

namespace metamer::sip {

/// The spectra of a published uplift (spectral::Uplift), each at one brightness, so that they scale with exposure.
///
/// An uplift takes colours under daylight. What a response would be there is a matrix of the surfaces' responses to
/// their daylight colours, by least squares, that keeps white. The uplift's spectrum less the smooth one of its
/// response is the solver's prior; so the colour is met whatever light it was seen under. A channel below zero counts
/// as zero, and what the method makes of white is taken off by a colour's share of it, so that neutrals stay on the
/// perfect reflector.
///
/// Immutable after construction, safe to share between threads.
class UpliftScene {
 public:
  /// Largest channel of the colours that the uplift is asked for.
  static constexpr double kBrightness = 0.5;

  /// @param solver    gives weights and smooth spectra. Copied from, not kept.
  /// @param surfaces  B x n reflectances at the band centres, three or more
  /// @param colours   n, linear Rec.709, of the surfaces under D65
  UpliftScene(const SoftBoundSolver& solver, std::shared_ptr<const spectral::Uplift> uplift,
              const Eigen::MatrixXd& surfaces, const std::vector<Eigen::Vector3d>& colours);

  /// Spectrum less the smooth one, for white-normalised responses, a column each: B x n. Zero where no channel is
  /// above zero.
  Eigen::MatrixXd deviations(const Eigen::Matrix3Xd& responses) const;
  BandVector deviation(const Eigen::Vector3d& response) const { return deviations(response); }

  struct Local {
    BandVector value;  ///< the deviation
    BandTriple slope;  ///< by the response, by central differences; slope * response is the value
  };
  Local local(const Eigen::Vector3d& response) const;

 private:
  std::shared_ptr<const spectral::Uplift> m_uplift;
  Eigen::Matrix3d m_rgbFromResponse;
  Eigen::MatrixXd m_deviationFromSpectrum;  ///< B x the uplift's wavelengths
  BandVector m_ofWhite;
};

}  // namespace metamer::sip
