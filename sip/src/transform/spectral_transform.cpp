// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/spectral_transform.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "metamer/sip/band_weights.h"
#include "metamer/sip/scene_cache.h"
#include "metamer/spectral/argument_checks.h"
#include "response/chromaticity.h"
#include "response/ray_polygon.h"
#include "response/samples_on_bands.h"
#include "transform/limiter.h"
#include "transform/pair_gain.h"
#include "transform/recovery.h"
#include "transform/sides.h"

namespace metamer::sip {

namespace {

/// Colours that are solved side by side: enough to fill vectors, few enough for their spectra to stay in the cache.
constexpr std::size_t kTogether = 64;

/// Scales by a power of two so that the largest component lies in [0.5, 1): the result of a colour and of the same
/// colour at another exposure then agree to the last bit for whole stops. Zero stays.
double exposureScale(const Eigen::Vector3d& colour) {
  int exponent = 0;
  std::frexp(colour.cwiseAbs().maxCoeff(), &exponent);
  // The smallest denormals would need a scale beyond the largest double.
  return std::ldexp(1.0, std::clamp(-exponent, -1000, 1000));
}

}  // namespace

/// Colours go through "relative" XYZ: of the working space, over its white. Plain adaptation leaves them as they are.
struct SpectralTransform::State {
  spectral::RgbSpace space;
  bool identity = false;
  Sides sides;
  Eigen::Matrix3Xd relativeFromSpectrum;  ///< 3 x B
  std::shared_ptr<const Recovery> recovery;
  Limiter limiter{Limiter::Reach{}};
  Cover unlimited;  ///< round the pairs that the limiter would not leave alone
  Eigen::Matrix3Xd pairResponses;
  bool relaxed = false;
  Eigen::Matrix3d linearSlope;  ///< of the relative result where no band is clamped and the scene adds nothing
  WeightedSums seenSamples;     ///< MeasuredScene's, as the relative result sees them
  Diagnostics diagnostics;

  /// The spectral result before any limit.
  Eigen::Vector3d relativeResult(const Eigen::Vector3d& relative, const Eigen::Vector3d& response,
                                 const Eigen::Ref<const Eigen::VectorXd>& spectrum) const {
    Eigen::Vector3d result = relativeFromSpectrum * spectrum + sides.unseen * relative;
    if (relaxed) {
      result += sides.relativeFromResponse * (response - recovery->solver().weights() * spectrum);
    }
    return result;
  }
  /// Its derivative by the response, from the spectrum's.
  Eigen::Matrix3d relativeSlope(const Eigen::Ref<const Eigen::MatrixX3d>& spectrumSlope) const {
    Eigen::Matrix3d slope = seen(relativeFromSpectrum, spectrumSlope) + sides.unseen * sides.relativeFromResponse;
    if (relaxed) {
      slope += sides.relativeFromResponse *
               (Eigen::Matrix3d::Identity() - seen(recovery->solver().weights(), spectrumSlope));
    }
    return slope;
  }
  void setSlopes() {
    linearSlope = relativeSlope(recovery->solver().unclamped());
    if (const MeasuredScene* measured = recovery->measured()) {
      Eigen::Matrix3Xd seen = relativeFromSpectrum;
      if (relaxed) {
        seen -= sides.relativeFromResponse * recovery->solver().weights();
      }
      seenSamples = measured->seenBy(seen);
    }
  }
  /// How the relative result before any limit changes with the response.
  Eigen::Matrix3d slopeAt(const Eigen::Vector3d& response, const Point& point) const;
  void setLimits(std::vector<spectral::DomainSamples> training, const std::vector<spectral::DomainSamples>& pairs);
  /// The limiter's result, or round pairs what it would limit.
  Eigen::Vector3d limited(const Eigen::Vector3d& relative, const Eigen::Vector3d& response,
                          const Eigen::Vector3d& difference) const {
    const Eigen::Vector3d within = limiter.apply(relative, difference);
    const double share = unlimitedAt(response).value;
    return share == 0.0 ? within : Eigen::Vector3d(within + share * (relative + difference - within));
  }
  Cover::Share unlimitedAt(const Eigen::Vector3d& response) const {
    return unlimited.isEmpty() || !hasChromaticity(response) ? Cover::Share{}
                                                             : unlimited.at(recovery->pairs()->placeOf(response));
  }
};

void SpectralTransform::State::setLimits(std::vector<spectral::DomainSamples> training,
                                         const std::vector<spectral::DomainSamples>& pairs) {
  const std::size_t firstPair = training.size();
  training.insert(training.end(), pairs.begin(), pairs.end());
  // The surfaces' true responses, whatever the bands.
  const Eigen::Matrix3Xd weights = sides.inputWeights(kConvergedBandCount);
  Eigen::Matrix3Xd responses(3, static_cast<Eigen::Index>(training.size()));
  for (std::size_t k = 0; k < training.size(); ++k) {
    responses.col(static_cast<Eigen::Index>(k)) = weights * training[k];
  }
  const Eigen::MatrixXd reflectances = recovery->spectraOfTraining(responses);
  std::vector<Eigen::Vector3d> colours;
  std::vector<Eigen::Vector3d> differences;
  for (Eigen::Index k = 0; k < responses.cols(); ++k) {
    colours.emplace_back(sides.relativeFromResponse * responses.col(k));
    differences.emplace_back(relativeResult(colours.back(), responses.col(k), reflectances.col(k)) - colours.back());
  }
  limiter = Limiter(Limiter::reachFor(colours, differences));
  diagnostics.reachUp = limiter.reach().up;
  diagnostics.reachDown = limiter.reach().down;
  diagnostics.reachAside = limiter.reach().aside;
  std::size_t limitedCount = 0;
  std::vector<Eigen::Index> limitedPairs;
  for (std::size_t i = 0; i < colours.size(); ++i) {
    if (!limiter.keeps(colours[i], differences[i])) {
      ++limitedCount;
      const auto pair = static_cast<Eigen::Index>(i) - static_cast<Eigen::Index>(firstPair);
      if (pair >= 0 && recovery->pairs()->isExact(pair)) {
        limitedPairs.push_back(pair);
      }
    }
  }
  diagnostics.limitedShare =
      static_cast<double>(limitedCount) / static_cast<double>(std::max<std::size_t>(1, colours.size()));
  pairResponses = responses.rightCols(static_cast<Eigen::Index>(pairs.size()));
  if (!limitedPairs.empty()) {
    unlimited = recovery->pairs()->coverOf(limitedPairs);
  }
}

Eigen::Matrix3d SpectralTransform::State::slopeAt(const Eigen::Vector3d& response, const Point& point) const {
  const MeasuredScene* const measured = recovery->measured();
  if (point.clamped.none() && measured != nullptr) {
    const auto mixture = measured->mixture(response);
    return mixture ? Eigen::Matrix3d(linearSlope + MeasuredScene::slope(*mixture, seenSamples)) : linearSlope;
  }
  if (point.kept == nullptr) {
    return relativeSlope(recovery->slope(response, point.clamped));
  }
  if (point.kept->slope.rows() == 0) {
    point.kept->slope = recovery->slope(response, point.clamped);
  }
  return relativeSlope(point.kept->slope);
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
    const Eigen::MatrixXd surfaces = samplesOnBands(spec.training, kDecisionBandCount);
    state->diagnostics.gain = gainOf(pair, surfaces, 0.0);
    relaxation = relaxationOf(pair, surfaces);
  }
  state->diagnostics.relaxation = relaxation;
  state->relaxed = relaxation > 0.0;
  // The price of roughness grows with the number of steps that a slope is spread over.
  const double price = relaxation * (kDecisionBandCount - 1) / (bandCount - 1);
  state->recovery = cache != nullptr ? cache->recovery(weights, price, spec.scene)
                                     : std::make_shared<const Recovery>(weights, price, spec.scene);
  state->setSlopes();
  if (!state->identity) {
    state->setLimits(spec.training, spec.scene.kind == ReferenceScene::Kind::Pairs
                                        ? spec.scene.pairs
                                        : std::vector<spectral::DomainSamples>{});
  }
  m_state = std::move(state);
}

SpectralTransform::~SpectralTransform() = default;
SpectralTransform::SpectralTransform(SpectralTransform&&) noexcept = default;
SpectralTransform& SpectralTransform::operator=(SpectralTransform&&) noexcept = default;

Eigen::Vector3d SpectralTransform::apply(const Eigen::Vector3d& rgb) const {
  Point point;
  point.rgb = rgb;
  solveTogether(std::span(&point, 1));
  return point.value;
}

void SpectralTransform::apply(std::span<Eigen::Vector3d> colours) const {
  std::array<Point, kTogether> points;
  for (std::size_t first = 0; first < colours.size(); first += kTogether) {
    const std::size_t count = std::min(kTogether, colours.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      points[k].rgb = colours[first + k];
    }
    solveTogether(std::span(points).first(count));
    for (std::size_t k = 0; k < count; ++k) {
      colours[first + k] = points[k].value;
    }
  }
}

void SpectralTransform::solve(std::span<Point> points) const {
  for (std::size_t first = 0; first < points.size(); first += kTogether) {
    solveTogether(points.subspan(first, std::min(kTogether, points.size() - first)));
  }
}

void SpectralTransform::solveTogether(std::span<Point> points) const {
  std::vector<Point*> solved;
  for (Point& point : points) {
    point.value = point.rgb;
    point.clamped.reset();
    point.difference.setZero();
    if (!m_state->identity && point.rgb.allFinite() && !point.rgb.isZero(0.0)) {
      solved.push_back(&point);
    }
  }
  const Sides& sides = m_state->sides;
  Eigen::Matrix3Xd responses(3, static_cast<Eigen::Index>(solved.size()));
  for (std::size_t k = 0; k < solved.size(); ++k) {
    responses.col(static_cast<Eigen::Index>(k)) =
        sides.responseFromRgb * (exposureScale(solved[k]->rgb) * solved[k]->rgb);
  }
  // Those whose spectra are known already are not solved again.
  std::vector<std::size_t> open;
  for (std::size_t k = 0; k < solved.size(); ++k) {
    if (solved[k]->kept == nullptr || solved[k]->kept->reflectance.size() == 0) {
      open.push_back(k);
    }
  }
  Eigen::Matrix3Xd openResponses(3, static_cast<Eigen::Index>(open.size()));
  for (std::size_t i = 0; i < open.size(); ++i) {
    openResponses.col(static_cast<Eigen::Index>(i)) = responses.col(static_cast<Eigen::Index>(open[i]));
  }
  std::vector<ClampedBands> clamped;
  const Eigen::MatrixXd reflectances = m_state->recovery->spectra(openResponses, &clamped);
  const auto finish = [&](std::size_t k, const Eigen::Ref<const Eigen::VectorXd>& reflectance) {
    Point& point = *solved[k];
    const double scale = exposureScale(point.rgb);
    const Eigen::Vector3d relative = sides.relativeFromRgb * (scale * point.rgb);
    const Eigen::Vector3d response = responses.col(static_cast<Eigen::Index>(k));
    point.difference = m_state->relativeResult(relative, response, reflectance) - relative;
    point.value = sides.rgbFromRelative * m_state->limited(relative, response, point.difference) / scale;
  };
  for (std::size_t i = 0; i < open.size(); ++i) {
    Point& point = *solved[open[i]];
    point.clamped = clamped[i];
    finish(open[i], reflectances.col(static_cast<Eigen::Index>(i)));
    if (point.kept != nullptr) {
      *point.kept = {reflectances.col(static_cast<Eigen::Index>(i)), clamped[i], {}};
    }
  }
  for (std::size_t k = 0, i = 0; k < solved.size(); ++k) {
    if (i < open.size() && open[i] == k) {
      ++i;
      continue;
    }
    solved[k]->clamped = solved[k]->kept->clamped;
    finish(k, solved[k]->kept->reflectance);
  }
}

void SpectralTransform::apply(std::span<float> rgba) const {
  spectral::requirePixels(static_cast<std::int64_t>(rgba.size()));
  std::array<Eigen::Vector3d, kTogether> colours;
  for (std::size_t first = 0; first < rgba.size(); first += 4 * kTogether) {
    const std::span<float> some = rgba.subspan(first, std::min(4 * kTogether, rgba.size() - first));
    const std::size_t count = some.size() / 4;
    for (std::size_t k = 0; k < count; ++k) {
      colours[k] = Eigen::Map<const Eigen::Vector3f>(some.data() + 4 * k).cast<double>();
    }
    apply(std::span(colours).first(count));
    for (std::size_t k = 0; k < count; ++k) {
      Eigen::Map<Eigen::Vector3f>(some.data() + 4 * k) = colours[k].cast<float>();
    }
  }
}

Eigen::Matrix3d SpectralTransform::slopeAt(const Point& point) const {
  if (m_state->identity || !point.rgb.allFinite()) {
    return Eigen::Matrix3d::Identity();
  }
  const State& state = *m_state;
  const Eigen::Vector3d scaled = (point.rgb.isZero(0.0) ? 1.0 : exposureScale(point.rgb)) * point.rgb;
  const Eigen::Vector3d response = state.sides.responseFromRgb * scaled;
  const Eigen::Vector3d relative = state.sides.relativeFromRgb * scaled;
  const Eigen::Matrix3d differenceSlope =
      state.slopeAt(response, point) * state.sides.responseFromRgb - state.sides.relativeFromRgb;
  const Limiter::Limited limited = state.limiter.limited(relative, point.difference);
  Eigen::Matrix3d slope = limited.byColour * state.sides.relativeFromRgb + limited.byDifference * differenceSlope;
  if (const Cover::Share share = state.unlimitedAt(response); share.value > 0.0) {
    const Eigen::Matrix3d whole = state.sides.relativeFromRgb + differenceSlope;
    slope +=
        share.value * (whole - slope) +
        (relative + point.difference - limited.value) *
            (share.slope.transpose() * state.recovery->pairs()->placeSlope(response) * state.sides.responseFromRgb);
  }
  return state.sides.rgbFromRelative * slope;
}

SpectralTransform::Linearisation SpectralTransform::linearise(const Eigen::Vector3d& rgb) const {
  Point point;
  point.rgb = rgb;
  solveTogether(std::span(&point, 1));
  Linearisation local{point.value, slopeAt(point), point.clamped, false};
  if (!m_state->identity && rgb.allFinite() && !rgb.isZero(0.0)) {
    local.isLimited =
        !m_state->limiter.keeps(m_state->sides.relativeFromRgb * (exposureScale(rgb) * rgb), point.difference);
  }
  return local;
}

Eigen::VectorXd SpectralTransform::reflectance(const Eigen::Vector3d& rgb) const {
  if (!rgb.allFinite()) {
    return Eigen::VectorXd::Zero(bandCount());
  }
  const double scale = rgb.isZero(0.0) ? 1.0 : exposureScale(rgb);
  return m_state->recovery->spectra(m_state->sides.responseFromRgb * (scale * rgb)) / scale;
}

bool SpectralTransform::isIdentity() const {
  return m_state->identity;
}
int SpectralTransform::bandCount() const {
  return m_state->recovery->solver().bandCount();
}
std::shared_ptr<const void> SpectralTransform::recovery() const {
  return m_state->recovery;
}
const spectral::RgbSpace& SpectralTransform::space() const {
  return m_state->space;
}
Eigen::Matrix3d SpectralTransform::linearMatrix() const {
  if (m_state->identity) {
    return Eigen::Matrix3d::Identity();
  }
  return m_state->sides.rgbFromRelative * m_state->relativeSlope(m_state->recovery->solver().unclamped()) *
         m_state->sides.responseFromRgb;
}
Eigen::Matrix3d SpectralTransform::responseFromRgb() const {
  return m_state->sides.responseFromRgb;
}
Eigen::Matrix3d SpectralTransform::rgbFromOutputResponse() const {
  return m_state->sides.rgbFromOutputResponse;
}
Eigen::Matrix3d SpectralTransform::plainAdaptation() const {
  return m_state->identity ? Eigen::Matrix3d::Identity()
                           : Eigen::Matrix3d(m_state->sides.rgbFromRelative * m_state->sides.relativeFromRgb);
}
Eigen::Vector3d SpectralTransform::whiteXyz() const {
  return m_state->space.whiteXyz();
}
std::vector<Eigen::Vector3d> SpectralTransform::knownColours() const {
  const Eigen::Matrix3Xd known = m_state->sides.responseFromRgb.inverse() * m_state->pairResponses;
  std::vector<Eigen::Vector3d> colours;
  for (Eigen::Index k = 0; k < known.cols(); ++k) {
    if (m_state->recovery->pairs()->isExact(k)) {
      colours.emplace_back(known.col(k));
    }
  }
  return colours;
}
SpectralTransform::Diagnostics SpectralTransform::diagnostics() const {
  return m_state->diagnostics;
}

std::vector<Eigen::Vector3d> SpectralTransform::linearConeCorners() const {
  const State& state = *m_state;
  if (state.identity || !state.recovery->isSmooth()) {
    return {};
  }
  // Far corners round all colours that reflectances can make, then the half-spaces: no band below zero, and no more
  // taken than is left alone (Limiter: half its reach).
  std::vector<Eigen::Vector3d> corners = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
  for (auto& corner : corners) {
    corner = 8.0 * corner - Eigen::Vector3d::Constant(7.0 / 3.0);
  }
  std::vector<Eigen::Vector3d> normals;
  for (Eigen::Index b = 0; b < state.recovery->solver().unclamped().rows(); ++b) {
    normals.emplace_back(state.recovery->solver().unclamped().row(b).transpose());
  }
  const Eigen::Matrix3d& relative = state.sides.relativeFromResponse;
  const Eigen::Matrix3d difference = state.relativeSlope(state.recovery->solver().unclamped()) - relative;
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
