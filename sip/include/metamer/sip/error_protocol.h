// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "metamer/sip/spectral_locus.h"
#include "metamer/sip/spectral_transform.h"

namespace metamer::sip {

/// The one error protocol of tests, certificates and benchmarks (docs/error_protocol.md).
///
/// Probes: chromaticities spread evenly (R2 low-discrepancy sequence) over the working gamut and inside the spectral
/// locus; the patches of a chart under the input light; a ring at 97 % of the way
/// from white to the locus. Each at Y = 0.18 * 2^e (patches at their own luminance * 2^e), e = -10 ... +10.
/// Error: CIEDE2000 between a candidate's result and the converged engine's (401 bands), both divided by 2^e, relative
/// to the working white.
class ErrorProtocol {
 public:
  /// The reflectance set of data/ that is its chart.
  static constexpr const char* kChart = "colorchecker";

  struct Options {
    int chromaticityCount = 1024;  ///< 0 ... kMostProbes (probe_limits.h), as the ring's
    int ringCount = 96;
    int lowestStop = -10;          ///< -kMostStops ... highestStop
    int highestStop = 10;          ///< lowestStop ... kMostStops
    bool insideGamutOnly = false;  ///< leave out probes with a negative component: what a log cube cannot hold
    /// Probes are left out at stops at which a component is above it: what a table of a display's signal cannot hold.
    double largestComponent = std::numeric_limits<double>::infinity();
  };
  struct Probe {
    std::string name;     ///< "xy 0.3127 0.3290", "patch 5 blue flower", "ring 12"
    Eigen::Vector3d rgb;  ///< at stop 0
  };
  struct Report {
    double mean = 0;
    double p99 = 0;
    double max = 0;
    std::size_t count = 0;
    std::string worstProbe;  ///< its name and stop
    Eigen::Vector3d worstRgb = Eigen::Vector3d::Zero();
  };

  /// @param chart  reflectances of the chart, with their names. @throws spectral::InputError: an option out of range
  ErrorProtocol(const TransformSpec& spec, const std::vector<spectral::Spectrum>& chart, const Options& options);
  ErrorProtocol(const TransformSpec& spec, const std::vector<spectral::Spectrum>& chart)
      : ErrorProtocol(spec, chart, Options{}) {}

  /// Runs every probe at every stop through a candidate, which turns RGBA pixels into RGBA pixels in place.
  Report measure(const std::function<void(std::span<float> rgba)>& candidate) const;
  /// The same against another transform in place of the converged engine: what a table adds to its own source.
  Report measureAgainst(const SpectralTransform& reference,
                        const std::function<void(std::span<float> rgba)>& candidate) const;

  /// The same, with the largest error looked for round the worst probes as well: where a representation bends, it lies
  /// between them. Mean, percentile and count are measure()'s.
  Report search(const std::function<void(std::span<float> rgba)>& candidate) const;

  const std::vector<Probe>& probes() const { return m_probes; }
  const SpectralTransform& converged() const { return m_converged; }

 private:
  /// What a transform makes of the probes.
  std::vector<Eigen::Vector3d> resultsOf(const SpectralTransform& transform) const;

  /// Where a probe errs most.
  struct Peak {
    double error = 0;
    int stop = 0;
  };
  /// @param peaks  filled, one a probe, unless null
  Report compare(const std::vector<Eigen::Vector3d>& expected,
                 const std::function<void(std::span<float> rgba)>& candidate, std::vector<Peak>* peaks = nullptr) const;
  /// CIELAB of each colour.
  std::vector<Eigen::Vector3d> labOf(const std::vector<Eigen::Vector3d>& rgb) const;
  /// CIEDE2000 of RGBA pixels over their exposure; infinite where one is no number.
  std::vector<double> errorsOf(const std::vector<Eigen::Vector3d>& expectedLab, std::span<const float> rgba,
                               double exposure) const;

  Options m_options;
  SpectralTransform m_converged;
  SpectralLocus m_locus;
  Eigen::Matrix3d m_xyzFromRgb;
  Eigen::Vector3d m_white;
  std::vector<Probe> m_probes;
  std::vector<Eigen::Vector3d> m_expected;  // of the converged engine at stop 0
};

}  // namespace metamer::sip
