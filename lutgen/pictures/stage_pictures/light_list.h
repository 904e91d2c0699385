// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "metamer/stage/environment_drive.h"
#include "metamer/stage/stage_geometry.h"

namespace metamer::lutgen {

/// A light of the stage.
struct PositionedLight {
  std::string name;
  Eigen::Vector3d position;  ///< from the stage's middle, finite, never there
};

/// Lights from CSV: the header name,x,y,z, and a line a light (metres, or any unit; the axes of stage::LatLong).
/// @param where  what messages call it
/// @throws spectral::InputError
std::vector<PositionedLight> parseLights(const std::string& text, const std::string& where);

/// Lights at positions round the stage's middle, each of which stands for the directions nearest to its own.
class LightList {
 public:
  /// @param file  as of parseLights
  /// @throws spectral::InputError
  LightList(const std::filesystem::path& file, stage::LatLong layout);

  /// Adds rows of the environment, which are averaged over cells of about a third of a degree.
  void addRows(int first, int count, const Eigen::Matrix3Xf& rgb);

  /// name,x,y,z,solid_angle,R,G,B and the drives that make each light's mean radiance.
  std::string drivesAsCsv(const stage::EnvironmentDriver& driver, const std::vector<std::string>& emitters) const;

 private:
  stage::LatLong m_layout;
  stage::LatLong m_cells;
  int m_side = 1;  ///< pixels along a side of a cell
  std::vector<PositionedLight> m_lights;
  Eigen::Matrix4Xd m_sums;  ///< radiance times solid angle, and solid angle, a column a cell
};

}  // namespace metamer::lutgen
