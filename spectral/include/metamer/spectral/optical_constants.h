// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {

/// The two parts of a complex refractive index n + i k.
enum class OpticalConstant { Refraction, Extinction };

/// One part of a file of optical constants, wavelengths in nm, values as they stand (any size from 0 up: no percent),
/// end values holding outside. Read are
///   tables (.csv .txt ..., as readCsv) with columns, or blocks one below the other, that are called n and k; a single
///   curve serves for either, unless it is called the other;
///   .yml .yaml of refractiveindex.info with data "tabulated n", "tabulated k" or "tabulated nk".
/// Wavelengths are in the unit that a header states, else in micrometres where all are below 100, else in nm.
/// @throws InputError naming the file, field, value and remedy: the part is not there, or is a formula
Spectrum readOpticalConstant(const std::filesystem::path& file, OpticalConstant part);

/// The same of text. @param isYaml  refractiveindex.info's YAML, else a table
Spectrum opticalConstantFrom(const std::string& text, bool isYaml, const std::string& where, OpticalConstant part);

}  // namespace metamer::spectral
