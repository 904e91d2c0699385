// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// What a channel is sent for its light, both of full: signals over light^(1 / gamma), evenly spread over 0 ... 1,
/// linear between.
struct PanelSignal {
  double gamma = 1;
  std::vector<double> signals;  ///< at least two
};

/// A solved RGB wall, for OCIO.
struct StageMatrices {
  std::string name;                     ///< of the stage; part of every name made from it
  Eigen::Matrix3d wallFromContent;      ///< M, out of frustum
  Eigen::Matrix3d frustumFromContent;   ///< N, in frustum
  Eigen::Vector3d frustumOffset;        ///< added after N
  Eigen::Matrix3d correctedFromCamera;  ///< Q
  Eigen::Matrix3d xyzFromCamera;        ///< of the camera's linear RGB, any scale
  Eigen::Vector3d whiteXyz;             ///< what is white in it, any scale
  std::vector<PanelSignal> signals;     ///< of red, green and blue, of as many; empty: what is sent is not known
};

/// Wall drives from content in the camera's linear RGB: the matrix, the offset, and nothing below 0.
OCIO::GroupTransformRcPtr outOfFrustumTransform(const StageMatrices& stage);
OCIO::GroupTransformRcPtr inFrustumTransform(const StageMatrices& stage);
/// The correction after the camera.
OCIO::GroupTransformRcPtr postCorrectionTransform(const StageMatrices& stage);

/// What is sent for wall drives, which are light: cut to 0 ... 1. Needs three signals.
OCIO::GroupTransformRcPtr signalTransform(const StageMatrices& stage);

/// Writes PREFIX_out_of_frustum, PREFIX_in_frustum and PREFIX_post_correction, each as .spimtx, .clf and .ctf. A
/// .spimtx is the matrix and offset alone: what it gives below 0 is to be cut by the program that uses it.
/// Where signals are known, PREFIX_signal.clf and .ctf, to be applied after either of the wall's.
/// @return the files
/// @throws spectral::InputError where one cannot be written; none of them is then left
std::vector<std::filesystem::path> writeStageFiles(const StageMatrices& stage, const std::filesystem::path& prefix);

}  // namespace metamer::ocio
