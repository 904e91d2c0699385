// SPDX-License-Identifier: Apache-2.0
// Compiled once per instruction set by Highway and chosen at run time.
#include "metamer/sip/colour_differences.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "judge/colour_differences.cpp"
#include <hwy/foreach_target.h>
// Highway's dispatch needs the target list first.
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "metamer/spectral/argument_checks.h"
#include "vector/choose_kernel.h"
#include "vector/double_functions-inl.h"

HWY_BEFORE_NAMESPACE();
namespace metamer::sip {
namespace HWY_NAMESPACE {

using Mask = hn::Mask<Double>;

constexpr double kDegree = std::numbers::pi / 180.0;

HWY_INLINE V number(double value) {
  return hn::Set(Double(), value);
}

/// A place or a direction in the plane of a and b.
struct Pair {
  V a, b;
};
HWY_INLINE V dot(Pair p, Pair q) {
  return hn::Add(hn::Mul(p.a, q.a), hn::Mul(p.b, q.b));
}
HWY_INLINE V cross(Pair p, Pair q) {
  return hn::Sub(hn::Mul(p.a, q.b), hn::Mul(p.b, q.a));
}
HWY_INLINE V length(Pair p) {
  return hn::Sqrt(dot(p, p));
}
HWY_INLINE Pair divided(Pair p, V by) {
  return {hn::Div(p.a, by), hn::Div(p.b, by)};
}
/// The direction whose angle is the sum of both.
HWY_INLINE Pair turned(Pair p, Pair by) {
  return {hn::Sub(hn::Mul(p.a, by.a), hn::Mul(p.b, by.b)), hn::Add(hn::Mul(p.b, by.a), hn::Mul(p.a, by.b))};
}
HWY_INLINE Pair chosen(Mask mask, Pair yes, Pair no) {
  return {hn::IfThenElse(mask, yes.a, no.a), hn::IfThenElse(mask, yes.b, no.b)};
}

/// CIE 015:2018, equations 8.4 and 8.5.
HWY_INLINE V lightnessResponse(V ratio) {
  constexpr double kCut = (24.0 / 116.0) * (24.0 / 116.0) * (24.0 / 116.0);
  const V straight = hn::Add(hn::Mul(ratio, number(841.0 / 108.0)), number(16.0 / 116.0));
  return hn::IfThenElse(hn::Gt(ratio, number(kCut)), cubeRoot(ratio), straight);
}

/// sqrt(C^7 / (C^7 + 25^7)).
HWY_INLINE V chromaWeight(V chroma) {
  constexpr double kSeventh = 6103515625.0;
  const V cube = hn::Mul(hn::Mul(chroma, chroma), chroma);
  const V seventh = hn::Mul(hn::Mul(cube, cube), chroma);
  return hn::Sqrt(hn::Div(seventh, hn::Add(seventh, number(kSeventh))));
}

/// Degrees of a direction, -180 ... 180.
HWY_INLINE V degreesOf(Pair direction) {
  const Double d;
  // Of the direction or its opposite, by the tangent of its eighth part: |x| <= tan(11.25 degrees).
  const V cosine = hn::Abs(direction.a);
  const V sine = hn::Xor(direction.b, hn::And(direction.a, hn::SignBit(d)));
  const V half = hn::Div(sine, hn::Add(number(1.0), cosine));
  const V quarter = hn::Div(half, hn::Add(number(1.0), hn::Sqrt(hn::Add(number(1.0), hn::Mul(half, half)))));
  const V x = hn::Div(quarter, hn::Add(number(1.0), hn::Sqrt(hn::Add(number(1.0), hn::Mul(quarter, quarter)))));
  constexpr std::array<double, 12> kArcTangent = {-1.0 / 23.0, 1.0 / 21.0, -1.0 / 19.0, 1.0 / 17.0,
                                                  -1.0 / 15.0, 1.0 / 13.0, -1.0 / 11.0, 1.0 / 9.0,
                                                  -1.0 / 7.0,  1.0 / 5.0,  -1.0 / 3.0,  1.0};
  const V degrees = hn::Mul(hn::Mul(x, number(8.0 / kDegree)), polynomial(hn::Mul(x, x), kArcTangent));
  const V opposite = hn::Or(number(180.0), hn::And(direction.b, hn::SignBit(d)));
  return hn::IfThenElse(hn::Lt(direction.a, hn::Zero(d)), hn::Add(degrees, opposite), degrees);
}

/// What CIEDE2000 turns chroma and hue by among blues, round 275 degrees: the cross term of both, over the weight of
/// chroma.
HWY_INLINE V blueTurn(Pair hue) {
  const Pair behind = {number(0.087155742747658173558), number(0.99619469809174553230)};  // cos and sin of -275 degrees
  const V difference = degreesOf(turned(hue, behind));
  // Of hues counted from 0 to 360.
  const Mask wraps = hn::And(hn::Ge(hue.b, number(0.0)), hn::Gt(difference, number(0.0)));
  const V blueness = hn::Div(hn::Sub(difference, hn::IfThenElseZero(wraps, number(360.0))), number(25.0));
  const V angle = hn::Mul(fade(hn::Mul(blueness, blueness)), number(60.0 * kDegree));
  // Taylor's series of the sine, to 60 degrees.
  constexpr std::array<double, 10> kSine = {-1.0 / 121645100408832000.0,
                                            1.0 / 355687428096000.0,
                                            -1.0 / 1307674368000.0,
                                            1.0 / 6227020800.0,
                                            -1.0 / 39916800.0,
                                            1.0 / 362880.0,
                                            -1.0 / 5040.0,
                                            1.0 / 120.0,
                                            -1.0 / 6.0,
                                            1.0};
  return hn::Mul(number(-2.0), hn::Mul(angle, polynomial(hn::Mul(angle, angle), kSine)));
}

/// The mean hue of two colours, the shorter way round, and their difference in hue.
struct Hues {
  Pair mean;
  V difference;
};
HWY_INLINE Hues huesOf(Pair ab1, Pair ab2, V c1, V c2) {
  const Double d;
  const V zero = hn::Zero(d);
  const V across = cross(ab1, ab2);
  const V along = dot(ab1, ab2);
  // Exactly opposite hues are 180 degrees apart by their angles in 0 ... 360.
  const Mask rises = hn::Or(
      hn::Gt(across, zero),
      hn::And(hn::Eq(across, zero), hn::Or(hn::Gt(ab1.b, zero), hn::And(hn::Eq(ab1.b, zero), hn::Gt(ab1.a, zero)))));
  const V sign = hn::IfThenElse(rises, number(1.0), number(-1.0));
  const V product = hn::Mul(c1, c2);
  // 2 sqrt(c1 c2) sin(half the angle between), each way where it keeps its digits.
  const V near = hn::Div(hn::Add(across, across), hn::Sqrt(hn::Mul(number(2.0), hn::Add(product, along))));
  const V far = hn::Mul(sign, hn::Sqrt(hn::Mul(number(2.0), hn::Sub(product, along))));
  const Pair unit1 = divided(ab1, c1);
  const Pair unit2 = divided(ab2, c2);
  const Pair sum = {hn::Add(unit1.a, unit2.a), hn::Add(unit1.b, unit2.b)};
  const Pair turn = {hn::Mul(sign, hn::Sub(unit2.b, unit1.b)), hn::Mul(sign, hn::Sub(unit1.a, unit2.a))};
  const Pair direction = chosen(hn::Ge(dot(unit1, unit2), zero), sum, turn);
  // Neutrals have no hue of their own: no difference, and the other's for a mean.
  const V total = hn::Add(c1, c2);
  const Mask haveHues = hn::And(hn::Gt(c1, zero), hn::Gt(c2, zero));
  const Pair one = divided({hn::Add(ab1.a, ab2.a), hn::Add(ab1.b, ab2.b)}, total);
  const Pair none = {number(1.0), zero};
  return {chosen(haveHues, divided(direction, length(direction)), chosen(hn::Gt(total, zero), one, none)),
          hn::IfThenElseZero(haveHues, hn::IfThenElse(hn::Gt(along, zero), near, far))};
}

/// CIEDE2000's weight of hues. @param hue  the mean
HWY_INLINE V hueWeight(Pair hue) {
  const Pair twice = turned(hue, hue);
  const Pair thrice = turned(twice, hue);
  const Pair fourfold = turned(twice, twice);
  const auto beside = [](Pair direction, double cosine, double sine) {
    return dot(direction, {number(cosine), number(sine)});
  };
  // Cosines of the hue less 30, thrice the hue more 6, and four times the hue less 63 degrees.
  V sum = hn::Sub(number(1.0), hn::Mul(number(0.17), beside(hue, 0.86602540378443864676, 0.5)));
  sum = hn::Add(sum, hn::Mul(number(0.24), twice.a));
  sum = hn::Add(sum, hn::Mul(number(0.32), beside(thrice, 0.99452189536827333692, -0.10452846326765347140)));
  return hn::Sub(sum, hn::Mul(number(0.20), beside(fourfold, 0.45399049973954679156, 0.89100652418836786236)));
}

struct Lab {
  V lightness;
  Pair ab;
};

HWY_INLINE V difference2000(const Lab& one, const Lab& other) {
  const V stretch = hn::Sub(
      number(1.5), hn::Mul(number(0.5), chromaWeight(hn::Mul(number(0.5), hn::Add(length(one.ab), length(other.ab))))));
  const Pair ab1 = {hn::Mul(stretch, one.ab.a), one.ab.b};
  const Pair ab2 = {hn::Mul(stretch, other.ab.a), other.ab.b};
  const V c1 = length(ab1);
  const V c2 = length(ab2);
  const auto [hue, hueDifference] = huesOf(ab1, ab2, c1, c2);
  const V chroma = hn::Mul(number(0.5), hn::Add(c1, c2));
  const V grey = hn::Sub(hn::Mul(number(0.5), hn::Add(one.lightness, other.lightness)), number(50.0));
  const V fromGrey = hn::Mul(grey, grey);
  const V lightnessScale =
      hn::Add(number(1.0), hn::Div(hn::Mul(number(0.015), fromGrey), hn::Sqrt(hn::Add(number(20.0), fromGrey))));
  const V chromaScale = hn::Add(number(1.0), hn::Mul(number(0.045), chroma));
  const V hueScale = hn::Add(number(1.0), hn::Mul(hn::Mul(number(0.015), chroma), hueWeight(hue)));
  const V l = hn::Div(hn::Sub(other.lightness, one.lightness), lightnessScale);
  const V c = hn::Div(hn::Sub(c2, c1), chromaScale);
  const V h = hn::Div(hueDifference, hueScale);
  const V turn = hn::Mul(blueTurn(hue), chromaWeight(chroma));
  const V square = hn::Add(hn::Add(hn::Mul(l, l), hn::Mul(c, c)), hn::Add(hn::Mul(h, h), hn::Mul(turn, hn::Mul(c, h))));
  // The turn can outweigh the squares by a rounding error between equal colours. NaN stays NaN.
  return hn::IfThenElse(hn::Lt(square, number(0.0)), number(0.0), hn::Sqrt(square));
}

/// @param planes  lightness, a, b of the wanted and red, green, blue of the given colours, `stride` numbers apart
/// @param count   a multiple of kMostDoubles
/// @param matrix  XYZ over white from RGB, by rows
void differences(const double* planes, std::size_t stride, std::size_t count, const double* matrix, double* result) {
  const Double d;
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto plane = [&](std::size_t index) { return hn::LoadU(d, planes + index * stride + i); };
    const V red = plane(3);
    const V green = plane(4);
    const V blue = plane(5);
    std::array<V, 3> response{hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (std::size_t row = 0; row < 3; ++row) {
      const double* const weights = matrix + 3 * row;
      const V ratio = hn::Add(hn::Add(hn::Mul(red, number(weights[0])), hn::Mul(green, number(weights[1]))),
                              hn::Mul(blue, number(weights[2])));
      response[row] = lightnessResponse(ratio);
    }
    const auto [x, y, z] = response;
    const Lab given = {hn::Sub(hn::Mul(number(116.0), y), number(16.0)),
                       {hn::Mul(number(500.0), hn::Sub(x, y)), hn::Mul(number(200.0), hn::Sub(y, z))}};
    hn::StoreU(difference2000({plane(0), {plane(1), plane(2)}}, given), d, result + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace metamer::sip
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace metamer::sip {
namespace {

using Differences = void(const double*, std::size_t, std::size_t, const double*, double*);

/// Lanes of the longest vector.
constexpr std::size_t kLanes = HWY_NAMESPACE::kMostDoubles;
/// Colours that are measured at once.
constexpr std::size_t kBlock = 8 * kLanes;
constexpr std::size_t kPlanes = 6;

}  // namespace

void ColourDifferences::measure(std::span<const Eigen::Vector3d> lab, std::span<const Eigen::Vector3d> rgb,
                                std::span<double> result) const {
  const auto count = static_cast<std::int64_t>(lab.size());
  spectral::requireAsMany("colours", static_cast<std::int64_t>(rgb.size()), "wanted are", count);
  spectral::requireAsMany("differences", static_cast<std::int64_t>(result.size()), "wanted are", count);
  Differences* const kernel = METAMER_CHOOSE_KERNEL(Differences, differences);
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> matrix = m_relativeFromRgb;
  std::array<double, kPlanes * kBlock> planes{};
  std::array<double, kBlock> found{};
  for (std::size_t begin = 0; begin < lab.size(); begin += kBlock) {
    const std::size_t here = std::min(kBlock, lab.size() - begin);
    for (std::size_t i = 0; i < here; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto axis = static_cast<Eigen::Index>(k);
        planes[k * kBlock + i] = lab[begin + i][axis];
        planes[(3 + k) * kBlock + i] = rgb[begin + i][axis];
      }
    }
    kernel(planes.data(), kBlock, (here + kLanes - 1) / kLanes * kLanes, matrix.data(), found.data());
    std::transform(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(here),
                   result.begin() + static_cast<std::ptrdiff_t>(begin),
                   [](double one) { return std::isfinite(one) ? one : std::numeric_limits<double>::infinity(); });
  }
}

}  // namespace metamer::sip
#endif
