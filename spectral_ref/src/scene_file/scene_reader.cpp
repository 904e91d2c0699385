// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/scene_reader.h"

#include <system_error>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "scene_file/fingerprint.h"
#include "scene_file/scene_film.h"
#include "scene_file/scene_shapes.h"

namespace metamer::spectral_ref {
namespace {

using spectral::InputError;

/// Of the text and all that the names in it stood for.
std::uint64_t fingerprintOf(const std::string& text, const Scene& scene) {
  Fingerprint fingerprint;
  fingerprint.add(text.data(), text.size());
  for (const auto& spectrum : scene.spectra) {
    fingerprint.add(spectrum.data(), sizeof(double) * static_cast<std::size_t>(spectrum.size()));
  }
  if (!scene.fluorescences.empty()) {
    for (const UltravioletSamples& spectrum : scene.ultraviolet) {
      fingerprint.add(spectrum.data(), sizeof(double) * static_cast<std::size_t>(spectrum.size()));
    }
    for (const spectral::FluorescentSamples& surface : scene.fluorescences) {
      fingerprint.add(surface.perNm.data(), sizeof(double) * static_cast<std::size_t>(surface.perNm.size()));
    }
  }
  for (const EmitterPicture& picture : scene.pictures) {
    fingerprint.add(picture.drives.data(), sizeof(float) * picture.drives.size());
  }
  for (const Texture& texture : scene.textures) {
    fingerprint.add(texture.picture.values.data(), sizeof(std::uint16_t) * texture.picture.values.size());
    fingerprint.add(texture.corners.data(), sizeof(texture.corners[0]) * texture.corners.size());
  }
  for (const Mesh& mesh : scene.meshes) {
    fingerprint.add(mesh.vertices.data(), sizeof(mesh.vertices[0]) * mesh.vertices.size());
    fingerprint.add(mesh.triangles.data(), sizeof(mesh.triangles[0]) * mesh.triangles.size());
  }
  return fingerprint.value();
}

}  // namespace

Scene readScene(const std::filesystem::path& file, const spectral::DataLibrary& library) {
  return parseScene(spectral::readTextFile(file), spectral::utf8(file), file.parent_path(), library);
}

Scene parseScene(const std::string& text, const std::string& where, const std::filesystem::path& folder,
                 const spectral::DataLibrary& library) {
  const YamlMap top(parseSceneText(text, where),
                    {"metamer_scene", "film", "camera", "integrator", "spectra", "shapes", "lights"});
  top.requireVersion();
  Scene scene(readFilm(top.find("film"), library, folder));
  scene.camera = readCamera(top.find("camera"));
  scene.integrator = readIntegrator(top.find("integrator"));
  SceneSpectra spectra(top.find("spectra"), scene, library, folder);
  if (const auto shapes = top.find("shapes")) {
    for (const YamlValue& shape : shapes->items()) {
      readShape(shape, spectra, scene);
    }
  }
  if (const auto lights = top.find("lights")) {
    for (const YamlValue& light : lights->items()) {
      readLight(light, spectra, scene);
    }
  }
  scene.fingerprint = fingerprintOf(text, scene);
  return scene;
}

}  // namespace metamer::spectral_ref
