// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/feasible_cone.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>

namespace metamer::sip {

namespace {

/// Generators this much lighter than the heaviest (ends of the visible range) do not widen the cone: a reflectance
/// would have to be as many times brighter to use them.
constexpr double kLightestGenerator = 1e-9;

Eigen::Vector2d chromaticityOf(const Eigen::Vector3d& ray) {
  return ray.head<2>() / ray.sum();
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Andrew's monotone chain, counter-clockwise, without collinear points.
std::vector<Eigen::Vector2d> convexHull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y()); });
  std::vector<Eigen::Vector2d> hull;
  const auto extend = [&hull](const Eigen::Vector2d& point, std::size_t floor) {
    while (hull.size() >= floor + 2 && cross(hull[hull.size() - 2], hull.back(), point) <= 1e-12) {
      hull.pop_back();
    }
    hull.push_back(point);
  };
  for (const auto& point : points) {
    extend(point, 0);
  }
  const std::size_t lower = hull.size() - 1;
  for (auto point = points.rbegin() + 1; point != points.rend(); ++point) {
    extend(*point, lower);
  }
  hull.pop_back();
  return hull;
}

}  // namespace

FeasibleCone::FeasibleCone(const Eigen::Matrix3Xd& rays, const Eigen::Matrix3Xd& basis) : m_basis(basis) {
  const Eigen::Vector3d white = Eigen::Vector3d::Constant(1.0 / 3.0);
  const double heaviest = rays.colwise().sum().maxCoeff();
  std::vector<Eigen::Vector3d> drawnIn;
  for (Eigen::Index i = 0; i < rays.cols(); ++i) {
    const double weight = rays.col(i).sum();
    if (weight > kLightestGenerator * heaviest) {
      drawnIn.emplace_back((1.0 - kMargin) * rays.col(i) / weight + kMargin * white);
    }
  }
  assert(!drawnIn.empty());
  if (rank() == 1) {
    m_corners.emplace_back(basis.col(0) * (basis.col(0).sum() < 0.0 ? -1.0 : 1.0));
    return;
  }
  if (rank() == 2) {
    // In the plane: the two outermost directions.
    const auto angle = [&](const Eigen::Vector3d& ray) {
      const Eigen::Vector2d inPlane = basis.transpose() * ray;
      const Eigen::Vector2d whiteInPlane = basis.transpose() * white;
      return std::atan2(whiteInPlane.x() * inPlane.y() - whiteInPlane.y() * inPlane.x(), inPlane.dot(whiteInPlane));
    };
    const auto [low, high] = std::minmax_element(drawnIn.begin(), drawnIn.end(),
                                                 [&](const auto& a, const auto& b) { return angle(a) < angle(b); });
    for (const auto& ray : {*low, *high}) {
      m_corners.emplace_back((basis * (basis.transpose() * ray)).normalized());
    }
    return;
  }
  std::vector<Eigen::Vector2d> chromaticities;
  chromaticities.reserve(drawnIn.size());
  for (const auto& ray : drawnIn) {
    chromaticities.push_back(chromaticityOf(ray));
  }
  for (const auto& corner : convexHull(std::move(chromaticities))) {
    m_corners.push_back(Eigen::Vector3d(corner.x(), corner.y(), 1.0 - corner.x() - corner.y()).normalized());
  }
  for (std::size_t i = 0; i < m_corners.size(); ++i) {
    Eigen::Vector3d normal = m_corners[i].cross(m_corners[(i + 1) % m_corners.size()]).normalized();
    m_normals.push_back(normal.dot(white) < 0.0 ? Eigen::Vector3d(-normal) : normal);
  }
}

bool FeasibleCone::contains(const Eigen::Vector3d& colour) const {
  return rank() == 3 && std::all_of(m_normals.begin(), m_normals.end(),
                                    [&](const Eigen::Vector3d& normal) { return normal.dot(colour) >= 0.0; });
}

FeasibleCone::Projection FeasibleCone::project(const Eigen::Vector3d& colour) const {
  if (contains(colour)) {
    return {colour, Eigen::Matrix3d::Identity(), 0};
  }
  const int corners = static_cast<int>(m_corners.size());
  // A facet, where the foot of the perpendicular falls between its two rays.
  const int facets = corners >= 3 ? corners : corners - 1;
  for (int i = 0; i < facets; ++i) {
    const Eigen::Vector3d& from = m_corners[i];
    const Eigen::Vector3d& to = m_corners[(i + 1) % corners];
    const Eigen::Vector3d normal = rank() == 3 ? m_normals[i] : Eigen::Vector3d(from.cross(to).normalized());
    if (rank() == 3 && normal.dot(colour) >= 0.0) {
      continue;
    }
    const Eigen::Matrix3d projector = Eigen::Matrix3d::Identity() - normal * normal.transpose();
    const Eigen::Vector3d foot = projector * colour;
    // Coordinates along the two rays, by the 2 x 2 normal equations of the pair.
    const double cosine = from.dot(to);
    const double alongFrom = foot.dot(from) - cosine * foot.dot(to);
    const double alongTo = foot.dot(to) - cosine * foot.dot(from);
    if (alongFrom >= 0.0 && alongTo >= 0.0) {
      return {foot, projector, 1 + i};
    }
  }
  // Else the nearest ray, or the apex for what lies behind all of them.
  int nearest = -1;
  double longest = 0.0;
  for (int i = 0; i < corners; ++i) {
    const double length = m_corners[i].dot(colour);
    if (length > longest) {
      longest = length;
      nearest = i;
    }
  }
  if (nearest < 0) {
    return {Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), 1 + 2 * corners};
  }
  const Eigen::Vector3d& ray = m_corners[nearest];
  return {longest * ray, ray * ray.transpose(), 1 + corners + nearest};
}

}  // namespace metamer::sip
