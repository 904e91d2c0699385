// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/ray_group.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

/// Where the rays of a group go.
enum class Course {
  Alike,  ///< from about the same place, or to it
  Any,
};

/// The shapes in Embree's hierarchy. The only file that knows Embree is its source.
class EmbreeScene {
 public:
  explicit EmbreeScene(const Scene& scene);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Nearest shape; false where there is none.
  bool intersect(const Ray& ray, Hit& hit) const;
  /// Whether anything lies between.
  bool occluded(const Ray& ray) const;

  /// The same of several rays at once, in less time. The last bits of a hit may depend on the rays beside it: a group
  /// must be made up the same way however a render is cut into parts.
  /// @param active  rays that count, at least one
  /// @return  those that hit something
  /// @param course  changes no more than the time and those bits
  RayMask intersect(const RayGroup& rays, RayMask active, HitGroup& hits, Course course = Course::Any) const;
  /// @return  those that something lies in the way of
  RayMask occluded(const RayGroup& rays, RayMask active, Course course = Course::Any) const;

  /// Emitting shapes number rectangles first, then spheres, then meshes, each in the scene's order.
  std::uint32_t emitterOfRectangle(std::size_t index) const { return m_rectangles[index].emitter; }
  std::uint32_t emitterOfSphere(std::size_t index) const { return m_spheres[index].emitter; }
  std::uint32_t emitterOfMesh(std::size_t index) const { return m_meshes[index].emitter; }

 private:
  struct ShapeRecord {
    Vec3 normal;
    Vec3 center;
    std::uint32_t material;
    std::uint32_t emitter;
    float radius;
  };
  struct MeshRecord {
    std::uint32_t material;
    std::uint32_t emitter;
  };
  struct Handles;

  /// What a hit is told of the shape.
  struct HitSurface {
    Vec3 position;
    Vec3 normal;
    std::uint32_t material;
    std::uint32_t emitter;
  };
  /// @param place  about where on the shape
  HitSurface surfaceAt(unsigned geometry, unsigned primitive, const Vec3& place, const Vec3& meshNormal) const;

  std::unique_ptr<Handles> m_handles;
  std::vector<ShapeRecord> m_rectangles;
  std::vector<ShapeRecord> m_spheres;
  std::vector<MeshRecord> m_meshes;
};

}  // namespace metamer::spectral_ref
