// SPDX-License-Identifier: Apache-2.0
#include "geometry/camera.h"

#include <algorithm>
#include <cmath>

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

Eigen::Vector2f Camera::filtered(int x, int y, const Eigen::Vector2f& square) const {
  Eigen::Vector2f offset = (square.array() - 0.5F) * (2.0F * m_radius);
  if (m_filter == FilmSettings::Filter::Gaussian) {
    for (int i = 0; i < 2; ++i) {
      const double tail = static_cast<double>(m_tail);
      const double p = tail + (1.0 - 2.0 * tail) * static_cast<double>(square[i]);
      offset[i] = std::clamp(static_cast<float>(normalQuantile(p)) * m_sigma, -m_radius, m_radius);
    }
  }
  return offset + Eigen::Vector2f(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
}

}  // namespace metamer::spectral_ref
