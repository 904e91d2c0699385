// SPDX-License-Identifier: Apache-2.0
// Mallett and Yuksel 2019, "Spectral primary decomposition for rendering with sRGB reflectance", equation 1: three
// curves that add to one within 1e-5, each the reflectance of a primary.
#include "metamer/spectral/vector_lanes.h"
#include "uplift/methods.h"
#include "uplift/uplift_basis.h"

namespace metamer::spectral {
namespace {

METAMER_VECTOR_LANES void mix(const Eigen::Vector3d& rgb, const Eigen::MatrixX3d& curves, double* spectrum) {
  const Eigen::Index count = curves.rows();
  const double* const red = curves.col(0).data();
  const double* const green = curves.col(1).data();
  const double* const blue = curves.col(2).data();
  const double ofRed = rgb[0];
  const double ofGreen = rgb[1];
  const double ofBlue = rgb[2];
  for (Eigen::Index i = 0; i < count; ++i) {
    spectrum[i] = ofRed * red[i] + ofGreen * green[i] + ofBlue * blue[i];
  }
}

class Mallett : public Uplift {
 public:
  Mallett(const UpliftBasis& basis, const Eigen::Matrix3d& xyzFromRgb)
      : Uplift(basis.wavelengthsNm, xyzFromRgb), m_curves(basis.curves.rows(), 3) {
    m_curves << basis.curve("red"), basis.curve("green"), basis.curve("blue");
  }

 private:
  void spectrumOf(const Eigen::Vector3d& rgb, double* spectrum) const override { mix(rgb, m_curves, spectrum); }

  Eigen::MatrixX3d m_curves;  ///< of red, green and blue
};

}  // namespace

std::unique_ptr<Uplift> makeMallett(const DataLibrary& library, const std::optional<UpliftWeights>& weights) {
  const UpliftBasis basis = readUpliftBasis(library, "mallett");
  return std::make_unique<Mallett>(basis,
                                   upliftXyzFromRgb(library, upliftWeightsOr(weights, library, basis.wavelengthsNm)));
}

}  // namespace metamer::spectral
