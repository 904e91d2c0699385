// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"

namespace metamer::spectral {

/// A published way from a colour to a reflectance. metamer's own: sip/scene_uplift.h.
enum class UpliftMethod {
  Smits,       ///< Smits 1999: sums of seven curves; linear on six cones
  Mallett,     ///< Mallett and Yuksel 2019: sums of three curves; linear
  Jakob,       ///< Jakob and Hanika 2019: a sigmoid of a parabola, solved a colour
  JakobTable,  ///< the same from a table of coefficients
  Otsu,        ///< Otsu, Yamamoto and Hachisuka 2018: mean and three components of a cluster of measured surfaces
  Meng,        ///< Meng, Simon, Hanika and Dachsbacher 2015: the smoothest spectrum that is nowhere negative
};

/// "smits", "mallett", "jakob", "jakob table", "otsu", "meng".
const std::vector<std::string>& upliftMethodNames();
/// @throws InputError for any other name (lists these)
UpliftMethod upliftMethodNamed(const std::string& name);

/// XYZ that each wavelength of an uplift counts for, a row each: XYZ = weightsᵀ spectrum, the perfect reflector at Y
/// = 1.
using UpliftWeights = Eigen::Matrix<double, Eigen::Dynamic, 3>;

/// One way from colours to reflectances, ready: immutable, safe to share between threads.
///
/// A colour is linear RGB with Rec.709's primaries, (1, 1, 1) the perfect reflector under D65. A spectrum is
/// reflectance at wavelengthsNm(), linear between them, its end values held outside. docs/uplift.md says for each
/// method what comes of colours outside Rec.709, below black and above white. Of a colour with a NaN or an infinity all
/// of the spectrum is NaN, and no other spectrum is touched.
class Uplift {
 public:
  virtual ~Uplift() = default;
  Uplift(const Uplift&) = delete;
  Uplift& operator=(const Uplift&) = delete;

  /// nm, rising.
  const std::vector<double>& wavelengthsNm() const { return m_wavelengthsNm; }
  /// XYZ (CIE 1931 2° under D65, Y = 1 for the perfect reflector) of a colour, as the methods that need it take it:
  /// Rec.709's matrix, scaled a row each so that (1, 1, 1) is the perfect reflector by this object's weights.
  const Eigen::Matrix3d& xyzFromRgb() const { return m_xyzFromRgb; }

  /// @param rgb      three numbers a colour
  /// @param spectra  gets wavelengthsNm().size() a colour, one spectrum after another
  /// @throws InputError where the sizes do not agree
  void spectra(std::span<const double> rgb, std::span<double> spectra) const;

 protected:
  Uplift(std::vector<double> wavelengthsNm, const Eigen::Matrix3d& xyzFromRgb)
      : m_wavelengthsNm(std::move(wavelengthsNm)), m_xyzFromRgb(xyzFromRgb) {}

 private:
  /// The spectrum of one finite colour.
  virtual void spectrumOf(const Eigen::Vector3d& rgb, double* spectrum) const = 0;
  /// Of several, for methods that solve many at once for less; the same to rounding.
  virtual void spectraOf(std::span<const double> rgb, double* spectra) const;

  std::vector<double> m_wavelengthsNm;
  Eigen::Matrix3d m_xyzFromRgb;
};

/// @param library  gives D65, the CIE 1931 2° observer, Rec.709 and the bases
/// @param weights  how spectra are summed to XYZ, one row a wavelength of the method; left out, exact integrals of
/// spectra
///                 that are linear between those wavelengths over 380 to 780 nm. Smits and Mallett need none.
/// @throws InputError where the weights are of another size or not finite
std::unique_ptr<Uplift> makeUplift(UpliftMethod method, const DataLibrary& library,
                                   const std::optional<UpliftWeights>& weights = {});

/// Coefficients of Jakob and Hanika's model: R = 1/2 + U / (2 sqrt(1 + U²)), U = (c0 t + c1) t + c2, where t rises from
/// 0 at 380 nm to 1 at 780 nm.
using JakobCoefficients = std::array<float, 3>;

/// Jakob and Hanika's table of coefficients over Rec.709's cube, for who evaluates a few wavelengths a colour.
class JakobTable {
 public:
  /// Solves resolution³ colours for each component that may be the largest: 0.8 million of them at 64.
  /// @param resolution  4 to 128
  explicit JakobTable(const DataLibrary& library, int resolution = 64,
                      const std::optional<UpliftWeights>& weights = {});

  int resolution() const { return m_resolution; }
  /// Trilinear in the largest component and the ratios of the others to it, as published. Each component is first taken
  /// into 0 ... 1; of a NaN, 0.
  JakobCoefficients coefficients(const std::array<float, 3>& rgb) const;

 private:
  int m_resolution;
  std::vector<float> m_axis;          ///< of the largest component, 0 ... 1: dense at both ends
  std::vector<float> m_coefficients;  ///< [largest][its place][ratio][ratio][4]; the fourth is unused
};

}  // namespace metamer::spectral
