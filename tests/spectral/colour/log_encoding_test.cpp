// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/log_encoding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "metamer/spectral/log_pieces.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

LogEncoding encodingNamed(const std::string& name) {
  for (const LogEncoding encoding : allLogEncodings()) {
    if (nameOf(encoding) == name) {
      return encoding;
    }
  }
  ADD_FAILURE() << name;
  return LogEncoding::AcesCct;
}

TEST(LogEncodingTest, EqualsColourScience) {
  // The makers print six digits, so that their two parts miss each other by up to 8e-7 at the cut (LogC3); ours are
  // joined. Decoded light is compared relative to its size above 1, since an error of the signal grows with it.
  std::map<std::string, std::unique_ptr<MaxDifference>> differences;
  for (const FixtureRow& row : readFixture("log_encodings.csv")) {
    auto& difference = differences[row.text(0) + " " + row.text(1)];
    if (!difference) {
      difference = std::make_unique<MaxDifference>("log curve " + row.text(0) + " " + row.text(1), 1e-6);
    }
    const LogEncoding encoding = encodingNamed(row.text(0));
    const double in = row.number(2);
    difference->addRelative(row.text(1) == "encode" ? encode(encoding, in) : decode(encoding, in), row.number(3));
  }
  EXPECT_EQ(differences.size(), 2 * allLogEncodings().size());
}

TEST(LogEncodingTest, MidGreyAsTheMakersPrintIt) {
  // Each to the digits of its source.
  EXPECT_NEAR(encode(LogEncoding::AcesCct, 0.18), 0.4135884, 5e-8);
  EXPECT_NEAR(encode(LogEncoding::LogC3, 0.18), 0.391007, 5e-7);
  EXPECT_NEAR(encode(LogEncoding::LogC4, 0.18), 0.278396, 5e-7);
  EXPECT_NEAR(encode(LogEncoding::SLog3, 0.18), 420.0 / 1023.0, 1e-12);
  EXPECT_NEAR(encode(LogEncoding::VLog, 0.18) * 1023, 433, 0.5);
  EXPECT_NEAR(encode(LogEncoding::Log3G10, 0.18), 1.0 / 3.0, 5e-6);
  EXPECT_NEAR(encode(LogEncoding::CanonLog2, 0.18), 0.398254692, 5e-9);
  EXPECT_NEAR(encode(LogEncoding::CanonLog3, 0.18), 0.343389, 5e-7);
  EXPECT_NEAR(encode(LogEncoding::DaVinciIntermediate, 0.18), 0.336043, 5e-7);
}

TEST(LogEncodingTest, StrictlyRisingAndContinuousOnTheWholeLine) {
  for (const LogEncoding encoding : allLogEncodings()) {
    double before = encode(encoding, -2.0);
    for (int i = -19999; i <= 20000; ++i) {
      const double signal = encode(encoding, i * 1e-4);
      ASSERT_GT(signal, before) << nameOf(encoding) << " at " << i * 1e-4;
      // The steepest curve, Log3G10 below zero, rises by 1.6e-3 in a step.
      ASSERT_LT(signal - before, 2e-3) << nameOf(encoding) << " at " << i * 1e-4;
      before = signal;
    }
    for (const double extreme : {-1e30, -65504.0, 65504.0, 1e30}) {
      EXPECT_TRUE(std::isfinite(encode(encoding, extreme))) << nameOf(encoding);
    }
  }
}

TEST(LogEncodingTest, NoJumpAtTheCuts) {
  const std::map<LogEncoding, std::vector<double>> cuts{{LogEncoding::AcesCct, {0.0078125}},
                                                        {LogEncoding::LogC3, {0.010591}},
                                                        {LogEncoding::LogC4, {-0.0180570}},
                                                        {LogEncoding::SLog3, {0.01125}},
                                                        {LogEncoding::VLog, {0.01}},
                                                        {LogEncoding::Log3G10, {-0.01}},
                                                        {LogEncoding::CanonLog2, {0.0}},
                                                        {LogEncoding::CanonLog3, {0.9 * 0.014, -0.9 * 0.014}},
                                                        {LogEncoding::DaVinciIntermediate, {0.00262409}}};
  for (const auto& [encoding, places] : cuts) {
    for (const double cut : places) {
      const double step = 1e-12;
      // The steepest slope is 23 (Canon Log 2 at 0): 5e-11 over the two steps; the makers' jumps are above 1e-9.
      EXPECT_NEAR(encode(encoding, cut - step), encode(encoding, cut + step), 1e-10) << nameOf(encoding);
    }
  }
}

TEST(LogEncodingTest, DecodeUndoesEncode) {
  MaxDifference difference("log curve round trip", 1e-12);  // log and power of double numbers
  for (const LogEncoding encoding : allLogEncodings()) {
    for (int i = -4000; i <= 4000; ++i) {
      const double linear = i * 0.015;
      difference.addRelative(decode(encoding, encode(encoding, linear)), linear);
    }
  }
}

TEST(LogEncodingTest, AllInTheOrderOfTheEnumeration) {
  ASSERT_EQ(allLogEncodings().size(), 9U);
  for (std::size_t i = 0; i < allLogEncodings().size(); ++i) {
    EXPECT_EQ(static_cast<std::size_t>(allLogEncodings()[i]), i);
  }
}

TEST(LogEncodingTest, PiecesAreTheCurve) {
  const auto encoded = [](const LogPieces& p, double light) {
    const auto logarithm = [&](const LogPieces::Logarithm& l) {
      return l.scale * std::log10(l.gain * light + l.shift) + l.offset;
    };
    return light >= p.lightAbove  ? logarithm(p.above)
           : light < p.lightBelow ? logarithm(p.below)
                                  : p.signalAbove + p.slope * (light - p.lightAbove);
  };
  const auto decoded = [](const LogPieces& p, double signal) {
    const auto exponential = [&](const LogPieces::Logarithm& l) {
      return (std::pow(10.0, (signal - l.offset) / l.scale) - l.shift) / l.gain;
    };
    return signal >= p.signalAbove  ? exponential(p.above)
           : signal < p.signalBelow ? exponential(p.below)
                                    : p.lightAbove + (signal - p.signalAbove) / p.slope;
  };
  for (const LogEncoding encoding : allLogEncodings()) {
    const LogPieces pieces = piecesOf(encoding);
    for (int i = -3000; i <= 3000; ++i) {
      const double signal = i * 1.0007e-3;
      const double light = decode(encoding, signal);
      // A step of a double at 3, through the steepest of the curves.
      EXPECT_NEAR(decoded(pieces, signal), light, 1e-13 * std::max(std::abs(light), 1.0)) << nameOf(encoding);
      EXPECT_NEAR(encoded(pieces, light), encode(encoding, light), 1e-14) << nameOf(encoding) << " at " << light;
    }
  }
}

}  // namespace
}  // namespace metamer::spectral
