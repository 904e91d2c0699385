// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_estimator.h"

#include <Eigen/Dense>
#include <cmath>

#include "colours/brightness.h"
#include "colours/in_parallel.h"
#include "colours/pixel_checks.h"
#include "inverse/most_probable.h"

namespace metamer::skin {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// The table's axes: (R - G) and (B - G) over the mean of the three, and the logarithm of that mean.
constexpr int kAlongChroma = 25;
constexpr int kAlongBrightness = 21;
constexpr int kStartKnot = 13;
/// The table's chromaticities are those of skins of so many times the prior's deviations.
constexpr double kWidening = 2;
constexpr int kWideningDraws = 2000;
/// Where even the nearest knots are further apart than that, the view sees no colour along an axis.
constexpr double kNarrowest = 1e-3;

struct Place {
  Eigen::Array3d at;  ///< in knots
  double gain = 1;
};

/// The chromaticity and the brightness's logarithm of a colour of positive mean.
Eigen::Array3d placeOf(const Vector3d& rgb, double mean) {
  return {(rgb[0] - rgb[1]) / mean, (rgb[2] - rgb[1]) / mean, std::log(mean)};
}

}  // namespace

struct SkinEstimator::State {
  SkinColours colours;
  MostProbable mostProbable;
  Eigen::Array3d start;
  Eigen::Array3d scale;
  std::vector<Eigen::Array<float, 5, 1>> knots;  ///< coordinates, by the three axes

  State(const spectral::DataLibrary& library, const SkinView& view)
      : colours(library, view),
        mostProbable(colours.prior(), [this](const SkinCoordinates& at) { return colours.rgb(skinOf(at)); }) {}

  void layAxes() {
    SkinPrior wide = colours.prior();
    wide.standardDeviation *= kWidening;
    Eigen::Array3d low = Eigen::Array3d::Constant(INFINITY);
    Eigen::Array3d high = -low;
    for (const SkinParameters& skin : sampleSkins(wide, kWideningDraws, 1)) {
      const Vector3d rgb = colours.rgb(skin);
      // Cameras' matrices may leave a dark skin without brightness.
      if (rgb.mean() > 0) {
        low = low.min(placeOf(rgb, rgb.mean()));
        high = high.max(placeOf(rgb, rgb.mean()));
      }
    }
    low[2] = std::log(kDarkest);
    high[2] = std::log(kBrightest);
    start = low;
    scale = Eigen::Array3d(kAlongChroma - 1, kAlongChroma - 1, kAlongBrightness - 1) / (high - low).max(kNarrowest);
  }

  Vector3d colourAt(int first, int second, int brightness) const {
    const Eigen::Array3d at = start + Eigen::Array3d(first, second, brightness) / scale;
    const double mean = std::exp(at[2]);
    // (R - G), (B - G) and the mean as R, G and B.
    const double green = 1 - (at[0] + at[1]) / 3;
    return mean * Vector3d(at[0] + green, green, at[1] + green);
  }

  std::size_t knot(int first, int second, int brightness) const {
    return static_cast<std::size_t>((first * kAlongChroma + second) * kAlongBrightness + brightness);
  }

  void solveColumn(int first, int second) {
    SkinCoordinates middle = mostProbable.of(colourAt(first, second, kStartKnot), colours.prior().mean);
    for (const int direction : {1, -1}) {
      SkinCoordinates at = middle;
      for (int i = direction > 0 ? kStartKnot : kStartKnot - 1; i >= 0 && i < kAlongBrightness; i += direction) {
        at = mostProbable.of(colourAt(first, second, i), at);
        knots[knot(first, second, i)] = at.cast<float>().array();
      }
    }
  }

  void solve(int threads) {
    layAxes();
    constexpr std::size_t kColumns = static_cast<std::size_t>(kAlongChroma) * kAlongChroma;
    knots.resize(kColumns * kAlongBrightness);
    inParallel(kColumns, threads, [this](std::size_t begin, std::size_t end) {
      for (std::size_t column = begin; column < end; ++column) {
        solveColumn(static_cast<int>(column / kAlongChroma), static_cast<int>(column % kAlongChroma));
      }
    });
  }

  /// Of a colour of positive mean.
  Place place(const Vector3d& rgb, double mean) const {
    Place result;
    const Eigen::Array3d most(kAlongChroma - 1, kAlongChroma - 1, kAlongBrightness - 1);
    result.at = ((placeOf(rgb, mean) - start) * scale).max(0).min(most);
    result.gain = gainOf(mean);
    return result;
  }

  SkinCoordinates read(const Eigen::Array3d& at) const {
    const int i = std::min(static_cast<int>(at[0]), kAlongChroma - 2);
    const int j = std::min(static_cast<int>(at[1]), kAlongChroma - 2);
    const int k = std::min(static_cast<int>(at[2]), kAlongBrightness - 2);
    const auto a = static_cast<float>(at[0] - i);
    const auto b = static_cast<float>(at[1] - j);
    const auto c = static_cast<float>(at[2] - k);
    const auto along = [&](int x, int y) {
      const auto* const here = &knots[knot(i + x, j + y, k)];
      return Eigen::Array<float, 5, 1>(here[0] + c * (here[1] - here[0]));
    };
    const Eigen::Array<float, 5, 1> near = along(0, 0) + b * (along(0, 1) - along(0, 0));
    const Eigen::Array<float, 5, 1> far = along(1, 0) + b * (along(1, 1) - along(1, 0));
    return (near + a * (far - near)).cast<double>().matrix();
  }
};

SkinEstimator::SkinEstimator(const spectral::DataLibrary& library, const SkinView& view, int threads) {
  requireThreads(threads);
  const auto state = std::make_shared<State>(library, view);
  state->solve(threads);
  m_state = state;
}

SkinPixel SkinEstimator::estimate(const Vector3f& rgb) const {
  const Vector3d colour = rgb.cast<double>();
  const double mean = colour.mean();
  if (!canBeSkin(colour)) {
    return m_state->colours.pixel(skinOf(m_state->colours.prior().mean), 0, rgb);
  }
  const Place place = m_state->place(colour, mean);
  return m_state->colours.pixel(skinOf(m_state->read(place.at)), place.gain, rgb);
}

void SkinEstimator::estimate(std::span<const float> rgb, std::span<SkinPixel> pixels, int threads) const {
  requireThree(rgb.size(), pixels.size());
  requireThreads(threads);
  inParallel(pixels.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      pixels[i] = estimate(Vector3f(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]));
    }
  });
}

const SkinColours& SkinEstimator::colours() const {
  return m_state->colours;
}

SkinIdentification SkinEstimator::identification() const {
  const State& state = *m_state;
  const SkinCoordinates at = state.colours.prior().mean;
  const Vector3d colour = state.colours.rgb(skinOf(at));
  const MostProbable::Jacobian slope = state.mostProbable.slope(at, colour) / (kColourNoise * colour.mean());
  const Eigen::Matrix<double, 5, 5> known = (slope.transpose() * slope + state.mostProbable.precision()).inverse();
  const Eigen::Matrix<double, 5, 5> before = state.colours.prior().covariance();
  SkinIdentification result;
  for (Eigen::Index i = 0; i < 5; ++i) {
    result.explained[static_cast<std::size_t>(i)] = 1 - known(i, i) / before(i, i);
  }
  result.melaninAgainstBlood = known(0, 1) / std::sqrt(known(0, 0) * known(1, 1));
  constexpr double kExplained = 0.5;
  result.separatesBloodFromMelanin = result.explained[0] > kExplained && result.explained[1] > kExplained;
  return result;
}

SkinChromaticities SkinEstimator::chromaticities() const {
  const Eigen::Array2d low = m_state->start.head<2>();
  return {low, low + (kAlongChroma - 1) / m_state->scale.head<2>(), kAlongChroma};
}

SkinPixel SkinEstimator::estimateBySolving(const Vector3d& rgb) const {
  const double mean = rgb.mean();
  const Vector3f given = rgb.cast<float>();
  if (!canBeSkin(rgb)) {
    return m_state->colours.pixel(skinOf(m_state->colours.prior().mean), 0, given);
  }
  const double gain = gainOf(mean);
  const SkinCoordinates found = m_state->mostProbable.of(rgb / gain, m_state->colours.prior().mean);
  return m_state->colours.pixel(skinOf(found), gain, given);
}

}  // namespace metamer::skin
