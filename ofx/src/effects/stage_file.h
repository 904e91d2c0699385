// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

namespace metamer::ofx {

/// What `lutgen stage solve` writes, as far as pixels need it (course notes, section 2.7). Linear camera RGB.
struct Stage {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();   ///< wall drive from picture content, in the camera's view
  Eigen::Matrix3d q = Eigen::Matrix3d::Identity();   ///< correction of the camera's picture
  Eigen::Matrix3d n = Eigen::Matrix3d::Identity();   ///< wall drive from content that lights the set
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< added to the drive: takes the wall's black level away
};

/// Reads a stage file: JSON with M, Q and N, each three rows of three numbers, and offset, three numbers. Other keys
/// are not looked at.
/// @throws spectral::InputError naming the file, the key and the remedy
Stage readStageFile(const std::filesystem::path& file);
/// The same from text. @param where what messages call it
Stage parseStageFile(const std::string& text, const std::string& where);

}  // namespace metamer::ofx
