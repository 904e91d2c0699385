// SPDX-License-Identifier: Apache-2.0
#include "scenes/dataset_scene.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "metamer/spectral/input_error.h"
#include "pairs/pair_conflicts.h"
#include "response/chromaticity.h"
#include "scenes/delaunay.h"

namespace metamer::sip {

namespace {

constexpr double kRounding = 1e-12;
/// Least variance of the samples' chromaticities in any direction.
constexpr double kLeastVariance = 1e-6;

/// Lets samples that lie too near to one another for their spectra keep what they agree on.
/// @param chromaticities  of the samples, white first
/// @param deviations      of unit sum
void settle(const std::vector<Eigen::Vector2d>& chromaticities, Eigen::MatrixXd& deviations) {
  const auto count = static_cast<Eigen::Index>(chromaticities.size());
  Eigen::Matrix2Xd places(2, count);
  Eigen::MatrixXd ofMeanOne(deviations.rows(), count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index from = (i + 1) % count;
    places.col(i) = chromaticities[static_cast<std::size_t>(from)];
    ofMeanOne.col(i) = 3.0 * deviations.col(from);
  }
  const Eigen::Matrix2Xd centred = places.colwise() - Eigen::Vector2d(places.rowwise().mean());
  const Eigen::Matrix2d covariance =
      centred * centred.transpose() / static_cast<double>(count) + kLeastVariance * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d whitening = Eigen::Matrix2d(covariance.llt().matrixL()).inverse();
  const SettledPairs settled = settledPairs(whitening * places, ofMeanOne);
  for (Eigen::Index i = 0; i < count; ++i) {
    deviations.col((i + 1) % count) = settled.deviations.col(i) / 3.0;
  }
}

}  // namespace

DatasetScene::DatasetScene(const SoftBoundSolver& solver, const Eigen::MatrixXd& reflectances) {
  const Eigen::Matrix3Xd& weights = solver.weights();
  const Eigen::Index bandCount = weights.cols();
  struct Group {
    Eigen::Vector2d chromaticity;
    Eigen::VectorXd spectrum;
    int members;
  };
  std::vector<Group> groups;
  const Eigen::VectorXd perfect = Eigen::VectorXd::Ones(bandCount) / 3.0;
  groups.push_back({Eigen::Vector2d::Constant(1.0 / 3.0), perfect, 1});
  for (Eigen::Index i = 0; i < reflectances.cols(); ++i) {
    const Eigen::Vector3d response = weights * reflectances.col(i);
    const double sum = response.sum();
    if (sum < 3.0 * kDarkestMean) {
      continue;
    }
    const Eigen::Vector2d chromaticity = response.head<2>() / sum;
    const auto near = std::find_if(groups.begin(), groups.end(), [&](const Group& group) {
      return (group.chromaticity - chromaticity).norm() < kMergeDistance;
    });
    if (near == groups.end()) {
      groups.push_back({chromaticity, reflectances.col(i) / sum, 1});
    } else if (near != groups.begin()) {  // white itself stays the perfect reflector
      near->spectrum = (near->spectrum * near->members + reflectances.col(i) / sum) / (near->members + 1);
      ++near->members;
    }
  }
  const auto count = static_cast<Eigen::Index>(groups.size());
  m_responses.resize(3, count);
  m_deviations.resize(bandCount, count);
  std::vector<Eigen::Vector2d> chromaticities;
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::VectorXd& spectrum = groups[static_cast<std::size_t>(i)].spectrum;
    m_responses.col(i) = weights * spectrum;
    m_deviations.col(i) = spectrum - solver.unclamped() * m_responses.col(i);
    chromaticities.emplace_back(m_responses.col(i).head<2>() / m_responses.col(i).sum());
  }
  settle(chromaticities, m_deviations);
  m_triangles = delaunayTriangles(chromaticities);
  if (m_triangles.empty()) {
    throw spectral::InputError("scene", "dataset", std::to_string(reflectances.cols()) + " samples",
                               "under this light they do not span a plane of chromaticities; use another set or light");
  }
  for (const auto& triangle : m_triangles) {
    Eigen::Matrix3d corners;
    corners << m_responses.col(triangle[0]), m_responses.col(triangle[1]), m_responses.col(triangle[2]);
    m_barycentric.emplace_back(corners.inverse());
  }
  std::map<std::pair<int, int>, int> uses;
  for (const auto& triangle : m_triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++uses[std::minmax(triangle[k], triangle[(k + 1) % 3])];
    }
  }
  for (const auto& [edge, triangles] : uses) {
    if (triangles == 1) {
      m_hull.push_back({edge.first, edge.second});
    }
  }
}

BandTriple DatasetScene::piece(const Eigen::Vector3d& response) const {
  // On an edge or a corner rounding may put a colour outside every triangle that it belongs to.
  const double sum = response.sum();
  for (std::size_t t = 0; t < m_triangles.size(); ++t) {
    if ((m_barycentric[t] * response).minCoeff() >= -kRounding * sum) {
      const auto& corners = m_triangles[t];
      BandTriple deviations(m_deviations.rows(), 3);
      deviations << m_deviations.col(corners[0]), m_deviations.col(corners[1]), m_deviations.col(corners[2]);
      return deviations * m_barycentric[t];
    }
  }
  // Outside: the nearest place on the hull, in the plane of chromaticity.
  const Eigen::Vector2d place = response.head<2>() / sum;
  double nearest = std::numeric_limits<double>::infinity();
  std::array<int, 2> best = m_hull.front();
  Eigen::Vector2d along = Eigen::Vector2d::Zero();
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  double bestPart = 0.0;
  for (const auto& edge : m_hull) {
    const Eigen::Vector2d a = m_responses.col(edge[0]).head<2>();
    const Eigen::Vector2d ab = m_responses.col(edge[1]).head<2>() - a;
    const double part = std::clamp((place - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
    const double distance = (place - a - part * ab).norm();
    if (distance < nearest) {
      nearest = distance;
      best = edge;
      along = ab;
      from = a;
      bestPart = part;
    }
  }
  // value = sum * (first + part (second - first)), and sum * part is linear in the response.
  const BandVector first = m_deviations.col(best[0]);
  const BandVector step = m_deviations.col(best[1]) - first;
  if (bestPart <= 0.0 || bestPart >= 1.0) {
    return (first + bestPart * step) * Eigen::RowVector3d::Ones();
  }
  Eigen::RowVector3d partTimesSum = Eigen::RowVector3d::Constant(-from.dot(along));
  partTimesSum.head<2>() += along.transpose();
  return first * Eigen::RowVector3d::Ones() + step * (partTimesSum / along.squaredNorm());
}

BandVector DatasetScene::deviation(const Eigen::Vector3d& response) const {
  if (!(response.sum() > 0.0)) {
    return BandVector::Zero(m_deviations.rows());
  }
  return piece(response) * response;
}

Eigen::MatrixXd DatasetScene::deviations(const Eigen::Matrix3Xd& responses) const {
  Eigen::MatrixXd result(m_deviations.rows(), responses.cols());
  for (Eigen::Index k = 0; k < responses.cols(); ++k) {
    result.col(k) = deviation(responses.col(k));
  }
  return result;
}

DatasetScene::Local DatasetScene::local(const Eigen::Vector3d& response) const {
  if (!(response.sum() > 0.0)) {
    return {BandVector::Zero(m_deviations.rows()), BandTriple::Zero(m_deviations.rows(), 3)};
  }
  const BandTriple slope = piece(response);
  return {slope * response, slope};
}

}  // namespace metamer::sip
