// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/spectral_locus.h"

#include <algorithm>
#include <limits>

#include "metamer/spectral/input_error.h"

namespace metamer::sip {

namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace

SpectralLocus::SpectralLocus(const spectral::Observer& observer) {
  if (observer.response != spectral::Observer::Response::Xyz) {
    throw spectral::InputError("", "observer", observer.name, "must be a CIE observer, whose curves are X, Y, Z");
  }
  const auto curves = observer.onDomain();
  std::vector<Eigen::Vector2d> points;
  for (Eigen::Index i = 0; i < curves.rows(); ++i) {
    const double sum = curves.row(i).sum();
    if (sum > 0.0) {
      points.emplace_back(curves.row(i).head<2>().transpose() / sum);
    }
  }
  // Convex hull (Andrew's monotone chain): the tables' last digits dent the locus at both ends.
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  const auto addChain = [&](auto begin, auto end) {
    const std::size_t start = m_corners.size();
    for (auto point = begin; point != end; ++point) {
      while (m_corners.size() >= start + 2 &&
             cross(m_corners.back() - m_corners[m_corners.size() - 2], *point - m_corners.back()) <= 0.0) {
        m_corners.pop_back();
      }
      m_corners.push_back(*point);
    }
    m_corners.pop_back();
  };
  addChain(points.begin(), points.end());
  addChain(points.rbegin(), points.rend());
}

bool SpectralLocus::contains(const Eigen::Vector2d& xy) const {
  for (std::size_t i = 0; i < m_corners.size(); ++i) {
    const Eigen::Vector2d& a = m_corners[i];
    if (cross(m_corners[(i + 1) % m_corners.size()] - a, xy - a) < 0.0) {
      return false;
    }
  }
  return true;
}

double SpectralLocus::distanceFrom(const Eigen::Vector2d& xy, const Eigen::Vector2d& direction) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < m_corners.size(); ++i) {
    const Eigen::Vector2d& a = m_corners[i];
    const Eigen::Vector2d edge = m_corners[(i + 1) % m_corners.size()] - a;
    const double approach = cross(direction, edge);
    if (approach > 0.0) {  // leaving through this edge
      nearest = std::min(nearest, cross(a - xy, edge) / approach);
    }
  }
  return nearest;
}

}  // namespace metamer::sip
