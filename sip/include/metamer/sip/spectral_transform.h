// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "metamer/sip/pipeline.h"
#include "metamer/sip/smoothest_spectrum.h"
#include "metamer/spectral/chromatic_adaptation.h"
#include "metamer/spectral/rgb_space.h"

namespace metamer::sip {

/// How a tristimulus gets its spectrum (course notes, section 5.4).
struct ReferenceScene {
  enum class Kind {
    Smooth,   ///< the smoothest spectrum
    Dataset,  ///< measured spectra, interpolated over chromaticity
    Prior,    ///< the spectrum that deviates most smoothly from a blend of measured spectra nearby
  };
  Kind kind = Kind::Smooth;
  std::vector<spectral::DomainSamples> samples;  ///< reflectances; empty for Smooth
  double strength = 1.0;                         ///< Prior: 0 = smooth ... 1 = the blend in full
  double radius = 0.04;                          ///< Prior: standard deviation of the kernel in CIE xy
};

/// Everything that defines a transform: plain values, no names to look up.
struct TransformSpec {
  spectral::RgbSpace space;  ///< working space, linear, in and out
  Pipeline input;
  Pipeline output;
  double adaptation = 0.0;  ///< 0: the eye stays with the input light; 1: neutrals stay neutral
  spectral::ChromaticAdaptation cat = spectral::ChromaticAdaptation::VonKries;
  bool keepExposure = false;  ///< keep the light lost or won by filters
  ReferenceScene scene;
  std::vector<spectral::DomainSamples> training;  ///< for cameras without a matrix
  spectral::Observer standardObserver;            ///< CIE 1931 2 degree
};

/// The spectral intermediate transform of a specification: RGB in, RGB out, both linear in the working space.
///
/// Homogeneous of degree one (eq. 5.1) by construction, continuous on all of R^3, finite for every finite input.
/// Immutable; safe to share between threads; the result of a colour depends on nothing but the colour.
class SpectralTransform {
 public:
  /// @param bandCount kMinimumBandCount ... kConvergedBandCount
  /// @throws spectral::InputError where the specification has no meaning (no light, a white the CAT cannot reach)
  explicit SpectralTransform(const TransformSpec& spec, int bandCount = kDefaultBandCount);
  ~SpectralTransform();
  SpectralTransform(SpectralTransform&&) noexcept;
  SpectralTransform& operator=(SpectralTransform&&) noexcept;

  /// Exact result for one colour. A colour with a NaN or infinite component comes back unchanged.
  Eigen::Vector3d apply(const Eigen::Vector3d& rgb) const;

  /// The same for `rgba.size() / 4` pixels in place; alpha is left alone.
  void apply(std::span<float> rgba) const;

  /// The transform near one colour, to first order.
  struct Linearisation {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();  ///< derivative; value = matrix * rgb (homogeneity)
    ActiveSet active;                                  ///< bands held at zero
    bool isFeasible = false;                           ///< as isFeasible()
  };
  /// @param guess  bands held for a colour nearby, where known: saves time, does not change the answer
  Linearisation linearise(const Eigen::Vector3d& rgb, const ActiveSet* guess = nullptr) const;

  /// The reflectance given to a colour inside the feasible cone, at the band centres; nothing outside it.
  std::optional<Eigen::VectorXd> reflectance(const Eigen::Vector3d& rgb) const;

  /// Whether a reflectance can make this colour under the input light (or the data set's hull holds it).
  bool isFeasible(const Eigen::Vector3d& rgb) const;

  bool isIdentity() const;  ///< both pipelines are the same: apply() copies
  int bandCount() const;
  const spectral::RgbSpace& space() const;
  Eigen::Matrix3d unconstrainedMatrix() const;  ///< the transform where no band is clamped
  /// Corner rays, in RGB and in order round white, of the cone where unconstrainedMatrix() is exact; empty where there
  /// is none.
  std::vector<Eigen::Vector3d> linearConeCorners() const;
  /// White-normalised input response from RGB: (1,1,1) is (1,1,1).
  Eigen::Matrix3d responseFromRgb() const;
  /// RGB from the output pipeline's response (of PreparedPipeline, before any reflectance is guessed): what a scene
  /// known by its spectra should become.
  Eigen::Matrix3d rgbFromOutputResponse() const;
  /// White of the working space, Y = 1.
  Eigen::Vector3d whiteXyz() const;

  struct Diagnostics {
    double conditionNumber = 0;  ///< of the white-normalised input weights: how far the input light sees three channels
    int rank = 3;                ///< channels that the input light really tells apart
    double matrixGain = 0;       ///< largest singular value of unconstrainedMatrix()
  };
  Diagnostics diagnostics() const;

 private:
  struct State;
  std::unique_ptr<const State> m_state;
};

}  // namespace metamer::sip
