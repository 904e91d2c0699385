// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral_ref/checkpoint.h"
#include "metamer/spectral_ref/film.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

/// Samples after which resampling starts anew, so that a sample depends on few before it: ranges that begin at
/// multiples of it render nothing twice.
inline constexpr std::uint64_t kSamplesTogether = 16;

/// How direct light at the first surface is sampled.
enum class Restir {
  Off,    ///< next-event estimation alone
  Hero,   ///< reservoirs with the target of the hero wavelength (4.15)
  Lanes,  ///< reservoirs with a target summed over all lanes
};

/// What next-event estimation chooses a light by, where reservoirs do not.
enum class LightRule {
  Place,  ///< what lights may give at a point; in scenes of few lights, their power
  Power,  ///< their power alone: what the other is measured against
};

/// What, besides the scene, decides every bit of a picture. The number of threads does not.
struct RenderOptions {
  std::uint32_t seed = 0;
  bool guiding = false;
  Restir restir = Restir::Off;
  LightRule lightRule = LightRule::Place;
  bool operator==(const RenderOptions&) const = default;
};

/// What guiding has learnt about a pixel.
struct WavelengthDensity {
  spectral::DomainSamples density;  ///< that wavelengths are drawn from, per nm
  /// Share of 380 +- 0.5 ... 399 +- 0.5, 400 +- 0.5 ... nm (20 nm each, the last one 21) in |y(lambda)| F(lambda).
  std::vector<double> histogram;
  bool isOwn = false;  ///< whether the density is the pixel's own, not the picture's
};

/// Renders a scene progressively into a film.
class Renderer {
 public:
  /// @param scene    stays alive as long as the renderer
  /// @param firstSample  of the film; resampling takes earlier ones as well, to fill its reservoirs
  /// @param threads  0: as many as there are
  /// @throws std::runtime_error where Embree cannot take the scene
  Renderer(const Scene& scene, const RenderOptions& options, std::uint64_t firstSample = 0, int threads = 0);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Takes samples up to `end`, but stops after about `seconds` at the earliest boundary between passes.
  /// How the work is cut into calls changes no bit of the film.
  void render(std::uint64_t end, double seconds);
  /// The first sample not taken yet.
  std::uint64_t nextSample() const;

  const Film& film() const;

  /// What was learnt about a pixel's wavelengths; none without guiding or before the first render().
  std::optional<WavelengthDensity> wavelengthDensity(int x, int y) const;

  /// All state as bytes, piece by piece: it may be a gigabyte. restore() goes on from there, bit by bit.
  void writeState(const ByteSink& sink) const;
  /// @throws spectral::InputError where the bytes are not of this scene and these options; where they end early, the
  ///         renderer is of no more use
  /// @param where  what messages call the bytes
  void restore(const ByteSource& state, const std::string& where);

 private:
  struct State;
  std::unique_ptr<State> m_state;
};

}  // namespace metamer::spectral_ref
