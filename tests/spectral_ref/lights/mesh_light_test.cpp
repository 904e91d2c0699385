// SPDX-License-Identifier: Apache-2.0
// Direct light on and from triangle meshes, read from PLY files, against the closed form for an even polygon: the sum
// over its edges of the angle each takes up times the normal of the plane it spans (Lambert 1760).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "spectral/temporary_folder.h"
#include "spectral_ref/scene_fixture.h"

namespace metamer::spectral_ref {
namespace {

using Corners = std::vector<Vector3>;

/// Irradiance over radiance at a point that has the whole polygon before it. @param corners  clockwise as seen from it
double polygonForm(const Vector3& point, const Vector3& normal, const Corners& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3 a = (corners[i] - point).normalized();
    const Vector3 b = (corners[(i + 1) % corners.size()] - point).normalized();
    const Vector3 across = a.cross(b);
    sum += std::atan2(across.norm(), a.dot(b)) * across.normalized().dot(normal);
  }
  return -0.5 * sum;
}

/// Faces by numbers of corners; each counter-clockwise seen from the side that shines or is painted.
std::filesystem::path plyFile(const std::string& name, const Corners& corners,
                              const std::vector<std::vector<int>>& faces) {
  std::filesystem::path path = scratchFile(name + ".ply");
  std::ofstream file(path);
  file.precision(9);
  file << "ply\nformat ascii 1.0\nelement vertex " << corners.size()
       << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << faces.size()
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vector3& corner : corners) {
    file << corner.x() << ' ' << corner.y() << ' ' << corner.z() << '\n';
  }
  for (const std::vector<int>& face : faces) {
    file << face.size();
    for (const int corner : face) {
      file << ' ' << corner;
    }
    file << '\n';
  }
  return path;
}

/// The plate -2 ... 2 in x and y at z = 0, of uneven quadrilaterals.
std::filesystem::path platePly() {
  const std::vector<double> lines = {-2.0, -1.7, -0.9, 0.05, 0.3, 1.1, 2.0};
  const int count = static_cast<int>(lines.size());
  Corners corners;
  std::vector<std::vector<int>> faces;
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < count; ++i) {
      corners.emplace_back(lines[static_cast<std::size_t>(i)], lines[static_cast<std::size_t>(j)], 0.0);
      if (i + 1 < count && j + 1 < count) {
        const int first = j * count + i;
        faces.push_back({first, first + 1, first + count + 1, first + count});
      }
    }
  }
  return plyFile("plate", corners, faces);
}

/// An L above the plate, tilted; in the order that it is gone round by when seen from below.
Corners lampOutline() {
  const Vector3 corner(0.4, -0.9, 1.6);
  const Vector3 u(1.0, 0.0, 0.3);
  const Vector3 v(0.1, 1.0, -0.2);
  Corners outline;
  for (const auto& [a, b] : {std::pair(0.0, 0.0), std::pair(0.0, 1.0), std::pair(0.3, 1.0), std::pair(0.3, 0.4),
                             std::pair(0.9, 0.4), std::pair(0.9, 0.0)}) {
    outline.push_back(corner + a * u + b * v);
  }
  return outline;
}
std::filesystem::path lampPly() {
  return plyFile("lamp", lampOutline(), {{0, 1, 2, 3}, {3, 4, 0}, {4, 5, 0}});
}

struct Area {
  int x, y, width, height;
};
constexpr int kPixels = 32;

/// Mean of the form over what a block of pixels sees of the plate.
double meanForm(const Area& area, const Corners& lamp) {
  const double side = 10.0 * std::tan(0.5 * 20.0 * M_PI / 180.0);  // half of the plate's part in the picture
  constexpr int kSteps = 16;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double column = area.x + area.width * (i + 0.5) / kSteps;
      const double row = area.y + area.height * (j + 0.5) / kSteps;
      const Vector3 place(side * (2.0 * column / kPixels - 1.0), side * (1.0 - 2.0 * row / kPixels), 0.0);
      sum += polygonForm(place, Vector3::UnitZ(), lamp);
    }
  }
  return sum / (kSteps * kSteps);
}

std::string sceneWith(const std::string& plate, const std::string& lamp) {
  return "metamer_scene: 1\n"
         "film: {width: 32, height: 32}\n"
         "camera: {origin: [0, 0, 10], target: [0, 0, 0], up: [0, 1, 0], fov_x: 20}\n"
         "integrator: {max_depth: 2, wavelengths: 4}\n"
         "shapes:\n"
         "  - " +
         plate + "\n    diffuse: 0.5\n  - " + lamp + "\n    emission: 3\n";
}

class MeshLightTest : public testing::TestWithParam<Restir> {
 protected:
  /// Off the lamp, which hides part of the plate from the camera.
  static constexpr std::array<Area, 3> kAreas = {Area{1, 1, 8, 8}, Area{12, 20, 4, 8}, Area{2, 12, 12, 4}};

  static void expectForm(const std::string& text, const Corners& lamp, const std::string& what) {
    const Film film = rendered(sceneOf(text), 1024, {0, false, GetParam()});
    for (const Area& area : kAreas) {
      const double expected = 0.5 / M_PI * 3.0 * meanForm(area, lamp);
      const double mean = luminanceOver(film, area.x, area.y, area.width, area.height).mean;
      // Over three seeds the farthest of these means was 1.3e-3 away, under a mesh of lamps.
      EXPECT_NEAR(mean / expected, 1.0, 1.5e-3) << what;
      std::printf("%s, restir %d: %.5f of the closed form\n", what.c_str(), static_cast<int>(GetParam()),
                  mean / expected);
    }
  }
};

const std::string kPlainPlate = "rectangle: {center: [0, 0, 0], half_u: [2, 0, 0], half_v: [0, 2, 0]}";

TEST_P(MeshLightTest, ASmallLampOnAPlateOfTriangles) {
  // The rectangle, gone round as seen from below, where it shines to.
  const Vector3 center(1.5, 0.5, 2.0);
  const Vector3 u(0.0, 0.1, 0.02);
  const Vector3 v(0.1, 0.0, 0.03);
  const Corners lamp = {center - u - v, center + u - v, center + u + v, center - u + v};
  expectForm(sceneWith("mesh: " + platePly().string(),
                       "rectangle: {center: [1.5, 0.5, 2.0], half_u: [0, 0.1, 0.02], half_v: [0.1, 0, 0.03]}"),
             lamp, "mesh under a rectangle");
}

TEST_P(MeshLightTest, ALampOfTriangles) {
  expectForm(sceneWith(kPlainPlate, "mesh: " + lampPly().string()), lampOutline(), "plate under a mesh");
  expectForm(sceneWith("mesh: " + platePly().string(), "mesh: " + lampPly().string()), lampOutline(),
             "mesh under a mesh");
}

TEST_P(MeshLightTest, TheBackOfAMeshIsDark) {
  Corners corners = lampOutline();
  const auto turned = plyFile("turned", corners, {{3, 2, 1, 0}, {0, 4, 3}, {0, 5, 4}});
  const Film film = rendered(sceneOf(sceneWith(kPlainPlate, "mesh: " + turned.string())), 4, {0, false, GetParam()});
  EXPECT_EQ(luminanceOver(film, 1, 1, 8, 8).mean, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Integrators, MeshLightTest, testing::Values(Restir::Off, Restir::Hero, Restir::Lanes));

}  // namespace
}  // namespace metamer::spectral_ref
