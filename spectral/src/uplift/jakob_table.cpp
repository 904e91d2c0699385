// SPDX-License-Identifier: Apache-2.0
// The table of Jakob and Hanika 2019, section 4.2: three cubes, one for each component that may be the largest, over
// its size and the ratios of the others to it.
#include <algorithm>
#include <cmath>

#include "metamer/spectral/argument_checks.h"
#include "uplift/jakob_solver.h"
#include "uplift/methods.h"
#include "uplift/uplift_basis.h"

namespace metamer::spectral {
namespace {

constexpr int kDefaultResolution = 64;
/// How far from black and white the cubes' ends are solved: their own coefficients are infinite, and would be mixed
/// into all colours beside them.
constexpr double kMargin = 2e-4;

double smoothStep(double x) {
  return x * x * (3 - 2 * x);
}

/// The last of an axis but its end that is not above a value, else the first. Without branches: of colours in no order
/// half of them would be guessed wrong, and each wrong guess throws away the next colours' loads.
std::size_t lastNotAbove(const std::vector<float>& axis, float value) {
  const float* base = axis.data();
  for (std::size_t left = axis.size() - 1; left > 1;) {
    const std::size_t half = left / 2;
    base += base[half] <= value ? half : 0;
    left -= half;
  }
  return static_cast<std::size_t>(base - axis.data());
}

class JakobByTable : public Uplift {
 public:
  JakobByTable(const DataLibrary& library, const UpliftWeights& weights, const Eigen::Matrix3d& xyzFromRgb)
      : Uplift(JakobSolver::wavelengthsNm(), xyzFromRgb),
        m_solver(weights),
        m_table(library, kDefaultResolution, weights) {}

 private:
  void spectrumOf(const Eigen::Vector3d& rgb, double* spectrum) const override {
    const Eigen::Vector3f colour = rgb.cast<float>();
    const JakobCoefficients found = m_table.coefficients({colour[0], colour[1], colour[2]});
    m_solver.spectrum(Eigen::Map<const Eigen::Vector3f>(found.data()).cast<double>(), spectrum);
  }

  JakobSolver m_solver;
  JakobTable m_table;
};

}  // namespace

JakobTable::JakobTable(const DataLibrary& library, int resolution, const std::optional<UpliftWeights>& weights)
    : m_resolution(resolution) {
  requireWithin("resolution", resolution, 4, 128);
  const UpliftWeights used = upliftWeightsOr(weights, library, JakobSolver::wavelengthsNm());
  const Eigen::Matrix3d xyzFromRgb = upliftXyzFromRgb(library, used);
  const JakobSolver solver(used);
  const auto size = static_cast<std::size_t>(resolution);
  for (int k = 0; k < resolution; ++k) {
    m_axis.push_back(static_cast<float>(smoothStep(smoothStep(k / static_cast<double>(resolution - 1)))));
  }
  m_coefficients.resize(3 * size * size * size * 4);
  for (std::size_t largest = 0; largest < 3; ++largest) {
    for (std::size_t second = 0; second < size; ++second) {
      for (std::size_t first = 0; first < size; ++first) {
        Eigen::Vector3d direction;
        direction[static_cast<Eigen::Index>(largest)] = 1;
        direction[static_cast<Eigen::Index>((largest + 1) % 3)] = static_cast<double>(first) / (resolution - 1);
        direction[static_cast<Eigen::Index>((largest + 2) % 3)] = static_cast<double>(second) / (resolution - 1);
        // From the middle to both ends, each from the one before.
        const std::size_t middle = size / 2;
        Eigen::Vector3d ofMiddle = Eigen::Vector3d::Zero();
        const auto solveAt = [&](std::size_t place, const Eigen::Vector3d& start) {
          const double value = std::clamp(static_cast<double>(m_axis[place]), kMargin, 1 - kMargin);
          Eigen::Vector3d found = solver.solveFrom(start, xyzFromRgb * (value * direction)).coefficients;
          float* const node = &m_coefficients[4 * (((largest * size + place) * size + second) * size + first)];
          Eigen::Map<Eigen::Vector3f>{node} = found.cast<float>();
          return found;
        };
        Eigen::Vector3d start = ofMiddle = solveAt(middle, solver.solve(xyzFromRgb * (0.5 * direction)).coefficients);
        for (std::size_t place = middle + 1; place < size; ++place) {
          start = solveAt(place, start);
        }
        start = ofMiddle;
        for (std::size_t place = middle; place-- > 0;) {
          start = solveAt(place, start);
        }
      }
    }
  }
}

JakobCoefficients JakobTable::coefficients(const std::array<float, 3>& rgb) const {
  std::array<float, 3> colour;
  for (std::size_t k = 0; k < 3; ++k) {
    // Written so that a NaN is 0.
    colour[k] = rgb[k] > 0 ? std::min(rgb[k], 1.0F) : 0.0F;
  }
  std::size_t largest = colour[1] > colour[0] ? 1 : 0;
  largest = colour[2] > colour[largest] ? 2 : largest;
  const float value = colour[largest];
  const auto size = static_cast<std::size_t>(m_resolution);
  const auto last = static_cast<float>(m_resolution - 1);
  // Black is the darkest grey. The least denormals would overflow one over themselves.
  const bool isBlack = value < 1e-30F;
  const float first = isBlack ? last : colour[(largest + 1) % 3] * (last / value);
  const float second = isBlack ? last : colour[(largest + 2) % 3] * (last / value);
  const std::size_t i = std::min(static_cast<std::size_t>(first), size - 2);
  const std::size_t j = std::min(static_cast<std::size_t>(second), size - 2);
  const std::size_t k = lastNotAbove(m_axis, value);
  const float x = first - static_cast<float>(i);
  const float y = second - static_cast<float>(j);
  const float z = (value - m_axis[k]) / (m_axis[k + 1] - m_axis[k]);

  using Node = Eigen::Array4f;
  const float* const corner = &m_coefficients[4 * (((largest * size + k) * size + j) * size + i)];
  const auto node = [&](std::size_t dz, std::size_t dy, std::size_t dx) {
    return Eigen::Map<const Node>(corner + 4 * ((dz * size + dy) * size + dx));
  };
  const auto plane = [&](std::size_t dz) -> Node {
    return (1 - y) * ((1 - x) * node(dz, 0, 0) + x * node(dz, 0, 1)) +
           y * ((1 - x) * node(dz, 1, 0) + x * node(dz, 1, 1));
  };
  const Node found = (1 - z) * plane(0) + z * plane(1);
  return {found[0], found[1], found[2]};
}

std::unique_ptr<Uplift> makeJakobTable(const DataLibrary& library, const std::optional<UpliftWeights>& weights) {
  const UpliftWeights used = upliftWeightsOr(weights, library, JakobSolver::wavelengthsNm());
  return std::make_unique<JakobByTable>(library, used, upliftXyzFromRgb(library, used));
}

}  // namespace metamer::spectral
