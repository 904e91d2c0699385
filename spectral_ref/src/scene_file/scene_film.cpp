// SPDX-License-Identifier: Apache-2.0
#include "scene_file/scene_film.h"

#include <Eigen/Geometry>
#include <cmath>

namespace metamer::spectral_ref {
namespace {

using spectral::InputError;
using spectral::Observer;

constexpr int kLargestSide = 65536;
constexpr double kMostPixels = 1 << 28;
constexpr const char* kStandardObserver = "CIE 1931 2";

SpectralBins readBins(const YamlValue& value) {
  const YamlMap section(value, {"from", "to", "step"});
  const char* remedy = "is missing; give from, to and step in nm, such as {from: 380, to: 780, step: 10}";
  SpectralBins bins;
  bins.fromNm = section.require("from", remedy).number(spectral::kDomainStartNm, spectral::kDomainEndNm);
  const double to = section.require("to", remedy).number(bins.fromNm, spectral::kDomainEndNm);
  bins.stepNm = section.require("step", remedy).number(1.0, spectral::kDomainSize);
  const double steps = (to - bins.fromNm) / bins.stepNm;
  constexpr double kRounding = 1e-6;
  if (std::abs(steps - std::round(steps)) > kRounding) {
    throw section.require("to", "").error("must lie a whole number of steps above from");
  }
  bins.count = static_cast<int>(std::round(steps)) + 1;
  return bins;
}

std::array<float, 8> chromaticitiesOf(const spectral::RgbSpace& space) {
  std::array<float, 8> xy{};
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d& place = i < 3 ? space.primaries[i] : space.white;
    xy[2 * i] = static_cast<float>(place.x());
    xy[2 * i + 1] = static_cast<float>(place.y());
  }
  return xy;
}

void readSpace(const YamlMap& section, const spectral::DataLibrary& library, FilmSettings& film) {
  const auto value = section.find("space");
  const bool isXyz = film.observer.response == Observer::Response::Xyz;
  const std::string name = value ? value->text() : isXyz ? "XYZ" : "native";
  film.space = name;
  if (isXyz || film.observer.xyzFromResponse) {
    const Eigen::Matrix3d xyz = isXyz ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : *film.observer.xyzFromResponse;
    film.luminanceOfResponse = xyz.row(1).transpose();
    film.colourFromResponse = xyz;
  } else {
    // No luminance is known: the mean of the channels stands for it.
    film.luminanceOfResponse = Eigen::Vector3d::Constant(1.0 / 3.0);
  }
  if (name == "native") {
    film.colourFromResponse.setIdentity();
    return;
  }
  if (!isXyz && !film.observer.xyzFromResponse) {
    throw value->error("observer '" + film.observer.name + "' has no matrix to XYZ; use 'space: native'");
  }
  if (name == "XYZ") {
    constexpr float kThird = 1.0F / 3.0F;
    film.chromaticities = {1.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, kThird, kThird};
    return;
  }
  spectral::ColourSpace space;
  try {
    space = library.colourSpace(name);
  } catch (const InputError& error) {
    throw value->error("", std::string("must be XYZ, native or a linear space; ") + error.what());
  }
  if (space.encoding) {
    throw value->error("is encoded; a film is linear, name a linear space such as ACEScg");
  }
  film.colourFromResponse = space.linear.rgbFromXyz() * film.colourFromResponse;
  film.chromaticities = chromaticitiesOf(space.linear);
}

void readFilter(const YamlValue& value, FilmSettings& film) {
  if (value.isScalar() && value.text() == "box") {
    return;
  }
  if (value.isScalar() && value.text() == "gaussian") {
    film.filter = FilmSettings::Filter::Gaussian;
    film.filterRadius = 1.5;
    return;
  }
  if (!value.isMap()) {
    throw value.error("must be box, gaussian, or {gaussian: SIGMA, radius: R} or {box: RADIUS} in pixels");
  }
  const YamlMap section(value, {"box", "gaussian", "radius"});
  constexpr double kLargestRadius = 16.0;
  if (const auto box = section.find("box")) {
    film.filterRadius = box->number(0.0, kLargestRadius);
    return;
  }
  film.filter = FilmSettings::Filter::Gaussian;
  film.filterSigma = section.require("gaussian", "is missing; give its sigma in pixels").number(0.01, kLargestRadius);
  const auto radius = section.find("radius");
  film.filterRadius = radius ? radius->number(0.01, kLargestRadius) : 3.0 * film.filterSigma;
}

}  // namespace

FilmSettings readFilm(const std::optional<YamlValue>& value, const spectral::DataLibrary& library,
                      const std::filesystem::path& folder) {
  if (!value) {
    return FilmSettings(library.observer(kStandardObserver));
  }
  const YamlMap section(*value, {"width", "height", "observer", "space", "bins", "filter", "photometric"});
  const auto observer = section.find("observer");
  FilmSettings film([&] {
    try {
      return library.observer(observer ? observer->text() : kStandardObserver, folder);
    } catch (const InputError& error) {
      throw(observer ? *observer : *value).error("", error.what());
    }
  }());
  if (const auto width = section.find("width")) {
    film.width = width->integer(1, kLargestSide);
  }
  if (const auto height = section.find("height")) {
    film.height = height->integer(1, kLargestSide);
  }
  if (static_cast<double>(film.width) * film.height > kMostPixels) {
    throw section.error("", "has more than 2^28 pixels; render it in parts");
  }
  readSpace(section, library, film);
  const double sum = film.luminanceOfResponse.dot(film.observer.onDomain().colwise().sum().transpose());
  if (!(sum > 0)) {
    throw(observer ? *observer : *value).error("sees nothing between 380 and 780 nm");
  }
  if (const auto bins = section.find("bins")) {
    film.bins = readBins(*bins);
  }
  if (const auto filter = section.find("filter")) {
    readFilter(*filter, film);
  }
  if (const auto photometric = section.find("photometric")) {
    film.photometric = photometric->boolean();
  }
  return film;
}

CameraSettings readCamera(const std::optional<YamlValue>& value) {
  CameraSettings camera;
  if (!value) {
    return camera;
  }
  const YamlMap section(*value, {"origin", "target", "up", "fov_x"});
  if (const auto origin = section.find("origin")) {
    camera.origin = vectorOf(*origin);
  }
  if (const auto target = section.find("target")) {
    camera.target = vectorOf(*target);
  }
  if (const auto up = section.find("up")) {
    camera.up = vectorOf(*up);
  }
  if (const auto angle = section.find("fov_x")) {
    camera.fovXDegrees = angle->number(1e-3, 179.0);
  }
  const Vector3 forward = camera.target - camera.origin;
  if (!(forward.norm() > 0)) {
    throw section.error("", "origin and target are the same point; move one");
  }
  if (!(forward.normalized().cross(camera.up.normalized()).norm() > 1e-6)) {
    throw section.error("", "up points along the view; give another direction");
  }
  return camera;
}

IntegratorSettings readIntegrator(const std::optional<YamlValue>& value) {
  IntegratorSettings settings;
  if (!value) {
    return settings;
  }
  const YamlMap section(*value, {"max_depth", "russian_roulette", "wavelengths"});
  constexpr int kDeepest = 4096;
  if (const auto depth = section.find("max_depth")) {
    settings.maxDepth = depth->integer(1, kDeepest);
  }
  if (const auto roulette = section.find("russian_roulette")) {
    settings.russianRoulette = roulette->integer(1, 2 * kDeepest);
  }
  if (const auto lanes = section.find("wavelengths")) {
    const int count = lanes->integer(1, 16);
    if (count != 1 && count != 4 && count != 8 && count != 16) {
      throw lanes->error("must be 1, 4, 8 or 16");
    }
    settings.wavelengths = count;
  }
  return settings;
}

}  // namespace metamer::spectral_ref
