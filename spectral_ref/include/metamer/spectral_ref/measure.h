// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace metamer::spectral_ref {

/// A part of a picture, in pixels from the top left.
struct PatchArea {
  std::string name;
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
};

/// Means over a patch.
struct PatchMean {
  PatchArea area;
  std::array<double, 3> colour{};  ///< R, G, B of the film's space
  double luminance = 0;            ///< Y
  double variance = 0;             ///< of the mean luminance
  double degrees = 0;              ///< of freedom of the variance
  double halfWidth = 0;            ///< of the 95 % interval of Y, by Student's t
  std::vector<double> bins;        ///< spectral radiance
};

struct Measurement {
  std::vector<double> wavelengthsNm;  ///< of the bins
  std::vector<PatchMean> patches;
};

/// Patch means of a rendered picture with 95 % intervals. Where the file holds replicates (ReSTIR: pixels depend on
/// each other), the interval comes from their spread, else from the pixels' variances.
/// @throws spectral::InputError: no such picture, a patch outside it, no variance
Measurement measure(const std::filesystem::path& file, const std::vector<PatchArea>& areas);

/// The quantile of Student's t distribution at which a share `p` (0.5 ... 1) lies below. @param degrees  at least 1
double studentQuantile(double p, double degrees);

}  // namespace metamer::spectral_ref
