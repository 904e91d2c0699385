// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "lights/light_sample.h"

namespace metamer::spectral_ref {

/// A picture infinitely far away, latitude by longitude as OpenEXR has it: +y up, the middle towards +z, +x at a
/// quarter of the width. Each pixel is an element, sampled evenly over its solid angle.
struct EnvironmentEmitter : NeverHit {
  const EmitterPicture* picture = nullptr;
  float sceneRadius = 1;

  template <typename Add>
  static void collect(const Scene& scene, const EmbreeScene& /*shapes*/, const Add& add) {
    for (const EnvironmentLight& environment : scene.environments) {
      EnvironmentEmitter emitter;
      emitter.picture = &scene.pictures[environment.picture];
      emitter.sceneRadius = radiusOf(scene);
      add(emitter, Glow{0, emitter.picture},
          static_cast<std::size_t>(emitter.picture->width) * static_cast<std::size_t>(emitter.picture->height), kNone);
    }
  }

  LightSample located(std::uint32_t element, float u, float v, const Vec3& /*from*/) const { return at(element, u, v); }
  LightSample at(std::uint32_t element, float u, float v) const {
    const auto width = static_cast<std::uint32_t>(picture->width);
    const auto column = static_cast<float>(element % width);
    const std::uint32_t wholeRow = element / width;
    const auto row = static_cast<float>(wholeRow);
    const auto height = static_cast<float>(picture->height);
    const float cosTop = std::cos(kPi * row / height);
    const float cosBottom = std::cos(kPi * (row + 1.0F) / height);
    const float y = cosTop + (cosBottom - cosTop) * v;
    const float phi = 2.0F * kPi * (column + u) / static_cast<float>(width);
    const float sine = std::sqrt(std::max(0.0F, 1.0F - y * y));
    LightSample sample;
    sample.direction = Vec3(sine * std::sin(phi), y, -sine * std::cos(phi));
    sample.distance = std::numeric_limits<float>::infinity();
    sample.pdf = static_cast<float>(width) / (2.0F * kPi * (cosTop - cosBottom));
    return sample;
  }
  /// The pixel in a direction.
  std::uint32_t elementTowards(const Vec3& direction) const {
    float phi = std::atan2(direction.x(), -direction.z()) / (2.0F * kPi);
    phi -= std::floor(phi);
    const int column = std::min(static_cast<int>(phi * static_cast<float>(picture->width)), picture->width - 1);
    const float theta = std::acos(std::clamp(direction.y(), -1.0F, 1.0F)) * kInversePi;
    const int row = std::min(static_cast<int>(theta * static_cast<float>(picture->height)), picture->height - 1);
    return static_cast<std::uint32_t>(row * picture->width + column);
  }
  double powerExtent(std::uint32_t element) const {
    return static_cast<double>(kPi * sceneRadius * sceneRadius / at(element, 0.0F, 0.0F).pdf);
  }
  LightBounds bounds(std::uint32_t element) const {
    const LightSample middle = at(element, 0.5F, 0.5F);
    LightBounds bounds;
    bounds.isInfinite = true;
    bounds.axis = middle.direction;
    bounds.least = middle.direction;
    bounds.most = middle.direction;
    bounds.intensity = 1.0F / middle.pdf;
    bounds.spread = 0.0F;
    for (const float v : {0.0F, 0.5F, 1.0F}) {
      const Vec3 corner = at(element, 0.0F, v).direction;
      bounds.spread = std::max(bounds.spread, std::acos(std::clamp(middle.direction.dot(corner), -1.0F, 1.0F)));
    }
    return bounds;
  }

 private:
  /// Half the diagonal of the box that holds all shapes.
  static float radiusOf(const Scene& scene) {
    Eigen::AlignedBox3d box;
    for (const Rectangle& rectangle : scene.rectangles) {
      for (const double su : {-1.0, 1.0}) {
        for (const double sv : {-1.0, 1.0}) {
          box.extend(rectangle.center + su * rectangle.halfU + sv * rectangle.halfV);
        }
      }
    }
    for (const Sphere& sphere : scene.spheres) {
      box.extend(sphere.center - Vector3::Constant(sphere.radius));
      box.extend(sphere.center + Vector3::Constant(sphere.radius));
    }
    for (const Mesh& mesh : scene.meshes) {
      for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t index : triangle) {
          const auto& vertex = mesh.vertices[index];
          box.extend(Vector3(vertex[0], vertex[1], vertex[2]));
        }
      }
    }
    return box.isEmpty() ? 1.0F : static_cast<float>(0.5 * box.diagonal().norm());
  }
};

}  // namespace metamer::spectral_ref
