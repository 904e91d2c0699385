// SPDX-License-Identifier: Apache-2.0
#include "chain/signed_log.h"

#include <cmath>

namespace metamer::ocio {
namespace {

const double kDarkest = 0.18 * std::exp2(-kChainStops);
/// A camera log is a straight line below its break: one that lies beyond all values gives the identity.
constexpr double kBeyond = 1048576.0;
constexpr double kStopsOfBeyond = 20.0;
/// Of the first logarithm's results, undone right after it; a power of two, so that no bit changes. Without it the
/// straight line's slope is above 1e9, which OpenColorIO (to 2.6) writes into shaders as "2.15150285e+09.": no compiler
/// takes that.
constexpr double kFirstScale = 0.125;

/// Which channels a logarithm is for; the others stay as they are.
enum class Channels { Third, All };

/// log2(value / at) + kSignedLogToe above `at`, a straight line through zero below, which meets it smoothly; `times`
/// that.
OCIO::LogCameraTransformRcPtr logAbove(double at, Channels channels, OCIO::TransformDirection direction,
                                       double times = 1.0) {
  const auto perChannel = [&](double identity, double log, double(&values)[3]) {
    values[0] = values[1] = channels == Channels::All ? log : identity;
    values[2] = log;
  };
  double breaks[3];
  double offsets[3];
  double slopes[3];
  double logSlopes[3];
  perChannel(kBeyond, at, breaks);
  perChannel(kBeyond - kStopsOfBeyond, times * (kSignedLogToe - std::log2(at)), offsets);
  perChannel(1.0, times * kSignedLogToe / at, slopes);
  perChannel(1.0, times, logSlopes);
  auto log = OCIO::LogCameraTransform::Create(breaks);
  log->setBase(2.0);
  log->setLogSideSlopeValue(logSlopes);
  log->setLogSideOffsetValue(offsets);
  log->setLinearSlopeValue(slopes);
  log->setDirection(direction);
  return log;
}

/// One factor for the first two channels, another and an offset for the third.
OCIO::MatrixTransformRcPtr scale(double others, double third, double offset = 0.0) {
  const double values[16] = {others, 0, 0, 0, 0, others, 0, 0, 0, 0, third, 0, 0, 0, 0, 1};
  const double offsets[4] = {0, 0, offset, 0};
  auto matrix = OCIO::MatrixTransform::Create();
  matrix->setMatrix(values);
  matrix->setOffset(offsets);
  return matrix;
}

}  // namespace

double signedLog(double value) {
  const double size = std::abs(value);
  const double log = size > kDarkest ? std::log2(size / kDarkest) + kSignedLogToe : kSignedLogToe * size / kDarkest;
  return std::copysign(log, value);
}

double signedExponential(double log) {
  const double size = std::abs(log);
  const double value =
      size > kSignedLogToe ? kDarkest * std::exp2(size - kSignedLogToe) : kDarkest * size / kSignedLogToe;
  return std::copysign(value, log);
}

OCIO::GroupTransformRcPtr signedLogOfThird() {
  auto group = OCIO::GroupTransform::Create();
  // The first takes what is above zero, and carries the rest far below; the second, on the negative, takes that rest
  // and carries the first's logarithms on as they are.
  group->appendTransform(logAbove(kDarkest, Channels::Third, OCIO::TRANSFORM_DIR_FORWARD, kFirstScale));
  group->appendTransform(scale(1.0, -1.0 / kFirstScale));
  group->appendTransform(logAbove(kSignedLogToe, Channels::Third, OCIO::TRANSFORM_DIR_FORWARD));
  group->appendTransform(scale(1.0, -0.5 / kMostSignedLog, 0.5));
  return group;
}

OCIO::GroupTransformRcPtr signedExponentialOfAll() {
  auto group = OCIO::GroupTransform::Create();
  group->appendTransform(scale(-1.0, -1.0));
  group->appendTransform(logAbove(kSignedLogToe, Channels::All, OCIO::TRANSFORM_DIR_INVERSE));
  group->appendTransform(scale(-1.0, -1.0));
  group->appendTransform(logAbove(kDarkest, Channels::All, OCIO::TRANSFORM_DIR_INVERSE));
  return group;
}

}  // namespace metamer::ocio
