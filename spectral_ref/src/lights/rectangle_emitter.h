// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "lights/light_sample.h"

namespace metamer::spectral_ref {

/// A rectangle that shines from its front: evenly, or as the pixels of a picture, each an element.
struct RectangleEmitter {
  Vec3 corner;
  Vec3 edgeU;  ///< whole
  Vec3 edgeV;
  Vec3 normal;
  float area = 0;  ///< of an element
  const EmitterPicture* picture = nullptr;
  double inverseColumns = 1;
  float inverseRows = 1;

  template <typename Add>
  static void collect(const Scene& scene, const EmbreeScene& shapes, const Add& add) {
    for (std::size_t i = 0; i < scene.rectangles.size(); ++i) {
      if (shapes.emitterOfRectangle(i) == kNone) {
        continue;
      }
      const Rectangle& rectangle = scene.rectangles[i];
      RectangleEmitter emitter;
      emitter.corner = (rectangle.center - rectangle.halfU - rectangle.halfV).cast<float>();
      emitter.edgeU = (2.0 * rectangle.halfU).cast<float>();
      emitter.edgeV = (2.0 * rectangle.halfV).cast<float>();
      const Vector3 normal = rectangle.halfU.cross(rectangle.halfV);
      emitter.normal = normal.normalized().cast<float>();
      emitter.area = static_cast<float>(4.0 * normal.norm());
      Glow glow;
      std::size_t elements = 1;
      if (rectangle.picture) {
        const EmitterPicture& picture = scene.pictures[*rectangle.picture];
        glow.picture = emitter.picture = &picture;
        elements = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
        emitter.inverseColumns = 1.0 / static_cast<double>(picture.width);
        emitter.inverseRows = 1.0F / static_cast<float>(picture.height);
        emitter.area /= static_cast<float>(elements);
      } else {
        glow.spectrum = rectangle.surface.emission->spectrum;
      }
      add(emitter, glow, elements, shapes.emitterOfRectangle(i));
    }
  }

  Vec3 at(std::uint32_t element, float u, float v) const {
    const Eigen::Vector2f place = along(element, u, v);
    return corner + edgeU * place.x() + edgeV * place.y();
  }
  AreaPoint areaPoint(std::uint32_t element, float u, float v) const { return {at(element, u, v), normal * area}; }
  std::uint32_t elementOf(const Hit& hit) const {
    if (picture == nullptr) {
      return 0;
    }
    const int width = picture->width;
    const int height = picture->height;
    const int column = std::clamp(static_cast<int>(hit.u * static_cast<float>(width)), 0, width - 1);
    const int row = std::clamp(static_cast<int>((1.0F - hit.v) * static_cast<float>(height)), 0, height - 1);
    return static_cast<std::uint32_t>(row * width + column);
  }
  float pdf(const Hit& hit, const Vec3& from, const Vec3& direction) const {
    return densityOnArea(hit, area, from, direction);
  }
  double powerExtent(std::uint32_t /*element*/) const { return static_cast<double>(kPi * area); }
  LightBounds bounds(std::uint32_t element) const {
    const std::array<Vec3, 4> corners = {at(element, 0.0F, 0.0F), at(element, 1.0F, 0.0F), at(element, 0.0F, 1.0F),
                                         at(element, 1.0F, 1.0F)};
    LightBounds bounds;
    bounds.least = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]).cwiseMin(corners[3]);
    bounds.most = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]).cwiseMax(corners[3]);
    bounds.axis = normal;
    bounds.intensity = area;
    return bounds;
  }

 private:
  /// Where a point of an element lies along the edges.
  Eigen::Vector2f along(std::uint32_t element, float u, float v) const {
    if (picture == nullptr) {
      return {u, v};
    }
    // By a product: whole-number division would cost as much as all the rest. Halves keep it exact.
    const auto row = static_cast<std::uint32_t>((static_cast<double>(element) + 0.5) * inverseColumns);
    const std::uint32_t column = element - row * static_cast<std::uint32_t>(picture->width);
    return {(static_cast<float>(column) + u) * static_cast<float>(inverseColumns),
            1.0F - (static_cast<float>(row) + v) * inverseRows};
  }
};

}  // namespace metamer::spectral_ref
