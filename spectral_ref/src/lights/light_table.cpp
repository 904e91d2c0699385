// SPDX-License-Identifier: Apache-2.0
#include "lights/light_table.h"

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
  std::vector<double> powers = worths(scene);
  for (std::size_t entry = 0; entry < powers.size(); ++entry) {
    const Emitter& emitter = m_emitters[m_emitterOfEntry[entry]];
    powers[entry] *= powerExtent(emitter, static_cast<std::uint32_t>(entry) - emitter.first);
  }
  m_choice = AliasTable(powers);
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
      emitter.inverseColumns = 1.0 / static_cast<double>(emitter.picture->width);
      emitter.inverseRows = 1.0F / static_cast<float>(emitter.picture->height);
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

/// What the radiance (point and spot lights: intensity) of each entry is worth.
std::vector<double> LightTable::worths(const Scene& scene) const {
  spectral::DomainSamples luminance = spectral::DomainSamples::Zero();
  const auto curves = scene.film.observer.onDomain();
  luminance = (curves * scene.film.luminanceOfResponse).cwiseAbs();
  luminance /= std::max(luminance.sum(), std::numeric_limits<double>::min());
  std::vector<double> ofSpectrum;
  for (const spectral::DomainSamples& spectrum : scene.spectra) {
    ofSpectrum.push_back(worth(spectrum, luminance));
  }
  std::vector<double> result(m_emitterOfEntry.size());
  for (std::size_t entry = 0; entry < result.size(); ++entry) {
    const Emitter& emitter = m_emitters[m_emitterOfEntry[entry]];
    if (emitter.picture == nullptr) {
      result[entry] = ofSpectrum[emitter.spectrum];
      continue;
    }
    const std::size_t emitters = emitter.picture->emitters.size();
    const std::size_t element = entry - emitter.first;
    for (std::size_t k = 0; k < emitters; ++k) {
      result[entry] += static_cast<double>(emitter.picture->drives[element * emitters + k]) *
                       ofSpectrum[emitter.picture->emitters[k]];
    }
  }
  return result;
}

/// Power of an element over its radiance or intensity.
double LightTable::powerExtent(const Emitter& emitter, std::uint32_t element) const {
  switch (emitter.kind) {
    case Kind::Rectangle:
    case Kind::Sphere:
      return static_cast<double>(kPi * emitter.area);
    case Kind::Mesh: {
      const auto corner = corners(*emitter.mesh, element);
      return static_cast<double>(kPi * 0.5F * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm());
    }
    case Kind::Environment:
      return static_cast<double>(kPi * m_sceneRadius * m_sceneRadius / inEnvironment(emitter, element, {}).pdf);
    case Kind::Point:
      return 4.0 * static_cast<double>(kPi);
    case Kind::Spot:
      break;
  }
  return 2.0 * static_cast<double>(kPi) * (1.0 - static_cast<double>(emitter.cosCone));
}

/// Corners of a rectangle's element; a triangle's, the first one twice.
std::array<Vec3, 4> LightTable::cornersOf(const Emitter& emitter, std::uint32_t element) const {
  if (emitter.kind == Kind::Mesh) {
    const auto corner = corners(*emitter.mesh, element);
    return {corner[0], corner[1], corner[2], corner[0]};
  }
  std::array<Vec3, 4> result;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Eigen::Vector2f place = onRectangle(emitter, element, i % 2 == 0 ? 0.0F : 1.0F, i < 2 ? 0.0F : 1.0F);
    result[i] = emitter.origin + emitter.edgeU * place.x() + emitter.edgeV * place.y();
  }
  return result;
}

LightBounds LightTable::boundsOf(const Emitter& emitter, std::uint32_t element) const {
  LightBounds bounds;
  bounds.intensity = 1.0F;
  bounds.least = emitter.origin;
  bounds.most = emitter.origin;
  bounds.spread = kPi;
  switch (emitter.kind) {
    case Kind::Rectangle:
    case Kind::Mesh: {
      const auto corner = cornersOf(emitter, element);
      bounds.least = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]).cwiseMin(corner[3]);
      bounds.most = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]).cwiseMax(corner[3]);
      bounds.axis = emitter.normal;
      bounds.intensity = emitter.area;
      if (emitter.kind == Kind::Mesh) {
        const Vec3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        bounds.axis = normal.normalized();
        bounds.intensity = 0.5F * normal.norm();
      }
      bounds.spread = 0.0F;
      break;
    }
    case Kind::Sphere:
      bounds.least -= Vec3::Constant(emitter.radius);
      bounds.most += Vec3::Constant(emitter.radius);
      bounds.intensity = kPi * emitter.radius * emitter.radius;
      break;
    case Kind::Environment: {
      const LightSample middle = inEnvironment(emitter, element, {0, 0.5F, 0.5F});
      bounds.isInfinite = true;
      bounds.axis = middle.direction;
      bounds.least = middle.direction;
      bounds.most = middle.direction;
      bounds.intensity = 1.0F / middle.pdf;
      bounds.spread = 0.0F;
      for (const float v : {0.0F, 0.5F, 1.0F}) {
        const Vec3 corner = inEnvironment(emitter, element, {0, 0.0F, v}).direction;
        bounds.spread = std::max(bounds.spread, std::acos(std::clamp(middle.direction.dot(corner), -1.0F, 1.0F)));
      }
      break;
    }
    case Kind::Point:
      break;
    case Kind::Spot:
      bounds.axis = emitter.edgeU;
      bounds.spread = std::acos(emitter.cosCone);
      break;
  }
  return bounds;
}

std::vector<LightBounds> LightTable::bounds(const Scene& scene) const {
  const std::vector<double> worth = worths(scene);
  std::vector<LightBounds> result;
  result.reserve(worth.size());
  for (std::size_t entry = 0; entry < worth.size(); ++entry) {
    const Emitter& emitter = m_emitters[m_emitterOfEntry[entry]];
    result.push_back(boundsOf(emitter, static_cast<std::uint32_t>(entry) - emitter.first));
    result.back().intensity *= static_cast<float>(worth[entry]);
  }
  return result;
}

/// Where a point of an element lies along the edges of its rectangle.
Eigen::Vector2f LightTable::onRectangle(const Emitter& emitter, std::uint32_t element, float u, float v) {
  if (emitter.picture == nullptr) {
    return {u, v};
  }
  // By a product: whole-number division would cost as much as all the rest. Halves keep it exact.
  const auto row = static_cast<std::uint32_t>((static_cast<double>(element) + 0.5) * emitter.inverseColumns);
  const std::uint32_t column = element - row * static_cast<std::uint32_t>(emitter.picture->width);
  return {(static_cast<float>(column) + u) * static_cast<float>(emitter.inverseColumns),
          1.0F - (static_cast<float>(row) + v) * emitter.inverseRows};
}

float LightTable::geometry(const LightPoint& point, const Vec3& from, const Vec3& normal) const {
  const Emitter& emitter = m_emitters[m_emitterOfEntry[point.entry]];
  const std::uint32_t element = point.entry - emitter.first;
  Vec3 towards;
  Vec3 area;
  if (emitter.kind == Kind::Rectangle) {
    const Eigen::Vector2f place = onRectangle(emitter, element, point.u, point.v);
    towards = emitter.origin + emitter.edgeU * place.x() + emitter.edgeV * place.y() - from;
    area = emitter.normal * emitter.area;
  } else if (emitter.kind == Kind::Mesh) {
    const auto corner = corners(*emitter.mesh, element);
    const float root = std::sqrt(point.u);
    const Vec3 edge1 = corner[1] - corner[0];
    const Vec3 edge2 = corner[2] - corner[0];
    towards = corner[0] + edge1 * (root * (1.0F - point.v)) + edge2 * (root * point.v) - from;
    area = 0.5F * edge1.cross(edge2);
  } else {
    const LightSample light = located(point, from);
    return light.pdf > 0.0F ? std::max(0.0F, light.direction.dot(normal)) * light.scale / light.pdf : 0.0F;
  }
  const float squared = towards.squaredNorm();
  return std::max(0.0F, towards.dot(normal)) * std::max(0.0F, -towards.dot(area)) / (squared * squared);
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
  const std::uint32_t wholeRow = element / width;
  const auto row = static_cast<float>(wholeRow);
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

LightSample LightTable::located(const LightPoint& point, const Vec3& from) const {
  const std::uint32_t index = m_emitterOfEntry[point.entry];
  const Emitter& emitter = m_emitters[index];
  const std::uint32_t element = point.entry - emitter.first;
  LightSample sample;
  switch (emitter.kind) {
    case Kind::Rectangle: {
      const Eigen::Vector2f place = onRectangle(emitter, element, point.u, point.v);
      sample = onArea(emitter.origin + emitter.edgeU * place.x() + emitter.edgeV * place.y(), emitter.normal,
                      emitter.area, from);
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

float LightTable::locatedPdf(const Hit& hit, const Vec3& from, const Vec3& direction) const {
  const Emitter& emitter = m_emitters[hit.emitter];
  if (emitter.kind == Kind::Sphere) {
    return spherePdf(emitter, from);
  }
  float area = emitter.area;
  if (emitter.kind == Kind::Mesh) {
    const auto corner = corners(*emitter.mesh, elementOf(hit));
    area = 0.5F * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
  }
  const float cosine = -direction.dot(hit.normal);
  return cosine > 0.0F ? (hit.position - from).squaredNorm() / (cosine * area) : 0.0F;
}

float LightTable::locatedEnvironmentPdf(const Vec3& direction) const {
  return inEnvironment(m_emitters[m_environment], environmentElement(direction), {}).pdf;
}

}  // namespace metamer::spectral_ref
