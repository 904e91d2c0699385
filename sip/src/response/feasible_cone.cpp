// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/feasible_cone.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "response/ray_polygon.h"

namespace metamer::sip {

namespace {

/// Generators this much lighter than the heaviest, or than faint ones, are noise.
constexpr double kDark = 1e-9;

const Eigen::Vector3d kWhite = Eigen::Vector3d::Constant(1.0 / 3.0);

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

Eigen::Matrix3Xd litGenerators(const Eigen::Matrix3Xd& rays) {
  const double faint = kFaintGenerator * rays.sum() / static_cast<double>(rays.cols());
  Eigen::Matrix3Xd lit(3, rays.cols());
  Eigen::Index count = 0;
  for (const auto& ray : rays.colwise()) {
    if (ray.sum() > kDark * faint) {
      const double heaviness = ray.sum() / faint;
      const double faintness = 1.0 / (1.0 + heaviness * heaviness * heaviness * heaviness);
      lit.col(count++) = (1.0 - faintness) * ray / ray.sum() + faintness * kWhite;
    }
  }
  return lit.leftCols(count);
}

FeasibleCone::FeasibleCone(const Eigen::Matrix3Xd& rays, const Eigen::Matrix3Xd& basis) : m_basis(basis) {
  const double heaviest = rays.colwise().sum().maxCoeff();
  std::vector<Eigen::Vector3d> drawnIn;
  for (Eigen::Index i = 0; i < rays.cols(); ++i) {
    const double weight = rays.col(i).sum();
    if (weight > kDark * heaviest) {
      drawnIn.emplace_back((1.0 - kMargin) * rays.col(i) / weight + kMargin * kWhite);
    }
  }
  assert(!drawnIn.empty());
  if (rank() == 1) {
    m_corners.emplace_back(basis.col(0) * (basis.col(0).sum() < 0.0 ? -1.0 : 1.0));
    return;
  }
  if (rank() == 2) {
    const auto [low, high] = std::minmax_element(drawnIn.begin(), drawnIn.end(), [this](const auto& a, const auto& b) {
      return angleFromWhite(a) < angleFromWhite(b);
    });
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
  setNormals();
}

FeasibleCone FeasibleCone::within(const FeasibleCone& other) const {
  FeasibleCone shared = *this;
  if (rank() == 2) {
    const auto narrower = [this](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return std::abs(angleFromWhite(a)) < std::abs(angleFromWhite(b)) ? a : b;
    };
    for (std::size_t side = 0; side < 2; ++side) {
      shared.m_corners[side] = narrower(m_corners[side], other.m_corners[side]);
    }
  } else if (rank() == 3) {
    for (const Eigen::Vector3d& normal : other.m_normals) {
      shared.m_corners = clipRays(shared.m_corners, normal);
    }
    for (Eigen::Vector3d& corner : shared.m_corners) {
      corner.normalize();
    }
    shared.setNormals();
  }
  return shared;
}

void FeasibleCone::setNormals() {
  m_normals.clear();
  for (std::size_t i = 0; i < m_corners.size(); ++i) {
    const Eigen::Vector3d normal = m_corners[i].cross(m_corners[(i + 1) % m_corners.size()]).normalized();
    m_normals.emplace_back(normal.dot(kWhite) < 0.0 ? -normal : normal);
  }
}

double FeasibleCone::angleFromWhite(const Eigen::Vector3d& ray) const {
  const Eigen::Vector2d inPlane = m_basis.transpose() * ray;
  const Eigen::Vector2d white = m_basis.transpose() * kWhite;
  return std::atan2(white.x() * inPlane.y() - white.y() * inPlane.x(), inPlane.dot(white));
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
