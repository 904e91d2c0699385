// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/fluorescence.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "fluorescence/fluorescent_samples.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr double kRounding = 1e-6;

void checkCurves(const CompactFluorescence& surface) {
  if (!(surface.quantumYield >= 0 && surface.quantumYield <= 1)) {
    throw InputError(surface.name, "quantum yield", numberText(surface.quantumYield),
                     "must be from 0 to 1: no dye gives off more photons than it takes");
  }
  const auto check = [&](const char* what, const Spectrum& spectrum, double most) {
    for (std::size_t i = 0; i < spectrum.values().size(); ++i) {
      const double value = spectrum.values()[i];
      if (value < 0 || value > most) {
        throw InputError(surface.name, what + (" at " + numberText(spectrum.wavelengthsNm()[i])) + " nm",
                         numberText(value),
                         value < 0 ? "must not be negative" : "must be at most 1: it is a share of what arrives");
      }
    }
  };
  check("reflectance", surface.reflectance, 1.0);
  check("excitation", surface.excitation, 1.0);
  check("emission", surface.emission, HUGE_VAL);
}

/// All wavelengths of some spectra, each once.
std::vector<double> unionOf(std::initializer_list<const std::vector<double>*> tables) {
  std::set<double> nm;
  for (const std::vector<double>* table : tables) {
    nm.insert(table->begin(), table->end());
  }
  return {nm.begin(), nm.end()};
}

}  // namespace

FluorescentSamples samplesOf(const CompactFluorescence& surface) {
  checkCurves(surface);
  FluorescentSamples samples;
  samples.reflectance = onExcitation(surface.reflectance);
  const ExcitationSamples taken = onExcitation(surface.excitation);
  const double photons = integralOf(surface.emission);
  if (!(photons > 0) && taken.maxCoeff() > 0 && surface.quantumYield > 0) {
    throw InputError(surface.name, "emission", "0", "is zero everywhere, though something excites it");
  }
  const ExcitationSamples given = onExcitation(surface.emission) / std::max(photons, 1e-300);
  for (int i = 0; i < kExcitationSize; ++i) {
    const double nm = kExcitationStartNm + i;
    if (samples.reflectance[i] + taken[i] > 1 + kRounding && nm >= surface.reflectance.wavelengthsNm().front() &&
        nm <= surface.reflectance.wavelengthsNm().back()) {
      throw InputError(surface.name, "at " + numberText(nm) + " nm", numberText(samples.reflectance[i] + taken[i]),
                       "is reflectance and excitation together; no surface reflects and takes more than 1");
    }
    for (int o = i + 1; o < kExcitationSize; ++o) {
      samples.perNm(o, i) = surface.quantumYield * taken[i] * given[o] * nm / (kExcitationStartNm + o);
    }
  }
  keepBalance(samples);
  return samples;
}

FluorescentSamples samplesOf(const Fluorescence& surface) {
  return std::visit([](const auto& one) { return samplesOf(one); }, surface);
}

std::string fluorescenceText(const CompactFluorescence& surface) {
  std::string text =
      "quantum_yield," + formatted("%.7g", surface.quantumYield) + "\nwavelength_nm,reflectance,excitation,emission\n";
  for (const double nm : unionOf({&surface.reflectance.wavelengthsNm(), &surface.excitation.wavelengthsNm(),
                                  &surface.emission.wavelengthsNm()})) {
    text += formatted("%.10g,%.7g,%.7g,%.7g\n", nm, surface.reflectance.at(nm), surface.excitation.at(nm),
                      surface.emission.at(nm));
  }
  return text;
}

}  // namespace metamer::spectral
