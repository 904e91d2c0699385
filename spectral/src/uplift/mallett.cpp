// SPDX-License-Identifier: Apache-2.0
// Mallett and Yuksel 2019, "Spectral primary decomposition for rendering with sRGB reflectance", equation 1: three
// curves that add to one within 1e-5, each the reflectance of a primary.
#include "uplift/curve_mixture.h"
#include "uplift/methods.h"
#include "uplift/uplift_basis.h"

namespace metamer::spectral {
namespace {

class Mallett : public Uplift {
 public:
  Mallett(const UpliftBasis& basis, const Eigen::Matrix3d& xyzFromRgb)
      : Uplift(basis.wavelengthsNm, xyzFromRgb),
        m_red(basis.curve("red")),
        m_green(basis.curve("green")),
        m_blue(basis.curve("blue")) {}

 private:
  void spectrumOf(const Eigen::Vector3d& rgb, double* spectrum) const override {
    mixCurves({&m_red, &m_green, &m_blue}, rgb, spectrum);
  }

  Eigen::VectorXd m_red;
  Eigen::VectorXd m_green;
  Eigen::VectorXd m_blue;
};

}  // namespace

std::unique_ptr<Uplift> makeMallett(const DataLibrary& library, const std::optional<UpliftWeights>& weights) {
  const UpliftBasis basis = readUpliftBasis(library, "mallett");
  return std::make_unique<Mallett>(basis,
                                   upliftXyzFromRgb(library, upliftWeightsOr(weights, library, basis.wavelengthsNm)));
}

}  // namespace metamer::spectral
