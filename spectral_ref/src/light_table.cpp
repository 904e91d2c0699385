// SPDX-License-Identifier: Apache-2.0
#include "light_table.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace metamer::spectral_ref {
namespace {

Vec3 toFloat(const Vector3& v) {
  return v.cast<float>();
}

std::array<Vec3, 3> corners(const Mesh& mesh, std::size_t triangle) {
  std::array<Vec3, 3> result;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& vertex = mesh.vertices[mesh.triangles[triangle][k]];
    result[k] = Vec3(vertex[0], vertex[1], vertex[2]);
  }
  return result;
}

/// What a spectrum is worth when lights are chosen: mostly its luminance, a little its whole power, so that light of
/// any wavelength has its chance.
double worth(const spectral::DomainSamples& spectrum, const spectral::DomainSamples& luminance) {
  constexpr double kInvisibleShare = 0.1;
  return (1.0 - kInvisibleShare) * spectrum.dot(luminance) + kInvisibleShare * spectrum.mean();
}

/// Radius of a sphere about the origin of coordinates' box that holds all shapes.
float radiusOf(const Scene& scene) {
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

}  // namespace

LightTable::LightTable(const Scene& scene, const EmbreeScene& shapes) : m_sceneRadius(radiusOf(scene)) {
  addShapes(scene, shapes);
  for (const EnvironmentLight& environment : scene.environments) {
    const EmitterPicture& picture = scene.pictures[environment.picture];
    m_environment = static_cast<std::uint32_t>(m_emitters.size());
    Emitter emitter;
    emitter.kind = Kind::Environment;
    emitter.picture = &picture;
    add(emitter, static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
  }
  for (const PointLight& light : scene.points) {
    Emitter emitter;
    emitter.kind = Kind::Point;
    emitter.spectrum = light.intensity;
    emitter.origin = toFloat(light.position);
    add(emitter, 1);
  }
  for (const SpotLight& light : scene.spots) {
    Emitter emitter;
    emitter.kind = Kind::Spot;
    emitter.spectrum = light.intensity;
    emitter.origin = toFloat(light.position);
    emitter.edgeU = toFloat(light.direction.normalized());
    const auto cosine = [](double degrees) { return static_cast<float>(std::cos(degrees * kRadiansADegree)); };
    emitter.cosCone = cosine(light.coneDegrees);
    emitter.cosBeam = cosine(light.beamDegrees);
    add(emitter, 1);
  }
  m_choice = AliasTable(weights(scene));
}

void LightTable::add(const Emitter& emitter, std::size_t elements) {
  const auto index = static_cast<std::uint32_t>(m_emitters.size());
  m_emitters.push_back(emitter);
  m_emitters.back().first = static_cast<std::uint32_t>(m_emitterOfEntry.size());
  m_emitterOfEntry.insert(m_emitterOfEntry.end(), elements, index);
}

void LightTable::addShapes(const Scene& scene, const EmbreeScene& shapes) {
  for (std::size_t i = 0; i < scene.rectangles.size(); ++i) {
    if (shapes.emitterOfRectangle(i) == kNone) {
      continue;
    }
    assert(shapes.emitterOfRectangle(i) == m_emitters.size());
    const Rectangle& rectangle = scene.rectangles[i];
    Emitter emitter;
    emitter.kind = Kind::Rectangle;
    emitter.origin = toFloat(rectangle.center - rectangle.halfU - rectangle.halfV);
    emitter.edgeU = toFloat(2.0 * rectangle.halfU);
    emitter.edgeV = toFloat(2.0 * rectangle.halfV);
    const Vector3 normal = rectangle.halfU.cross(rectangle.halfV);
    emitter.normal = toFloat(normal.normalized());
    emitter.area = static_cast<float>(4.0 * normal.norm());
    std::size_t elements = 1;
    if (rectangle.picture) {
      emitter.picture = &scene.pictures[*rectangle.picture];
      elements = static_cast<std::size_t>(emitter.picture->width) * static_cast<std::size_t>(emitter.picture->height);
      emitter.area /= static_cast<float>(elements);
    } else {
      emitter.spectrum = rectangle.surface.emission->spectrum;
    }
    add(emitter, elements);
  }
  for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
    if (shapes.emitterOfSphere(i) == kNone) {
      continue;
    }
    assert(shapes.emitterOfSphere(i) == m_emitters.size());
    const Sphere& sphere = scene.spheres[i];
    Emitter emitter;
    emitter.kind = Kind::Sphere;
    emitter.origin = toFloat(sphere.center);
    emitter.radius = static_cast<float>(sphere.radius);
    emitter.area = 4.0F * kPi * emitter.radius * emitter.radius;
    emitter.spectrum = sphere.surface.emission->spectrum;
    add(emitter, 1);
  }
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    if (shapes.emitterOfMesh(i) == kNone) {
      continue;
    }
    assert(shapes.emitterOfMesh(i) == m_emitters.size());
    Emitter emitter;
    emitter.kind = Kind::Mesh;
    emitter.mesh = &scene.meshes[i];
    emitter.spectrum = emitter.mesh->surface.emission->spectrum;
    add(emitter, emitter.mesh->triangles.size());
  }
}

std::vector<double> LightTable::weights(const Scene& scene) const {
  spectral::DomainSamples luminance = spectral::DomainSamples::Zero();
  const auto curves = scene.film.observer.onDomain();
  luminance = (curves * scene.film.luminanceOfResponse).cwiseAbs();
  luminance /= std::max(luminance.sum(), std::numeric_limits<double>::min());
  std::vector<double> worths;
  for (const spectral::DomainSamples& spectrum : scene.spectra) {
    worths.push_back(worth(spectrum, luminance));
  }
  std::vector<double> result(m_emitterOfEntry.size());
  for (std::size_t entry = 0; entry < result.size(); ++entry) {
    const Emitter& emitter = m_emitters[m_emitterOfEntry[entry]];
    const std::size_t element = entry - emitter.first;
    double radiance = 0;
    if (emitter.picture != nullptr) {
      const std::size_t emitters = emitter.picture->emitters.size();
      for (std::size_t k = 0; k < emitters; ++k) {
        radiance +=
            static_cast<double>(emitter.picture->drives[element * emitters + k]) * worths[emitter.picture->emitters[k]];
      }
    } else {
      radiance = worths[emitter.spectrum];
    }
    double extent = 0;
    switch (emitter.kind) {
      case Kind::Rectangle:
      case Kind::Sphere:
        extent = static_cast<double>(kPi * emitter.area);
        break;
      case Kind::Mesh: {
        const auto corner = corners(*emitter.mesh, element);
        extent = static_cast<double>(kPi * 0.5F * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm());
        break;
      }
      case Kind::Environment:
        extent = static_cast<double>(kPi * m_sceneRadius * m_sceneRadius /
                                     inEnvironment(emitter, static_cast<std::uint32_t>(element), {}).pdf);
        break;
      case Kind::Point:
        extent = 4.0 * static_cast<double>(kPi);
        break;
      case Kind::Spot:
        extent = 2.0 * static_cast<double>(kPi) * (1.0 - static_cast<double>(emitter.cosCone));
        break;
    }
    result[entry] = radiance * extent;
  }
  return result;
}

LightSample LightTable::onArea(const Vec3& point, const Vec3& normal, float area, const Vec3& from) {
  LightSample sample;
  const Vec3 towards = point - from;
  const float squared = towards.squaredNorm();
  sample.distance = std::sqrt(squared);
  sample.direction = towards / sample.distance;
  const float cosine = -sample.direction.dot(normal);
  sample.pdf = cosine > 0.0F ? squared / (cosine * area) : 0.0F;
  return sample;
}

LightSample LightTable::onSphere(const Emitter& emitter, const LightPoint& point, const Vec3& from) const {
  const Vec3 towards = emitter.origin - from;
  const float squared = towards.squaredNorm();
  const float radiusSquared = emitter.radius * emitter.radius;
  if (squared <= radiusSquared) {
    return {};  // inside: the sphere emits outwards
  }
  LightSample sample;
  const float sineSquared = radiusSquared / squared;
  const float oneMinusCos = sineSquared / (1.0F + std::sqrt(1.0F - sineSquared));
  const Vec3 local = squareToCone(point.u, point.v, oneMinusCos);
  sample.direction = Frame(towards / std::sqrt(squared)).toWorld(local);
  // Where the ray meets the sphere, less what float error makes of that for rays that graze it: nothing that blocks the
  // light hides in there.
  constexpr float kGrazing = 2e-3F;
  const float depth = oneMinusCos * (1.0F - point.u) * (2.0F - oneMinusCos * (1.0F + point.u));
  sample.distance = std::sqrt(squared) * (local.z() - std::sqrt(depth)) - kGrazing * emitter.radius;
  sample.pdf = 1.0F / (2.0F * kPi * oneMinusCos);
  return sample;
}

float LightTable::spherePdf(const Emitter& emitter, const Vec3& from) const {
  const float squared = (emitter.origin - from).squaredNorm();
  const float radiusSquared = emitter.radius * emitter.radius;
  if (squared <= radiusSquared) {
    return 0.0F;
  }
  const float sineSquared = radiusSquared / squared;
  return (1.0F + std::sqrt(1.0F - sineSquared)) / (2.0F * kPi * sineSquared);
}

LightSample LightTable::inEnvironment(const Emitter& emitter, std::uint32_t element, const LightPoint& point) const {
  const auto width = static_cast<std::uint32_t>(emitter.picture->width);
  const auto column = static_cast<float>(element % width);
  const auto row = static_cast<float>(element / width);
  const auto height = static_cast<float>(emitter.picture->height);
  const float cosTop = std::cos(kPi * row / height);
  const float cosBottom = std::cos(kPi * (row + 1.0F) / height);
  const float y = cosTop + (cosBottom - cosTop) * point.v;
  const float phi = 2.0F * kPi * (column + point.u) / static_cast<float>(width);
  const float sine = std::sqrt(std::max(0.0F, 1.0F - y * y));
  LightSample sample;
  sample.direction = Vec3(-sine * std::sin(phi), y, sine * std::cos(phi));
  sample.distance = std::numeric_limits<float>::infinity();
  sample.pdf = static_cast<float>(width) / (2.0F * kPi * (cosTop - cosBottom));
  return sample;
}

std::uint32_t LightTable::environmentElement(const Vec3& direction) const {
  const EmitterPicture& picture = *m_emitters[m_environment].picture;
  float phi = std::atan2(-direction.x(), direction.z()) / (2.0F * kPi);
  phi -= std::floor(phi);
  const int column = std::min(static_cast<int>(phi * static_cast<float>(picture.width)), picture.width - 1);
  const float theta = std::acos(std::clamp(direction.y(), -1.0F, 1.0F)) * kInversePi;
  const int row = std::min(static_cast<int>(theta * static_cast<float>(picture.height)), picture.height - 1);
  return static_cast<std::uint32_t>(row * picture.width + column);
}

LightSample LightTable::sample(const LightPoint& point, const Vec3& from) const {
  const std::uint32_t index = m_emitterOfEntry[point.entry];
  const Emitter& emitter = m_emitters[index];
  const std::uint32_t element = point.entry - emitter.first;
  LightSample sample;
  switch (emitter.kind) {
    case Kind::Rectangle: {
      float u = point.u;
      float v = point.v;
      if (emitter.picture != nullptr) {
        const auto width = static_cast<std::uint32_t>(emitter.picture->width);
        const auto height = static_cast<std::uint32_t>(emitter.picture->height);
        u = (static_cast<float>(element % width) + u) / static_cast<float>(width);
        v = 1.0F - (static_cast<float>(element / width) + v) / static_cast<float>(height);
      }
      sample = onArea(emitter.origin + emitter.edgeU * u + emitter.edgeV * v, emitter.normal, emitter.area, from);
      break;
    }
    case Kind::Sphere:
      sample = onSphere(emitter, point, from);
      break;
    case Kind::Mesh: {
      const auto corner = corners(*emitter.mesh, element);
      const float root = std::sqrt(point.u);
      const Vec3 edge1 = corner[1] - corner[0];
      const Vec3 edge2 = corner[2] - corner[0];
      const Vec3 normal = edge1.cross(edge2);
      const float length = normal.norm();
      sample = onArea(corner[0] + edge1 * (root * (1.0F - point.v)) + edge2 * (root * point.v), normal / length,
                      0.5F * length, from);
      break;
    }
    case Kind::Environment:
      sample = inEnvironment(emitter, element, point);
      break;
    case Kind::Point:
    case Kind::Spot: {
      const Vec3 towards = emitter.origin - from;
      const float squared = towards.squaredNorm();
      sample.distance = std::sqrt(squared);
      sample.direction = towards / sample.distance;
      sample.scale = 1.0F / squared;
      if (emitter.kind == Kind::Spot) {
        const float cosine = -sample.direction.dot(emitter.edgeU);
        const float t = std::clamp((cosine - emitter.cosCone) / (emitter.cosBeam - emitter.cosCone), 0.0F, 1.0F);
        sample.scale *= t * t * (3.0F - 2.0F * t);
      }
      sample.isDelta = true;
      sample.pdf = squared > 0.0F && sample.scale > 0.0F ? 1.0F : 0.0F;
      break;
    }
  }
  sample.emitter = index;
  sample.element = element;
  sample.pdf *= m_choice.probability(point.entry);
  return sample;
}

std::uint32_t LightTable::elementOf(const Hit& hit) const {
  const Emitter& emitter = m_emitters[hit.emitter];
  if (emitter.kind == Kind::Mesh) {
    return hit.primitive;
  }
  if (emitter.picture == nullptr) {
    return 0;
  }
  const int width = emitter.picture->width;
  const int height = emitter.picture->height;
  const int column = std::clamp(static_cast<int>(hit.u * static_cast<float>(width)), 0, width - 1);
  const int row = std::clamp(static_cast<int>((1.0F - hit.v) * static_cast<float>(height)), 0, height - 1);
  return static_cast<std::uint32_t>(row * width + column);
}

float LightTable::pdf(const Hit& hit, const Vec3& from, const Vec3& direction) const {
  const Emitter& emitter = m_emitters[hit.emitter];
  const std::uint32_t element = elementOf(hit);
  const float choice = m_choice.probability(emitter.first + element);
  if (emitter.kind == Kind::Sphere) {
    return choice * spherePdf(emitter, from);
  }
  float area = emitter.area;
  if (emitter.kind == Kind::Mesh) {
    const auto corner = corners(*emitter.mesh, element);
    area = 0.5F * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
  }
  const float cosine = -direction.dot(hit.normal);
  return cosine > 0.0F ? choice * (hit.position - from).squaredNorm() / (cosine * area) : 0.0F;
}

float LightTable::environmentPdf(const Vec3& direction) const {
  const Emitter& emitter = m_emitters[m_environment];
  const std::uint32_t element = environmentElement(direction);
  return m_choice.probability(emitter.first + element) * inEnvironment(emitter, element, {}).pdf;
}

}  // namespace metamer::spectral_ref
