// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/wall_spectra.h"

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"

namespace metamer::stage {

using spectral::InputError;

WallCapture captureOf(const WallSpectra& spectra) {
  if (spectra.reflectances.empty()) {
    throw InputError("", "spectra.reflectances", "", "are none; name a chart");
  }
  spectral::requireAbove("beta", spectra.beta, 0);
  WallCapture capture;
  capture.beta = spectra.beta;
  for (std::size_t k = 0; k < 3; ++k) {
    capture.cameraFromWall.col(static_cast<Eigen::Index>(k)) = spectra.camera.transpose() * spectra.emitters[k];
  }
  const double wallExposure = capture.cameraFromWall.row(1).sum();
  capture.environmentWhite = spectra.camera.transpose() * spectra.target;
  const double targetExposure = capture.environmentWhite[1];
  if (!(wallExposure > 0) || !(targetExposure > 0)) {
    const bool isWall = !(wallExposure > 0);
    throw InputError("", isWall ? "spectra.emitters" : "spectra.target", "",
                     "gives the camera no green; check the spectrum and the camera");
  }
  capture.cameraFromWall /= wallExposure;
  capture.environmentWhite /= targetExposure;
  const auto count = static_cast<Eigen::Index>(spectra.reflectances.size());
  capture.target.resize(3, count);
  for (Eigen::Matrix3Xd& chart : capture.charts) {
    chart.resize(3, count);
  }
  for (Eigen::Index i = 0; i < count; ++i) {
    const spectral::Spectrum& reflectance = spectra.reflectances[static_cast<std::size_t>(i)];
    capture.patchNames.push_back(reflectance.name());
    const Eigen::Matrix<double, spectral::kDomainSize, 3> seen = reflectance.onDomain().asDiagonal() * spectra.camera;
    capture.target.col(i) = seen.transpose() * spectra.target / targetExposure;
    for (std::size_t k = 0; k < 3; ++k) {
      // The square lights the chart with 1/beta of what a whole sphere of it would.
      capture.charts[k].col(i) = seen.transpose() * spectra.emitters[k] / (wallExposure * spectra.beta);
    }
  }
  return capture;
}

}  // namespace metamer::stage
