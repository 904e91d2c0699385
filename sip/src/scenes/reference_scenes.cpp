// SPDX-License-Identifier: Apache-2.0
#include "scenes/reference_scenes.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/input_error.h"
#include "scenes/delaunay.h"

namespace metamer::sip {

namespace {

/// Samples darker than this fraction of white carry no usable chromaticity.
constexpr double kDarkest = 1e-4;

}  // namespace

DatasetScene::DatasetScene(const Eigen::Matrix3Xd& weights, const Eigen::MatrixXd& reflectances) {
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
    if (sum < 3.0 * kDarkest) {
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
  m_spectra.resize(bandCount, count);
  std::vector<Eigen::Vector2d> chromaticities;
  for (Eigen::Index i = 0; i < count; ++i) {
    m_spectra.col(i) = groups[static_cast<std::size_t>(i)].spectrum;
    m_responses.col(i) = weights * m_spectra.col(i);
    chromaticities.emplace_back(m_responses.col(i).head<2>() / m_responses.col(i).sum());
  }
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
  m_cone.emplace(m_responses, Eigen::Matrix3d::Identity());
}

DatasetScene::Piece DatasetScene::locate(const Eigen::Vector3d& response) const {
  int best = 0;
  double deepest = -std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < m_triangles.size(); ++t) {
    const double lowest = (m_barycentric[t] * response).minCoeff();
    if (lowest > deepest) {
      deepest = lowest;
      best = static_cast<int>(t);
      if (lowest >= 0.0) {
        break;
      }
    }
  }
  const auto& corners = m_triangles[static_cast<std::size_t>(best)];
  Eigen::MatrixX3d spectra(m_spectra.rows(), 3);
  spectra << m_spectra.col(corners[0]), m_spectra.col(corners[1]), m_spectra.col(corners[2]);
  return {best, spectra * m_barycentric[static_cast<std::size_t>(best)]};
}

PriorScene::PriorScene(const Eigen::Matrix3Xd& weights, const Eigen::Matrix3d& xyzFromNormalised,
                       const Eigen::MatrixXd& reflectances, double strength, double radius)
    : m_xyzFromNormalised(xyzFromNormalised), m_strength(strength), m_radius(radius) {
  if (!(strength >= 0.0 && strength <= 1.0)) {
    throw spectral::InputError("scene", "strength", std::to_string(strength), "give a number from 0 to 1");
  }
  if (!(radius > 0.0 && radius <= 1.0)) {
    throw spectral::InputError("scene", "radius", std::to_string(radius), "give a distance in xy above 0, at most 1");
  }
  m_spectra.resize(reflectances.rows(), reflectances.cols());
  Eigen::Index used = 0;
  for (Eigen::Index i = 0; i < reflectances.cols(); ++i) {
    const Eigen::Vector3d response = weights * reflectances.col(i);
    if (response.sum() < 3.0 * kDarkest) {
      continue;
    }
    m_chromaticities.push_back(spectral::chromaticity(m_xyzFromNormalised * response));
    m_spectra.col(used++) = reflectances.col(i) / response.sum();
  }
  m_spectra.conservativeResize(Eigen::NoChange, used);
}

Eigen::VectorXd PriorScene::blend(const Eigen::Vector3d& response) const {
  const Eigen::Vector2d chromaticity = spectral::chromaticity(m_xyzFromNormalised * response);
  Eigen::VectorXd kernel(static_cast<Eigen::Index>(m_chromaticities.size()));
  for (Eigen::Index i = 0; i < kernel.size(); ++i) {
    const double distance = (m_chromaticities[static_cast<std::size_t>(i)] - chromaticity).norm() / m_radius;
    kernel[i] = std::exp(-0.5 * distance * distance);
  }
  const double fade = std::exp(-0.5 * 3.0 * 3.0);
  return m_strength * response.sum() / (fade + kernel.sum()) * (m_spectra * kernel);
}

}  // namespace metamer::sip
