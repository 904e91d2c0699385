// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/spectral/input_error.h"

namespace metamer::spectral {

/// One row of a fixture of tests/oracle.
class FixtureRow {
 public:
  explicit FixtureRow(std::vector<std::string> cells) : m_cells(std::move(cells)) {}
  std::size_t size() const { return m_cells.size(); }
  const std::string& text(std::size_t column) const { return m_cells.at(column); }
  double number(std::size_t column) const;
  Eigen::Vector3d vector(std::size_t firstColumn) const;

 private:
  std::vector<std::string> m_cells;
};

/// The rows below the comment and the header of tests/oracle/<name>.
std::vector<FixtureRow> readFixture(const std::string& name);

/// The largest difference seen, printed and held against a tolerance at the end of its life.
class MaxDifference {
 public:
  MaxDifference(std::string name, double tolerance) : m_name(std::move(name)), m_tolerance(tolerance) {}
  ~MaxDifference();
  MaxDifference(const MaxDifference&) = delete;
  MaxDifference& operator=(const MaxDifference&) = delete;

  void add(double actual, double expected);
  void add(const Eigen::Ref<const Eigen::MatrixXd>& actual, const Eigen::Ref<const Eigen::MatrixXd>& expected);
  /// The difference divided by the expected size where that is above 1: for light, which has no upper bound.
  void addRelative(double actual, double expected);

 private:
  std::string m_name;
  double m_tolerance;
  double m_difference = 0;
  int m_count = 0;
};

/// The data library of the source tree.
const DataLibrary& testLibrary();

/// The text of the InputError that a call throws; a message that fails comparisons where it throws none.
template <typename Call>
std::string errorOf(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

/// 0 ... 1, the same on every platform (the standard's distributions are not).
inline double unitRandom(std::mt19937& random) {
  return static_cast<double>(random()) / 4294967296.0;
}

}  // namespace metamer::spectral
