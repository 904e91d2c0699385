// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/spectral_transform.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "metamer/sip/band_weights.h"
#include "metamer/sip/feasible_cone.h"
#include "metamer/spectral/input_error.h"
#include "response/ray_polygon.h"
#include "scenes/reference_scenes.h"

namespace metamer::sip {

using spectral::InputError;

namespace {

/// Channels of the white-normalised input weights whose singular value falls below this part of the largest are not
/// told apart by the light (low-pressure sodium, a laser): the difference of two colours there is noise, and it takes
/// ordinary chromatic adaptation instead of being amplified. Of all lamps in data/, low-pressure sodium has 0.03 and
/// 0.003 in the CIE 1931 observer, every other at least 0.13.
constexpr double kRankTolerance = 0.05;

/// A channel whose white is this much darker than the brightest one's is dark.
constexpr double kDarkChannel = 1e-12;

/// Of a camera's sensitivity over its best: where it is below, its range ends.
constexpr double kFaintest = 1e-2;

/// Step of the differences that linearise a transform with a prior, relative to the colour: far below the width of
/// any kernel, far above rounding.
constexpr double kDifferenceStep = 1e-5;

/// Orthonormal directions that the light tells apart; the identity where it tells all three.
Eigen::Matrix3Xd signalBasis(const Eigen::Matrix3Xd& weights, double& conditionNumber) {
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(weights, Eigen::ComputeThinU);
  const Eigen::Vector3d singular = svd.singularValues();
  conditionNumber = singular[0] / std::max(singular[2], 1e-300);
  int rank = 1;
  while (rank < 3 && singular[rank] >= kRankTolerance * singular[0]) {
    ++rank;
  }
  if (rank == 3) {
    return Eigen::Matrix3d::Identity();
  }
  return svd.matrixU().leftCols(rank);
}

/// The weights of the bands within a camera's range. Beyond, its channels are noise, whose ratios would widen the cone
/// by colours that take reflectances of thousands. The range comes from the integration domain, whatever the bands.
Eigen::Matrix3Xd withinRange(const Eigen::Matrix3Xd& weights,
                             const Eigen::Matrix<double, spectral::kDomainSize, 3>& curves) {
  const Eigen::ArrayXd sensitivity = curves.cwiseAbs().rowwise().sum();
  const double least = kFaintest * sensitivity.maxCoeff();
  int first = 0;
  while (sensitivity[first] < least) {
    ++first;
  }
  int last = spectral::kDomainSize - 1;
  while (sensitivity[last] < least) {
    --last;
  }
  const auto bandCount = static_cast<int>(weights.cols());
  std::vector<int> within;
  for (int band = 0; band < bandCount; ++band) {
    const double sample = bandCentreNm(band, bandCount) - spectral::kDomainStartNm;
    if (sample >= first && sample <= last) {
      within.push_back(band);
    }
  }
  return weights(Eigen::all, within);
}

/// Scales by a power of two so that the largest component lies in [0.5, 1): the result of a colour and of the same
/// colour at another exposure then agree to the last bit for whole stops. Zero stays.
double exposureScale(const Eigen::Vector3d& colour) {
  int exponent = 0;
  std::frexp(colour.cwiseAbs().maxCoeff(), &exponent);
  // The smallest denormals would need a scale beyond the largest double.
  return std::ldexp(1.0, std::clamp(-exponent, -1000, 1000));
}

}  // namespace

struct SpectralTransform::State {
  spectral::RgbSpace space;
  bool identity = false;
  Eigen::Matrix3d responseFromRgb;  ///< white-normalised input response
  Eigen::Matrix3d rgbFromOutputResponse;
  Eigen::Matrix3Xd rgbFromSpectrum;  ///< 3 x B: output RGB from reflectance
  Eigen::MatrixX3d spectrumToRgb;    ///< its transpose
  Eigen::Matrix3Xd basis;            ///< directions the input light tells apart
  Eigen::Matrix3d extension;         ///< output RGB from the response that lies outside the cone
  std::optional<SmoothestSpectrumSolver> solver;
  std::optional<FeasibleCone> cone;
  std::optional<DatasetScene> dataset;
  std::optional<PriorScene> prior;
  Diagnostics diagnostics;

  const FeasibleCone& domain() const { return dataset ? dataset->cone() : *cone; }

  /// Response in the solver's three rows (the directions told apart, padded with zeros).
  Eigen::Vector3d target(const Eigen::Vector3d& response) const {
    if (basis.cols() == 3) {
      return response;
    }
    Eigen::Vector3d padded = Eigen::Vector3d::Zero();
    padded.head(basis.cols()) = basis.transpose() * response;
    return padded;
  }
  /// Matrix that acts on the response itself, from one that acts on the target (both with three columns).
  Eigen::MatrixX3d onResponse(const Eigen::MatrixX3d& fromTarget) const {
    if (basis.cols() == 3) {
      return fromTarget;
    }
    return fromTarget.leftCols(basis.cols()) * basis.transpose();
  }
  SmoothestSpectrumSolver::Solution solve(const Eigen::Vector3d& response) const {
    std::optional<SmoothestSpectrumSolver::Solution> solution;
    if (prior) {
      const Eigen::VectorXd blend = prior->blend(response);
      solution = solver->solve(target(response), &blend);
    } else {
      solution = solver->solve(target(response));
    }
    // The cone is drawn in from the set of feasible responses, so there is a solution; should rounding deny it,
    // the unbounded spectrum stands in.
    if (!solution) {
      solution.emplace();
      solution->reflectance = solver->unconstrained() * target(response);
    }
    return *std::move(solution);
  }
  /// Output RGB from the target (3 x 3) near a response, with the bands held there.
  Eigen::Matrix3d linearise(const Eigen::Vector3d& response, const ActiveSet* guess, ActiveSet& active) const {
    auto piece = solver->linearise(target(response), spectrumToRgb, guess);
    if (!piece) {
      return rgbFromSpectrum * solver->unconstrained();
    }
    active = std::move(piece->active);
    return piece->matrix;
  }
};

SpectralTransform::SpectralTransform(const TransformSpec& spec, int bandCount) {
  auto state = std::make_unique<State>();
  state->space = spec.space;
  if (!(spec.adaptation >= 0.0 && spec.adaptation <= 1.0)) {
    throw InputError("recipe", "adaptation", std::to_string(spec.adaptation), "give a number from 0 to 1");
  }
  const PreparedPipeline input = prepare(spec.input, spec.training, spec.standardObserver);
  const PreparedPipeline output = prepare(spec.output, spec.training, spec.standardObserver);
  // A channel without any light has no white to be normalised by: low-pressure sodium leaves an eye's blue one dark.
  if (!(input.white.minCoeff() > kDarkChannel * input.white.maxCoeff())) {
    throw InputError(spec.input.illuminant.name(), "input.observer", spec.input.observer.name,
                     "gets nothing from this light in one of its channels; use another observer or another light");
  }
  const double exposure = spec.keepExposure ? output.filterTransmission / input.filterTransmission : 1.0;
  state->identity = input.light == output.light && input.curves == output.curves &&
                    input.xyzFromResponse == output.xyzFromResponse && exposure == 1.0;

  const Eigen::Vector3d white = spec.space.whiteXyz();
  const Eigen::Matrix3d xyzFromNormalised = input.xyzFromResponse * input.white.asDiagonal();
  state->responseFromRgb =
      xyzFromNormalised.inverse() * spectral::adaptXyz(spec.cat, white, input.whiteXyz()) * spec.space.xyzFromRgb();

  // The output's gain in cone space: D W/W_out + (1 - D) W/W_in.
  const Eigen::Matrix3d cones = spectral::lmsFromXyz(spec.cat);
  const Eigen::Array3d whiteCones = (cones * white).array();
  const Eigen::Array3d inputCones = (cones * input.whiteXyz()).array();
  const Eigen::Array3d outputCones = (cones * output.whiteXyz()).array();
  Eigen::Array3d gain = (1.0 - spec.adaptation) * whiteCones / inputCones;
  if (spec.adaptation > 0.0) {
    if (outputCones.minCoeff() <= 1e-9) {
      throw InputError(spec.output.illuminant.name(), "adaptation", std::to_string(spec.adaptation),
                       "the eye cannot adapt to this light with " + spectral::nameOf(spec.cat) +
                           " (no response in one cone); use adaptation 0 or vonkries");
    }
    gain += spec.adaptation * whiteCones / outputCones;
  }
  const Eigen::Matrix3d rgbFromOutputXyz =
      exposure * spec.space.rgbFromXyz() * cones.inverse() * gain.matrix().asDiagonal() * cones;
  state->rgbFromOutputResponse = rgbFromOutputXyz * output.xyzFromResponse;
  state->rgbFromSpectrum = state->rgbFromOutputResponse * bandWeights(output.light, output.curves, bandCount);

  state->spectrumToRgb = state->rgbFromSpectrum.transpose();

  const auto weightsOf = [&](int count) -> Eigen::Matrix3Xd {
    return input.white.cwiseInverse().asDiagonal() * bandWeights(input.light, input.curves, count);
  };
  const Eigen::Matrix3Xd weights = weightsOf(bandCount);
  state->basis = signalBasis(weights, state->diagnostics.conditionNumber);
  state->diagnostics.rank = static_cast<int>(state->basis.cols());
  Eigen::Matrix3Xd rows = Eigen::Matrix3Xd::Zero(3, bandCount);
  rows.topRows(state->basis.cols()) = state->basis.transpose() * weights;
  state->solver.emplace(rows);
  const bool isCamera = spec.input.observer.response == spectral::Observer::Response::Camera;
  const auto coneOf = [&](const Eigen::Matrix3Xd& rays) { return FeasibleCone(rays, state->basis); };
  const auto inRange = [&](const Eigen::Matrix3Xd& all) { return isCamera ? withinRange(all, input.curves) : all; };
  // What these bands can make, and what it takes no impossible reflectance for: the latter whatever the bands.
  state->cone = coneOf(inRange(weights)).within(coneOf(litGenerators(inRange(weightsOf(kConvergedBandCount)))));

  const Eigen::Matrix3d matrix = state->rgbFromSpectrum * state->onResponse(state->solver->unconstrained());
  const Eigen::Matrix3d ordinaryAdaptation =
      rgbFromOutputXyz * cones.inverse() * (outputCones / inputCones).matrix().asDiagonal() * cones * xyzFromNormalised;
  state->extension =
      matrix + ordinaryAdaptation * (Eigen::Matrix3d::Identity() - state->basis * state->basis.transpose());
  state->diagnostics.matrixGain =
      Eigen::JacobiSVD<Eigen::Matrix3d>(state->extension * state->responseFromRgb).singularValues()[0];

  if (spec.scene.kind != ReferenceScene::Kind::Smooth) {
    if (state->basis.cols() < 3) {
      throw InputError(spec.input.illuminant.name(), "scene", "dataset or prior",
                       "this light does not tell three channels apart; use scene kind smooth");
    }
    if (spec.scene.samples.empty()) {
      throw InputError("recipe", "scene.set", "", "a dataset or prior needs a set of reflectances");
    }
    Eigen::MatrixXd samples(bandCount, static_cast<Eigen::Index>(spec.scene.samples.size()));
    for (std::size_t i = 0; i < spec.scene.samples.size(); ++i) {
      samples.col(static_cast<Eigen::Index>(i)) = atBandCentres(spec.scene.samples[i], bandCount);
    }
    if (spec.scene.kind == ReferenceScene::Kind::Dataset) {
      state->dataset.emplace(weights, samples);
    } else {
      state->prior.emplace(weights, xyzFromNormalised, samples, spec.scene.strength, spec.scene.radius);
    }
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
  const Eigen::Vector3d response = m_state->responseFromRgb * (scale * rgb);
  const auto projection = m_state->domain().project(response);
  Eigen::Vector3d result = m_state->extension * (response - projection.point);
  if (!projection.point.isZero(0.0)) {
    if (m_state->dataset) {
      result += m_state->rgbFromSpectrum *
                (m_state->dataset->locate(projection.point).spectrumFromResponse * projection.point);
    } else {
      result += m_state->rgbFromSpectrum * m_state->solve(projection.point).reflectance;
    }
  }
  return result / scale;
}

void SpectralTransform::apply(std::span<float> rgba) const {
  assert(rgba.size() % 4 == 0);
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    Eigen::Map<Eigen::Vector3f> pixel(rgba.data() + i);
    const Eigen::Vector3d result = apply(Eigen::Vector3d(pixel.cast<double>()));
    pixel = result.cast<float>();
  }
}

SpectralTransform::Linearisation SpectralTransform::linearise(const Eigen::Vector3d& rgb,
                                                              const ActiveSet* guess) const {
  Linearisation local;
  if (m_state->identity) {
    return {rgb, Eigen::Matrix3d::Identity(), {}, isFeasible(rgb)};
  }
  if (m_state->prior) {
    local.isFeasible = isFeasible(rgb);
    // The blend's own gradient has no closed form worth its code: central differences.
    local.value = apply(rgb);
    const double step = kDifferenceStep * rgb.cwiseAbs().maxCoeff();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d offset = step * Eigen::Vector3d::Unit(k);
      local.matrix.col(k) = (apply(rgb + offset) - apply(rgb - offset)) / (2.0 * step);
    }
    return local;
  }
  const double scale = rgb.isZero(0.0) ? 1.0 : exposureScale(rgb);
  const Eigen::Vector3d response = m_state->responseFromRgb * (scale * rgb);
  const auto projection = m_state->domain().project(response);
  local.isFeasible = projection.piece == 0;
  Eigen::Matrix3d inside = Eigen::Matrix3d::Zero();
  if (!projection.point.isZero(0.0)) {
    if (m_state->dataset) {
      inside = m_state->rgbFromSpectrum * m_state->dataset->locate(projection.point).spectrumFromResponse;
    } else {
      inside = m_state->onResponse(m_state->linearise(projection.point, guess, local.active));
    }
  }
  local.matrix = (inside * projection.matrix + m_state->extension * (Eigen::Matrix3d::Identity() - projection.matrix)) *
                 m_state->responseFromRgb;
  local.value = local.matrix * rgb;
  return local;
}

std::optional<Eigen::VectorXd> SpectralTransform::reflectance(const Eigen::Vector3d& rgb) const {
  const Eigen::Vector3d response = m_state->responseFromRgb * rgb;
  const auto projection = m_state->domain().project(response);
  if (!rgb.allFinite() || projection.piece != 0) {
    return std::nullopt;
  }
  if (m_state->dataset) {
    return Eigen::VectorXd(m_state->dataset->locate(response).spectrumFromResponse * response);
  }
  return m_state->solve(response).reflectance;
}

bool SpectralTransform::isFeasible(const Eigen::Vector3d& rgb) const {
  return rgb.allFinite() && m_state->domain().contains(m_state->responseFromRgb * rgb);
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
Eigen::Matrix3d SpectralTransform::unconstrainedMatrix() const {
  return m_state->identity ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                           : Eigen::Matrix3d(m_state->extension * m_state->responseFromRgb);
}
Eigen::Matrix3d SpectralTransform::responseFromRgb() const {
  return m_state->responseFromRgb;
}
Eigen::Matrix3d SpectralTransform::rgbFromOutputResponse() const {
  return m_state->rgbFromOutputResponse;
}
Eigen::Vector3d SpectralTransform::whiteXyz() const {
  return m_state->space.whiteXyz();
}
SpectralTransform::Diagnostics SpectralTransform::diagnostics() const {
  return m_state->diagnostics;
}

std::vector<Eigen::Vector3d> SpectralTransform::linearConeCorners() const {
  if (m_state->identity || m_state->dataset || m_state->prior || m_state->cone->rank() < 3) {
    return {};
  }
  std::vector<Eigen::Vector3d> corners = m_state->cone->corners();
  const Eigen::MatrixX3d& spectrum = m_state->solver->unconstrained();
  for (Eigen::Index b = 0; b < spectrum.rows() && corners.size() >= 3; ++b) {
    corners = clipRays(corners, spectrum.row(b).transpose());
  }
  if (corners.size() < 3) {
    return {};
  }
  const Eigen::Matrix3d rgbFromResponse = m_state->responseFromRgb.inverse();
  for (auto& corner : corners) {
    corner = rgbFromResponse * corner;
  }
  return corners;
}

}  // namespace metamer::sip
