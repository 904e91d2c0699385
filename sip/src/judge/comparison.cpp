// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "metamer/sip/colour_differences.h"
#include "metamer/sip/probe_limits.h"
#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/quantile.h"

namespace metamer::sip {
namespace {

constexpr double kMiddle = 0.18;

/// Pairs of colours at an exposure, gathered to be judged together.
class JudgedPairs {
 public:
  explicit JudgedPairs(const spectral::RgbSpace& space)
      : m_xyzFromRgb(space.xyzFromRgb()), m_white(space.whiteXyz()), m_differences(m_xyzFromRgb, m_white) {}

  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double exposure) {
    const auto isSame = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
    m_areEqual.push_back(isSame(a[0], b[0]) && isSame(a[1], b[1]) && isSame(a[2], b[2]));
    m_lab.push_back(spectral::lab(m_xyzFromRgb * a / exposure, m_white));
    m_rgb.emplace_back(b / exposure);
  }

  /// CIEDE2000 of each; nothing between equal ones, numbers or not.
  std::vector<double> errors() const {
    std::vector<double> errors(m_lab.size());
    m_differences.measure(m_lab, m_rgb, errors);
    for (std::size_t i = 0; i < errors.size(); ++i) {
      errors[i] = m_areEqual[i] ? 0.0 : errors[i];
    }
    return errors;
  }
  double luminance(const Eigen::Vector3d& rgb) const { return m_xyzFromRgb.row(1).dot(rgb); }

 private:
  Eigen::Matrix3d m_xyzFromRgb;
  Eigen::Vector3d m_white;
  ColourDifferences m_differences;
  std::vector<bool> m_areEqual;
  std::vector<Eigen::Vector3d> m_lab;
  std::vector<Eigen::Vector3d> m_rgb;
};

Eigen::Vector3d pixelAt(std::span<const float> rgba, std::size_t index) {
  return Eigen::Map<const Eigen::Vector3f>(rgba.data() + 4 * index).cast<double>();
}

/// The colours, each with the difference of the pair that was added with it.
std::vector<ComparedColour> judged(std::vector<ComparedColour> colours, const JudgedPairs& pairs) {
  const std::vector<double> errors = pairs.errors();
  for (std::size_t i = 0; i < colours.size(); ++i) {
    colours[i].deltaE = errors[i];
  }
  return colours;
}

}  // namespace

Comparison summarise(std::vector<ComparedColour> colours) {
  Comparison result;
  result.colours = std::move(colours);
  if (result.colours.empty()) {
    return result;
  }
  std::vector<double> errors;
  errors.reserve(result.colours.size());
  for (std::size_t i = 0; i < result.colours.size(); ++i) {
    const double error = result.colours[i].deltaE;
    errors.push_back(error);
    result.mean += error;
    if (error > result.colours[result.worst].deltaE) {
      result.worst = i;
    }
  }
  result.max = result.colours[result.worst].deltaE;
  result.mean /= static_cast<double>(errors.size());
  result.p99 = spectral::quantile(std::move(errors), 0.99);
  return result;
}

Comparison compareTransforms(const spectral::RgbSpace& space, const std::vector<ErrorProtocol::Probe>& probes,
                             int lowestStop, int highestStop, const std::function<void(std::span<float>)>& a,
                             const std::function<void(std::span<float>)>& b, double largestComponent) {
  spectral::requireWithin("lowest stop", lowestStop, -kMostStops, highestStop);
  spectral::requireWithin("highest stop", highestStop, lowestStop, kMostStops);
  JudgedPairs pairs(space);
  std::vector<ComparedColour> colours;
  std::vector<float> in(4 * probes.size());
  for (int stop = lowestStop; stop <= highestStop; ++stop) {
    const double exposure = std::ldexp(1.0, stop);
    for (std::size_t i = 0; i < probes.size(); ++i) {
      Eigen::Map<Eigen::Vector4f>(in.data() + 4 * i) << (exposure * probes[i].rgb).cast<float>(), 1.0F;
    }
    std::vector<float> byA = in;
    std::vector<float> byB = in;
    a(byA);
    b(byB);
    for (std::size_t i = 0; i < probes.size(); ++i) {
      if (exposure * probes[i].rgb.maxCoeff() > largestComponent) {
        continue;
      }
      colours.push_back({probes[i].name, exposure * probes[i].rgb, static_cast<double>(stop), 0.0});
      pairs.add(pixelAt(byA, i), pixelAt(byB, i), exposure);
    }
  }
  return summarise(judged(std::move(colours), pairs));
}

Comparison comparePixels(const spectral::RgbSpace& space, std::span<const float> a, std::span<const float> b,
                         int darkestStop) {
  spectral::requirePixels(static_cast<std::int64_t>(a.size()));
  spectral::requireAsMany("pixels of the second picture", static_cast<std::int64_t>(b.size()), "the first has",
                          static_cast<std::int64_t>(a.size()));
  JudgedPairs pairs(space);
  std::vector<ComparedColour> colours;
  colours.reserve(a.size() / 4);
  for (std::size_t i = 0; i < a.size() / 4; ++i) {
    const Eigen::Vector3d first = pixelAt(a, i);
    const Eigen::Vector3d second = pixelAt(b, i);
    const double relative = first.allFinite() ? pairs.luminance(first) / kMiddle : 1.0;
    const double exposure = std::max(relative, std::ldexp(1.0, darkestStop));
    colours.push_back({"", first, std::log2(exposure), 0.0});
    pairs.add(first, second, exposure);
  }
  return summarise(judged(std::move(colours), pairs));
}

}  // namespace metamer::sip
