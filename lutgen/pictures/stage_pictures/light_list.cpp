// SPDX-License-Identifier: Apache-2.0
#include "stage_pictures/light_list.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <sstream>

#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

constexpr int kMostCellsAcross = 1024;
constexpr std::size_t kMostLights = 10'000;

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  std::string cell;
  while (std::getline(stream, cell, ',')) {
    cells.emplace_back(spectral::trimmed(cell));
  }
  return cells;
}

}  // namespace

std::vector<PositionedLight> parseLights(const std::string& text, const std::string& where) {
  std::vector<PositionedLight> lights;
  std::istringstream stream(text);
  std::string line;
  bool hasHeader = false;
  for (int number = 1; std::getline(stream, line); ++number) {
    line = std::string(spectral::trimmed(line));
    if (line.empty() || line.front() == '#') {
      continue;
    }
    const std::string at = where + ":" + std::to_string(number);
    const std::vector<std::string> cells = cellsOf(line);
    if (!hasHeader) {
      if (cells != std::vector<std::string>{"name", "x", "y", "z"}) {
        throw InputError(at, "header", line, "must be name,x,y,z");
      }
      hasHeader = true;
      continue;
    }
    if (cells.size() != 4) {
      throw InputError(at, "columns", std::to_string(cells.size()), "must be 4: name,x,y,z");
    }
    PositionedLight light{cells[0], {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string& cell = cells[k + 1];
      const auto parsed =
          std::from_chars(cell.data(), cell.data() + cell.size(), light.position[static_cast<Eigen::Index>(k)]);
      if (parsed.ec != std::errc() || parsed.ptr != cell.data() + cell.size()) {
        throw InputError(at, "position", cell, "must be a number");
      }
    }
    if (!light.position.allFinite() || light.position.isZero(0)) {
      throw InputError(at, "position", line, "must not be the stage's middle");
    }
    if (lights.size() == kMostLights) {
      throw InputError(at, "lights", "", "are more than " + std::to_string(kMostLights));
    }
    lights.push_back(std::move(light));
  }
  if (lights.empty()) {
    throw InputError(where, "lights", "", "are none; give the header name,x,y,z and a line a light");
  }
  return lights;
}

LightList::LightList(const std::filesystem::path& file, stage::LatLong layout)
    : m_layout(layout), m_lights(parseLights(spectral::readTextFile(file), spectral::utf8(file))) {
  m_side = std::max(1, m_layout.width / kMostCellsAcross);
  m_cells = {(m_layout.width + m_side - 1) / m_side, (m_layout.height + m_side - 1) / m_side};
  m_sums = Eigen::Matrix4Xd::Zero(4, static_cast<Eigen::Index>(m_cells.width) * m_cells.height);
}

void LightList::addRows(int first, int count, const Eigen::Matrix3Xf& rgb) {
  for (int row = 0; row < count; ++row) {
    const double solidAngle = m_layout.solidAngle(first + row);
    const Eigen::Index cellRow = static_cast<Eigen::Index>((first + row) / m_side) * m_cells.width;
    for (int column = 0; column < m_layout.width; ++column) {
      const Eigen::Vector3f pixel = rgb.col(static_cast<Eigen::Index>(row) * m_layout.width + column);
      auto sum = m_sums.col(cellRow + column / m_side);
      sum.head<3>() += solidAngle * pixel.cast<double>();
      sum[3] += solidAngle;
    }
  }
}

std::string LightList::drivesAsCsv(const stage::EnvironmentDriver& driver,
                                   const std::vector<std::string>& emitters) const {
  Eigen::Matrix3Xd directions(3, static_cast<Eigen::Index>(m_lights.size()));
  for (std::size_t i = 0; i < m_lights.size(); ++i) {
    directions.col(static_cast<Eigen::Index>(i)) = m_lights[i].position.stableNormalized();
  }
  Eigen::Matrix4Xd lights = Eigen::Matrix4Xd::Zero(4, directions.cols());
  for (int row = 0; row < m_cells.height; ++row) {
    for (int column = 0; column < m_cells.width; ++column) {
      // The middle of the cell in the whole picture: the last ones may be narrower.
      const int x = std::min(column * m_side + m_side / 2, m_layout.width - 1);
      const int y = std::min(row * m_side + m_side / 2, m_layout.height - 1);
      Eigen::Index nearest = 0;
      (directions.transpose() * m_layout.direction(x, y)).maxCoeff(&nearest);
      lights.col(nearest) += m_sums.col(static_cast<Eigen::Index>(row) * m_cells.width + column);
    }
  }
  std::string text = "name,x,y,z,solid_angle,R,G,B";
  for (const std::string& emitter : emitters) {
    text += "," + emitter;
  }
  text += "\n";
  stage::EnvironmentDriver::Memory memory;
  std::array<double, stage::kMostEnvironmentEmitters> drives{};
  for (std::size_t i = 0; i < m_lights.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const double solidAngle = lights(3, column);
    Eigen::Vector3d radiance = Eigen::Vector3d::Zero();
    if (solidAngle > 0) {
      radiance = lights.col(column).head<3>() / solidAngle;
    }
    driver.solve(radiance, directions.col(column), memory, drives.data());
    const Eigen::Vector3d& position = m_lights[i].position;
    text += m_lights[i].name + spectral::formatted(",%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", position.x(), position.y(),
                                                   position.z(), solidAngle, radiance[0], radiance[1], radiance[2]);
    for (std::size_t k = 0; k < emitters.size(); ++k) {
      text += spectral::formatted(",%.9g", drives[k]);
    }
    text += "\n";
  }
  return text;
}

}  // namespace metamer::lutgen
