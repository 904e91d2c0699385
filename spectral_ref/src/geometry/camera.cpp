// SPDX-License-Identifier: Apache-2.0
#include "geometry/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "metamer/spectral/vector_lanes.h"

namespace metamer::spectral_ref {
namespace {

double normalCdf(double x) {
  return 0.5 * std::erfc(-x / std::sqrt(2.0));
}

/// Inverse of the normal distribution by Newton's method on a bracket: used once a sample, and exact.
double normalQuantile(double p) {
  double low = -8.0;
  double high = 8.0;
  double x = 0.0;
  constexpr int kMostSteps = 60;
  for (int i = 0; i < kMostSteps && high - low > 1e-9; ++i) {
    const double error = normalCdf(x) - p;
    (error > 0 ? high : low) = x;
    const double slope = std::exp(-0.5 * x * x) / std::sqrt(2.0 * static_cast<double>(kPi));
    const double next = x - error / slope;
    if (std::abs(error) < 1e-12) {
      break;
    }
    x = next > low && next < high ? next : 0.5 * (low + high);
  }
  return x;
}

/// The directions corner + right x + down y.
METAMER_VECTOR_LANES void directionsThrough(const std::array<Vec3, 3>& film, const EachRay<float>& x,
                                            const EachRay<float>& y, EachVec3& directions) {
  const auto& [corner, right, down] = film;
  const float cx = corner.x(), cy = corner.y(), cz = corner.z();
  const float rx = right.x(), ry = right.y(), rz = right.z();
  const float dx = down.x(), dy = down.y(), dz = down.z();
  for (std::size_t i = 0; i < kRaysTogether; ++i) {
    const float a = cx + rx * x[i] + dx * y[i];
    const float b = cy + ry * x[i] + dy * y[i];
    const float c = cz + rz * x[i] + dz * y[i];
    const float inverse = 1.0F / std::sqrt(a * a + b * b + c * c);
    directions.x[i] = a * inverse;
    directions.y[i] = b * inverse;
    directions.z[i] = c * inverse;
  }
}

/// Places about pixels' centres, evenly over a box.
METAMER_VECTOR_LANES void placesInBoxes(const EachRay<int>& pixels, const EachRay<float>& u, float radius,
                                        EachRay<float>& places) {
  const float width = 2.0F * radius;
  METAMER_RAYS_APART
  for (std::size_t i = 0; i < kRaysTogether; ++i) {
    places[i] = (static_cast<float>(pixels[i]) + 0.5F) + (u[i] - 0.5F) * width;
  }
}

}  // namespace

Camera::Camera(const CameraSettings& settings, const FilmSettings& film)
    : m_origin(settings.origin.cast<float>()),
      m_filter(film.filter),
      m_radius(static_cast<float>(film.filterRadius)),
      m_sigma(static_cast<float>(film.filterSigma)),
      m_tail(static_cast<float>(normalCdf(-film.filterRadius / film.filterSigma))) {
  const Vector3 forward = (settings.target - settings.origin).normalized();
  const Vector3 right = forward.cross(settings.up).normalized();
  const Vector3 down = forward.cross(right);
  const double halfWidth = std::tan(settings.fovXDegrees * (0.5 * kRadiansADegree));
  const double pixel = 2.0 * halfWidth / film.width;
  m_right = (right * pixel).cast<float>();
  m_down = (down * pixel).cast<float>();
  m_corner = (forward - right * halfWidth - down * (0.5 * film.height * pixel)).cast<float>();
}

void Camera::rays(const EachRay<float>& x, const EachRay<float>& y, RayGroup& rays) const {
  directionsThrough({m_corner, m_right, m_down}, x, y, rays.direction);
  rays.origin.x.fill(m_origin.x());
  rays.origin.y.fill(m_origin.y());
  rays.origin.z.fill(m_origin.z());
  rays.most.fill(std::numeric_limits<float>::infinity());
}

void Camera::filteredRays(const EachRay<int>& x, const EachRay<int>& y, const EachRay<float>& u,
                          const EachRay<float>& v, RayGroup& rays) const {
  EachRay<float> across{};
  EachRay<float> down{};
  if (m_filter == FilmSettings::Filter::Gaussian) {
    for (std::size_t i = 0; i < kRaysTogether; ++i) {
      const Eigen::Vector2f place = filtered(x[i], y[i], {u[i], v[i]});
      across[i] = place.x();
      down[i] = place.y();
    }
  } else {
    placesInBoxes(x, u, m_radius, across);
    placesInBoxes(y, v, m_radius, down);
  }
  this->rays(across, down, rays);
}

Eigen::Vector2f Camera::gaussian(const Eigen::Vector2f& square) const {
  Eigen::Vector2f offset;
  for (int i = 0; i < 2; ++i) {
    const double tail = static_cast<double>(m_tail);
    const double p = tail + (1.0 - 2.0 * tail) * static_cast<double>(square[i]);
    offset[i] = std::clamp(static_cast<float>(normalQuantile(p)) * m_sigma, -m_radius, m_radius);
  }
  return offset;
}

}  // namespace metamer::spectral_ref
