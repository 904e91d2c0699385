// SPDX-License-Identifier: Apache-2.0
#include "chain/chromaticity_plane.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace metamer::ocio {
namespace {

/// Least cosine between a colour and the plane's axis: below it the plane would be stretched beyond use.
constexpr double kLeastCosine = 0.02;
/// Axes tried, on white-normalised responses.
constexpr std::array<std::array<double, 3>, 4> kAxes = {{{1, 1, 1}, {1, 2, 1}, {1, 1, 0.5}, {1, 1, 2}}};
/// A cosine that is worth turning the axis for.
constexpr double kGoodCosine = 0.15;
/// Part of the unit square left free on every side.
constexpr double kMargin = 0.004;
/// Directions tried for the sides of the parallelogram that becomes the unit square.
constexpr int kSideDirections = 360;

/// Colours all over a cone: blends of white with the points of its border.
std::vector<Eigen::Vector3d> spread(const std::vector<Eigen::Vector3d>& corners) {
  constexpr int kRings = 12;
  std::vector<Eigen::Vector3d> colours;
  const Eigen::Vector3d white = Eigen::Vector3d::Ones().normalized();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d side = corners[i].normalized() + corners[(i + 1) % corners.size()].normalized();
    for (int ring = 0; ring <= kRings; ++ring) {
      const double t = static_cast<double>(ring) / kRings;
      colours.push_back((1.0 - t) * white + t * side.normalized());
    }
  }
  return colours;
}

/// The axis of the narrowest circular cone round all directions (Badoiu and Clarkson's step toward the farthest).
Eigen::Vector3d narrowestConeAxis(const std::vector<Eigen::Vector3d>& directions) {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  for (const auto& direction : directions) {
    axis += direction.normalized();
  }
  axis.normalize();
  for (int step = 1; step <= 2000; ++step) {
    const auto farthest = std::min_element(directions.begin(), directions.end(), [&](const auto& p, const auto& q) {
      return axis.dot(p) * q.norm() < axis.dot(q) * p.norm();
    });
    axis = (axis + (farthest->normalized() - axis) / (step + 1.0)).normalized();
  }
  return axis;
}

double leastCosine(const Eigen::Vector3d& axis, const std::vector<Eigen::Vector3d>& directions) {
  double least = 1.0;
  for (const auto& direction : directions) {
    if (!direction.isZero(0.0)) {
      least = std::min(least, axis.dot(direction) / (axis.norm() * direction.norm()));
    }
  }
  return least;
}

struct Side {
  Eigen::Vector2d normal;
  double low = 0;
  double width = 0;
  double straight = 0;  ///< length of the border that runs along either side
};

Side sideAcross(const std::vector<Eigen::Vector2d>& points, double angle) {
  constexpr double kNear = 0.01;
  Side side{{std::cos(angle), std::sin(angle)}, std::numeric_limits<double>::infinity(), 0.0, 0.0};
  double high = -side.low;
  for (const auto& point : points) {
    side.low = std::min(side.low, side.normal.dot(point));
    high = std::max(high, side.normal.dot(point));
  }
  side.width = high - side.low;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d& from = points[i];
    const Eigen::Vector2d& to = points[(i + 1) % points.size()];
    const auto isNear = [&](const Eigen::Vector2d& point) {
      const double at = (side.normal.dot(point) - side.low) / side.width;
      return at < kNear || at > 1.0 - kNear;
    };
    if (isNear(from) && isNear(to)) {
      side.straight += (to - from).norm();
    }
  }
  return side;
}

/// The parallelogram round a polygon that has most of the polygon's border along its sides, by its two pairs of sides:
/// what happens close to a straight border can then be resolved by nodes that crowd toward one side. For what can be
/// seen the straight borders are the line of purples and the line from green to red.
std::array<Side, 2> bestParallelogram(const std::vector<Eigen::Vector2d>& points) {
  std::vector<Side> sides;
  sides.reserve(kSideDirections);
  for (int i = 0; i < kSideDirections; ++i) {
    sides.push_back(sideAcross(points, std::numbers::pi * i / kSideDirections));
  }
  std::array<Side, 2> best{};
  double bestLength = -1.0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (std::size_t j = i + 1; j < sides.size(); ++j) {
      const double sine = sides[i].normal.x() * sides[j].normal.y() - sides[i].normal.y() * sides[j].normal.x();
      if (std::abs(sine) > 0.4 && sides[i].straight + sides[j].straight > bestLength) {
        bestLength = sides[i].straight + sides[j].straight;
        best = {sides[i], sides[j]};
      }
    }
  }
  return best;
}

/// A frame on white-normalised responses whose unit square holds a cone.
/// @param corners   of the cone, in order
/// @param axis      the sum s, positive on all colours
/// @param colours   all colours, on which p1 must be positive too
ChromaticityFrame squareFrame(const std::vector<Eigen::Vector3d>& corners, const Eigen::Vector3d& axis,
                              const std::vector<Eigen::Vector3d>& colours) {
  const Eigen::Vector3d first = axis.unitOrthogonal();
  const Eigen::Vector3d second = axis.normalized().cross(first);
  std::vector<Eigen::Vector2d> points;
  points.reserve(corners.size());
  for (const auto& corner : corners) {
    points.emplace_back(first.dot(corner) / axis.dot(corner), second.dot(corner) / axis.dot(corner));
  }
  std::array<Eigen::Vector3d, 2> rows;
  const auto sides = bestParallelogram(points);
  for (std::size_t k = 0; k < 2; ++k) {
    const Eigen::Vector3d along = sides[k].normal.x() * first + sides[k].normal.y() * second - sides[k].low * axis;
    rows[k] = along * ((1.0 - 2.0 * kMargin) / sides[k].width) + axis * kMargin;
  }
  double lowest = 0.0;
  for (const auto& colour : colours) {
    lowest = std::min(lowest, rows[1].dot(colour) / axis.dot(colour));
  }
  ChromaticityFrame frame;
  frame.offset = std::max(1.0, 0.5 - lowest);
  frame.fromRgb.row(0) = rows[0];
  frame.fromRgb.row(1) = rows[1] + frame.offset * axis;
  frame.fromRgb.row(2) = axis - rows[0] - rows[1] - frame.offset * axis;
  return frame;
}

}  // namespace

Eigen::Vector3d ChromaticityFrame::coordinates(const Eigen::Vector3d& rgb) const {
  const Eigen::Vector3d p = fromRgb * rgb;
  const double sum = p.sum();
  return {p[0] / sum, p[1] / sum - offset, p[1] > 0.0 ? std::log2(p[1]) : std::numeric_limits<double>::quiet_NaN()};
}

Eigen::Vector3d ChromaticityFrame::colour(const Eigen::Vector3d& coordinates) const {
  const double amount = std::exp2(coordinates[2]);
  const double sum = amount / (coordinates[1] + offset);
  const Eigen::Vector3d p(coordinates[0] * sum, amount, sum - coordinates[0] * sum - amount);
  return fromRgb.inverse() * p;
}

std::vector<ChromaticityPlane> chromaticityPlanes(const sip::TransformSpec& spec,
                                                  const sip::SpectralTransform& transform) {
  const sip::SpectralLocus locus(spec.standardObserver);
  const Eigen::Matrix3d responseFromRgb = transform.responseFromRgb();
  const Eigen::Matrix3d rgbFromResponse = responseFromRgb.inverse();
  std::vector<Eigen::Vector3d> corners;
  for (const Eigen::Vector2d& xy : locus.corners()) {
    corners.emplace_back(responseFromRgb * transform.space().rgbFromXyz() *
                         Eigen::Vector3d(xy.x(), xy.y(), 1.0 - xy.x() - xy.y()));
  }
  const std::vector<Eigen::Vector3d> in = spread(corners);
  std::vector<Eigen::Vector3d> out;
  out.reserve(in.size());
  for (const auto& response : in) {
    out.push_back(transform.apply(rgbFromResponse * response));
  }
  const Eigen::Vector3d white = Eigen::Vector3d::Ones();
  std::vector<ChromaticityPlane> planes;
  const auto add = [&](const ChromaticityFrame& input, const ChromaticityFrame& output) {
    ChromaticityPlane plane{input, output, {}, locus, transform.space().xyzFromRgb()};
    plane.input.fromRgb = input.fromRgb * responseFromRgb;
    plane.white = plane.input.coordinates(white).head<2>();
    planes.push_back(plane);
  };

  // One axis for both sides, what comes out being taken back through the matrix. The sum of white-normalised responses
  // spreads chromaticities as CIE xy does, which suits the eye; it is turned toward the axis of all colours as far as
  // it must be.
  const Eigen::FullPivLU<Eigen::Matrix3d> matrix(transform.linearMatrix());
  if (matrix.isInvertible()) {
    const Eigen::Matrix3d back = responseFromRgb * matrix.inverse();
    std::vector<Eigen::Vector3d> all = in;
    for (const auto& rgb : out) {
      all.push_back(back * rgb);
    }
    const Eigen::Vector3d narrowest = narrowestConeAxis(all);
    for (const auto& weights : kAxes) {
      const Eigen::Vector3d wanted = Eigen::Map<const Eigen::Vector3d>(weights.data()).normalized();
      Eigen::Vector3d axis = wanted;
      for (double turn = 0.125; turn <= 1.0 && leastCosine(axis, all) < kGoodCosine; turn += 0.125) {
        axis = (1.0 - turn) * wanted + turn * narrowest;
      }
      if (leastCosine(axis, all) >= kLeastCosine) {
        const ChromaticityFrame input = squareFrame(corners, axis, all);
        add(input, {input.fromRgb * back, input.offset});
      }
    }
  }
  // The two sides are too far apart for that: an axis each.
  if (planes.empty()) {
    add(squareFrame(corners, narrowestConeAxis(in), in), squareFrame(out, narrowestConeAxis(out), out));
  }
  return planes;
}

}  // namespace metamer::ocio
