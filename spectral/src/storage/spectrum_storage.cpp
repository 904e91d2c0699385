// SPDX-License-Identifier: Apache-2.0
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/storage.h"
#include "metamer/spectral/text.h"
#include "storage/line_search.h"
#include "storage/moments.h"

namespace metamer::spectral {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kHatFloor = 0.3;
constexpr double kCosineFloor = 1.0;
constexpr double kLeastImportance = 0.01;
/// Cosines that smooth surfaces are made of, and how fast they matter less: order j counts (1 + j)^-1.5.
constexpr int kSurfaceCosines = 24;
constexpr double kSurfaceDecay = 1.5;
/// What sees all wavelengths alike, beside the observer's curves with peaks from 1 to 1.8: power that the eye hardly
/// sees is kept too.
constexpr double kEvenSight = 0.1;
/// Of Moments: a signal that touches its bounds has no other of the same moments, and the equations no solution.
constexpr double kInside = 1e-4;
constexpr double kLargestCode = 255;

/// 0 ... 1 along the domain, faster where density is larger.
DomainSamples cumulated(const DomainSamples& density) {
  DomainSamples axis;
  axis[0] = 0;
  for (Index k = 1; k < kDomainSize; ++k) {
    axis[k] = axis[k - 1] + 0.5 * (density[k - 1] + density[k]);
  }
  return axis / axis[kDomainSize - 1];
}

[[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& remedy) {
  throw InputError("storage", field, value, remedy);
}

const std::string& nameOf(StorageForm form) {
  return storageFormNames()[static_cast<std::size_t>(form)];
}

void check(const DomainSamples& samples, SpectralQuantity quantity, StorageForm form) {
  if (quantity == SpectralQuantity::Sensitivity) {
    refuse("quantity", "sensitivity", "is not stored; give a light, a reflectance or a transmittance");
  }
  if (!samples.allFinite() || samples.minCoeff() < 0) {
    refuse("samples", std::to_string(samples.minCoeff()), "must be finite, and 0 or more");
  }
  const bool isLight = quantity == SpectralQuantity::SpectralPowerDistribution;
  if (isLight && form == StorageForm::Bytes) {
    refuse("form", "bytes", "hold reflectances; lights take lines, hats, cosines, moments or points");
  }
  if (!isLight && form == StorageForm::Lines) {
    refuse("form", "lines", "hold lights; reflectances take cosines, hats, bytes, moments or points");
  }
  if (!isLight && (form == StorageForm::Bytes || form == StorageForm::Moments) && samples.maxCoeff() > 1) {
    refuse("samples", std::to_string(samples.maxCoeff()),
           nameOf(form) + " hold what is at most 1; store it as hats or cosines");
  }
}

std::vector<float> floats(const VectorXd& values) {
  const Eigen::VectorXf rounded = values.cast<float>();
  return {rounded.begin(), rounded.end()};
}

VectorXd evenly(int count) {
  return VectorXd::LinSpaced(count, 0, 1);
}

}  // namespace

const std::vector<std::string>& storageFormNames() {
  static const std::vector<std::string> names = {"points", "hats", "bytes", "cosines", "moments", "lines"};
  return names;
}

StorageForm storageFormNamed(const std::string& name) {
  const std::vector<std::string>& names = storageFormNames();
  const auto found = std::find(names.begin(), names.end(), lowerCase(trimmed(name)));
  if (found == names.end()) {
    throw InputError("", "form", name, "must be one of: " + joined(names));
  }
  return static_cast<StorageForm>(found - names.begin());
}

SpectrumStorage::SpectrumStorage(const DataLibrary& library) {
  const auto curves = library.observer("CIE 1931 2").onDomain();
  DomainSamples root = curves.rowwise().norm();
  root /= root.maxCoeff();
  m_importance = root.array() + kLeastImportance;
  m_hatAxis = cumulated(root.array() + kHatFloor);
  m_cosineAxis = cumulated(root.array() + kCosineFloor);
  const Columns surfaces = cosines(kSurfaceCosines);
  Columns sights(kDomainSize, 4);
  sights << curves, DomainSamples::Constant(kEvenSight);
  m_seen.resize(sights.cols() * kSurfaceCosines, kDomainSize);
  for (Index sight = 0; sight < sights.cols(); ++sight) {
    for (Index j = 0; j < kSurfaceCosines; ++j) {
      m_seen.row(sight * kSurfaceCosines + j) =
          std::pow(1.0 + static_cast<double>(j), -kSurfaceDecay) * sights.col(sight).cwiseProduct(surfaces.col(j));
    }
  }
}

SpectrumStorage::Columns SpectrumStorage::hats(int count) const {
  // Nodes in samples of the domain.
  VectorXd nodes(count);
  Index before = 0;
  for (Index node = 0; node < count; ++node) {
    const double place = static_cast<double>(node) / (count - 1);
    while (before + 2 < kDomainSize && m_hatAxis[before + 1] < place) {
      ++before;
    }
    nodes[node] =
        static_cast<double>(before) + (place - m_hatAxis[before]) / (m_hatAxis[before + 1] - m_hatAxis[before]);
  }
  nodes[count - 1] = kDomainSize - 1;
  Columns basis = Columns::Zero(kDomainSize, count);
  Index node = 0;
  for (Index k = 0; k < kDomainSize; ++k) {
    while (node + 2 < count && nodes[node + 1] < static_cast<double>(k)) {
      ++node;
    }
    const double share = (static_cast<double>(k) - nodes[node]) / (nodes[node + 1] - nodes[node]);
    basis(k, node) = 1 - share;
    basis(k, node + 1) = share;
  }
  return basis;
}

SpectrumStorage::Columns SpectrumStorage::cosines(int count) const {
  Columns basis(kDomainSize, count);
  for (Index j = 0; j < count; ++j) {
    basis.col(j) = (std::numbers::pi * static_cast<double>(j) * m_cosineAxis.array()).cos();
  }
  return basis;
}

VectorXd SpectrumStorage::fitted(const Columns& basis, const DomainSamples& samples, bool isLight) const {
  if (isLight) {
    return (m_seen * basis).completeOrthogonalDecomposition().solve(m_seen * samples);
  }
  const DomainSamples root = m_importance.cwiseSqrt();
  return (root.asDiagonal() * basis).colPivHouseholderQr().solve(root.cwiseProduct(samples));
}

/// Rounded one after another from the ends inward, the rest fitted anew each time: it takes up what rounding leaves.
std::vector<float> SpectrumStorage::bytesOf(const DomainSamples& samples, int count) const {
  const DomainSamples root = m_importance.cwiseSqrt();
  const Eigen::MatrixXd basis = root.asDiagonal() * hats(count);
  VectorXd rest = root.cwiseProduct(samples);
  std::vector<Index> open(static_cast<std::size_t>(count));
  std::iota(open.begin(), open.end(), Index{0});
  std::stable_sort(open.begin(), open.end(),
                   [count](Index a, Index b) { return std::abs(2 * a - (count - 1)) > std::abs(2 * b - (count - 1)); });
  std::vector<float> codes(static_cast<std::size_t>(count));
  while (!open.empty()) {
    const VectorXd values = Eigen::MatrixXd(basis(Eigen::all, open)).colPivHouseholderQr().solve(rest);
    const double code = std::round(kLargestCode * std::sqrt(std::clamp(values[0], 0.0, 1.0)));
    codes[static_cast<std::size_t>(open[0])] = static_cast<float>(code);
    rest -= std::pow(code / kLargestCode, 2) * basis.col(open[0]);
    open.erase(open.begin());
  }
  return codes;
}

StoredSpectrum SpectrumStorage::withLines(const DomainSamples& samples, int count) const {
  const VectorXd target = m_seen * samples;
  HatsAndLines best;
  bool isFirst = true;
  for (int lines = 0; 2 * lines <= count; ++lines) {
    const int hatCount = count - 2 * lines;
    if (hatCount == 1) {
      continue;
    }
    const Eigen::MatrixXd seenHats =
        hatCount > 0 ? Eigen::MatrixXd(m_seen * hats(hatCount)) : Eigen::MatrixXd(m_seen.rows(), 0);
    HatsAndLines fit = fitLines(seenHats, m_seen, target, lines);
    if (isFirst || fit.residual < best.residual) {
      best = std::move(fit);
      isFirst = false;
    }
  }
  StoredSpectrum stored{StorageForm::Lines, true, 0, floats(best.hats)};
  for (std::size_t k = 0; k < best.lines.size(); ++k) {
    if (best.powers[static_cast<Index>(k)] == 0 && best.hats.size() >= kFewestStored) {
      continue;  // found no use
    }
    ++stored.lines;
    stored.numbers.push_back(static_cast<float>(kDomainStartNm + best.lines[k]));
    stored.numbers.push_back(static_cast<float>(best.powers[static_cast<Index>(k)]));
  }
  return stored;
}

HatBasis SpectrumStorage::hatBasis(int count) const {
  requireWithin("count", count, kFewestStored, kMostStored);
  const Columns basis = hats(count);
  const DomainSamples root = m_importance.cwiseSqrt();
  const Eigen::MatrixXd weighted = root.asDiagonal() * basis;
  const Eigen::MatrixXd roots = root.asDiagonal();
  return {basis, weighted.colPivHouseholderQr().solve(roots)};
}

StoredSpectrum SpectrumStorage::pack(const DomainSamples& samples, SpectralQuantity quantity, StorageForm form,
                                     int count) const {
  requireWithin("count", count, kFewestStored, kMostStored);
  check(samples, quantity, form);
  StoredSpectrum stored{form, quantity == SpectralQuantity::SpectralPowerDistribution, 0, {}};
  switch (form) {
    case StorageForm::Points: {
      VectorXd values(count);
      for (Index k = 0; k < count; ++k) {
        const double place = evenly(count)[k] * (kDomainSize - 1);
        const Index at = std::min<Index>(static_cast<Index>(place), kDomainSize - 2);
        values[k] = samples[at] + (place - static_cast<double>(at)) * (samples[at + 1] - samples[at]);
      }
      stored.numbers = floats(values);
      break;
    }
    case StorageForm::Hats:
      stored.numbers = floats(stored.isLight ? nonNegative(m_seen * hats(count), m_seen * samples)
                                             : fitted(hats(count), samples, false).cwiseMax(0.0));
      break;
    case StorageForm::Bytes:
      stored.numbers = bytesOf(samples, count);
      break;
    case StorageForm::Cosines:
      stored.numbers = floats(fitted(cosines(count), samples, stored.isLight));
      break;
    case StorageForm::Moments: {
      const VectorXd phases = std::numbers::pi * (m_cosineAxis.array() - 1);
      const double floor = kInside * (stored.isLight ? 10 * samples.mean() : 1);
      const VectorXd inside =
          stored.isLight ? VectorXd(samples.array() + floor) : VectorXd(samples.cwiseMax(floor).cwiseMin(1 - floor));
      stored.numbers = floats(trigonometricMoments(phases, inside, count));
      break;
    }
    case StorageForm::Lines:
      return withLines(samples, count);
  }
  return stored;
}

DomainSamples SpectrumStorage::unpacked(const StoredSpectrum& stored) const {
  const int hatCount = static_cast<int>(stored.numbers.size()) - 2 * stored.lines;
  const bool hasLines = stored.form == StorageForm::Lines && stored.isLight && stored.lines >= 0;
  requireWithin("numbers", static_cast<int>(stored.numbers.size()), kFewestStored, kMostStored);
  const Eigen::Map<const Eigen::VectorXf> kept(stored.numbers.data(), static_cast<Index>(stored.numbers.size()));
  if (!kept.allFinite() || hatCount < 0 || hatCount == 1 || (stored.lines != 0 && !hasLines)) {
    refuse("numbers", std::to_string(stored.numbers.size()), "are not what a spectrum was stored in; store it again");
  }
  const VectorXd numbers = kept.cast<double>();
  const int count = static_cast<int>(numbers.size());
  switch (stored.form) {
    case StorageForm::Points: {
      DomainSamples samples;
      for (Index k = 0; k < kDomainSize; ++k) {
        const double place = static_cast<double>(k) / (kDomainSize - 1) * (count - 1);
        const Index at = std::min<Index>(static_cast<Index>(place), count - 2);
        samples[k] = numbers[at] + (place - static_cast<double>(at)) * (numbers[at + 1] - numbers[at]);
      }
      return samples.cwiseMax(0.0);
    }
    case StorageForm::Hats:
      return (hats(count) * numbers).cwiseMax(0.0);
    case StorageForm::Bytes:
      return hats(count) * (numbers / kLargestCode).cwiseAbs2().cwiseMin(1.0);
    case StorageForm::Cosines: {
      const DomainSamples samples = cosines(count) * numbers;
      return stored.isLight ? samples : DomainSamples(samples.cwiseMax(0.0));
    }
    case StorageForm::Moments: {
      const VectorXd phases = std::numbers::pi * (m_cosineAxis.array() - 1);
      if (numbers.isZero(0.0)) {
        return DomainSamples::Zero();
      }
      DomainSamples samples = stored.isLight ? positiveSignal(numbers, phases) : boundedSignal(numbers, phases);
      if (!samples.allFinite()) {
        refuse("numbers", std::to_string(count), "are the moments of no spectrum; store it again");
      }
      return samples;
    }
    case StorageForm::Lines:
      break;
  }
  DomainSamples samples = DomainSamples::Zero();
  if (hatCount > 0) {
    samples = hats(hatCount) * numbers.head(hatCount);
  }
  for (int k = 0; k < stored.lines; ++k) {
    const double nm = numbers[hatCount + 2 * k];
    if (!(nm >= kDomainStartNm && nm <= kDomainEndNm)) {
      refuse("line", std::to_string(nm), "lies outside 380 ... 780 nm; store the light again");
    }
    samples[static_cast<Index>(std::lround(nm)) - kDomainStartNm] += numbers[hatCount + 2 * k + 1];
  }
  return samples.cwiseMax(0.0);
}

}  // namespace metamer::spectral
