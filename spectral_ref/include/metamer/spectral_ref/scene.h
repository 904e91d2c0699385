// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "metamer/spectral/observer.h"
#include "metamer/spectral/reradiation.h"
#include "metamer/spectral/rgb_space.h"
#include "metamer/spectral/spectrum.h"

/// A scene as plain values: what a scene file says once every name in it is looked up. Lengths are in one unit of the
/// user's choice, angles in degrees, radiance in W.m^-2.sr^-1.nm^-1.
namespace metamer::spectral_ref {

using Vector3 = Eigen::Vector3d;

/// Values at 300, 301, ... 379 nm.
using UltravioletSamples = Eigen::Matrix<double, spectral::kDomainInExcitation, 1>;

/// Index into Scene::spectra.
using SpectrumId = std::uint32_t;

/// Spectral channels of the film, centred on from, from + step, ... to: each the mean radiance over one step about
/// its centre, cut to 379.5 ... 780.5 nm.
struct SpectralBins {
  double fromNm = 0;
  double stepNm = 0;
  int count = 0;  ///< 0: none

  double centreNm(int bin) const { return fromNm + stepNm * bin; }
  bool operator==(const SpectralBins&) const = default;
};

struct FilmSettings {
  explicit FilmSettings(spectral::Observer eye) : observer(std::move(eye)) {}

  int width = 256;
  int height = 256;
  spectral::Observer observer;
  /// Film colour from the observer's response; identity for XYZ and for a camera's own channels.
  Eigen::Matrix3d colourFromResponse = Eigen::Matrix3d::Identity();
  /// Luminance (Y) as a sum of the observer's three responses.
  Eigen::Vector3d luminanceOfResponse = Eigen::Vector3d::UnitY();
  std::string space = "XYZ";
  /// xy of red, green, blue and white of that space, one after another; none for a camera's own channels.
  std::optional<std::array<float, 8>> chromaticities;
  bool photometric = false;  ///< R, G, B and Y in cd.m^-2 instead of relative to a radiance of 1
  SpectralBins bins;
  enum class Filter { Box, Gaussian } filter = Filter::Box;
  double filterRadius = 0.5;  ///< pixels
  double filterSigma = 0.5;   ///< pixels, of the Gaussian
};

struct CameraSettings {
  Vector3 origin{0, 0, 1};
  Vector3 target{0, 0, 0};
  Vector3 up{0, 1, 0};
  double fovXDegrees = 40;  ///< full angle across the picture's width
};

struct IntegratorSettings {
  int maxDepth = 6;         ///< most edges from camera to light: 1 sees emitters, 2 direct light
  int russianRoulette = 5;  ///< from this edge on paths may end at random
  int wavelengths = 4;      ///< carried by a path: 1, 4, 8 or 16
};

/// Refractive index by wavelength (in micrometres): n = a + b/l^2 + c/l^4 (Cauchy), or
/// n^2 = 1 + sum_i b_i l^2 / (l^2 - c_i) (Sellmeier, c_i in um^2), or a table.
struct RefractiveIndex {
  std::vector<double> perNm;  ///< at 380, 381, ... 780 nm
  bool isConstant = true;
};

struct Material {
  enum class Kind { Black, Diffuse, Fluorescent, RoughConductor, SmoothDielectric, RoughDielectric, Gel };
  Kind kind = Kind::Black;
  SpectrumId colour = 0;              ///< reflectance (Diffuse, Fluorescent) or transmittance (Gel)
  std::uint32_t fluorescence = 0;     ///< Fluorescent: index into Scene::fluorescences
  SpectrumId eta = 0;                 ///< RoughConductor: real part of the index
  SpectrumId absorption = 0;          ///< RoughConductor: imaginary part of the index
  double roughness = 0;               ///< GGX alpha, 0 ... 1
  std::optional<SpectrumId> f0 = {};  ///< RoughConductor: reflectance at normal incidence instead of eta and k
  RefractiveIndex index;              ///< dielectrics: inside against outside
  double sheetIndex = 0;              ///< Gel: of the sheet, whose transmittance falls with the angle; 0: it does not
  /// Diffuse: index into Scene::textures, whose reflectance counts; `colour` is its mean.
  std::optional<std::uint32_t> texture = {};
};

/// A picture of reflectances: a pixel's values at nodes, linear between them.
struct ReflectancePicture {
  int width = 0;
  int height = 0;
  std::vector<double> nodesNm;               ///< rising, the first 380, the last 780
  static constexpr double kLargest = 65535;  ///< a reflectance of 1
  std::vector<std::uint16_t> values;         ///< height x width x nodes, top row first
};

/// A picture on a shape. Between pixels' middles it is bilinear.
struct Texture {
  enum class Wrap {
    Rectangle,  ///< u to the right, v up, once
    Sphere,     ///< longitude by latitude: +y up, the picture's middle at +z, upright from outside, left at the left
    Mesh,       ///< by the corners' coordinates, (0, 0) at the bottom left, again and again beyond 0 ... 1
  };
  ReflectancePicture picture;
  Wrap wrap = Wrap::Rectangle;
  Vector3 center{0, 0, 0};                                   ///< Sphere: its own
  std::vector<std::array<std::array<float, 2>, 3>> corners;  ///< Mesh: u, v of the corners of each triangle
};

/// Light of a surface: one spectrum, or a picture whose pixels mix several.
struct Emission {
  SpectrumId spectrum = 0;
};

/// The pixels of a picture as weights of emitter spectra.
struct EmitterPicture {
  int width = 0;
  int height = 0;
  std::vector<SpectrumId> emitters;
  std::vector<float> drives;  ///< height x width x emitters, top row first, never negative
};

struct Surface {
  std::uint32_t material = 0;  ///< index into Scene::materials
  std::optional<Emission> emission;
};

/// One-sided: it reflects and emits on the side its normal half_u x half_v points to; its back is black.
struct Rectangle {
  Vector3 center;
  Vector3 halfU;
  Vector3 halfV;
  Surface surface;
  std::optional<std::uint32_t> picture;  ///< index into Scene::pictures: an LED wall; u to the right, v up
};

struct Sphere {
  Vector3 center;
  double radius = 1;
  Surface surface;
};

struct Mesh {
  std::string file;
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from the side that reflects
  /// Texture coordinates of the corners of each triangle, until a texture takes them; none where the file lacks some.
  std::vector<std::array<std::array<float, 2>, 3>> corners;
  Surface surface;
  int dropped = 0;  ///< triangles of no area or with a coordinate that is no number, left out
};

struct EnvironmentLight {
  std::uint32_t picture = 0;  ///< latitude by longitude as OpenEXR has it: +y up, middle along +z, +x a quarter in
};
struct PointLight {
  Vector3 position;
  SpectrumId intensity = 0;  ///< W.sr^-1.nm^-1
};
struct SpotLight {
  Vector3 position;
  Vector3 direction;
  SpectrumId intensity = 0;  ///< W.sr^-1.nm^-1 along the direction
  double coneDegrees = 30;   ///< half angle where it ends
  double beamDegrees = 20;   ///< half angle up to which it is even; a smooth step between
};

struct Scene {
  explicit Scene(FilmSettings settings) : film(std::move(settings)) {}

  FilmSettings film;
  CameraSettings camera;
  IntegratorSettings integrator;
  std::vector<spectral::DomainSamples> spectra;
  /// The same at 300, 301, ... 379 nm: what fluorescence is excited by. A spectrum without has none.
  std::vector<UltravioletSamples> ultraviolet;
  std::vector<spectral::FluorescentSamples> fluorescences;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<EmitterPicture> pictures;
  std::vector<Rectangle> rectangles;
  std::vector<Sphere> spheres;
  std::vector<Mesh> meshes;
  std::vector<EnvironmentLight> environments;
  std::vector<PointLight> points;
  std::vector<SpotLight> spots;
  /// A spectrum at 300, 301, ... 780 nm.
  spectral::ExcitationSamples whole(SpectrumId id) const {
    spectral::ExcitationSamples samples = spectral::ExcitationSamples::Zero();
    if (id < ultraviolet.size()) {
      samples.head<spectral::kDomainInExcitation>() = ultraviolet[id];
    }
    samples.tail<spectral::kDomainSize>() = spectra[id];
    return samples;
  }

  /// Of all bytes the scene was read from: a checkpoint goes on with the same scene only.
  std::uint64_t fingerprint = 0;
  /// Findings that do not stop a render, one line each.
  std::vector<std::string> warnings;
};

}  // namespace metamer::spectral_ref
