// SPDX-License-Identifier: Apache-2.0
#include "fluorescence.h"

#include <cstddef>
#include <vector>

#include "library.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/fluorescence.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/text.h"
#include "run.h"

namespace metamer::lutgen {
namespace {

using spectral::ExcitationSamples;
using spectral::FluorescentSamples;
using spectral::formatted;

/// A light, and what the CIE 1931 observer makes of a surface in it.
class Judge {
 public:
  Judge(const spectral::DataLibrary& library, const std::string& light)
      : m_curves(library.observer("CIE 1931 2").onDomain()),
        m_light(spectral::onExcitation(library.illuminant(light))) {
    m_white = m_curves.transpose() * m_light.tail<spectral::kDomainSize>();
    if (!(m_white.minCoeff() > 0)) {
      throw spectral::InputError("--lights", "light", light,
                                 "leaves a channel of the eye dark: colours have no differences");
    }
    m_white /= m_white.y();
  }

  const ExcitationSamples& light() const { return m_light; }
  Eigen::Vector3d xyz(const FluorescentSamples& surface) const {
    return spectral::colourOf(surface, m_light, m_curves);
  }
  Eigen::Vector3d lab(const FluorescentSamples& surface) const { return spectral::lab(xyz(surface), m_white); }

  struct Peak {
    double factor = 0;
    int nm = 0;
  };
  /// Where the surface gives back most of what a perfect reflector does, among wavelengths with a hundredth of the
  /// light's mean or more.
  Peak brightest(const FluorescentSamples& surface) const {
    constexpr double kLit = 0.01;
    const ExcitationSamples back = surface.givenBack(m_light);
    Peak peak;
    for (int i = spectral::kDomainInExcitation; i < spectral::kExcitationSize; ++i) {
      if (m_light[i] > kLit * m_light.mean() && back[i] / m_light[i] > peak.factor) {
        peak = {back[i] / m_light[i], spectral::kExcitationStartNm + i};
      }
    }
    return peak;
  }

 private:
  Eigen::Matrix<double, spectral::kDomainSize, 3> m_curves;
  ExcitationSamples m_light;
  Eigen::Vector3d m_white;
};

std::string rangeText(const std::vector<double>& nm) {
  return formatted("%g to %g nm", nm.front(), nm.back());
}

void describe(const spectral::Reradiation& matrix) {
  words() << formatted("excitation %s, emission %s, every %g nm\n", rangeText(matrix.excitationNm()).c_str(),
                       rangeText(matrix.emissionNm()).c_str(), matrix.stepNm());
  note(matrix.notes());
}

void describe(const spectral::CompactFluorescence& surface) {
  words() << formatted("compact, %s, quantum yield %.3f\n", rangeText(surface.reflectance.wavelengthsNm()).c_str(),
                       surface.quantumYield);
}

}  // namespace

void showFluorescence(const std::string& file, const std::vector<std::string>& lights) {
  const auto library = openLibrary();
  const spectral::Fluorescence surface = spectral::readFluorescence(spectral::pathOf(file), library.pictures());
  std::visit([](const auto& one) { describe(one); }, surface);
  const FluorescentSamples samples = spectral::samplesOf(surface);
  for (const std::string& name : lights) {
    const Judge judge(library, name);
    const Eigen::Vector3d xyz = judge.xyz(samples);
    const Eigen::Vector2d xy = spectral::chromaticity(xyz);
    const Judge::Peak peak = judge.brightest(samples);
    words() << formatted("under %s: xy %.4f %.4f, Y %.3f, at most %.2f times a perfect reflector, at %d nm%s\n",
                         name.c_str(), xy.x(), xy.y(), xyz.y(), peak.factor, peak.nm,
                         peak.factor > 1 ? ": a reflectance cannot hold this" : "");
  }
  summarise(formatted("%s: of what arrives at a wavelength at most %.3f of the energy comes back, %.3f of the photons",
                      file.c_str(), samples.mostEnergy(), samples.mostPhotons()));
}

void fitFluorescence(const std::string& file, const std::string& output, const std::vector<std::string>& lights) {
  const auto library = openLibrary();
  const spectral::Fluorescence surface = spectral::readFluorescence(spectral::pathOf(file), library.pictures());
  const auto* matrix = std::get_if<spectral::Reradiation>(&surface);
  if (matrix == nullptr) {
    throw spectral::InputError(file, "form", "compact", "is what a fit makes; give a matrix");
  }
  note(matrix->notes());
  std::vector<Judge> judges;
  spectral::FitColours colours{library.observer("CIE 1931 2").onDomain(), {}};
  for (const std::string& name : lights) {
    colours.lights.push_back(judges.emplace_back(library, name).light());
  }
  const spectral::FluorescenceFit fit = spectral::fitFluorescence(*matrix, colours);
  const FluorescentSamples whole = spectral::samplesOf(*matrix);
  const FluorescentSamples compact = spectral::samplesOf(fit.surface);
  std::string differences;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    differences += formatted("%s%s %.3f", differences.empty() ? "" : ", ", lights[k].c_str(),
                             spectral::deltaE2000(judges[k].lab(whole), judges[k].lab(compact)));
  }
  spectral::writeWholeFile(spectral::pathOf(output), spectral::fluorescenceText(fit.surface));
  summarise(formatted("%s: quantum yield %.3f; %.1f %% of the re-radiation's rms is left; CIEDE2000 under %s",
                      output.c_str(), fit.surface.quantumYield, 100 * fit.residual, differences.c_str()));
}

}  // namespace metamer::lutgen
