// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/spectral/spectrum.h"

namespace metamer::spectral {

/// How a spectrum is kept in few numbers (docs/spectra.md, "Storage").
enum class StorageForm {
  Points,   ///< values at even steps, linear between them
  Hats,     ///< hat functions, by least squares, denser where the eye sees more
  Bytes,    ///< the same of reflectances, a byte each: 255 times the square root
  Cosines,  ///< cosines over that axis, by least squares
  Moments,  ///< trigonometric moments: of reflectances bounded by 0 and 1, of lights by maximum entropy
  Lines,    ///< lights: hats, and lines with a place and a power
};

/// "points", "hats", "bytes", "cosines", "moments", "lines".
const std::vector<std::string>& storageFormNames();
/// @throws InputError for any other name (lists these)
StorageForm storageFormNamed(const std::string& name);

/// Numbers that a spectrum may be kept in.
inline constexpr int kFewestStored = 4;
inline constexpr int kMostStored = 40;

/// A spectrum from 380 to 780 nm as it is kept.
struct StoredSpectrum {
  StorageForm form = StorageForm::Points;
  bool isLight = false;        ///< a power distribution; else a reflectance or a transmittance
  int lines = 0;               ///< Lines: how many of the numbers' last pairs are nm, power
  std::vector<float> numbers;  ///< Bytes: whole, 0 to 255

  /// That the numbers take; not the form's name and what else a file says once.
  std::size_t bytes() const { return numbers.size() * (form == StorageForm::Bytes ? 1 : sizeof(float)); }
};

/// StorageForm::Hats as two matrices, for who keeps many reflectances: `samples = samplesFromNumbers numbers`, and
/// `numbers = numbersFromSamples samples` by the least squares of pack(), before it cuts what is below 0.
struct HatBasis {
  Eigen::MatrixXd samplesFromNumbers;  ///< kDomainSize x count; in a row one or two are not 0, side by side
  Eigen::MatrixXd numbersFromSamples;  ///< count x kDomainSize
};

/// Packs and unpacks: holds the axis, which is that of the CIE 1931 2 degree observer. Immutable, safe to share between
/// threads.
///
/// The axis is cumulated from sqrt(x^2 + y^2 + z^2) of the observer's curves over its largest, plus 0.3 (hats) or 1
/// (cosines, moments); least squares count a wavelength by that root plus 0.01. Lights are fitted as smooth surfaces
/// see them: by their products with the observer's curves, and a little with none, and the first cosines, so that power
/// is kept where a line lies between nodes.
class SpectrumStorage {
 public:
  explicit SpectrumStorage(const DataLibrary& library);

  /// @param samples   at 380, 381, ... 780 nm, 0 or more
  /// @param quantity  PowerDistribution, Reflectance or Transmittance
  /// @param count     of numbers, kFewestStored ... kMostStored
  /// @throws InputError: another quantity or count, samples that are not finite or below 0; reflectances above 1 in
  ///         Bytes or Moments, and in Lines; lights in Bytes
  StoredSpectrum pack(const DomainSamples& samples, SpectralQuantity quantity, StorageForm form, int count) const;

  /// 0 or more, but for lights in cosines, which swing below it beside lines; of Bytes and Moments of a reflectance at
  /// most 1.
  /// @throws InputError where the numbers are none that pack() gives
  DomainSamples unpacked(const StoredSpectrum& stored) const;

  /// @param count  of numbers, kFewestStored ... kMostStored. @throws InputError: another count
  HatBasis hatBasis(int count) const;

 private:
  using Columns = Eigen::Matrix<double, kDomainSize, Eigen::Dynamic>;

  /// Hats between nodes that lie evenly on an axis.
  Columns hats(int count) const;
  Columns cosines(int count) const;
  Eigen::VectorXd fitted(const Columns& basis, const DomainSamples& samples, bool isLight) const;
  std::vector<float> bytesOf(const DomainSamples& samples, int count) const;
  StoredSpectrum withLines(const DomainSamples& samples, int count) const;

  DomainSamples m_importance;  ///< least squares' weights
  DomainSamples m_hatAxis;     ///< 0 ... 1
  DomainSamples m_cosineAxis;
  Eigen::MatrixXd m_seen;  ///< what smooth surfaces see of a light, a row each
};

}  // namespace metamer::spectral
