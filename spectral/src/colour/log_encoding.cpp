// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/log_encoding.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "metamer/spectral/log_pieces.h"

// The makers print constants rounded to six or so digits, so that their linear and logarithmic parts miss each other by
// up to 1e-6 at the cut. Here the linear part starts at the value of the logarithmic part at the cut, with the maker's
// slope: continuous to the last bit, and within that rounding of the printed formula.
namespace metamer::spectral {
namespace {

constexpr double kNowhere = -std::numeric_limits<double>::infinity();

/// signal = c log10(a x + b) + d from the cut on; below it the straight line of the given slope.
struct LogWithLinearToe {
  double a, b, c, d, cut, toeSlope;

  double atCut() const { return c * std::log10(a * cut + b) + d; }
  double encode(double x) const { return x >= cut ? c * std::log10(a * x + b) + d : atCut() + toeSlope * (x - cut); }
  double decode(double signal) const {
    const double signalAtCut = atCut();
    return signal >= signalAtCut ? (std::pow(10.0, (signal - d) / c) - b) / a : cut + (signal - signalAtCut) / toeSlope;
  }
  LogPieces pieces() const { return {{a, b, c, d}, {}, cut, atCut(), kNowhere, kNowhere, toeSlope}; }
};

/// log10(2), for curves that their makers write in base 2.
constexpr double kLog10Of2 = 0.301029995663981195213738894724493027;

/// S-2014-003, ACEScct, section 4.4.2: (log2(x) + 9.72) / 17.52 above 2^-7; A = 10.5402377416545 below.
constexpr LogWithLinearToe kAcesCct{1.0, 0.0, 1.0 / (17.52 * kLog10Of2), 9.72 / 17.52, 0.0078125, 10.5402377416545};

/// ARRI, "ALEXA Log C Curve: Usage in VFX" (2017), table for EI 800, exposure values: cut, a, b, c, d, e.
constexpr LogWithLinearToe kLogC3{5.555556, 0.052272, 0.247190, 0.385537, 0.010591, 5.367655};

/// Sony, "Technical Summary for S-Gamut3.Cine/S-Log3 and S-Gamut3/S-Log3" (2014), in 10-bit codes:
/// 420 + 261.5 log10((x + 0.01) / 0.19) from 0.01125 on; below a line from code 95 to code 171.2102946929.
constexpr LogWithLinearToe kSLog3{1.0 / 0.19,     0.01 / 0.19, 261.5 / 1023.0,
                                  420.0 / 1023.0, 0.01125,     (171.2102946929 - 95.0) / 0.01125 / 1023.0};

/// Panasonic, "V-Log/V-Gamut Reference Manual" (2014): b, c, d, cut1; the line is 5.6 x + 0.125.
constexpr LogWithLinearToe kVLog{1.0, 0.00873, 0.241514, 0.598206, 0.01, 5.6};

/// RED, "White Paper on REDWideGamutRGB and Log3G10" (2018): 0.224282 log10(155.975327 (x + 0.01) + 1), slope 15.1927
/// below -0.01.
constexpr LogWithLinearToe kLog3G10{155.975327, 155.975327 * 0.01 + 1.0, 0.224282, 0.0, -0.01, 15.1927};

/// Blackmagic Design, "DaVinci Wide Gamut Intermediate" (2021): DI_C (log2(x + DI_A) + DI_B) above DI_LIN_CUT,
/// DI_M x below.
constexpr LogWithLinearToe kDaVinciIntermediate{1.0,        0.0075,     0.07329248 / kLog10Of2, 0.07329248 * 7.0,
                                                0.00262409, 10.44426855};

/// ARRI, "ARRI LogC4 Logarithmic Color Space Specification" (2022), section 3: the constants are defined by formulas,
/// and the line is the tangent at signal 0.
struct LogC4 {
  static constexpr double kA = (262144.0 - 16.0) / 117.45;
  static constexpr double kB = (1023.0 - 95.0) / 1023.0;
  static constexpr double kC = 95.0 / 1023.0;

  static double slope() { return 7.0 * std::log(2.0) * std::exp2(7.0 - 14.0 * kC / kB) / (kA * kB); }
  static double cut() { return (std::exp2(14.0 * (-kC / kB) + 6.0) - 64.0) / kA; }
  static double encode(double x) {
    const double start = cut();
    return x >= start ? (std::log2(kA * x + 64.0) - 6.0) / 14.0 * kB + kC : (x - start) / slope();
  }
  static double decode(double signal) {
    return signal >= 0 ? (std::exp2(14.0 * ((signal - kC) / kB) + 6.0) - 64.0) / kA : signal * slope() + cut();
  }
  static LogPieces pieces() {
    const LogPieces::Logarithm logarithm{kA, 64.0, kB / (14.0 * kLog10Of2), kC - 6.0 / 14.0 * kB};
    return {logarithm, {}, cut(), 0.0, kNowhere, kNowhere, 1.0 / slope()};
  }
};

/// The logarithm of Canon's curves, mirrored about zero light.
/// Light is in reflectance: 90 % is Canon's 1.0, hence the 0.9.
constexpr double kCanonWhite = 0.9;

/// Canon, "Input Transform Version 202007 for EOS C300 Mark II" (2020), Canon Log 2.
struct CanonLog2 {
  static constexpr double kGain = 87.09937546;
  static constexpr double kScale = 0.24136077;
  static constexpr double kOffset = 0.092864125;

  static double encode(double x) {
    return kOffset + std::copysign(kScale * std::log10(1.0 + kGain * std::abs(x) / kCanonWhite), x);
  }
  static double decode(double signal) {
    const double above = signal - kOffset;
    return kCanonWhite * std::copysign((std::pow(10.0, std::abs(above) / kScale) - 1.0) / kGain, above);
  }
  static LogPieces pieces() {
    constexpr double kGainOfLight = kGain / kCanonWhite;
    return {
        {kGainOfLight, 1.0, kScale, kOffset}, {-kGainOfLight, 1.0, -kScale, kOffset}, 0.0, kOffset, 0.0, kOffset, 1.0};
  }
};

/// As above, Canon Log 3: logarithms beyond ±0.014, joined by the straight line through their ends (Canon prints it as
/// 1.9754798 x + 0.12512219).
struct CanonLog3 {
  static constexpr double kGain = 14.98325;
  static constexpr double kScale = 0.36726845;
  static constexpr double kOffsetAbove = 0.12240537;
  static constexpr double kOffsetBelow = 0.12783901;
  static constexpr double kCut = 0.014;

  static double logarithm(double x) { return kScale * std::log10(1.0 + kGain * x); }
  static double upperEnd() { return kOffsetAbove + logarithm(kCut); }
  static double lowerEnd() { return kOffsetBelow - logarithm(kCut); }

  static double encode(double light) {
    const double x = light / kCanonWhite;
    if (x > kCut) {
      return kOffsetAbove + logarithm(x);
    }
    if (x < -kCut) {
      return kOffsetBelow - logarithm(-x);
    }
    const double t = (x + kCut) / (2.0 * kCut);
    return (1.0 - t) * lowerEnd() + t * upperEnd();
  }
  static double decode(double signal) {
    const double upper = upperEnd();
    const double lower = lowerEnd();
    if (signal > upper) {
      return kCanonWhite * (std::pow(10.0, (signal - kOffsetAbove) / kScale) - 1.0) / kGain;
    }
    if (signal < lower) {
      return -kCanonWhite * (std::pow(10.0, (kOffsetBelow - signal) / kScale) - 1.0) / kGain;
    }
    return kCanonWhite * kCut * (2.0 * (signal - lower) / (upper - lower) - 1.0);
  }
  static LogPieces pieces() {
    constexpr double kGainOfLight = kGain / kCanonWhite;
    const double half = kCanonWhite * kCut;
    return {{kGainOfLight, 1.0, kScale, kOffsetAbove},
            {-kGainOfLight, 1.0, -kScale, kOffsetBelow},
            half,
            upperEnd(),
            -half,
            lowerEnd(),
            (upperEnd() - lowerEnd()) / (2.0 * half)};
  }
};

}  // namespace

const std::vector<LogEncoding>& allLogEncodings() {
  static const std::vector<LogEncoding> encodings{
      LogEncoding::AcesCct,   LogEncoding::LogC3,     LogEncoding::LogC4,
      LogEncoding::SLog3,     LogEncoding::VLog,      LogEncoding::Log3G10,
      LogEncoding::CanonLog2, LogEncoding::CanonLog3, LogEncoding::DaVinciIntermediate};
  return encodings;
}

std::string nameOf(LogEncoding encoding) {
  switch (encoding) {
    case LogEncoding::AcesCct:
      return "ACEScct";
    case LogEncoding::LogC3:
      return "LogC3";
    case LogEncoding::LogC4:
      return "LogC4";
    case LogEncoding::SLog3:
      return "S-Log3";
    case LogEncoding::VLog:
      return "V-Log";
    case LogEncoding::Log3G10:
      return "Log3G10";
    case LogEncoding::CanonLog2:
      return "Canon Log 2";
    case LogEncoding::CanonLog3:
      return "Canon Log 3";
    case LogEncoding::DaVinciIntermediate:
      return "DaVinci Intermediate";
  }
  return {};
}

namespace {

/// Calls `use` with the curve.
template <typename Use>
auto withCurve(LogEncoding encoding, const Use& use) -> decltype(use(kAcesCct)) {
  switch (encoding) {
    case LogEncoding::AcesCct:
      return use(kAcesCct);
    case LogEncoding::LogC3:
      return use(kLogC3);
    case LogEncoding::LogC4:
      return use(LogC4{});
    case LogEncoding::SLog3:
      return use(kSLog3);
    case LogEncoding::VLog:
      return use(kVLog);
    case LogEncoding::Log3G10:
      return use(kLog3G10);
    case LogEncoding::CanonLog2:
      return use(CanonLog2{});
    case LogEncoding::CanonLog3:
      return use(CanonLog3{});
    case LogEncoding::DaVinciIntermediate:
      return use(kDaVinciIntermediate);
  }
  return {};
}

}  // namespace

double encode(LogEncoding encoding, double linear) {
  return withCurve(encoding, [&](const auto& curve) { return curve.encode(linear); });
}

double decode(LogEncoding encoding, double signal) {
  return withCurve(encoding, [&](const auto& curve) { return curve.decode(signal); });
}

LogPieces piecesOf(LogEncoding encoding) {
  return withCurve(encoding, [](const auto& curve) { return curve.pieces(); });
}

}  // namespace metamer::spectral
