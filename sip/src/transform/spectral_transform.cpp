// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/spectral_transform.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

#include "metamer/sip/band_weights.h"
#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"
#include "response/ray_polygon.h"
#include "scenes/dataset_scene.h"
#include "scenes/measured_scene.h"
#include "soft_bound/soft_bound_solver.h"
#include "transform/limiter.h"
#include "transform/pair_gain.h"
#include "transform/sides.h"

namespace metamer::sip {

using spectral::InputError;

namespace {

/// Noise of a measured sample in the scene, over the kernel's 1, by cross-validation.
constexpr double kSampleNoise = 0.2;
constexpr double kSkinNoise = 0.1;
/// The skin scene's skins are followed by this much more closely at strength 1.
constexpr double kSkinSceneFactor = 0.1;

/// Scales by a power of two so that the largest component lies in [0.5, 1): the result of a colour and of the same
/// colour at another exposure then agree to the last bit for whole stops. Zero stays.
double exposureScale(const Eigen::Vector3d& colour) {
  int exponent = 0;
  std::frexp(colour.cwiseAbs().maxCoeff(), &exponent);
  // The smallest denormals would need a scale beyond the largest double.
  return std::ldexp(1.0, std::clamp(-exponent, -1000, 1000));
}

Eigen::MatrixXd onBands(const std::vector<spectral::DomainSamples>& samples, int bandCount) {
  Eigen::MatrixXd bands(bandCount, static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    bands.col(static_cast<Eigen::Index>(i)) = atBandCentres(samples[i], bandCount);
  }
  return bands;
}

using Scene = std::variant<std::monostate, MeasuredScene, DatasetScene>;

Scene makeScene(const ReferenceScene& scene, const SoftBoundSolver& solver, SceneCache* cache) {
  if (scene.kind == ReferenceScene::Kind::Smooth) {
    return {};
  }
  if (scene.samples.empty()) {
    throw InputError("recipe", "scene.set", "", "a scene of measured spectra needs a set of reflectances");
  }
  if (!(scene.strength >= 0.0 && scene.strength <= 1.0)) {
    throw InputError("recipe", "scene.strength", std::to_string(scene.strength), "give a number from 0 to 1");
  }
  if (scene.kind == ReferenceScene::Kind::Dataset) {
    return DatasetScene(solver, onBands(scene.samples, solver.bandCount()));
  }
  const Eigen::MatrixXd samples = onBands(scene.samples, MeasuredScene::kNodeCount);
  const Eigen::MatrixXd skins = onBands(scene.skins, MeasuredScene::kNodeCount);
  Eigen::MatrixXd all(MeasuredScene::kNodeCount, samples.cols() + skins.cols());
  all << samples, skins;
  const double strength = scene.kind == ReferenceScene::Kind::Skin ? scene.strength : 0.0;
  Eigen::VectorXd noise(all.cols());
  noise << Eigen::VectorXd::Constant(samples.cols(), kSampleNoise),
      Eigen::VectorXd::Constant(skins.cols(), kSkinNoise * std::pow(kSkinSceneFactor, strength));
  return cache != nullptr ? MeasuredScene(solver, *cache->seeds(solver.weights(), all, noise))
                          : MeasuredScene(solver, all, noise);
}

}  // namespace

/// Colours go through "relative" XYZ: of the working space, over its white. Plain adaptation leaves them as they are.
struct SpectralTransform::State {
  spectral::RgbSpace space;
  bool identity = false;
  Sides sides;
  Eigen::Matrix3Xd relativeFromSpectrum;  ///< 3 x B
  std::optional<SoftBoundSolver> solver;
  Scene scene;
  Limiter limiter{Limiter::Reach{}};
  bool relaxed = false;
  Eigen::Matrix3d linearSlope;  ///< of the relative result where no band is clamped and the scene adds nothing
  WeightedSums seenSamples;     ///< MeasuredScene's, as the relative result sees them
  Diagnostics diagnostics;

  std::optional<BandVector> prior(const Eigen::Vector3d& response) const {
    return std::visit(
        [&](const auto& kind) -> std::optional<BandVector> {
          if constexpr (requires { kind.deviation(response); }) {
            return kind.deviation(response);
          } else {
            return std::nullopt;
          }
        },
        scene);
  }
  SoftBoundSolver::Solution solve(const Eigen::Vector3d& response) const {
    const std::optional<BandVector> deviation = prior(response);
    return solver->solve(response, deviation ? &*deviation : nullptr);
  }
  /// The spectral result before any limit.
  Eigen::Vector3d relativeResult(const Eigen::Vector3d& relative, const Eigen::Vector3d& response,
                                 const BandVector& spectrum) const {
    Eigen::Vector3d result = relativeFromSpectrum * spectrum + sides.unseen * relative;
    if (relaxed) {
      result += sides.relativeFromResponse * (response - solver->weights() * spectrum);
    }
    return result;
  }
  /// Its derivative by the response, from the spectrum's.
  Eigen::Matrix3d relativeSlope(const BandTriple& spectrumSlope) const {
    Eigen::Matrix3d slope = relativeFromSpectrum * spectrumSlope + sides.unseen * sides.relativeFromResponse;
    if (relaxed) {
      slope += sides.relativeFromResponse * (Eigen::Matrix3d::Identity() - solver->weights() * spectrumSlope);
    }
    return slope;
  }
  void setSlopes() {
    linearSlope = relativeSlope(solver->unclamped());
    if (const auto* measured = std::get_if<MeasuredScene>(&scene)) {
      Eigen::Matrix3Xd seen = relativeFromSpectrum;
      if (relaxed) {
        seen -= sides.relativeFromResponse * solver->weights();
      }
      seenSamples = measured->seenBy(seen);
    }
  }
  struct Bent {
    SoftBoundSolver::Solution solution;
    Eigen::Matrix3d slope;  ///< of the relative result by the response
  };
  /// The spectrum of a response, and how the relative result changes with it.
  Bent bent(const Eigen::Vector3d& response, const ClampedBands* guess) const;
  void setLimits(const std::vector<spectral::DomainSamples>& training);
};

void SpectralTransform::State::setLimits(const std::vector<spectral::DomainSamples>& training) {
  // The surfaces' true responses, whatever the bands.
  const Eigen::Matrix3Xd weights = sides.inputWeights(kConvergedBandCount);
  std::vector<Eigen::Vector3d> colours;
  std::vector<Eigen::Vector3d> differences;
  for (const spectral::DomainSamples& surface : training) {
    const Eigen::Vector3d response = weights * surface;
    colours.emplace_back(sides.relativeFromResponse * response);
    differences.emplace_back(relativeResult(colours.back(), response, solve(response).reflectance) - colours.back());
  }
  limiter = Limiter(Limiter::reachFor(colours, differences));
  diagnostics.reachUp = limiter.reach().up;
  diagnostics.reachDown = limiter.reach().down;
  diagnostics.reachAside = limiter.reach().aside;
  std::size_t limited = 0;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    limited += limiter.keeps(colours[i], differences[i]) ? 0 : 1;
  }
  diagnostics.limitedShare =
      static_cast<double>(limited) / static_cast<double>(std::max<std::size_t>(1, colours.size()));
}

SpectralTransform::State::Bent SpectralTransform::State::bent(const Eigen::Vector3d& response,
                                                              const ClampedBands* guess) const {
  const auto of = [&](const BandVector* prior, const auto& slopeOf) {
    Bent bent;
    bent.solution = solver->solve(response, prior, guess);
    bent.slope = slopeOf(bent.solution.clamped);
    return bent;
  };
  if (const auto* measured = std::get_if<MeasuredScene>(&scene)) {
    if (const auto mixture = measured->mixture(response)) {
      // Without clamped bands the slope needs no spectra; near a colour with some it will.
      std::optional<MeasuredScene::Local> local;
      if (guess != nullptr && guess->any()) {
        local = measured->local(*mixture);
      }
      const BandVector prior = local ? local->value : measured->value(*mixture);
      return of(&prior, [&](const ClampedBands& clamped) -> Eigen::Matrix3d {
        if (clamped.none()) {
          return linearSlope + MeasuredScene::slope(*mixture, seenSamples);
        }
        if (!local) {
          local = measured->local(*mixture);
        }
        return relativeSlope(solver->derivative(clamped, &local->slope));
      });
    }
  } else if (const auto* dataset = std::get_if<DatasetScene>(&scene)) {
    const DatasetScene::Local local = dataset->local(response);
    return of(&local.value, [&](const ClampedBands& clamped) -> Eigen::Matrix3d {
      return relativeSlope(solver->derivative(clamped, &local.slope));
    });
  }
  return of(nullptr, [&](const ClampedBands& clamped) -> Eigen::Matrix3d {
    return clamped.none() ? linearSlope : relativeSlope(solver->derivative(clamped));
  });
}

SpectralTransform::SpectralTransform(const TransformSpec& spec, int bandCount, SceneCache* cache) {
  spectral::requireWithin("bandCount", bandCount, kMinimumBandCount, kConvergedBandCount);
  auto state = std::make_unique<State>();
  state->space = spec.space;
  state->sides = prepareSides(spec);
  const Sides& sides = state->sides;
  state->identity = sides.equal;
  state->relativeFromSpectrum = sides.relativeWeights(bandCount);
  const Eigen::Matrix3Xd weights = sides.inputWeights(bandCount);
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(weights);
  state->diagnostics.conditionNumber = svd.singularValues()[0] / std::max(svd.singularValues()[2], 1e-300);

  double relaxation = 0.0;
  if (!spec.training.empty() && !state->identity) {
    const PairWeights pair{sides.inputWeights(kDecisionBandCount), sides.relativeWeights(kDecisionBandCount),
                           sides.relativeFromResponse};
    const Eigen::MatrixXd surfaces = onBands(spec.training, kDecisionBandCount);
    state->diagnostics.gain = gainOf(pair, surfaces, 0.0);
    relaxation = relaxationOf(pair, surfaces);
  }
  state->diagnostics.relaxation = relaxation;
  state->relaxed = relaxation > 0.0;
  // The price of roughness grows with the number of steps that a slope is spread over.
  state->solver.emplace(weights, relaxation * (kDecisionBandCount - 1) / (bandCount - 1));
  state->scene = makeScene(spec.scene, *state->solver, cache);
  state->setSlopes();
  if (!state->identity) {
    state->setLimits(spec.training);
  }
  m_state = std::move(state);
}

SpectralTransform::~SpectralTransform() = default;
SpectralTransform::SpectralTransform(SpectralTransform&&) noexcept = default;
SpectralTransform& SpectralTransform::operator=(SpectralTransform&&) noexcept = default;

Eigen::Vector3d SpectralTransform::apply(const Eigen::Vector3d& rgb) const {
  if (m_state->identity || !rgb.allFinite() || rgb.isZero(0.0)) {
    return rgb;
  }
  const double scale = exposureScale(rgb);
  const Eigen::Vector3d scaled = scale * rgb;
  const Eigen::Vector3d response = m_state->sides.responseFromRgb * scaled;
  const Eigen::Vector3d relative = m_state->sides.relativeFromRgb * scaled;
  const Eigen::Vector3d difference =
      m_state->relativeResult(relative, response, m_state->solve(response).reflectance) - relative;
  return m_state->sides.rgbFromRelative * m_state->limiter.apply(relative, difference) / scale;
}

void SpectralTransform::apply(std::span<float> rgba) const {
  spectral::requirePixels(static_cast<std::int64_t>(rgba.size()));
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    Eigen::Map<Eigen::Vector3f> pixel(rgba.data() + i);
    const Eigen::Vector3d result = apply(Eigen::Vector3d(pixel.cast<double>()));
    pixel = result.cast<float>();
  }
}

SpectralTransform::Linearisation SpectralTransform::linearise(const Eigen::Vector3d& rgb,
                                                              const ClampedBands* guess) const {
  if (m_state->identity || !rgb.allFinite()) {
    return {rgb, Eigen::Matrix3d::Identity(), {}, false};
  }
  const State& state = *m_state;
  const double scale = rgb.isZero(0.0) ? 1.0 : exposureScale(rgb);
  const Eigen::Vector3d scaled = scale * rgb;
  const Eigen::Vector3d response = state.sides.responseFromRgb * scaled;
  const Eigen::Vector3d relative = state.sides.relativeFromRgb * scaled;
  const auto [solution, slope] = state.bent(response, guess);
  const Eigen::Vector3d difference = state.relativeResult(relative, response, solution.reflectance) - relative;
  const Eigen::Matrix3d differenceSlope = slope * state.sides.responseFromRgb - state.sides.relativeFromRgb;
  const Limiter::Limited limited = state.limiter.limited(relative, difference);
  Linearisation local;
  local.clamped = solution.clamped;
  local.isLimited = !state.limiter.keeps(relative, difference);
  local.matrix = state.sides.rgbFromRelative *
                 (limited.byColour * state.sides.relativeFromRgb + limited.byDifference * differenceSlope);
  local.value = state.sides.rgbFromRelative * limited.value / scale;
  return local;
}

Eigen::VectorXd SpectralTransform::reflectance(const Eigen::Vector3d& rgb) const {
  if (!rgb.allFinite()) {
    return Eigen::VectorXd::Zero(bandCount());
  }
  const double scale = rgb.isZero(0.0) ? 1.0 : exposureScale(rgb);
  return m_state->solve(m_state->sides.responseFromRgb * (scale * rgb)).reflectance / scale;
}

bool SpectralTransform::isIdentity() const {
  return m_state->identity;
}
int SpectralTransform::bandCount() const {
  return m_state->solver->bandCount();
}
const spectral::RgbSpace& SpectralTransform::space() const {
  return m_state->space;
}
Eigen::Matrix3d SpectralTransform::linearMatrix() const {
  if (m_state->identity) {
    return Eigen::Matrix3d::Identity();
  }
  return m_state->sides.rgbFromRelative * m_state->relativeSlope(m_state->solver->unclamped()) *
         m_state->sides.responseFromRgb;
}
Eigen::Matrix3d SpectralTransform::responseFromRgb() const {
  return m_state->sides.responseFromRgb;
}
Eigen::Matrix3d SpectralTransform::rgbFromOutputResponse() const {
  return m_state->sides.rgbFromOutputResponse;
}
Eigen::Vector3d SpectralTransform::whiteXyz() const {
  return m_state->space.whiteXyz();
}
SpectralTransform::Diagnostics SpectralTransform::diagnostics() const {
  return m_state->diagnostics;
}

std::vector<Eigen::Vector3d> SpectralTransform::linearConeCorners() const {
  const State& state = *m_state;
  if (state.identity || !std::holds_alternative<std::monostate>(state.scene)) {
    return {};
  }
  // Far corners round all colours that reflectances can make, then the half-spaces: no band below zero, and no more
  // taken than is left alone (Limiter: half its reach).
  std::vector<Eigen::Vector3d> corners = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  for (auto& corner : corners) {
    corner = 8.0 * corner - Eigen::Vector3d::Constant(7.0 / 3.0);
  }
  std::vector<Eigen::Vector3d> normals;
  for (Eigen::Index b = 0; b < state.solver->unclamped().rows(); ++b) {
    normals.emplace_back(state.solver->unclamped().row(b).transpose());
  }
  const Eigen::Matrix3d& relative = state.sides.relativeFromResponse;
  const Eigen::Matrix3d difference = state.relativeSlope(state.solver->unclamped()) - relative;
  const auto keepWithin = [&](Eigen::Index component, double reach, double sign) {
    normals.emplace_back((0.5 * reach * relative.row(1) - sign * difference.row(component)).transpose());
  };
  const Limiter::Reach& reach = state.limiter.reach();
  keepWithin(1, reach.up, 1.0);
  keepWithin(1, reach.down, -1.0);
  for (const Eigen::Index component : {0, 2}) {
    keepWithin(component, reach.aside, 1.0);
    keepWithin(component, reach.aside, -1.0);
    normals.emplace_back((0.5 * Limiter::kMostLoss * relative.row(component) + difference.row(component)).transpose());
  }
  for (const Eigen::Vector3d& normal : normals) {
    corners = clipRays(corners, normal);
    if (corners.size() < 3) {
      return {};
    }
  }
  const Eigen::Matrix3d rgbFromResponse = state.sides.responseFromRgb.inverse();
  for (auto& corner : corners) {
    corner = rgbFromResponse * corner;
  }
  return corners;
}

}  // namespace metamer::sip
