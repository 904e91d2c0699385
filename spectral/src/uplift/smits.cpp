// SPDX-License-Identifier: Apache-2.0
// Smits 1999, "An RGB-to-spectrum conversion for reflectances", Journal of Graphics Tools 4(4), section 4: the least
// component is white's share, what the middle one has more is a secondary's, what the largest has more still is a
// primary's.
#include <utility>

#include "uplift/curve_mixture.h"
#include "uplift/methods.h"
#include "uplift/uplift_basis.h"

namespace metamer::spectral {
namespace {

using Curves = std::array<Eigen::VectorXd, 3>;

class Smits : public Uplift {
 public:
  Smits(const UpliftBasis& basis, const Eigen::Matrix3d& xyzFromRgb)
      : Uplift(basis.wavelengthsNm, xyzFromRgb),
        m_white(basis.curve("white")),
        m_primaries{basis.curve("red"), basis.curve("green"), basis.curve("blue")},
        m_secondaries{basis.curve("cyan"), basis.curve("magenta"), basis.curve("yellow")} {}

 private:
  void spectrumOf(const Eigen::Vector3d& rgb, double* spectrum) const override {
    Eigen::Index least = 0;
    if (rgb[1] < rgb[least]) {
      least = 1;
    }
    if (rgb[2] < rgb[least]) {
      least = 2;
    }
    Eigen::Index middle = (least + 1) % 3;
    Eigen::Index largest = (least + 2) % 3;
    if (rgb[middle] > rgb[largest]) {
      std::swap(middle, largest);
    }
    // The secondary that lacks a component stands at that component's place.
    const Eigen::VectorXd& secondary = m_secondaries[static_cast<std::size_t>(least)];
    const Eigen::VectorXd& primary = m_primaries[static_cast<std::size_t>(largest)];
    mixCurves({&m_white, &secondary, &primary}, {rgb[least], rgb[middle] - rgb[least], rgb[largest] - rgb[middle]},
              spectrum);
  }

  Eigen::VectorXd m_white;
  Curves m_primaries;
  Curves m_secondaries;
};

}  // namespace

std::unique_ptr<Uplift> makeSmits(const DataLibrary& library, const std::optional<UpliftWeights>& weights) {
  const UpliftBasis basis = readUpliftBasis(library, "smits");
  return std::make_unique<Smits>(basis,
                                 upliftXyzFromRgb(library, upliftWeightsOr(weights, library, basis.wavelengthsNm)));
}

}  // namespace metamer::spectral
