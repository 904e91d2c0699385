// SPDX-License-Identifier: Apache-2.0
#include "scenes/measured_scene.h"

#include "response/chromaticity.h"

namespace metamer::sip {

namespace {

using Eigen::Index;

/// Places with room for the three spectra of a Gaussian, whose kernel is no sample's.
Eigen::ArrayX2d withThreeMore(const Eigen::ArrayX2d& places) {
  Eigen::ArrayX2d more = Eigen::ArrayX2d::Zero(places.rows() + 3, 2);
  more.topRows(places.rows()) = places;
  return more;
}

/// The slope of `n s(q)` by the response, from s and its derivatives by q.
template <typename Values>
auto slopeOf(const Values& values, const MeasuredScene::Mixture& mixture) {
  return values.col(0) * Eigen::RowVector3d::Constant(1.0 / 3.0) +
         mixture.mean * (values.template rightCols<2>() * mixture.placeSlope);
}

}  // namespace

MeasuredScene::MeasuredScene(const SoftBoundSolver& solver, const MeasuredSeeds& seeds,
                             const std::optional<SkinGaussian>& skin)
    : m_differences(seeds.differences),
      m_kernel(skin ? withThreeMore(seeds.places) : seeds.places),
      m_skin(skin),
      m_samples(seeds.places.rows()),
      m_bands(kNodeCount, solver.bandCount()) {
  // Samples are kept less smooth spectra at the nodes, so that sums lose no digits; what these differ by from the
  // smooth spectra at the bands is made up for.
  const Eigen::MatrixX3d nodeSmooth = m_bands.atNodes(solver.unclamped());
  m_smooth = solver.unclamped() - m_bands.atBands(nodeSmooth);
  Eigen::MatrixXd coefficients = seeds.solved;
  if (skin) {
    coefficients.conservativeResize(Eigen::NoChange, m_samples + 3);
    coefficients.rightCols<3>() = skin->spectra();
  }
  coefficients.topRows(kNodeCount) -= nodeSmooth * coefficients.bottomRows<3>();
  m_coefficients = WeightedSums(coefficients);
}

MeasuredScene::Chromaticity MeasuredScene::chromaticityOf(const Eigen::Vector3d& response) const {
  const double mean = response.mean();
  return {mean, m_differences * response / mean};
}

void MeasuredScene::weigh(const Eigen::Vector2d& place, Eigen::Ref<Eigen::VectorXd> values) const {
  m_kernel.values(place, values);
  if (m_skin) {
    const double share = m_skin->share(place).value;
    values.head(m_samples) *= 1.0 - share;
    values.segment<3>(m_samples) = share * m_skin->response(place);
  }
}

Eigen::MatrixX3d MeasuredScene::weighed(const Eigen::Vector2d& place) const {
  Eigen::MatrixX3d kernel = m_kernel.valuesAndSlopes(place);
  if (m_skin) {
    const SkinGaussian::Share share = m_skin->share(place);
    const Eigen::VectorXd values = kernel.col(0).head(m_samples);
    kernel.topRows(m_samples) *= 1.0 - share.value;
    kernel.topRightCorner(m_samples, 2) -= values * share.slope.transpose();
    const Eigen::Vector3d response = m_skin->response(place);
    kernel.middleRows<3>(m_samples) << share.value * response,
        response * share.slope.transpose() + share.value * m_skin->responseSlope();
  }
  return kernel;
}

BandVector MeasuredScene::atBands(const Eigen::Ref<const Eigen::VectorXd>& sums) const {
  return m_bands.atBands(sums) - m_smooth * sums.segment<3>(kNodeCount);
}

Eigen::MatrixXd MeasuredScene::deviations(const Eigen::Matrix3Xd& responses) const {
  std::vector<Index> near;
  for (Index k = 0; k < responses.cols(); ++k) {
    if (hasChromaticity(responses.col(k))) {
      near.push_back(k);
    }
  }
  const auto count = static_cast<Index>(near.size());
  Eigen::MatrixXd kernels(m_kernel.rows(), count);
  for (Index i = 0; i < count; ++i) {
    weigh(chromaticityOf(responses.col(near[static_cast<std::size_t>(i)])).place, kernels.col(i));
  }
  const Eigen::MatrixXd sums = m_coefficients.of(kernels);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(m_bands.bandCount(), responses.cols());
  for (Index i = 0; i < count; ++i) {
    const Index k = near[static_cast<std::size_t>(i)];
    result.col(k) = responses.col(k).mean() * atBands(sums.col(i));
  }
  return result;
}

std::optional<MeasuredScene::Mixture> MeasuredScene::mixture(const Eigen::Vector3d& response) const {
  if (!hasChromaticity(response)) {
    return std::nullopt;
  }
  const Chromaticity colour = chromaticityOf(response);
  return Mixture{colour.mean, sip::placeSlope(m_differences, colour.place, colour.mean), weighed(colour.place)};
}

MeasuredScene::Local MeasuredScene::local(const Mixture& mixture) const {
  const Eigen::MatrixXd sums = m_coefficients.of(mixture.kernel);
  BandTriple spectra(m_bands.bandCount(), 3);
  for (Index k = 0; k < 3; ++k) {
    spectra.col(k) = atBands(sums.col(k));
  }
  return {mixture.mean * spectra.col(0), slopeOf(spectra, mixture)};
}

MeasuredScene::Local MeasuredScene::local(const Eigen::Vector3d& response) const {
  if (const auto mixed = mixture(response)) {
    return local(*mixed);
  }
  return {BandVector::Zero(m_bands.bandCount()), BandTriple::Zero(m_bands.bandCount(), 3)};
}

WeightedSums MeasuredScene::seenBy(const Eigen::Matrix3Xd& weights) const {
  const auto spectra = m_coefficients.spectra();
  return WeightedSums(m_bands.nodeWeights(weights) * spectra.topRows(kNodeCount) -
                      weights * m_smooth * spectra.bottomRows(3));
}

Eigen::Matrix3d MeasuredScene::slope(const Mixture& mixture, const WeightedSums& seen) {
  const Eigen::Matrix3d values = seen.of(mixture.kernel).topRows<3>();
  return slopeOf(values, mixture);
}

}  // namespace metamer::sip
