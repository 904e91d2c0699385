// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_view.h"

#include <Eigen/Dense>
#include <cmath>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_integral.h"

namespace metamer::skin {
namespace {

/// Responses to a hat a band, the perfect reflector's of a mean of 1.
SkinView::Weights responses(const spectral::Spectrum& illuminant, const spectral::Observer& observer) {
  const spectral::SeenLight seen = spectral::seenLight(illuminant, {}, observer);
  SkinView::Weights weights = SkinView::Weights::Zero();
  for (int i = 0; i < spectral::kDomainSize; ++i) {
    const double at = i / kSkinBandNm;
    const int band = std::min(static_cast<int>(at), kSkinBands - 2);
    const Eigen::Vector3d here = seen.light[i] * seen.curves.row(i).transpose();
    weights.col(band) += (1 - (at - band)) * here;
    weights.col(band + 1) += (at - band) * here;
  }
  const double size = weights.sum() / 3;
  if (!(size > 0) || !std::isfinite(size)) {
    throw spectral::InputError("", "illuminant", illuminant.name(), "gives " + observer.name + " no response");
  }
  return weights / size;
}

}  // namespace

SkinView::SkinView(const spectral::Spectrum& illuminant, const spectral::Observer& observer,
                   const spectral::RgbSpace& space, spectral::ChromaticAdaptation adaptation) {
  const Weights weights = responses(illuminant, observer);
  if (!observer.xyzFromResponse) {
    throw spectral::InputError("", "observer", observer.name, "has no matrix to XYZ; give one that has");
  }
  const Eigen::Matrix3d& xyz = *observer.xyzFromResponse;
  const Eigen::Vector3d white = weights.rowwise().sum();
  const Eigen::Matrix3d rgbFromResponse =
      space.rgbFromXyz() * spectral::adaptXyz(adaptation, xyz * white, space.whiteXyz()) * xyz;
  m_rgbWeights = rgbFromResponse * weights;
  // A white of Y = 1 is (1, 1, 1) in every space.
  m_rgbWeights *= 3 / m_rgbWeights.sum();
  if (!m_rgbWeights.allFinite()) {
    throw spectral::InputError("", "observer", observer.name, "has a matrix to XYZ without an inverse");
  }

  // Smooth below, exact above: the stationary point of |differences|^2 with multipliers of the three colours.
  const Eigen::JacobiSVD<Eigen::MatrixXd> values(m_rgbWeights, Eigen::ComputeThinU | Eigen::ComputeThinV);
  constexpr double kSameColour = 1e-4;
  m_rank = static_cast<int>((values.singularValues().array() > kSameColour * values.singularValues()[0]).count());
  const Eigen::MatrixXd seen = values.matrixU().leftCols(m_rank).transpose() * m_rgbWeights;
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(kSkinBands + m_rank, kSkinBands + m_rank);
  for (int band = 0; band + 1 < kSkinBands; ++band) {
    system.block<2, 2>(band, band) += (Eigen::Matrix2d() << 1, -1, -1, 1).finished();
  }
  system.block(kSkinBands, 0, m_rank, kSkinBands) = seen;
  system.block(0, kSkinBands, kSkinBands, m_rank) = seen.transpose();
  Eigen::MatrixXd wanted = Eigen::MatrixXd::Zero(kSkinBands + m_rank, 3);
  wanted.bottomRows(m_rank) = values.matrixU().leftCols(m_rank).transpose();
  m_smoothest = system.fullPivLu().solve(wanted).topRows(kSkinBands);
}

}  // namespace metamer::skin
