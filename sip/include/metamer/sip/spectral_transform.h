// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "metamer/sip/balance.h"
#include "metamer/sip/clamped_bands.h"
#include "metamer/sip/pipeline.h"
#include "metamer/sip/scene_cache.h"
#include "metamer/spectral/chromatic_adaptation.h"
#include "metamer/spectral/rgb_space.h"
#include "metamer/spectral/uplift.h"

namespace metamer::sip {

/// Of ReferenceScene::fade. Beyond the largest, charts lose more than a tenth of a CIEDE2000 to skin.
inline constexpr double kDefaultSkinFade = 2.5;
inline constexpr double kLeastSkinFade = 0.5;
inline constexpr double kLargestSkinFade = 4.0;
/// Of ReferenceScene::radius: over a scene that knows most surfaces, and over the smooth one. By cross-validation.
inline constexpr double kDefaultPairRadius = 0.5;
inline constexpr double kSmoothPairRadius = 2.0;
inline constexpr double kLeastPairRadius = 0.05;
inline constexpr double kLargestPairRadius = 20.0;
/// More pairs take minutes to learn.
inline constexpr std::size_t kMostPairs = 16384;

/// How a tristimulus gets its spectrum (course notes, section 5.4).
struct ReferenceScene {
  enum class Kind {
    Natural,  ///< measured surfaces and skins: what they deviate from smooth is interpolated over chromaticity
    Skin,     ///< the same, and among skins' chromaticities as virtual skins are
    Smooth,   ///< the smoothest spectrum
    Dataset,  ///< measured spectra, interpolated over triangles of chromaticities
    Pairs,    ///< another of these, and colours whose spectra are known: exact at them, and round them drawn to them
    Smits,    ///< as each of the published uplifts has it (spectral::UpliftMethod), at one brightness
    Mallett,
    Jakob,
    Meng,
  };
  Kind kind = Kind::Smooth;
  std::vector<spectral::DomainSamples> samples;            ///< reflectances; empty for Smooth
  std::vector<spectral::DomainSamples> skins = {};         ///< Natural, Skin: reflectances of skins
  double strength = 1.0;                                   ///< Skin: 0 = as Natural ... 1
  std::vector<spectral::DomainSamples> virtualSkins = {};  ///< Skin: what its Gaussian is of, at least 4
  /// Skin: how far from the skins' mean chromaticity their Gaussian reaches, in their standard deviations.
  double fade = kDefaultSkinFade;
  std::vector<spectral::DomainSamples> pairs = {};  ///< Pairs: reflectances of the colours that are known
  std::vector<std::string> pairNames = {};          ///< for words: as many as pairs, or none
  Kind over = Kind::Natural;                        ///< Pairs: Natural, Skin or Smooth, whose fields hold too
  /// Pairs: how far one is felt, in standard deviations of the measured surfaces' chromaticities under the light.
  double radius = kDefaultPairRadius;
  std::shared_ptr<const spectral::Uplift> uplift = nullptr;  ///< Smits ... Meng: theirs
  std::vector<Eigen::Vector3d> sampleColours = {};           ///< Smits ... Meng: the samples under D65, linear Rec.709
};

/// The published uplift that a scene is of, none where it is of metamer's own.
std::optional<spectral::UpliftMethod> upliftOf(ReferenceScene::Kind kind);

/// What a message says of a name that is no scene's: lists those that are.
std::string sceneKindRemedy(const std::string& name);
/// "natural", "skin", "smooth", "dataset", "pairs", "smits", "mallett", "jakob", "meng".
/// @throws spectral::InputError for any other name, with sceneKindRemedy()
ReferenceScene::Kind sceneKindFromName(const std::string& name);
std::string nameOf(ReferenceScene::Kind kind);

/// Everything that defines a transform: plain values, no names to look up.
struct TransformSpec {
  spectral::RgbSpace space;  ///< working space, linear, in and out
  Pipeline input;
  Pipeline output;
  double adaptation = 0.0;  ///< 0: the eye stays with the input light; 1: neutrals stay as they are
  spectral::ChromaticAdaptation cat = spectral::ChromaticAdaptation::VonKries;  ///< where the light's colour shows
  bool keepExposure = false;  ///< keep the light lost or won by filters
  ReferenceScene scene;
  /// Ordinary surfaces: cameras without a matrix are fitted to them, and limits are set so that they are left alone.
  std::vector<spectral::DomainSamples> training;
  spectral::Observer standardObserver;   ///< CIE 1931 2 degree
  std::optional<Balance> balanced = {};  ///< how the picture was balanced, and the result is; none given: by `cat`
  std::optional<spectral::Spectrum> daylight = {};  ///< D65, for Balance::Kind::Camera
};

/// The spectral intermediate transform of a specification: RGB in, RGB out, both linear in the working space.
///
/// Homogeneous of degree one (eq. 5.1) by construction, continuous on all of R^3, finite for every finite input.
/// Immutable; safe to share between threads; the result of a colour depends on nothing but the colour.
class SpectralTransform {
 public:
  /// @param bandCount kMinimumBandCount ... kConvergedBandCount
  /// @param cache     of what other transforms of the same light, observer and scene had to solve; may be null. Not
  /// kept.
  /// @throws spectral::InputError outside these, or where the specification has no meaning (no light reaches a side)
  explicit SpectralTransform(const TransformSpec& spec, int bandCount = kDefaultBandCount, SceneCache* cache = nullptr);
  ~SpectralTransform();
  SpectralTransform(SpectralTransform&&) noexcept;
  SpectralTransform& operator=(SpectralTransform&&) noexcept;

  /// Exact result for one colour. A colour with a NaN or infinite component comes back unchanged.
  Eigen::Vector3d apply(const Eigen::Vector3d& rgb) const;

  /// The same for many colours in place, several times as fast as one by one.
  void apply(std::span<Eigen::Vector3d> colours) const;

  /// The same for `rgba.size() / 4` pixels in place; alpha is left alone. @throws spectral::InputError for half a pixel
  void apply(std::span<float> rgba) const;

  /// The transform near one colour, to first order.
  struct Linearisation {
    Eigen::Vector3d value = Eigen::Vector3d::Zero();
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();  ///< derivative; value = matrix * rgb (homogeneity)
    ClampedBands clamped;                              ///< bands where the reflectance is below zero
    bool isLimited = false;                            ///< the limit round plain adaptation takes part
  };
  Linearisation linearise(const Eigen::Vector3d& rgb) const;

  /// A spectrum that was solved for a colour, for all transforms that share a recovery(). Empty before.
  struct SolvedSpectrum {
    Eigen::VectorXd reflectance;
    ClampedBands clamped;
    Eigen::MatrixX3d slope;  ///< by the response; empty before it is asked for
  };
  /// A colour and what it becomes, with what the slope there depends on.
  struct Point {
    Eigen::Vector3d rgb = Eigen::Vector3d::Zero();         ///< in
    Eigen::Vector3d value = Eigen::Vector3d::Zero();       ///< out: apply(rgb)
    ClampedBands clamped;                                  ///< out: bands where the reflectance is below zero
    Eigen::Vector3d difference = Eigen::Vector3d::Zero();  ///< out: from plain adaptation, before any limit
    SolvedSpectrum* kept = nullptr;  ///< in: of this colour, where it is to be kept; out: filled. Changes no result
  };
  /// Many colours, several times as fast as one by one; slopeAt() then gives the derivative where it is wanted.
  void solve(std::span<Point> points) const;
  Eigen::Matrix3d slopeAt(const Point& solved) const;

  /// The spectrum given to a colour, at the band centres: a reflectance, but for what lies below zero where no
  /// reflectance can make the colour. Zero for a colour that is not finite.
  Eigen::VectorXd reflectance(const Eigen::Vector3d& rgb) const;

  /// Stands for which spectra responses are given: the same object for transforms that were made with one SceneCache
  /// and differ in nothing of that. With responseFromRgb() the same too, they give the same spectra to colours.
  std::shared_ptr<const void> recovery() const;

  bool isIdentity() const;  ///< both pipelines are the same: apply() copies
  int bandCount() const;
  const spectral::RgbSpace& space() const;
  /// The transform near colours where no band is clamped, nothing is limited and the scene adds nothing: all of it for
  /// the smooth scene inside linearConeCorners().
  Eigen::Matrix3d linearMatrix() const;
  /// Corner rays, in RGB and in order round white, of the cone where linearMatrix() is exact; empty where there is
  /// none.
  std::vector<Eigen::Vector3d> linearConeCorners() const;
  /// White-normalised input response from RGB: (1,1,1) is (1,1,1), but for a picture that was not balanced.
  Eigen::Matrix3d responseFromRgb() const;
  /// RGB from the output pipeline's response (of PreparedPipeline, before any reflectance is guessed): what a scene
  /// known by its spectra should become.
  Eigen::Matrix3d rgbFromOutputResponse() const;
  /// What plain chromatic adaptation would do, on RGB: what the transform keeps near to.
  Eigen::Matrix3d plainAdaptation() const;
  /// Of a scene of pairs, the colours whose spectra are met: RGB. Empty for other scenes.
  std::vector<Eigen::Vector3d> knownColours() const;
  /// White of the working space, Y = 1.
  Eigen::Vector3d whiteXyz() const;

  struct Diagnostics {
    double conditionNumber = 0;  ///< of the white-normalised input weights: how far the input light sees three channels
    double gain = 0;  ///< 95th percentile over the training surfaces, of the smooth linear piece without relaxation
    double relaxation = 0;  ///< on 81 bands; 0: the tristimulus is met exactly
    double reachUp = 0;     ///< limits round plain adaptation, of a colour's own luminance
    double reachDown = 0;
    double reachAside = 0;
    double limitedShare = 0;  ///< of the training surfaces that the limit touches
  };
  Diagnostics diagnostics() const;

 private:
  struct State;

  void solveTogether(std::span<Point> points) const;

  std::unique_ptr<const State> m_state;
};

}  // namespace metamer::sip
