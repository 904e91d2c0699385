// SPDX-License-Identifier: Apache-2.0
#include "uplift/jakob_solver.h"
#include "uplift/methods.h"
#include "uplift/uplift_basis.h"

namespace metamer::spectral {
namespace {

class Jakob : public Uplift {
 public:
  Jakob(const UpliftWeights& weights, const Eigen::Matrix3d& xyzFromRgb)
      : Uplift(JakobSolver::wavelengthsNm(), xyzFromRgb), m_solver(weights) {}

 private:
  void spectrumOf(const Eigen::Vector3d& rgb, double* spectrum) const override {
    m_solver.spectrum(m_solver.solve(xyzFromRgb() * rgb).coefficients, spectrum);
  }

  JakobSolver m_solver;
};

}  // namespace

std::unique_ptr<Uplift> makeJakob(const DataLibrary& library, const std::optional<UpliftWeights>& weights) {
  const UpliftWeights used = upliftWeightsOr(weights, library, JakobSolver::wavelengthsNm());
  return std::make_unique<Jakob>(used, upliftXyzFromRgb(library, used));
}

}  // namespace metamer::spectral
