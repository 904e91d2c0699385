// SPDX-License-Identifier: Apache-2.0
#include "spectral/fixture.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace metamer::spectral {

double FixtureRow::number(std::size_t column) const {
  return std::stod(m_cells.at(column));
}

Eigen::Vector3d FixtureRow::vector(std::size_t firstColumn) const {
  return {number(firstColumn), number(firstColumn + 1), number(firstColumn + 2)};
}

std::vector<FixtureRow> readFixture(const std::string& name) {
  std::ifstream stream(std::string(METAMER_ORACLE_FOLDER) + "/" + name);
  EXPECT_TRUE(stream) << name;
  std::vector<FixtureRow> rows;
  std::string line;
  for (int number = 0; std::getline(stream, line); ++number) {
    if (number < 2) {
      continue;
    }
    std::vector<std::string> cells;
    std::istringstream cellStream(line);
    for (std::string cell; std::getline(cellStream, cell, ',');) {
      cells.push_back(cell);
    }
    rows.emplace_back(std::move(cells));
  }
  EXPECT_FALSE(rows.empty()) << name;
  return rows;
}

MaxDifference::~MaxDifference() {
  std::printf("[ max difference ] %s %.2g over %d values, tolerance %.2g\n", m_name.c_str(), m_difference, m_count,
              m_tolerance);
  EXPECT_GT(m_count, 0) << m_name;
  EXPECT_LE(m_difference, m_tolerance) << m_name;
}

void MaxDifference::add(double actual, double expected) {
  const double difference = std::abs(actual - expected);
  // NaN must not pass.
  if (!(difference <= m_difference)) {
    m_difference = std::isnan(difference) ? INFINITY : difference;
  }
  ++m_count;
}

void MaxDifference::add(const Eigen::Ref<const Eigen::MatrixXd>& actual,
                        const Eigen::Ref<const Eigen::MatrixXd>& expected) {
  for (Eigen::Index i = 0; i < actual.rows(); ++i) {
    for (Eigen::Index j = 0; j < actual.cols(); ++j) {
      add(actual(i, j), expected(i, j));
    }
  }
}

void MaxDifference::addRelative(double actual, double expected) {
  const double size = std::fmax(1.0, std::abs(expected));
  add(actual / size, expected / size);
}

const DataLibrary& testLibrary() {
  static const DataLibrary library = DataLibrary::open(METAMER_DATA_FOLDER);
  return library;
}

}  // namespace metamer::spectral
