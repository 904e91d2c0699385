// SPDX-License-Identifier: Apache-2.0
// Otsu, Yamamoto and Hachisuka 2018, "Reproducing spectral reflectances from tristimulus colours", Computer Graphics
// Forum 37(6), section 4: the chromaticity names a cluster of measured surfaces, whose mean and three principal
// components meet the tristimulus (equation 6); what leaves 0 ... 1 is cut.
#include <Eigen/LU>
#include <cmath>

#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/input_error.h"
#include "uplift/methods.h"
#include "uplift/uplift_basis.h"

namespace metamer::spectral {
namespace {

/// A row of the selector. A place is a cluster, or below zero a row's number with its sign changed: row 0 is the first
/// and never a target.
struct Fork {
  double bound;
  Eigen::Index coordinate;
  int atMost;
  int above;
};

/// Spectrum of a cluster before the cut: mean + fromRgb rgb.
struct Cluster {
  Eigen::Matrix<double, Eigen::Dynamic, 3> fromRgb;
  Eigen::VectorXd constant;
};

class Otsu : public Uplift {
 public:
  Otsu(const UpliftBasis& basis, const UpliftWeights& weights, const Eigen::Matrix3d& xyzFromRgb)
      : Uplift(basis.wavelengthsNm, xyzFromRgb) {
    const std::size_t clusters = basis.names.size() / 4;
    for (const std::vector<double>& row : basis.selector) {
      m_forks.push_back(forkOf(row, basis.selector.size(), clusters, basis.where));
    }
    if (m_forks.empty()) {
      throw InputError(basis.where, "selector", "", "must have a row");
    }
    for (std::size_t k = 0; k < clusters; ++k) {
      const std::string number = std::to_string(k);
      Eigen::Matrix<double, Eigen::Dynamic, 3> components(basis.curves.rows(), 3);
      for (int j = 0; j < 3; ++j) {
        components.col(j) = basis.curve("basis " + number + " " + std::to_string(j));
      }
      const Eigen::VectorXd mean = basis.curve("mean " + number);
      const Eigen::Matrix3d xyzOfComponents = weights.transpose() * components;
      const Eigen::Matrix<double, Eigen::Dynamic, 3> fromXyz = components * xyzOfComponents.inverse();
      m_clusters.push_back({fromXyz * xyzFromRgb, mean - fromXyz * (weights.transpose() * mean)});
    }
    m_whiteXy = chromaticity(xyzFromRgb * Eigen::Vector3d::Ones());
  }

 private:
  static Fork forkOf(const std::vector<double>& row, std::size_t rows, std::size_t clusters, const std::string& where) {
    const auto isPlace = [&](double place) {
      // Rows lead on to later numbers by any way, but none to the first: there is no loop in a tree.
      return place == std::floor(place) && place < static_cast<double>(clusters) && -place < static_cast<double>(rows);
    };
    if (row.size() != 4 || (row[1] != 0 && row[1] != 1) || !isPlace(row[2]) || !isPlace(row[3])) {
      throw InputError(where, "selector", "", "must be rows of bound, coordinate (0 or 1) and two places");
    }
    return {row[0], static_cast<Eigen::Index>(row[1]), static_cast<int>(row[2]), static_cast<int>(row[3])};
  }

  const Cluster& clusterOf(const Eigen::Vector2d& xy) const {
    int place = 0;
    // A tree visits each row once at most.
    for (std::size_t visits = 0; visits < m_forks.size(); ++visits) {
      const Fork& fork = m_forks[static_cast<std::size_t>(-place)];
      place = xy[fork.coordinate] <= fork.bound ? fork.atMost : fork.above;
      if (place >= 0) {
        break;
      }
    }
    return m_clusters[static_cast<std::size_t>(std::max(place, 0))];
  }

  void spectrumOf(const Eigen::Vector3d& rgb, double* spectrum) const override {
    const Eigen::Vector3d xyz = xyzFromRgb() * rgb;
    const double sum = xyz.sum();
    const Cluster& cluster = clusterOf(sum > 0 ? Eigen::Vector2d(xyz.head<2>() / sum) : m_whiteXy);
    Eigen::Map<Eigen::VectorXd>(spectrum, cluster.constant.size()) =
        (cluster.constant + cluster.fromRgb.col(0) * rgb[0] + cluster.fromRgb.col(1) * rgb[1] +
         cluster.fromRgb.col(2) * rgb[2])
            .cwiseMax(0.0)
            .cwiseMin(1.0);
  }

  std::vector<Fork> m_forks;
  std::vector<Cluster> m_clusters;
  Eigen::Vector2d m_whiteXy;
};

}  // namespace

std::unique_ptr<Uplift> makeOtsu(const DataLibrary& library, const std::optional<UpliftWeights>& weights) {
  const UpliftBasis basis = readUpliftBasis(library, "otsu");
  const UpliftWeights used = upliftWeightsOr(weights, library, basis.wavelengthsNm);
  return std::make_unique<Otsu>(basis, used, upliftXyzFromRgb(library, used));
}

}  // namespace metamer::spectral
