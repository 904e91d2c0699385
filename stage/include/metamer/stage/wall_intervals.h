// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "metamer/stage/rgb_wall.h"

namespace metamer::stage {

/// Noise of captured values: standard deviation sqrt((relative * value)^2 + floor^2), normal, independent.
struct CaptureNoise {
  double relative = 0;  ///< 0 ... 1
  double floor = 0;     ///< in the camera's unit, 0 or more
};

/// Runs body(0) ... body(count - 1), in any order, on any thread.
using RunAll = std::function<void(int count, const std::function<void(int)>& body)>;

struct IntervalOptions {
  CaptureNoise noise;
  int samples = 500;  ///< 20 ... 100'000
  std::uint64_t seed = 1;
  bool choosesBound = false;  ///< whether N's bound is chosen; else it is the wall's option
  /// The environment's white is this patch of the target over `whiteReflectance`; -1: captured by itself.
  int whitePatch = -1;
  double whiteReflectance = 1;
  /// For colour differences, as chartDifferences() takes them; the white patch (or -1) sets the exposure before Q.
  Eigen::Matrix3d xyzFromCamera = Eigen::Matrix3d::Identity();
  Eigen::Vector3d whiteRgb = Eigen::Vector3d::Ones();
  int exposurePatch = -1;
  RunAll runAll;  ///< empty: one after another. Results do not depend on it
};

/// Lower and upper ends: 2.5 % of the samples lie below, 2.5 % above.
template <typename Value>
struct Interval {
  Value low;
  Value high;
};

/// @param values  at least one, in any order; linear between neighbours
Interval<double> endsOf(std::vector<double> values);

/// Ends for what noise makes larger, as it does the length of a difference: squares grow by the noise's, by as much in
/// the draws over the centre as in the centre over the truth. So that is taken from the ends' squares twice.
/// @param values  at least one, of draws
/// @param centre  of what was drawn from
Interval<double> loweredEnds(std::vector<double> values, double centre);

struct WallIntervals {
  int samples = 0;
  Interval<Eigen::Matrix3d> wallFromContent;      ///< M
  Interval<Eigen::Matrix3d> correctedFromCamera;  ///< Q
  Interval<Eigen::Matrix3d> frustumFromContent;   ///< N, with its bound
  Interval<Eigen::Vector3d> environmentDrive;
  Interval<double> meanBefore;  ///< mean CIEDE2000 with M alone
  Interval<double> meanAfter;   ///< with M and Q
  Interval<double> maxAfter;
  double largestCondition = 0;  ///< the bound of N that was chosen, or given
  bool boundIsChosen = false;   ///< lower than the one that was given
  double frustumError = 0;      ///< root mean square over the samples of |Q [SL] N - 1|, largest singular value
};

/// A standard normal number that depends on its three arguments alone: counter-based, so samples can be made in any
/// order. (SplitMix64's finaliser, Steele et al. 2014, and Box and Muller's transform.)
double normalNumber(std::uint64_t seed, std::uint64_t sample, std::uint64_t place);

/// A capture with another draw of the noise on all that was captured: primaries, charts, target, the environment's
/// white.
WallCapture noisyCapture(const WallCapture& capture, const IntervalOptions& options, std::uint64_t sample);

/// 95 % intervals of a wall's solution by Monte Carlo: each sample is the capture with noise once more, solved. Noise
/// biases two things, and the draws have it twice. It makes Q smaller where the chart's colours are weak in the wall's
/// light: draws of Q and N are freed of that. It raises colour differences: their ends are lowered (loweredEnds), or,
/// before Q, turned round the solution's own (Davison and Hinkley 1997, basic bootstrap); not below 0.
///
/// Where asked, the bound of N is the smallest of kTradeOffLimits and `walls.largestCondition` whose in-frustum error
/// over the samples is within 5 % of the least: less would lose colours that are known, more would show noise.
/// @throws spectral::InputError for options out of their range, and as solveWall
WallIntervals wallIntervals(const WallCapture& capture, const WallOptions& walls, const IntervalOptions& options);

}  // namespace metamer::stage
