// SPDX-License-Identifier: Apache-2.0
#include "integrator/diffuse_group.h"

#include <limits>

#include "integrator/gel_passage.h"
#include "metamer/spectral/vector_lanes.h"

namespace metamer::spectral_ref {
namespace {

METAMER_VECTOR_LANES void look(const HitGroup& hits, LightsOfGroup& lights, RayGroup& towards) {
  METAMER_RAYS_APART
  for (std::size_t i = 0; i < kRaysTogether; ++i) {
    const float px = hits.position.x[i];
    const float py = hits.position.y[i];
    const float pz = hits.position.z[i];
    const float nx = hits.normal.x[i];
    const float ny = hits.normal.y[i];
    const float nz = hits.normal.z[i];
    const float x = lights.place.x[i] - px;
    const float y = lights.place.y[i] - py;
    const float z = lights.place.z[i] - pz;
    const float inverse = 1.0F / (x * x + y * y + z * z);
    const float received = larger(x * nx + y * ny + z * nz, 0.0F) * inverse;
    const float given = larger(-(x * lights.area.x[i] + y * lights.area.y[i] + z * lights.area.z[i]), 0.0F) * inverse;
    // Both cosines over the squared distance: cos / pi over the density of the direction, times pi.
    const float geometry = received * given;
    lights.weight[i] = geometry / (kPi * lights.chance[i] + geometry * lights.isShared[i]);
    const float off = offDistance(px, py, pz);
    const float ox = px + nx * off;
    const float oy = py + ny * off;
    const float oz = pz + nz * off;
    towards.origin.x[i] = ox;
    towards.origin.y[i] = oy;
    towards.origin.z[i] = oz;
    // From where it starts: a light close by must not hide itself.
    towards.direction.x[i] = lights.place.x[i] - ox;
    towards.direction.y[i] = lights.place.y[i] - oy;
    towards.direction.z[i] = lights.place.z[i] - oz;
    towards.most[i] = kShortOfLight;
  }
}

METAMER_VECTOR_LANES void scatter(const HitGroup& hits, const EachRay<float>& u, const EachRay<float>& v,
                                  RayGroup& next, EachRay<float>& pdf) {
  METAMER_RAYS_APART
  for (std::size_t i = 0; i < kRaysTogether; ++i) {
    float a = 0;
    float b = 0;
    squareToDisc(u[i], v[i], a, b);
    const float c = std::sqrt(larger(1.0F - (a * a + b * b), 0.0F));
    // The axes of Frame.
    const float nx = hits.normal.x[i];
    const float ny = hits.normal.y[i];
    const float nz = hits.normal.z[i];
    const float sign = std::copysign(1.0F, nz);
    const float p = -1.0F / (sign + nz);
    const float q = nx * ny * p;
    next.direction.x[i] = (1.0F + sign * nx * nx * p) * a + q * b + nx * c;
    next.direction.y[i] = sign * q * a + (sign + ny * ny * p) * b + ny * c;
    next.direction.z[i] = -sign * nx * a - ny * b + nz * c;
    const float px = hits.position.x[i];
    const float py = hits.position.y[i];
    const float pz = hits.position.z[i];
    const float off = offDistance(px, py, pz);
    next.origin.x[i] = px + nx * off;
    next.origin.y[i] = py + ny * off;
    next.origin.z[i] = pz + nz * off;
    next.most[i] = std::numeric_limits<float>::infinity();
    pdf[i] = c * kInversePi;
  }
}

METAMER_VECTOR_LANES RayMask against(const EachVec3& directions, const EachVec3& normals) {
  RayMask result = 0;
  for (std::size_t i = 0; i < kRaysTogether; ++i) {
    const float cosine =
        directions.x[i] * normals.x[i] + directions.y[i] * normals.y[i] + directions.z[i] * normals.z[i];
    result |= cosine < 0.0F ? kRayBits[i] : 0U;
  }
  return result;
}

METAMER_VECTOR_LANES void along(const Vec3& corner, const Vec3& edgeU, const Vec3& edgeV, const EachRay<float>& u,
                                const EachRay<float>& v, EachVec3& places) {
  const float cx = corner.x(), cy = corner.y(), cz = corner.z();
  const float ux = edgeU.x(), uy = edgeU.y(), uz = edgeU.z();
  const float vx = edgeV.x(), vy = edgeV.y(), vz = edgeV.z();
  METAMER_RAYS_APART
  for (std::size_t i = 0; i < kRaysTogether; ++i) {
    places.x[i] = cx + ux * u[i] + vx * v[i];
    places.y[i] = cy + uy * u[i] + vy * v[i];
    places.z[i] = cz + uz * u[i] + vz * v[i];
  }
}

}  // namespace

RayMask onFront(const RayGroup& rays, const HitGroup& hits) {
  return against(rays.direction, hits.normal);
}

void pointsOn(const RectangleEmitter& rectangle, const EachRay<float>& u, const EachRay<float>& v,
              LightsOfGroup& lights) {
  along(rectangle.corner, rectangle.edgeU, rectangle.edgeV, u, v, lights.place);
  const Vec3 area = rectangle.normal * rectangle.area;
  lights.area.x.fill(area.x());
  lights.area.y.fill(area.y());
  lights.area.z.fill(area.z());
  lights.chance.fill(1.0F);
}

void lookAtLights(const HitGroup& hits, LightsOfGroup& lights, RayGroup& towards) {
  look(hits, lights, towards);
}

void scatterDiffusely(const HitGroup& hits, const EachRay<float>& u, const EachRay<float>& v, RayMask paths,
                      RayMask others, RayGroup& next, EachRay<float>& pdf) {
  if (others == 0) {
    scatter(hits, u, v, next, pdf);
    return;
  }
  RayGroup drawn;
  scatter(hits, u, v, drawn, pdf);
  forEachRay(paths, [&](std::size_t i) { next.set(i, drawn[i]); });
}

}  // namespace metamer::spectral_ref
