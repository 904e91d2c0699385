// SPDX-License-Identifier: Apache-2.0
#include "scene_file/scene_mesh.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <system_error>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "scene_file/obj_check.h"
#include "scene_file/ply_check.h"

namespace metamer::spectral_ref {
namespace {

/// Beyond, a float's steps are wider than the pixels of large pictures.
constexpr float kFarthestCoordinate = 1000;

bool isSound(const std::array<std::uint32_t, 3>& triangle, const std::vector<std::array<float, 3>>& vertices) {
  std::array<Eigen::Vector3d, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& vertex = vertices[triangle[k]];
    for (const float coordinate : vertex) {
      constexpr float kFarthest = 1e9F;
      if (!(std::abs(coordinate) <= kFarthest)) {
        return false;
      }
    }
    corners[k] = Eigen::Vector3f(vertex[0], vertex[1], vertex[2]).cast<double>();
  }
  const Eigen::Vector3d a = corners[1] - corners[0];
  const Eigen::Vector3d b = corners[2] - corners[0];
  return a.cross(b).norm() > 1e-9 * std::max(a.squaredNorm(), b.squaredNorm());
}

/// The mesh's own file and no other: materials and textures that it names are not read, and may be devices.
class OneFile : public Assimp::DefaultIOSystem {
 public:
  explicit OneFile(std::string path) : m_path(std::move(path)) {}
  bool Exists(const char* path) const override { return m_path == path; }
  Assimp::IOStream* Open(const char* path, const char* mode) override {
    return m_path == path ? DefaultIOSystem::Open(path, mode) : nullptr;
  }

 private:
  std::string m_path;
};

/// Texture coordinates of a triangle's corners. @return  false where it has none, or some that are no numbers
bool addCoordinates(const aiMesh& part, const aiFace& face, Mesh& mesh) {
  if (!part.HasTextureCoords(0)) {
    return false;
  }
  std::array<std::array<float, 2>, 3> corners{};
  bool areFinite = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const aiVector3D& place = part.mTextureCoords[0][face.mIndices[k]];
    corners[k] = {place.x, place.y};
    areFinite = areFinite && std::abs(place.x) <= kFarthestCoordinate && std::abs(place.y) <= kFarthestCoordinate;
  }
  mesh.corners.push_back(corners);
  return areFinite;
}

constexpr std::uintmax_t kLargestMesh = std::uintmax_t{4} << 30U;

}  // namespace

Mesh readMesh(const YamlValue& file, const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / spectral::pathOf(file.text());
  const std::string extension = spectral::utf8(path.extension());
  if (extension != ".obj" && extension != ".ply") {
    throw file.error("must be an .obj or .ply file");
  }
  std::error_code none;
  if (std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none)) {
    throw file.error("is a device, pipe or folder; give a mesh file");
  }
  if (std::filesystem::exists(path, none)) {
    if (std::filesystem::file_size(path, none) > kLargestMesh) {
      throw file.error("is larger than 4 GiB; split the mesh");
    }
    try {
      extension == ".ply" ? checkPly(path) : checkObj(path);
    } catch (const spectral::InputError& error) {
      throw file.error("", error.what());
    }
  }
  Assimp::Importer importer;
  importer.SetIOHandler(new OneFile(spectral::utf8(path)));  // the importer's from here on
  const aiScene* scene =
      importer.ReadFile(spectral::utf8(path), aiProcess_Triangulate | aiProcess_PreTransformVertices);
  if (scene == nullptr) {
    throw file.error("", "'" + spectral::utf8(path) + "' cannot be read: " + importer.GetErrorString());
  }
  Mesh mesh;
  mesh.file = spectral::utf8(path);
  bool hasCoordinates = true;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      mesh.vertices.push_back({part.mVertices[i].x, part.mVertices[i].y, part.mVertices[i].z});
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices != 3) {
        continue;  // points and lines have no surface
      }
      const std::array<std::uint32_t, 3> triangle = {first + face.mIndices[0], first + face.mIndices[1],
                                                     first + face.mIndices[2]};
      if (isSound(triangle, mesh.vertices)) {
        mesh.triangles.push_back(triangle);
        hasCoordinates = hasCoordinates && addCoordinates(part, face, mesh);
      } else {
        ++mesh.dropped;
      }
    }
  }
  if (!hasCoordinates) {
    mesh.corners.clear();
  }
  if (mesh.triangles.empty()) {
    throw file.error("", "'" + spectral::utf8(path) + "' has no triangle with an area; mend the mesh");
  }
  // What no triangle uses may be no number; the hierarchy must not see it.
  for (auto& vertex : mesh.vertices) {
    if (!std::all_of(vertex.begin(), vertex.end(), [](float v) { return std::isfinite(v); })) {
      vertex = {0.0F, 0.0F, 0.0F};
    }
  }
  return mesh;
}

}  // namespace metamer::spectral_ref
