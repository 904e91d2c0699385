// SPDX-License-Identifier: Apache-2.0
#include "loop/validation_scenes.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "metamer/spectral_ref/renderer.h"

namespace metamer::validation {
namespace {

using spectral_ref::Scene;
using spectral_ref::Vector3;

constexpr int kColumns = 6;
/// Pixels a patch and its gap take; means are of the inner ones.
constexpr int kPitch = 14;
constexpr int kInner = 8;
constexpr double kGap = 0.1;     ///< share of the pitch
constexpr double kDistance = 9;  ///< of the camera, in pitches
/// Of the calibration square's chart: small, so that the square's form factor is the same all over it.
constexpr double kSmallPitch = 0.01;

int rowsOf(const Chart& chart) {
  return (static_cast<int>(chart.names.size()) + kColumns - 1) / kColumns;
}

std::uint32_t addSpectrum(Scene& scene, const spectral::DomainSamples& values) {
  scene.spectra.push_back(values);
  return static_cast<std::uint32_t>(scene.spectra.size() - 1);
}

std::uint32_t addDiffuse(Scene& scene, const spectral::DomainSamples& reflectance) {
  spectral_ref::Material material;
  material.kind = spectral_ref::Material::Kind::Diffuse;
  material.colour = addSpectrum(scene, reflectance);
  scene.materials.push_back(material);
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

void addRectangle(Scene& scene, const Vector3& centre, const Vector3& halfU, const Vector3& halfV,
                  std::uint32_t material) {
  spectral_ref::Rectangle rectangle;
  rectangle.center = centre;
  rectangle.halfU = halfU;
  rectangle.halfV = halfV;
  rectangle.surface.material = material;
  scene.rectangles.push_back(rectangle);
}

/// A black rectangle that gives light.
void addLamp(Scene& scene, const Vector3& centre, const Vector3& halfU, const Vector3& halfV,
             const spectral::DomainSamples& radiance) {
  scene.materials.emplace_back();
  addRectangle(scene, centre, halfU, halfV, static_cast<std::uint32_t>(scene.materials.size() - 1));
  scene.rectangles.back().surface.emission = {addSpectrum(scene, radiance)};
}

void addBox(Scene& scene, double width, double height, const std::array<spectral::DomainSamples, 3>& walls) {
  const double depth = 3;
  const Vector3 up(0, height / 2, 0);
  const Vector3 along(0, 0, depth / 2);
  const Vector3 across(width / 2, 0, 0);
  const Vector3 middle(0, 0, depth / 2);
  addRectangle(scene, middle - across, up, along, addDiffuse(scene, walls[0]));  // looks along +x
  addRectangle(scene, middle + across, along, up, addDiffuse(scene, walls[1]));  // looks along -x
  const std::uint32_t rest = addDiffuse(scene, walls[2]);
  addRectangle(scene, middle - up, along, across, rest);        // floor
  addRectangle(scene, Vector3(0, 0, -0.02), across, up, rest);  // behind the chart
}

}  // namespace

Scene sceneOf(const Chart& chart, Stage stage, const spectral::DomainSamples& radiance,
              const spectral::Observer& observer, const std::array<spectral::DomainSamples, 3>& walls) {
  const bool small = stage == Stage::Square || stage == Stage::Surrounding;
  const double pitch = small ? kSmallPitch : 1.0;
  const int rows = rowsOf(chart);
  spectral_ref::FilmSettings film(observer);
  film.width = kColumns * kPitch;
  film.height = rows * kPitch;
  // The sum of the responses stands for luminance: all that is asked of it is a scale.
  film.luminanceOfResponse = Vector3::Constant(1.0 / 3.0);
  film.space = "native";
  Scene scene(film);
  scene.camera.origin = {0, 0, kDistance * pitch};
  scene.camera.target = {0, 0, 0};
  scene.camera.fovXDegrees = 2 * std::atan(0.5 * kColumns / kDistance) * 180 / std::numbers::pi;
  scene.integrator.maxDepth = stage == Stage::OpenBox ? 12 : 2;
  scene.integrator.wavelengths = 16;
  for (std::size_t i = 0; i < chart.names.size(); ++i) {
    const int column = static_cast<int>(i) % kColumns;
    const int row = static_cast<int>(i) / kColumns;
    const Vector3 centre(pitch * (column + 0.5 - 0.5 * kColumns), pitch * (0.5 * rows - row - 0.5), 0);
    const double half = 0.5 * pitch * (1 - kGap);
    addRectangle(scene, centre, {half, 0, 0}, {0, half, 0}, addDiffuse(scene, chart.reflectances[i]));
  }
  switch (stage) {
    case Stage::OpenBox:
      addBox(scene, kColumns, rows, walls);
      addLamp(scene, {0, 0.5 * rows - 0.1, 4.5}, {0.6, 0, 0}, {0, -0.42, 0.42}, radiance);
      break;
    case Stage::SmallLamp:
      addLamp(scene, {0, 0.5 * rows - 0.1, 4.5}, {0.6, 0, 0}, {0, -0.42, 0.42}, radiance);
      break;
    case Stage::Square:
      // It looks along -z; the camera looks past its edge through a chart that is far smaller than the square.
      addLamp(scene, {0, 0, 1}, {0, 0.5, 0}, {0.5, 0, 0}, radiance);
      break;
    case Stage::Surrounding: {
      spectral_ref::EmitterPicture sky;
      sky.width = 1;
      sky.height = 1;
      sky.emitters = {addSpectrum(scene, radiance)};
      sky.drives = {1.0F};
      scene.pictures.push_back(sky);
      scene.environments.push_back({0});
      break;
    }
  }
  return scene;
}

std::vector<Eigen::Matrix3Xd> renderPatches(const Scene& scene, const Chart& chart, int replicates, int samples,
                                            std::uint32_t seed, int threads) {
  std::vector<Eigen::Matrix3Xd> means;
  for (int replicate = 0; replicate < replicates; ++replicate) {
    spectral_ref::RenderOptions options;
    options.seed = seed + static_cast<std::uint32_t>(replicate);
    spectral_ref::Renderer renderer(scene, options, 0, threads);
    renderer.render(static_cast<std::uint64_t>(samples), std::numeric_limits<double>::infinity());
    const spectral_ref::Film& film = renderer.film();
    Eigen::Matrix3Xd mean = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(chart.names.size()));
    for (std::size_t i = 0; i < chart.names.size(); ++i) {
      const int left = static_cast<int>(i) % kColumns * kPitch + (kPitch - kInner) / 2;
      const int top = static_cast<int>(i) / kColumns * kPitch + (kPitch - kInner) / 2;
      for (int y = top; y < top + kInner; ++y) {
        for (int x = left; x < left + kInner; ++x) {
          mean.col(static_cast<Eigen::Index>(i)) += film.colour(static_cast<std::size_t>(y * scene.film.width + x));
        }
      }
    }
    means.emplace_back(mean / (kInner * kInner));
  }
  return means;
}

Eigen::Matrix3Xd meanOf(const std::vector<Eigen::Matrix3Xd>& replicates) {
  Eigen::Matrix3Xd mean = Eigen::Matrix3Xd::Zero(3, replicates.front().cols());
  for (const Eigen::Matrix3Xd& one : replicates) {
    mean += one / static_cast<double>(replicates.size());
  }
  return mean;
}

}  // namespace metamer::validation
