// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "bake/bake_operators.h"

namespace metamer::ocio {

/// Of the time that a bake takes, about: what preparing the recipe and its judges takes.
inline constexpr double kPreparedShare = 0.1;

/// A recipe on its way into a file: what it was prepared to, what judges it, and the certificate that is to be.
class JudgedRecipe {
 public:
  /// The gamut and exposures to judge by, for pixels of a space.
  using Probes = std::function<sip::ErrorProtocol::Options(const WorkingSpace&)>;

  /// @param options  must outlive this
  JudgedRecipe(const sip::Recipe& recipe, const spectral::DataLibrary& library, const BakeOptions& options,
               const Probes& probes);

  /// Puts the error of a transform of the engine's pixels into the certificate.
  /// @throws spectral::InputError where it gives what is not a number: no certificate says that
  void certify(const std::function<void(std::span<float> rgba)>& candidate);

  /// Puts the error of a transform of the engine's pixels through a graphics card into the certificate, of textures of
  /// floats and of halves.
  void certifyOnCards(const std::function<void(std::span<float> rgba)>& floats,
                      const std::function<void(std::span<float> rgba)>& halves);

  /// Tells whoever waits how much of the work is done.
  void tell(double share) const {
    if (m_options.progress) {
      m_options.progress(share);
    }
  }

  const Prepared& prepared() const { return *m_prepared; }
  const sip::ErrorProtocol& protocol() const { return *m_protocol; }
  Certificate& certificate() { return m_certificate; }
  const Certificate& certificate() const { return m_certificate; }

 private:
  sip::ErrorProtocol::Options prepare(const sip::Recipe& recipe, const spectral::DataLibrary& library,
                                      const Probes& probes);

  const BakeOptions& m_options;
  std::optional<Prepared> m_prepared;
  std::optional<sip::ErrorProtocol> m_protocol;
  std::optional<PixelProtocol> m_pixels;
  Certificate m_certificate;
};

/// What a file says of itself.
LutDescription descriptionOf(const Certificate& certificate);

}  // namespace metamer::ocio
