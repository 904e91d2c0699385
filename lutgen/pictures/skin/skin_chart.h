// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "metamer/skin/skin_colours.h"

namespace metamer::lutgen {

/// Skins side by side, each with its spectrum and its colour in a view.
struct SkinChart {
  int columns = 1;
  std::vector<skin::SkinParameters> skins;  ///< row by row; the last row may be short
  std::vector<skin::SkinSpectrum> spectra;
  std::vector<Eigen::Vector3d> rgb;  ///< linear

  int rows() const { return (static_cast<int>(skins.size()) + columns - 1) / columns; }
};

/// Draws from the prior, in a chart about half as wide again as high.
std::vector<skin::SkinParameters> drawnSkins(const skin::SkinPrior& prior, int count, std::uint32_t seed, int& columns);
/// Melanin along the rows and blood down them, evenly as they act on colour, over 2.5 of the prior's deviations either
/// way; the rest is the mean skin's.
std::vector<skin::SkinParameters> griddedSkins(const skin::SkinPrior& prior, int columns, int rows);

SkinChart skinChart(const skin::SkinColours& colours, std::vector<skin::SkinParameters> skins, int columns);

/// Reflectances as a table, a column a skin: what --reflectances and the like read.
std::string skinSpectraCsv(const SkinChart& chart);
/// Colours, L*a*b* of the space's white, and parameters, a row a skin.
std::string skinColoursCsv(const SkinChart& chart, const spectral::RgbSpace& space);

/// Writes the chart as a picture of squares, whole or not at all.
/// @param isSpectral  a channel a band beside the colours, in the layout of Fichet et al. 2021 ("T.550,000000nm")
/// @throws spectral::InputError
void writeSkinChart(const SkinChart& chart, const spectral::RgbSpace& space, int patchPixels, bool isSpectral,
                    const std::filesystem::path& file);

}  // namespace metamer::lutgen
