// SPDX-License-Identifier: Apache-2.0
#include "geometry/embree_scene.h"

#ifdef METAMER_EMBREE_4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <bit>
#include <cassert>
#include <limits>
#include <stdexcept>
#include <string>

namespace metamer::spectral_ref {
namespace {

constexpr unsigned kRectangles = 0;
constexpr unsigned kSpheres = 1;
constexpr unsigned kFirstMesh = 2;

struct FreeDevice {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct FreeScene {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};

void store(float* destination, const Vector3& point) {
  for (int i = 0; i < 3; ++i) {
    destination[i] = static_cast<float>(point[i]);
  }
}

template <typename T>
T* newBuffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t stride, std::size_t count) {
  void* data = rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, count);
  if (data == nullptr) {
    throw std::bad_alloc();
  }
  return static_cast<T*>(data);
}

RTCRay embreeRay(const Ray& ray) {
  RTCRay result;
  result.org_x = ray.origin.x();
  result.org_y = ray.origin.y();
  result.org_z = ray.origin.z();
  result.tnear = 0.0F;
  result.dir_x = ray.direction.x();
  result.dir_y = ray.direction.y();
  result.dir_z = ray.direction.z();
  result.time = 0.0F;
  result.tfar = ray.most;
  result.mask = 0xffffffffU;
  result.id = 0;
  result.flags = 0;
  return result;
}

/// Embree's functions for rays take their context before the rays in its third release, and after them since.
/// @param course  a hint, which the third release alone takes this way
template <typename Function, typename Rays, typename... First>
void ask(const Function& function, [[maybe_unused]] Course course, Rays& rays, First... first) {
#ifdef METAMER_EMBREE_4
  function(first..., &rays, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (course == Course::Alike) {
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }
  function(first..., &context, &rays);
#endif
}

bool isAlone(RayMask active) {
  return (active & (active - 1U)) == 0;
}

/// Rays of a group that Embree takes at once: as many as it has lanes for on most machines.
constexpr std::size_t kPacket = 8;
static_assert(kRaysTogether % kPacket == 0);
constexpr RayMask kWholePacket = firstRays(kPacket);
/// Embree's: -1 for rays that count, else 0.
using Valid = std::array<int, kPacket>;

/// A number of each ray as Embree has it; in place of those that do not count stands one that does.
METAMER_ALWAYS_INLINE void fill(float* to, const float* from, const Valid& valid, std::size_t first) {
  const float instead = from[first];
  METAMER_RAYS_APART
  for (std::size_t i = 0; i < kPacket; ++i) {
    to[i] = valid[i] != 0 ? from[i] : instead;
  }
}

/// @param start   first ray of the packet in the group
/// @param active  of the packet
METAMER_VECTOR_LANES void pack(const RayGroup& rays, std::size_t start, RayMask active, RTCRay8& packed, Valid& valid) {
  const auto first = static_cast<std::size_t>(std::countr_zero(active));
  for (std::size_t i = 0; i < kPacket; ++i) {
    valid[i] = -static_cast<int>((active >> i) & 1U);
  }
  fill(packed.org_x, &rays.origin.x[start], valid, first);
  fill(packed.org_y, &rays.origin.y[start], valid, first);
  fill(packed.org_z, &rays.origin.z[start], valid, first);
  fill(packed.dir_x, &rays.direction.x[start], valid, first);
  fill(packed.dir_y, &rays.direction.y[start], valid, first);
  fill(packed.dir_z, &rays.direction.z[start], valid, first);
  fill(packed.tfar, &rays.most[start], valid, first);
  for (std::size_t i = 0; i < kPacket; ++i) {
    packed.tnear[i] = 0.0F;
    packed.time[i] = 0.0F;
    packed.mask[i] = 0xffffffffU;
    packed.id[i] = 0;
    packed.flags[i] = 0;
  }
}

/// Where rays end, those that hit nothing included.
METAMER_VECTOR_LANES void unpack(const RayGroup& rays, std::size_t start, const RTCRayHit8& query, HitGroup& hits) {
  METAMER_RAYS_APART
  for (std::size_t n = 0; n < kPacket; ++n) {
    const std::size_t i = start + n;
    const float distance = query.ray.tfar[n];
    hits.position.x[i] = rays.origin.x[i] + rays.direction.x[i] * distance;
    hits.position.y[i] = rays.origin.y[i] + rays.direction.y[i] * distance;
    hits.position.z[i] = rays.origin.z[i] + rays.direction.z[i] * distance;
    hits.distance[i] = distance;
    hits.u[i] = query.hit.u[n];
    hits.v[i] = query.hit.v[n];
    hits.primitive[i] = query.hit.primID[n];
  }
}

/// Asks for the rays of each packet that has some. @return  those that `work` says, of the whole group
template <typename Work>
RayMask forEachPacket(RayMask active, const Work& work) {
  RayMask result = 0;
  for (std::size_t start = 0; start < kRaysTogether; start += kPacket) {
    if (const RayMask ofPacket = (active >> start) & kWholePacket; ofPacket != 0) {
      result |= work(start, ofPacket) << start;
    }
  }
  return result;
}

}  // namespace

struct EmbreeScene::Handles {
  std::unique_ptr<RTCDeviceTy, FreeDevice> device;
  std::unique_ptr<RTCSceneTy, FreeScene> scene;

  void attach(RTCGeometry geometry, unsigned id) const {
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene.get(), geometry, id);
    rtcReleaseGeometry(geometry);
  }
};

EmbreeScene::EmbreeScene(const Scene& scene) : m_handles(std::make_unique<Handles>()) {
  m_handles->device.reset(rtcNewDevice(nullptr));
  if (!m_handles->device) {
    throw std::runtime_error("Embree does not start on this machine");
  }
  RTCDevice device = m_handles->device.get();
  m_handles->scene.reset(rtcNewScene(device));
  rtcSetSceneFlags(m_handles->scene.get(), RTC_SCENE_FLAG_ROBUST);

  std::uint32_t emitters = 0;
  const auto emitterOf = [&](const Surface& surface, bool isPicture) {
    return surface.emission || isPicture ? emitters++ : kNone;
  };
  if (!scene.rectangles.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
    const std::size_t count = scene.rectangles.size();
    auto* vertices =
        newBuffer<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 4 * count);
    auto* indices = newBuffer<unsigned>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT4, 4 * sizeof(unsigned), count);
    for (std::size_t i = 0; i < count; ++i) {
      const Rectangle& rectangle = scene.rectangles[i];
      const std::array<Vector3, 4> corners = {
          rectangle.center - rectangle.halfU - rectangle.halfV, rectangle.center + rectangle.halfU - rectangle.halfV,
          rectangle.center + rectangle.halfU + rectangle.halfV, rectangle.center - rectangle.halfU + rectangle.halfV};
      for (std::size_t k = 0; k < 4; ++k) {
        store(vertices + 3 * (4 * i + k), corners[k]);
        indices[4 * i + k] = static_cast<unsigned>(4 * i + k);
      }
      m_rectangles.push_back({rectangle.halfU.cross(rectangle.halfV).normalized().cast<float>(),
                              rectangle.center.cast<float>(), rectangle.surface.material,
                              emitterOf(rectangle.surface, rectangle.picture.has_value()), 0.0F});
    }
    m_handles->attach(geometry, kRectangles);
  }
  if (!scene.spheres.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* vertices =
        newBuffer<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4, 4 * sizeof(float), scene.spheres.size());
    for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
      const Sphere& sphere = scene.spheres[i];
      store(vertices + 4 * i, sphere.center);
      vertices[4 * i + 3] = static_cast<float>(sphere.radius);
      m_spheres.push_back({Vec3::Zero(), sphere.center.cast<float>(), sphere.surface.material,
                           emitterOf(sphere.surface, false), static_cast<float>(sphere.radius)});
    }
    m_handles->attach(geometry, kSpheres);
  }
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices =
        newBuffer<float>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.vertices.size());
    auto* indices = newBuffer<unsigned>(geometry, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3, 3 * sizeof(unsigned),
                                        mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
      std::copy(mesh.vertices[i].begin(), mesh.vertices[i].end(), vertices + 3 * i);
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      std::copy(mesh.triangles[i].begin(), mesh.triangles[i].end(), indices + 3 * i);
    }
    m_meshes.push_back({mesh.surface.material, emitterOf(mesh.surface, false)});
    m_handles->attach(geometry, kFirstMesh + static_cast<unsigned>(m));
  }
  rtcCommitScene(m_handles->scene.get());
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
    throw std::runtime_error("Embree cannot take the scene (error " + std::to_string(error) + ")");
  }
}

EmbreeScene::~EmbreeScene() = default;

EmbreeScene::HitSurface EmbreeScene::surfaceAt(unsigned geometry, unsigned primitive, const Vec3& place,
                                               const Vec3& meshNormal) const {
  if (geometry == kRectangles) {
    const ShapeRecord& record = m_rectangles[primitive];
    return {place, record.normal, record.material, record.emitter};
  }
  if (geometry == kSpheres) {
    const ShapeRecord& record = m_spheres[primitive];
    const Vec3 normal = (place - record.center).normalized();
    // Back onto the sphere: the distance along a long ray carries more error than its radius does.
    return {record.center + normal * record.radius, normal, record.material, record.emitter};
  }
  const MeshRecord& record = m_meshes[geometry - kFirstMesh];
  return {place, meshNormal.normalized(), record.material, record.emitter};
}

bool EmbreeScene::intersect(const Ray& ray, Hit& hit) const {
  RTCRayHit query;
  query.ray = embreeRay(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  ask(rtcIntersect1, Course::Any, query, m_handles->scene.get());
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
    return false;
  }
  hit.distance = query.ray.tfar;
  hit.u = query.hit.u;
  hit.v = query.hit.v;
  hit.primitive = query.hit.primID;
  const HitSurface surface = surfaceAt(query.hit.geomID, query.hit.primID, ray.origin + ray.direction * hit.distance,
                                       {query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z});
  hit.position = surface.position;
  hit.normal = surface.normal;
  hit.material = surface.material;
  hit.emitter = surface.emitter;
  return true;
}

RayMask EmbreeScene::intersect(const RayGroup& rays, RayMask active, HitGroup& hits, Course course) const {
  assert(active != 0);
  return forEachPacket(active, [&](std::size_t start, RayMask ofPacket) -> RayMask {
    if (isAlone(ofPacket)) {
      const std::size_t alone = start + static_cast<std::size_t>(std::countr_zero(ofPacket));
      Hit hit;
      if (!intersect(rays[alone], hit)) {
        return 0;
      }
      hits.set(alone, hit);
      return ofPacket;
    }
    RTCRayHit8 query;
    alignas(32) Valid valid;
    pack(rays, start, ofPacket, query.ray, valid);
    for (std::size_t i = 0; i < kPacket; ++i) {
      query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    ask(rtcIntersect8, course, query, valid.data(), m_handles->scene.get());
    unpack(rays, start, query, hits);
    RayMask found = 0;
    forEachRay(ofPacket, [&](std::size_t n) {
      if (query.hit.geomID[n] == RTC_INVALID_GEOMETRY_ID) {
        return;
      }
      found |= RayMask{1} << n;
      const std::size_t i = start + n;
      const HitSurface surface = surfaceAt(query.hit.geomID[n], query.hit.primID[n], hits.position[i],
                                           {query.hit.Ng_x[n], query.hit.Ng_y[n], query.hit.Ng_z[n]});
      hits.position.set(i, surface.position);
      hits.normal.set(i, surface.normal);
      hits.material[i] = surface.material;
      hits.emitter[i] = surface.emitter;
    });
    return found;
  });
}

bool EmbreeScene::occluded(const Ray& ray) const {
  RTCRay query = embreeRay(ray);
  ask(rtcOccluded1, Course::Any, query, m_handles->scene.get());
  return query.tfar < 0.0F;
}

RayMask EmbreeScene::occluded(const RayGroup& rays, RayMask active, Course course) const {
  assert(active != 0);
  return forEachPacket(active, [&](std::size_t start, RayMask ofPacket) -> RayMask {
    if (isAlone(ofPacket)) {
      return occluded(rays[start + static_cast<std::size_t>(std::countr_zero(ofPacket))]) ? ofPacket : 0;
    }
    RTCRay8 query;
    alignas(32) Valid valid;
    pack(rays, start, ofPacket, query, valid);
    ask(rtcOccluded8, course, query, valid.data(), m_handles->scene.get());
    RayMask found = 0;
    forEachRay(ofPacket, [&](std::size_t n) { found |= query.tfar[n] < 0.0F ? RayMask{1} << n : 0U; });
    return found;
  });
}

}  // namespace metamer::spectral_ref
