// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <string>

#include "metamer/skin/skin_view.h"
#include "metamer/spectral/data_library.h"

namespace metamer::lutgen {

/// How an albedo was captured. Empty: what the maps say, or daylight and the CIE's observer.
struct SkinCapture {
  std::string illuminant;
  std::string observer;

  /// Names where there are none.
  SkinCapture orElse(const SkinCapture& other) const;
  std::string text() const { return illuminant + ", " + observer; }
};

inline const SkinCapture kUsualCapture{"D65", "CIE 1931 2"};

/// --illuminant, --observer. @param without  what is taken where they are left out, for the help
void addSkinCapture(CLI::App& command, SkinCapture& capture, const std::string& without);

/// The view of a capture whose pixels are linear RGB of a space. A camera without a matrix of its own gets that of its
/// light.
/// @throws spectral::InputError
skin::SkinView skinView(const SkinCapture& capture, const spectral::RgbSpace& space,
                        const spectral::DataLibrary& library);

/// A thread count as the skin library takes it. @param threads  0: as many as the machine has
int skinThreads(int threads);

}  // namespace metamer::lutgen
