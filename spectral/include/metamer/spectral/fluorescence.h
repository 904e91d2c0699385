// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "metamer/spectral/reradiation.h"
#include "metamer/spectral/spectral_picture.h"

/// Fluorescent surfaces in three curves and a number, and the files of both forms.
namespace metamer::spectral {

/// A re-radiation of rank one: P(i, o) = quantumYield x(i) e(o) i / o for o > i, else 0.
struct CompactFluorescence {
  std::string name;
  Spectrum reflectance;  ///< SpectralQuantity::Reflectance
  /// x: share of arriving photons that the dye takes, 0 ... 1; with the reflectance at most 1. Zero outside its table
  /// (SpectralQuantity::Sensitivity), as the emission.
  Spectrum excitation;
  Spectrum emission;        ///< e: photons per nm on any scale; its integral counts as 1
  double quantumYield = 0;  ///< photons given off for each taken, 0 ... 1
};

/// @throws InputError: quantum yield or excitation outside 0 ... 1, a negative value, no emission for an excitation,
/// reflectance and excitation that add up to more than 1 within the reflectance's table (outside it is lowered)
FluorescentSamples samplesOf(const CompactFluorescence& surface);

/// The compact form nearest to a matrix: least squares over its re-radiation, alternately in excitation and emission,
/// none negative.
///
/// A matrix does not tell what the dye takes without giving back: the quantum yield is the least for which nothing is
/// taken that was reflected, its photons given off over 1 - reflectance where that is largest.
struct FluorescenceFit {
  CompactFluorescence surface;
  double residual = 0;  ///< rms of what is left of the re-radiation over its rms, by band; 0 without any
};
FluorescenceFit fitFluorescence(const Reradiation& matrix);

/// How a fit is to look.
struct FitColours {
  Eigen::Matrix<double, kDomainSize, 3> curves;  ///< of an observer
  std::vector<ExcitationSamples> lights;         ///< each seen by all three curves
  double mostDifference = 0.5;                   ///< CIEDE2000 from the matrix under the light where it is largest
};

/// The compact form nearest to a matrix among those that look like it. Where the nearest of all differs by more, errors
/// of emission and of excitation that colours do not show are counted for less and less, until what is left of the
/// others is small enough; where that is nowhere, the one that looks most like it.
FluorescenceFit fitFluorescence(const Reradiation& matrix, const FitColours& colours);

using Fluorescence = std::variant<Reradiation, CompactFluorescence>;
FluorescentSamples samplesOf(const Fluorescence& surface);

/// Reads a file by its extension, or FILE:x,y of a picture:
///   .csv .txt .tsv  a matrix: a header row of excitations behind one cell of any text, then rows of an emission and
///   its
///                   factors (see Reradiation); or the compact form, see fluorescenceText(). Wavelengths in nm
///   .bfc            Labsphere's BFC-450: the same behind a line of six whole numbers, up to EOD
///   .exr            JCGT 2021: T.380,000000nm.400,000000nm from 380 to 400 nm, T.400,000000nm the diagonal; a pixel or
///                   the mean
/// @param pictures  reads .exr; without it they are refused
/// @throws InputError: what Reradiation and samplesOf() refuse, an empty or missing cell or channel, no number
Fluorescence readFluorescence(const std::filesystem::path& file, const PictureChannelReader& pictures = {});

/// The readers on text already in memory (`where` is what messages call it).
Fluorescence readFluorescenceTable(const std::string& text, const std::string& where);
Reradiation readBfc(const std::string& text, const std::string& where);

/// CSV: `quantum_yield,0.8`, then `wavelength_nm,reflectance,excitation,emission` and a row a wavelength of any of the
/// three.
std::string fluorescenceText(const CompactFluorescence& surface);

/// Excitation and emission of a channel's name, nm; empty: another channel.
std::optional<std::pair<double, double>> channelPairNm(const std::string& channel);

}  // namespace metamer::spectral
