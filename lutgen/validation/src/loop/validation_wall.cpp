// SPDX-License-Identifier: Apache-2.0
#include "loop/validation_wall.h"

#include <Eigen/SVD>
#include <algorithm>

#include "loop/validation_noise.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/stage/emitter_model.h"
#include "metamer/stage/rgb_wall.h"
#include "metamer/stage/stage_geometry.h"

namespace metamer::validation {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using spectral::DomainSamples;

/// Peak and half spectral width of the wall's channels, nm: a model of a common RGB panel.
constexpr std::array<std::array<double, 2>, 3> kPanel = {{{625, 18}, {530, 32}, {465, 22}}};

}  // namespace

WallValidation validateWall(const Chart& chart, const sip::PreparedPipeline& realPlace,
                            const spectral::Observer& camera, const std::array<DomainSamples, 3>& walls,
                            const ValidationOptions& options) {
  const auto render = [&](const Chart& shown, Stage stage, const DomainSamples& radiance) {
    return renderPatches(sceneOf(shown, stage, radiance, camera, walls), shown, options.replicates, options.samples,
                         options.seed, options.threads);
  };
  const Eigen::Matrix<double, spectral::kDomainSize, 3> curves = camera.onDomain();
  const double scale = 3.0 / curves.sum();  // the film's: its mean response to an even radiance of 1 is 1
  std::array<DomainSamples, 3> channels;
  stage::WallCapture capture;
  for (std::size_t k = 0; k < 3; ++k) {
    channels[k] = stage::ledModel(kPanel[k][0], kPanel[k][1]).onDomain();
    capture.cameraFromWall.col(static_cast<Eigen::Index>(k)) = scale * curves.transpose() * channels[k];
    capture.charts[k] = meanOf(render(chart, Stage::Square, channels[k]));
  }
  const auto target = render(chart, Stage::Surrounding, realPlace.light);
  capture.target = meanOf(target);
  capture.patchNames = chart.names;
  capture.environmentWhite = scale * curves.transpose() * realPlace.light;
  capture.beta = stage::calibrationSquareBeta(1, 1, 1);
  const stage::WallSolution solution = solveWall(capture);

  DomainSamples driven = DomainSamples::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    driven += solution.environmentDrive[static_cast<Eigen::Index>(k)] * channels[k];
  }
  const auto lit = render(chart, Stage::Surrounding, driven);
  const Matrix3Xd seen = meanOf(lit);

  const Vector3d white = realPlace.xyzFromResponse * capture.environmentWhite;
  const auto lab = [&](const Vector3d& rgb) {
    return spectral::lab(realPlace.xyzFromResponse * rgb / white.y(), white / white.y());
  };
  WallValidation result;
  for (Eigen::Index i = 0; i < seen.cols(); ++i) {
    std::vector<Vector3d> differences;
    for (std::size_t k = 0; k < lit.size(); ++k) {
      differences.emplace_back(lab(solution.correctedFromCamera * lit[k].col(i)) - lab(target[k].col(i)));
    }
    const Vector3d wanted = lab(capture.target.col(i));
    result.patches.push_back({chart.names[static_cast<std::size_t>(i)], spectral::deltaE2000(lab(seen.col(i)), wanted),
                              spectral::deltaE2000(lab(solution.correctedFromCamera * seen.col(i)), wanted),
                              intervalOfMean(wanted, differences)});
    result.predictionError =
        std::max(result.predictionError, spectral::deltaE2000(lab(solution.predicted.col(i)), lab(seen.col(i))));
  }
  const Eigen::Matrix3d through = solution.correctedFromCamera * capture.cameraFromWall * solution.frustumFromContent;
  result.frustumError = (through - Eigen::Matrix3d::Identity()).jacobiSvd().singularValues()[0];
  return result;
}

}  // namespace metamer::validation
