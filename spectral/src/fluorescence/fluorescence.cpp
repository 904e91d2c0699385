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

double integralOf(const Spectrum& spectrum) {
  const std::vector<double>& nm = spectrum.wavelengthsNm();
  double sum = 0;
  for (std::size_t i = 0; i + 1 < nm.size(); ++i) {
    sum += 0.5 * (nm[i + 1] - nm[i]) * (spectrum.values()[i] + spectrum.values()[i + 1]);
  }
  return sum;
}

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

/// Alternating least squares, factors(o, i) = emission(o) excitation(i) over the shifted entries. Sums of what is not
/// negative are not negative.
struct RankOne {
  Eigen::VectorXd emission;
  Eigen::VectorXd excitation;
};

RankOne rankOneOf(const Eigen::MatrixXd& shifted, const Eigen::MatrixXd& isShifted) {
  constexpr int kMostRounds = 2000;
  constexpr double kSettled = 1e-12;
  RankOne fit{Eigen::VectorXd::Zero(shifted.rows()), shifted.colwise().sum().transpose()};
  double before = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    const auto over = [](const Eigen::VectorXd& sum, const Eigen::VectorXd& weight) {
      return (weight.array() > 0).select(sum.array() / weight.array(), 0.0).matrix();
    };
    fit.emission = over(shifted * fit.excitation, isShifted * fit.excitation.cwiseAbs2());
    fit.excitation = over(shifted.transpose() * fit.emission, isShifted.transpose() * fit.emission.cwiseAbs2());
    const double left = (shifted - (fit.emission * fit.excitation.transpose()).cwiseProduct(isShifted)).squaredNorm();
    if (std::abs(before - left) <= kSettled * shifted.squaredNorm()) {
      break;
    }
    before = left;
  }
  return fit;
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

FluorescenceFit fitFluorescence(const Reradiation& matrix) {
  Eigen::MatrixXd isShifted = Eigen::MatrixXd::Zero(matrix.factors().rows(), matrix.factors().cols());
  for (Eigen::Index o = 0; o < isShifted.rows(); ++o) {
    for (Eigen::Index i = 0; i < isShifted.cols(); ++i) {
      isShifted(o, i) = matrix.isShifted(o, i) ? 1.0 : 0.0;
    }
  }
  const Eigen::MatrixXd shifted = matrix.factors().cwiseProduct(isShifted);
  RankOne fit = rankOneOf(shifted, isShifted);

  // From energy to photons: u(o) v(i) = step y(i) e(o) i / o, with y the photons given off for each that arrives.
  const std::vector<double> nm = unionOf({&matrix.excitationNm(), &matrix.emissionNm()});
  const FluorescentSamples whole = samplesOf(matrix);
  std::vector<double> reflectance;
  std::vector<double> photonsGiven(nm.size(), 0.0);
  std::vector<double> emission(nm.size(), 0.0);
  for (std::size_t k = 0; k < nm.size(); ++k) {
    const int cell = std::clamp(static_cast<int>(std::lround(nm[k])) - kExcitationStartNm, 0, kExcitationSize - 1);
    reflectance.push_back(whole.reflectance[cell]);
  }
  const auto placeOf = [&nm](double wanted) {
    return static_cast<std::size_t>(std::lower_bound(nm.begin(), nm.end(), wanted) - nm.begin());
  };
  for (std::size_t o = 0; o < matrix.emissionNm().size(); ++o) {
    emission[placeOf(matrix.emissionNm()[o])] = fit.emission[static_cast<Eigen::Index>(o)] * matrix.emissionNm()[o];
  }
  const double photons = integralOf({matrix.name(), SpectralQuantity::Sensitivity, nm, emission});
  for (double& value : emission) {
    value /= photons > 0 ? photons : 1.0;
  }
  double mostGiven = 0;
  for (std::size_t i = 0; i < matrix.excitationNm().size(); ++i) {
    const double given =
        fit.excitation[static_cast<Eigen::Index>(i)] * photons / (matrix.stepNm() * matrix.excitationNm()[i]);
    photonsGiven[placeOf(matrix.excitationNm()[i])] = given;
    mostGiven = std::max(mostGiven, given);
  }
  // Where little is given off its ratio to what is not reflected is noise.
  constexpr double kCounts = 0.1;
  double quantumYield = 0;
  for (std::size_t k = 0; k < nm.size(); ++k) {
    if (photonsGiven[k] > kCounts * mostGiven) {
      quantumYield = std::max(quantumYield, photonsGiven[k] / std::max(1.0 - reflectance[k], kRounding));
    }
  }
  quantumYield = std::min(quantumYield, 1.0);
  std::vector<double> excitation(nm.size(), 0.0);
  for (std::size_t k = 0; k < nm.size(); ++k) {
    excitation[k] = quantumYield > 0 ? std::min(photonsGiven[k] / quantumYield, 1.0 - reflectance[k]) : 0.0;
  }

  double squares = 0;
  for (Eigen::Index o = 0; o < shifted.rows(); ++o) {
    for (Eigen::Index i = 0; i < shifted.cols(); ++i) {
      const double from = matrix.excitationNm()[static_cast<std::size_t>(i)];
      const double to = matrix.emissionNm()[static_cast<std::size_t>(o)];
      const double model =
          matrix.stepNm() * quantumYield * excitation[placeOf(from)] * emission[placeOf(to)] * from / to;
      const double left = shifted(o, i) - isShifted(o, i) * model;
      squares += left * left;
    }
  }
  const double size = shifted.norm();
  return {{matrix.name(),
           {matrix.name(), SpectralQuantity::Reflectance, nm, reflectance},
           {matrix.name(), SpectralQuantity::Sensitivity, nm, excitation},
           {matrix.name(), SpectralQuantity::Sensitivity, nm, emission},
           quantumYield},
          size > 0 ? std::sqrt(squares) / size : 0.0};
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
