// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "metamer/spectral_ref/film.h"

namespace metamer::spectral_ref {

/// What a picture file says beside its channels; two parts merge only where all of it is the same.
using FilmNotes = std::vector<std::pair<std::string, std::string>>;

/// "0:16 32:48".
std::string rangesText(const SampleRanges& ranges);

/// Writes a film as multichannel OpenEXR, float32:
///   R, G, B              colour in the film's space
///   Y                    luminance of the pixel
///   variance.Y           variance of the pixel's Y (of the estimate, not of one sample); NaN below two replicates
///   samples              paths a pixel has taken
///   replicate.N.Y        Y of each replicate alone, where `withReplicates`
///   S0.550,000000nm ...  mean spectral radiance of each bin, W.m^-2.sr^-1.nm^-1, in the layout of Fichet et al. 2021
/// @param withState  adds a second part, "state", that holds the exact sums: such files merge without loss
/// @throws spectral::InputError where it cannot be written (then nothing is left behind)
void writeExr(const Film& film, const FilmNotes& notes, const std::filesystem::path& file, bool withState,
              bool withReplicates);

/// A film and its notes from a file written with its state, checked by the sum that it carries.
/// @throws spectral::InputError: not such a file, a damaged one
std::pair<Film, FilmNotes> readExrState(const std::filesystem::path& file);

/// Adds up films of the same picture. @throws spectral::InputError where samples overlap or formats differ
/// @param where  what messages call the second
void mergeFilm(Film& film, const Film& other, const std::string& where);

}  // namespace metamer::spectral_ref
