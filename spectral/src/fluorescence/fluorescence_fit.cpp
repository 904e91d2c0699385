// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "fluorescence/fluorescent_samples.h"
#include "fluorescence/rank_one.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/fluorescence.h"

namespace metamer::spectral {
namespace {

constexpr double kRounding = 1e-6;
/// How much errors that colours do not show count beside those that they do, one after another.
constexpr std::array<double, 6> kUnseen = {0.3, 0.1, 0.03, 0.01, 0.003, 0.001};
/// What is left of the re-radiation's rms, for a likeness to be more than that.
constexpr double kMostLeft = 0.5;

ShiftedFactors shiftedOf(const Reradiation& matrix) {
  ShiftedFactors shifted{matrix.factors(), Eigen::MatrixXd::Zero(matrix.factors().rows(), matrix.factors().cols())};
  for (Eigen::Index o = 0; o < shifted.is.rows(); ++o) {
    for (Eigen::Index i = 0; i < shifted.is.cols(); ++i) {
      shifted.is(o, i) = matrix.isShifted(o, i) ? 1.0 : 0.0;
    }
  }
  shifted.factors = shifted.factors.cwiseProduct(shifted.is).eval();
  return shifted;
}

/// All wavelengths of a matrix, each once.
std::vector<double> wavelengthsOf(const Reradiation& matrix) {
  std::set<double> nm(matrix.excitationNm().begin(), matrix.excitationNm().end());
  nm.insert(matrix.emissionNm().begin(), matrix.emissionNm().end());
  return {nm.begin(), nm.end()};
}

int cellOf(double nm) {
  return std::clamp(static_cast<int>(std::lround(nm)) - kExcitationStartNm, 0, kExcitationSize - 1);
}

/// Re-radiation by bands begins with the next band, that of the compact form with the next wavelength: what it gives
/// there beyond the matrix, the reflectance gives up.
void giveUpBesideDiagonal(const FluorescentSamples& whole, double stepNm, CompactFluorescence& surface) {
  const Eigen::MatrixXd more = samplesOf(surface).perNm - whole.perNm;
  const int near = static_cast<int>(std::lround(1.5 * stepNm));
  const int half = static_cast<int>(stepNm / 2);
  std::vector<double> reflectance = surface.reflectance.values();
  for (std::size_t k = 0; k < reflectance.size(); ++k) {
    const int middle = cellOf(surface.reflectance.wavelengthsNm()[k]);
    const int first = std::max(middle - half, 0);
    const int last = std::min(middle + half, kExcitationSize - 1);
    double sum = 0;
    for (int o = first; o <= last; ++o) {
      const int from = std::max(o - near, 0);
      sum += more.row(o).segment(from, o - from).sum();
    }
    const double most = std::max(1.0 - surface.excitation.values()[k], 0.0);
    reflectance[k] = std::clamp(reflectance[k] - sum / (last - first + 1), 0.0, most);
  }
  surface.reflectance = {surface.name, SpectralQuantity::Reflectance, surface.reflectance.wavelengthsNm(), reflectance};
}

/// @param whole  samples of the matrix
FluorescenceFit compactOf(const Reradiation& matrix, const FluorescentSamples& whole, const ShiftedFactors& shifted,
                          const RankOne& fit) {
  // From energy to photons: u(o) v(i) = step y(i) e(o) i / o, with y the photons given off for each that arrives.
  const std::vector<double> nm = wavelengthsOf(matrix);
  std::vector<double> reflectance;
  std::vector<double> photonsGiven(nm.size(), 0.0);
  std::vector<double> emission(nm.size(), 0.0);
  for (std::size_t k = 0; k < nm.size(); ++k) {
    reflectance.push_back(whole.reflectance[cellOf(nm[k])]);
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
  for (Eigen::Index o = 0; o < shifted.factors.rows(); ++o) {
    for (Eigen::Index i = 0; i < shifted.factors.cols(); ++i) {
      const double from = matrix.excitationNm()[static_cast<std::size_t>(i)];
      const double to = matrix.emissionNm()[static_cast<std::size_t>(o)];
      const double model =
          matrix.stepNm() * quantumYield * excitation[placeOf(from)] * emission[placeOf(to)] * from / to;
      const double left = shifted.factors(o, i) - shifted.is(o, i) * model;
      squares += left * left;
    }
  }
  const double size = shifted.factors.norm();
  FluorescenceFit found{{matrix.name(),
                         {matrix.name(), SpectralQuantity::Reflectance, nm, reflectance},
                         {matrix.name(), SpectralQuantity::Sensitivity, nm, excitation},
                         {matrix.name(), SpectralQuantity::Sensitivity, nm, emission},
                         quantumYield},
                        size > 0 ? std::sqrt(squares) / size : 0.0};
  giveUpBesideDiagonal(whole, matrix.stepNm(), found.surface);
  return found;
}

/// Of a fit from a matrix: CIEDE2000 under the light where it is largest.
double largestDifference(const FluorescentSamples& one, const FluorescentSamples& other, const FitColours& colours) {
  double largest = 0;
  for (const ExcitationSamples& light : colours.lights) {
    const Eigen::Vector3d white = colours.curves.transpose() * light.tail<kDomainSize>();
    const auto labOf = [&](const FluorescentSamples& surface) {
      return lab(colourOf(surface, light, colours.curves), white / white.y());
    };
    largest = std::max(largest, deltaE2000(labOf(one), labOf(other)));
  }
  return largest;
}

PhotonBounds boundsOf(const Reradiation& matrix, const ExcitationSamples& reflectance) {
  PhotonBounds bounds{matrix.stepNm(),
                      Eigen::Map<const Eigen::VectorXd>(matrix.emissionNm().data(),
                                                        static_cast<Eigen::Index>(matrix.emissionNm().size())) *
                          matrix.stepNm(),
                      Eigen::VectorXd(matrix.excitationNm().size())};
  for (std::size_t i = 0; i < matrix.excitationNm().size(); ++i) {
    const double nm = matrix.excitationNm()[i];
    bounds.excitation[static_cast<Eigen::Index>(i)] = matrix.stepNm() * nm * (1.0 - reflectance[cellOf(nm)]);
  }
  return bounds;
}

/// The observer's curves at a matrix's bands of emission, the largest of one length.
Eigen::MatrixX3d curvesAt(const std::vector<double>& emissionNm, const FitColours& colours) {
  Eigen::MatrixX3d curves = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(emissionNm.size()), 3);
  for (Eigen::Index o = 0; o < curves.rows(); ++o) {
    const auto cell = std::lround(emissionNm[static_cast<std::size_t>(o)]) - kDomainStartNm;
    if (cell >= 0 && cell < kDomainSize) {
      curves.row(o) = colours.curves.row(cell);
    }
  }
  return curves / curves.rowwise().norm().maxCoeff();
}

}  // namespace

FluorescenceFit fitFluorescence(const Reradiation& matrix) {
  const ShiftedFactors shifted = shiftedOf(matrix);
  return compactOf(matrix, samplesOf(matrix), shifted, nearestRankOne(shifted));
}

FluorescenceFit fitFluorescence(const Reradiation& matrix, const FitColours& colours) {
  const ShiftedFactors shifted = shiftedOf(matrix);
  const FluorescentSamples whole = samplesOf(matrix);
  RankOne rankOne = nearestRankOne(shifted);
  FluorescenceFit best = compactOf(matrix, whole, shifted, rankOne);
  double least = largestDifference(samplesOf(best.surface), whole, colours);
  const PhotonBounds bounds = boundsOf(matrix, whole.reflectance);
  const Eigen::MatrixX3d curves = curvesAt(matrix.emissionNm(), colours);
  for (const double unseen : kUnseen) {
    if (least <= colours.mostDifference) {
      break;
    }
    rankOne = nearestAsSeen(shifted, rankOne, bounds, curves, unseen);
    FluorescenceFit fit = compactOf(matrix, whole, shifted, rankOne);
    const double difference = largestDifference(samplesOf(fit.surface), whole, colours);
    if (difference < least && fit.residual <= std::max(kMostLeft, best.residual)) {
      least = difference;
      best = std::move(fit);
    }
  }
  return best;
}

}  // namespace metamer::spectral
