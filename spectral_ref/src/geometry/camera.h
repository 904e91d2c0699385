// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geometry/ray_group.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

/// A pinhole. Pixel (0, 0) is the top left corner of the picture.
class Camera {
 public:
  Camera(const CameraSettings& settings, const FilmSettings& film);

  /// The ray through a place on the film, in pixels.
  Ray ray(float x, float y) const {
    Ray result;
    result.origin = m_origin;
    result.direction = (m_corner + m_right * x + m_down * y).normalized();
    return result;
  }
  /// Those through several places at once.
  void rays(const EachRay<float>& x, const EachRay<float>& y, RayGroup& rays) const;
  /// Those through places about several pixels' centres, drawn by the pixel filter.
  /// @param x, y  pixels
  /// @param u, v  0 ... 1
  void filteredRays(const EachRay<int>& x, const EachRay<int>& y, const EachRay<float>& u, const EachRay<float>& v,
                    RayGroup& rays) const;
  /// A place on the film about a pixel's centre, drawn by the pixel filter.
  Eigen::Vector2f filtered(int x, int y, const Eigen::Vector2f& square) const {
    const Eigen::Vector2f pixel(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
    return pixel + (m_filter == FilmSettings::Filter::Gaussian
                        ? gaussian(square)
                        : Eigen::Vector2f((square.array() - 0.5F) * (2.0F * m_radius)));
  }

 private:
  Eigen::Vector2f gaussian(const Eigen::Vector2f& square) const;

  Vec3 m_origin;
  Vec3 m_corner;
  Vec3 m_right;
  Vec3 m_down;
  FilmSettings::Filter m_filter;
  float m_radius;
  float m_sigma;
  float m_tail;  ///< of the normal distribution below -radius
};

}  // namespace metamer::spectral_ref
