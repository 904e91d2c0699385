// SPDX-License-Identifier: Apache-2.0
#include "scene_file/scene_shapes.h"

#include <Eigen/Geometry>
#include <cmath>

#include "scene_file/scene_mesh.h"
#include "scene_file/scene_pictures.h"
#include "scene_file/scene_surface.h"

namespace metamer::spectral_ref {
namespace {

using Use = SceneSpectra::Use;

constexpr double kLargestLength = 1e9;

Rectangle readPlace(const YamlMap& section) {
  const char* remedy = "is missing; a rectangle has 'center', half_u and half_v";
  Rectangle rectangle;
  rectangle.center = vectorOf(section.require("center", remedy));
  rectangle.halfU = vectorOf(section.require("half_u", remedy));
  rectangle.halfV = vectorOf(section.require("half_v", remedy));
  const double area = rectangle.halfU.cross(rectangle.halfV).norm();
  if (!(area > 1e-12 * rectangle.halfU.norm() * rectangle.halfV.norm()) || !(area > 0)) {
    throw section.error("", "has no area; half_u and half_v must be longer than 0 and not along one line");
  }
  return rectangle;
}

void readRectangle(const YamlValue& place, const YamlMap& shape, SceneSpectra& spectra, Scene& scene) {
  Rectangle rectangle = readPlace(YamlMap(place, {"center", "half_u", "half_v"}));
  rectangle.surface = readSurface(shape, {}, spectra, scene);
  scene.rectangles.push_back(rectangle);
}

void readSphere(const YamlValue& place, const YamlMap& shape, SceneSpectra& spectra, Scene& scene) {
  const YamlMap section(place, {"center", "radius"});
  Sphere sphere;
  sphere.center = vectorOf(section.require("center", "is missing; a sphere has 'center' and radius"));
  sphere.radius =
      section.require("radius", "is missing; a sphere has 'center' and radius").number(1e-9, kLargestLength);
  Texture texture;
  texture.wrap = Texture::Wrap::Sphere;
  texture.center = sphere.center;
  sphere.surface = readSurface(shape, texture, spectra, scene);
  scene.spheres.push_back(sphere);
}

void readChart(const YamlValue& place, const YamlMap& shape, SceneSpectra& spectra, Scene& scene) {
  const YamlMap section(place, {"center", "half_u", "half_v", "set", "columns", "gap"});
  for (const char* key : kSurfaceKeys) {
    if (const auto value = shape.find(key)) {
      throw value->error("", "a chart has the materials of its set; leave this out");
    }
  }
  const Rectangle board = readPlace(section);
  const auto set = section.find("set");
  const std::vector<SpectrumId> patches = spectra.set(set.value_or(YamlValue::ofText("colorchecker", "set")));
  const auto columnsValue = section.find("columns");
  const int columns = columnsValue ? columnsValue->integer(1, 1024) : 6;
  const auto gapValue = section.find("gap");
  const double gap = gapValue ? gapValue->number(0.0, 0.9) : 0.1;
  const int count = static_cast<int>(patches.size());
  const int rows = (count + columns - 1) / columns;
  for (int i = 0; i < count; ++i) {
    const int row = i / columns;
    const double u = (2.0 * (i % columns) + 1.0) / columns - 1.0;
    const double v = 1.0 - (2.0 * row + 1.0) / rows;
    Rectangle patch;
    patch.center = board.center + u * board.halfU + v * board.halfV;
    patch.halfU = board.halfU * ((1.0 - gap) / columns);
    patch.halfV = board.halfV * ((1.0 - gap) / rows);
    patch.surface.material = addDiffuse(scene, patches[static_cast<std::size_t>(i)]);
    scene.rectangles.push_back(patch);
  }
}

void readLedWall(const YamlValue& place, const YamlMap& shape, SceneSpectra& spectra, Scene& scene) {
  const YamlMap section(place, {"center", "half_u", "half_v", "picture", "emitters", "matrix", "scale"});
  for (const char* key : kSurfaceKeys) {
    if (const auto value = shape.find(key)) {
      throw value->error("", "an LED wall has its picture's light; leave this out");
    }
  }
  Rectangle wall = readPlace(section);
  scene.pictures.push_back(readPicture(section, spectra));
  wall.picture = static_cast<std::uint32_t>(scene.pictures.size() - 1);
  scene.materials.emplace_back();
  wall.surface.material = static_cast<std::uint32_t>(scene.materials.size() - 1);
  scene.rectangles.push_back(wall);
}

void readMeshShape(const YamlValue& file, const YamlMap& shape, SceneSpectra& spectra, Scene& scene) {
  Mesh mesh = readMesh(file, spectra.folder());
  Texture texture;
  texture.wrap = Texture::Wrap::Mesh;
  texture.corners = std::move(mesh.corners);
  mesh.surface = readSurface(shape, texture, spectra, scene);
  if (mesh.dropped > 0) {
    scene.warnings.push_back(mesh.file + ": " + std::to_string(mesh.dropped) +
                             " triangles have no area or a coordinate that is no finite number, and are left out");
  }
  scene.meshes.push_back(std::move(mesh));
}

void readPoint(const YamlValue& value, SceneSpectra& spectra, Scene& scene) {
  const YamlMap section(value, {"position", "intensity"});
  PointLight light;
  light.position = vectorOf(section.require("position", "is missing; a point light has position and intensity"));
  light.intensity =
      spectra.find(section.require("intensity", "is missing; name a spectrum, in W.sr^-1.nm^-1"), Use::Emission);
  scene.points.push_back(light);
}

void readSpot(const YamlValue& value, SceneSpectra& spectra, Scene& scene) {
  const YamlMap section(value, {"position", "target", "intensity", "cone", "beam"});
  SpotLight light;
  light.position = vectorOf(section.require("position", "is missing; a spot has position, target and intensity"));
  const auto target = section.require("target", "is missing; a spot has position, target and intensity");
  light.direction = vectorOf(target) - light.position;
  if (!(light.direction.norm() > 0)) {
    throw target.error("", "is the spot's own position; move it");
  }
  light.direction.normalize();
  light.intensity =
      spectra.find(section.require("intensity", "is missing; name a spectrum, in W.sr^-1.nm^-1"), Use::Emission);
  if (const auto cone = section.find("cone")) {
    light.coneDegrees = cone->number(0.01, 90.0);
    light.beamDegrees = 0.75 * light.coneDegrees;
  }
  if (const auto beam = section.find("beam")) {
    light.beamDegrees = beam->number(0.0, light.coneDegrees * 0.999);
  }
  scene.spots.push_back(light);
}

void readEnvironment(const YamlValue& value, SceneSpectra& spectra, Scene& scene) {
  if (!scene.environments.empty()) {
    throw value.error("", "is the second one; a scene has one environment");
  }
  const YamlMap section(value, {"emission", "picture", "emitters", "matrix", "scale"});
  if (section.find("picture")) {
    if (const auto emission = section.find("emission")) {
      throw emission->error("", "cannot stand beside a picture; leave one out");
    }
    scene.pictures.push_back(readPicture(section, spectra));
    scene.environments.push_back({static_cast<std::uint32_t>(scene.pictures.size() - 1)});
    return;
  }
  EmitterPicture picture;
  picture.width = 1;
  picture.height = 1;
  picture.emitters = {spectra.find(
      section.require("emission", "is missing; name a spectrum: the same light all around"), Use::Emission)};
  picture.drives = {1.0F};
  scene.pictures.push_back(picture);
  scene.environments.push_back({static_cast<std::uint32_t>(scene.pictures.size() - 1)});
}

}  // namespace

void readShape(const YamlValue& value, SceneSpectra& spectra, Scene& scene) {
  const YamlMap shape(value, {"rectangle", "sphere", "chart", "mesh", "led_wall", "diffuse", "skin", "fluorescent",
                              "conductor", "dielectric", "gel", "emission"});
  int kinds = 0;
  for (const char* kind : {"rectangle", "sphere", "chart", "mesh", "led_wall"}) {
    kinds += shape.find(kind) ? 1 : 0;
  }
  if (kinds != 1) {
    throw shape.error("", "must be one rectangle, sphere, chart, mesh or led_wall");
  }
  if (const auto rectangle = shape.find("rectangle")) {
    readRectangle(*rectangle, shape, spectra, scene);
  } else if (const auto sphere = shape.find("sphere")) {
    readSphere(*sphere, shape, spectra, scene);
  } else if (const auto chart = shape.find("chart")) {
    readChart(*chart, shape, spectra, scene);
  } else if (const auto mesh = shape.find("mesh")) {
    readMeshShape(*mesh, shape, spectra, scene);
  } else if (const auto wall = shape.find("led_wall")) {
    readLedWall(*wall, shape, spectra, scene);
  }
}

void readLight(const YamlValue& value, SceneSpectra& spectra, Scene& scene) {
  const YamlMap light(value, {"environment", "point", "spot"});
  if (light.keys().size() != 1) {
    throw light.error("", "must be one environment, point or spot");
  }
  if (const auto environment = light.find("environment")) {
    readEnvironment(*environment, spectra, scene);
  } else if (const auto point = light.find("point")) {
    readPoint(*point, spectra, scene);
  } else if (const auto spot = light.find("spot")) {
    readSpot(*spot, spectra, scene);
  }
}

}  // namespace metamer::spectral_ref
