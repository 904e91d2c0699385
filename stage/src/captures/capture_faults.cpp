// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/capture_faults.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "metamer/spectral/formatted.h"

namespace metamer::stage {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using spectral::formatted;
using Order = std::array<int, 3>;

constexpr Order kAsNamed = {0, 1, 2};
/// The other orders of three, exchanges of two first.
constexpr std::array<Order, 5> kOtherOrders = {Order{2, 1, 0}, Order{1, 0, 2}, Order{0, 2, 1}, Order{1, 2, 0},
                                               Order{2, 0, 1}};
constexpr std::array<const char*, 4> kCharts = {"red", "green", "blue", "target"};
constexpr std::array<const char*, 3> kColumns = {"R", "G", "B"};
/// A grey patch under a channel has that channel's colour to within this; another's is 20 degrees or more away.
constexpr double kSameColourDegrees = 8;
/// A white patch of unknown reflectance may be tinted.
constexpr double kSameColourUnknownDegrees = 14;
/// Two charts this near to one direction of their values are one light.
constexpr double kSameLight = 0.999;
/// Another order of the camera's channels must be this much likelier.
constexpr double kOrderMargin = 2;
constexpr double kCollinear = 1e4;
/// Reflectances of greys that count: darker ones are noise and flare.
constexpr double kDarkestGrey = 0.15;
/// Light of a patch over that of its primary, times beta: 1 but for how the panel's light spreads.
constexpr double kChannelsDiffer = 1.25;
constexpr double kExposuresDiffer = 1.35;
/// In the target, red's part of the spectrum this far below blue's is an exchange.
constexpr double kExchangedNm = 30;

double degreesBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
}

Vector3d reordered(const Vector3d& rgb, const Order& order) {
  return {rgb[order[0]], rgb[order[1]], rgb[order[2]]};
}

std::string chartField(std::size_t chart) {
  return std::string("charts.") + kCharts[chart];
}

/// "red and blue" for an exchange of two, "red, green and blue" for all three.
std::string movedNames(const Order& order, const std::array<const char*, 3>& names) {
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) {
    if (order[k] != static_cast<int>(k)) {
      text += (text.empty() ? "" : " and ") + std::string(names[k]);
    }
  }
  return text;
}

constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};

class Judge {
 public:
  Judge(const WallCapture& capture, const std::optional<ChartExpectation>& expectation, int whitePatch)
      : m_capture(capture),
        m_expectation(expectation),
        m_same(expectation ? kSameColourDegrees : kSameColourUnknownDegrees) {
    for (std::size_t c = 0; c < 4; ++c) {
      const Matrix3Xd& rgb = chart(c);
      if (expectation && hasGreys()) {
        m_grey[c] = greyOf(rgb);
      } else if (whitePatch >= 0) {
        m_grey[c] = rgb.col(whitePatch);
      }
    }
  }

  std::vector<CaptureFault> faults() {
    if (auto found = sameCaptures(); !found.empty()) {
      return found;
    }
    std::vector<CaptureFault> found;
    if (m_expectation) {
      for (std::size_t c = 0; c < 4; ++c) {
        const auto own = chartFaults(*m_expectation, chart(c), m_capture.patchNames, chartField(c));
        found.insert(found.end(), own.begin(), own.end());
      }
    }
    // Colours are told by greys and strongest channels: a chart in another order has other greys.
    if (found.empty() && m_grey[0].norm() > 0) {
      found = channelFaults();
    }
    return found;
  }

 private:
  const Matrix3Xd& chart(std::size_t c) const { return c < 3 ? m_capture.charts[c] : m_capture.target; }
  Vector3d primary(std::size_t k) const { return m_capture.cameraFromWall.col(static_cast<Eigen::Index>(k)); }

  bool hasGreys() const {
    return std::any_of(greys().begin(), greys().end(), [&](auto i) { return isLight(i); });
  }
  const std::vector<Eigen::Index>& greys() const { return m_expectation->greys; }
  bool isLight(Eigen::Index patch) const { return m_expectation->level[patch] > kDarkestGrey; }

  /// What a perfect reflector would show, from the greys.
  Vector3d greyOf(const Matrix3Xd& rgb) const {
    Vector3d sum = Vector3d::Zero();
    double weight = 0;
    for (const Eigen::Index patch : greys()) {
      if (isLight(patch)) {
        const double level = m_expectation->level[patch];
        sum += level * rgb.col(m_expectation->known[static_cast<std::size_t>(patch)]);
        weight += level * level;
      }
    }
    return sum / weight;
  }

  std::vector<CaptureFault> sameCaptures() const {
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        const double cosine = chart(a).cwiseProduct(chart(b)).sum() / (chart(a).norm() * chart(b).norm());
        if (cosine > kSameLight && chart(a).cols() >= static_cast<Eigen::Index>(kFewestKnownPatches)) {
          return {{chartField(b), "",
                   "shows the same light as " + chartField(a) + ": one capture was used twice; name the right file"}};
        }
      }
    }
    return {};
  }

  /// The order of the camera's channels that gives each primary its own; whatever the channels' gains are.
  Order orderOfPrimaries() const {
    const double least = 1e-6 * m_capture.cameraFromWall.maxCoeff();
    const auto likelihood = [&](const Order& order) {
      double product = 1;
      for (std::size_t k = 0; k < 3; ++k) {
        product *= std::max(least, m_capture.cameraFromWall(order[k], static_cast<Eigen::Index>(k))) / least;
      }
      return product;
    };
    Order best = kAsNamed;
    double most = kOrderMargin * likelihood(kAsNamed);
    for (const Order& order : kOtherOrders) {
      if (likelihood(order) > most) {
        most = likelihood(order);
        best = order;
      }
    }
    return best;
  }

  /// The middle of the wavelengths that explain a channel of a chart; not a number without an expectation or light.
  double wavelengthOf(const Matrix3Xd& rgb, Eigen::Index channel) const {
    const Eigen::VectorXd values = rgb(channel, m_expectation->known).transpose();
    const double top = values.maxCoeff();
    if (!(top > 0)) {
      return std::nan("");
    }
    const ChannelFit fit = fitChannel(m_expectation->bands, values, 1e3 * top);
    return fit.weights.dot(m_expectation->bandCentresNm) / fit.weights.sum();
  }

  /// The order in which the charts' lights are red, green and blue, by how materials look in them.
  Order orderOfLights() const {
    std::array<double, 3> nm{};
    for (std::size_t k = 0; k < 3; ++k) {
      Eigen::Index strongest = 0;
      chart(k).rowwise().sum().maxCoeff(&strongest);
      nm[k] = wavelengthOf(chart(k), strongest);
    }
    Order order = kAsNamed;
    if (std::isfinite(nm[0] + nm[1] + nm[2])) {
      std::sort(order.begin(), order.end(),
                [&](int a, int b) { return nm[static_cast<std::size_t>(a)] > nm[static_cast<std::size_t>(b)]; });
    }
    return order;
  }

  bool isPrimary(const Vector3d& grey, std::size_t k) const { return degreesBetween(grey, primary(k)) < m_same; }

  std::vector<CaptureFault> channelFaults() const {
    const Order primaries = orderOfPrimaries();
    const Order lights = m_expectation ? orderOfLights() : kAsNamed;
    if (isPrimary(m_grey[0], 0) && isPrimary(m_grey[1], 1) && isPrimary(m_grey[2], 2)) {
      if (primaries != kAsNamed) {
        return {namesFault(primaries, lights)};
      }
      auto found = exposureFaults();
      if (const auto target = targetFault()) {
        found.push_back(*target);
      }
      return found;
    }
    const bool namesAreRight = m_expectation && primaries == kAsNamed && lights == kAsNamed;
    if (namesAreRight) {
      if (const auto columns = columnsFault()) {
        return {*columns};
      }
    }
    if (const auto files = filesFault(primaries)) {
      return {*files};
    }
    if (const auto columns = columnsFault()) {
      return {*columns};
    }
    return strayFaults();
  }

  /// Primaries and charts agree with each other, not with their names.
  CaptureFault namesFault(const Order& primaries, const Order& lights) const {
    if (m_expectation && lights == kAsNamed) {
      return {"primaries", movedNames(primaries, kColumns),
              "are exchanged in all captures: the camera's columns stand in another order (BGR pictures?), as the "
              "charts' materials show; write R,G,B"};
    }
    return {"primaries", movedNames(primaries, kChannels),
            "have each other's names, and so have their charts: name each channel of the wall by its colour"};
  }

  /// Some files have each other's names.
  std::optional<CaptureFault> filesFault(const Order& primaries) const {
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        for (int c = 0; c < 4; ++c) {
          const std::array<std::size_t, 3> from = {static_cast<std::size_t>(a), static_cast<std::size_t>(b),
                                                   static_cast<std::size_t>(c)};
          const bool isOrder = a != b && b != c && a != c;
          if (!isOrder || !isPrimary(m_grey[from[0]], 0) || !isPrimary(m_grey[from[1]], 1) ||
              !isPrimary(m_grey[from[2]], 2)) {
            continue;
          }
          std::string moved;
          for (std::size_t k = 0; k < 3; ++k) {
            if (from[k] != k) {
              moved += (moved.empty() ? "" : " and ") + std::string(kChannels[k]);
            }
          }
          if (const bool withTarget = a == 3 || b == 3 || c == 3; withTarget) {
            return CaptureFault{"charts", moved + " and target",
                                "are exchanged: the target shows a channel of the wall alone; name each file's own "
                                "light"};
          }
          if (primaries != kAsNamed) {
            return CaptureFault{"primaries", moved,
                                "are exchanged, against the charts and the camera's channels; name each by its colour"};
          }
          return CaptureFault{"charts", moved, "are exchanged, against the primaries; name each file's own light"};
        }
      }
    }
    return std::nullopt;
  }

  /// Columns of some charts stand in another order.
  std::optional<CaptureFault> columnsFault() const {
    for (const Order& order : kOtherOrders) {
      bool explains = true;
      std::string charts;
      for (std::size_t k = 0; k < 3; ++k) {
        if (!isPrimary(m_grey[k], k)) {
          explains = explains && isPrimary(reordered(m_grey[k], order), k);
          charts += (charts.empty() ? "" : ", ") + chartField(k);
        }
      }
      if (explains) {
        return CaptureFault{
            charts, movedNames(order, kColumns),
            "are exchanged: with its columns in another order it has its primary's colour; write R,G,B"};
      }
    }
    return std::nullopt;
  }

  /// A chart under one channel has light that its primary has not.
  std::vector<CaptureFault> strayFaults() const {
    std::vector<CaptureFault> found;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!isPrimary(m_grey[k], k)) {
        found.push_back({chartField(k), formatted("%.0f degrees", degreesBetween(m_grey[k], primary(k))),
                         std::string("is how far its greys are from the colour of primaries.") + kChannels[k] +
                             ": other light falls on the chart, or the primary is another one; show one channel alone "
                             "in a dark room"});
      }
    }
    return found;
  }

  std::vector<CaptureFault> exposureFaults() const {
    if (!m_expectation || !hasGreys()) {
      return {};
    }
    Vector3d ratio;
    for (std::size_t k = 0; k < 3; ++k) {
      ratio[static_cast<Eigen::Index>(k)] = m_capture.beta * m_grey[k].dot(primary(k)) / primary(k).squaredNorm();
    }
    std::array<double, 3> sorted = {ratio[0], ratio[1], ratio[2]};
    std::sort(sorted.begin(), sorted.end());
    const double middle = sorted[1];
    const Vector3d off = (ratio / middle).array().log().abs();
    Eigen::Index worst = 0;
    if (!(middle > 0) || !off.allFinite()) {
      return {};
    }
    if (sorted[2] > kChannelsDiffer * sorted[0]) {
      off.maxCoeff(&worst);
      const std::string name = kChannels[static_cast<std::size_t>(worst)];
      const double stops = std::log2(ratio[worst] / middle);
      return {{"primaries." + name, formatted("%+.2f stops", -stops),
               "is how its exposure differs from that of charts." + name +
                   ", against the other channels; shoot all primaries and charts at one exposure and full drive"}};
    }
    if (middle > kExposuresDiffer || middle < 1 / kExposuresDiffer) {
      return {{"primaries", formatted("%+.2f stops", -std::log2(middle)),
               "is how their exposure differs from the charts', by the size of calibration_square; shoot both at one "
               "exposure, or correct the square"}};
    }
    return {};
  }

  /// The target's columns, by the wavelengths that explain them.
  std::optional<CaptureFault> targetFault() const {
    if (!m_expectation) {
      return std::nullopt;
    }
    const double red = wavelengthOf(m_capture.target, 0);
    const double blue = wavelengthOf(m_capture.target, 2);
    if (!(red < blue - kExchangedNm)) {
      return std::nullopt;
    }
    return CaptureFault{
        chartField(3), "R and B",
        formatted("are exchanged: materials look in R as at %.0f nm and in B as at %.0f nm; write R,G,B", red, blue)};
  }

  const WallCapture& m_capture;
  const std::optional<ChartExpectation>& m_expectation;
  double m_same;
  std::array<Vector3d, 4> m_grey = {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()};
};

bool canBeSolved(const WallCapture& capture) {
  if (capture.target.cols() == 0 || !(capture.target.maxCoeff() > 0) || !capture.cameraFromWall.allFinite()) {
    return false;
  }
  for (const Matrix3Xd& chart : capture.charts) {
    if (chart.cols() != capture.target.cols() || !(chart.maxCoeff() > 0)) {
      return false;
    }
  }
  const Vector3d sizes = Eigen::JacobiSVD<Matrix3d>(capture.cameraFromWall).singularValues();
  return sizes[0] < kCollinear * sizes[2];
}

}  // namespace

std::vector<CaptureFault> captureFaults(const WallCapture& capture, const std::optional<ChartExpectation>& expectation,
                                        int whitePatch) {
  if (!canBeSolved(capture)) {
    return {};
  }
  return Judge(capture, expectation, whitePatch).faults();
}

}  // namespace metamer::stage
