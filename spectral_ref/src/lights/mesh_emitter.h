// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>

#include "lights/light_sample.h"

namespace metamer::spectral_ref {

/// A mesh that shines from its front, each triangle an element.
struct MeshEmitter {
  const Mesh* mesh = nullptr;

  template <typename Add>
  static void collect(const Scene& scene, const EmbreeScene& shapes, const Add& add) {
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
      if (shapes.emitterOfMesh(i) != kNone) {
        const Mesh& mesh = scene.meshes[i];
        add(MeshEmitter{&mesh}, Glow{mesh.surface.emission->spectrum, nullptr}, mesh.triangles.size(),
            shapes.emitterOfMesh(i));
      }
    }
  }

  AreaPoint areaPoint(std::uint32_t element, float u, float v) const {
    const auto corner = corners(element);
    const float root = std::sqrt(u);
    const Vec3 edge1 = corner[1] - corner[0];
    const Vec3 edge2 = corner[2] - corner[0];
    return {corner[0] + edge1 * (root * (1.0F - v)) + edge2 * (root * v), 0.5F * edge1.cross(edge2)};
  }
  static std::uint32_t elementOf(const Hit& hit) { return hit.primitive; }
  float pdf(const Hit& hit, const Vec3& from, const Vec3& direction) const {
    return densityOnArea(hit, area(hit.primitive), from, direction);
  }
  double powerExtent(std::uint32_t element) const { return static_cast<double>(kPi * area(element)); }
  LightBounds bounds(std::uint32_t element) const {
    const auto corner = corners(element);
    LightBounds bounds;
    bounds.least = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]);
    bounds.most = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]);
    const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    bounds.axis = normal.normalized();
    bounds.intensity = 0.5F * normal.norm();
    return bounds;
  }

 private:
  std::array<Vec3, 3> corners(std::size_t triangle) const {
    std::array<Vec3, 3> result;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& vertex = mesh->vertices[mesh->triangles[triangle][k]];
      result[k] = Vec3(vertex[0], vertex[1], vertex[2]);
    }
    return result;
  }
  float area(std::size_t triangle) const {
    const auto corner = corners(triangle);
    return 0.5F * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
  }
};

}  // namespace metamer::spectral_ref
