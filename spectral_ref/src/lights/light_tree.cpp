// SPDX-License-Identifier: Apache-2.0
#include "lights/light_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace metamer::spectral_ref {
namespace {

struct Cone {
  Vec3 axis;
  float spread;
};

float angleBetween(const Vec3& a, const Vec3& b) {
  return std::acos(std::clamp(a.dot(b), -1.0F, 1.0F));
}

/// A cone that holds two others.
Cone united(const Cone& a, const Cone& b) {
  const Vec3 sum = a.axis + b.axis;
  const float length = sum.norm();
  if (!(length > 0.0F)) {
    return {a.axis, kPi};
  }
  const Vec3 axis = sum / length;
  return {axis, std::min(kPi, std::max(angleBetween(axis, a.axis) + a.spread, angleBetween(axis, b.axis) + b.spread))};
}

/// What the order is made by, packed: a build reads it over and over.
struct Place {
  Vec3 twiceCenter;
  std::uint32_t light;
};

/// Whole numbers in the order of floats. @param value  no NaN; both zeros are alike
std::uint32_t ordered(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value + 0.0F);
  return bits ^ ((0U - (bits >> 31U)) | 0x80000000U);
}

/// Where a place comes along an axis. By number where places are equal: the same tree whatever the library.
std::uint64_t keyOf(const Place& place, Eigen::Index axis) {
  return std::uint64_t{ordered(place.twiceCenter[axis])} << 32U | place.light;
}

/// Puts those of first ... last - 1 that come before a pivot, one of them, to the front, in steps without branches:
/// which way one goes is chance. @return  where the others begin, the pivot first
Place* parted(Place* first, Place* last, Place* pivot, Eigen::Index axis) {
  std::swap(*pivot, *(last - 1));
  const std::uint64_t bound = keyOf(*(last - 1), axis);
  Place* others = first;
  for (Place* place = first; place != last - 1; ++place) {
    const Place moved = *place;
    *place = *others;
    *others = moved;
    others += keyOf(moved, axis) < bound ? 1 : 0;
  }
  std::swap(*others, *(last - 1));
  return others;
}

/// As std::nth_element, which asks at every step. What it leaves on either side is the same.
void putLesserFirst(Place* first, Place* middle, Place* last, Eigen::Index axis) {
  constexpr std::ptrdiff_t kFew = 32;
  constexpr int kMostRounds = 64;  // where pivots are unlucky, the library's way does not mind
  const auto before = [axis](const Place& a, const Place& b) { return keyOf(a, axis) < keyOf(b, axis); };
  for (int round = 0; last - first > kFew && round < kMostRounds; ++round) {
    const std::ptrdiff_t eighth = (last - first) / 8;
    std::array<Place*, 7> samples{};
    for (std::ptrdiff_t i = 0; i < 7; ++i) {
      samples[static_cast<std::size_t>(i)] = first + (i + 1) * eighth;
    }
    std::sort(samples.begin(), samples.end(), [&](const Place* a, const Place* b) { return before(*a, *b); });
    Place* const others = parted(first, last, samples[samples.size() / 2], axis);
    if (others == middle) {
      return;
    }
    if (middle < others) {
      last = others;
    } else {
      first = others + 1;
    }
  }
  std::nth_element(first, middle, last, before);
}

/// Makes the nodes, and the order of the lights with them.
class TreeBuilder {
 public:
  TreeBuilder(const std::vector<LightBounds>& lights, std::vector<LightTree::Node>& nodes)
      : m_lights(lights), m_nodes(nodes) {
    const auto count = static_cast<std::uint32_t>(lights.size());
    m_places.reserve(lights.size());
    for (std::uint32_t light = 0; light < count; ++light) {
      m_places.push_back({lights[light].least + lights[light].most, light});
    }
    const auto far = std::partition(m_places.begin(), m_places.end(),
                                    [&](const Place& place) { return !lights[place.light].isInfinite; });
    m_firstFar = static_cast<std::uint32_t>(far - m_places.begin());
    m_nodes.reserve(2 * lights.size());
    build(0, count);
  }

  const std::vector<Place>& places() const { return m_places; }

 private:
  struct Built {
    Vec3 least;
    Vec3 most;
    Cone cone;
  };

  /// Puts the lesser half along the longest axis first, and says where the other begins.
  std::uint32_t halved(std::uint32_t begin, std::uint32_t end) {
    Vec3 least = Vec3::Constant(std::numeric_limits<float>::infinity());
    Vec3 most = -least;
    for (std::uint32_t i = begin; i < end; ++i) {
      least = least.cwiseMin(m_places[i].twiceCenter);
      most = most.cwiseMax(m_places[i].twiceCenter);
    }
    Eigen::Index axis = 0;
    (most - least).maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    putLesserFirst(m_places.data() + begin, m_places.data() + middle, m_places.data() + end, axis);
    return middle;
  }

  Built build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t index = m_nodes.size();
    m_nodes.emplace_back();
    LightTree::Node node{};
    node.begin = begin;
    node.end = end;
    Built built{};
    if (end - begin == 1) {
      const LightBounds& light = m_lights[m_places[begin].light];
      built = {light.least, light.most, {light.axis, light.spread}};
      node.intensity = light.intensity;
      node.isInfinite = light.isInfinite;
    } else {
      // Those far away come last in the whole order, in a half of their own.
      const bool isMixed = begin < m_firstFar && m_firstFar < end;
      const std::uint32_t middle = isMixed ? m_firstFar : halved(begin, end);
      const Built left = build(begin, middle);
      node.right = static_cast<std::uint32_t>(m_nodes.size());
      const Built right = build(middle, end);
      const LightTree::Node& first = m_nodes[index + 1];
      const LightTree::Node& second = m_nodes[node.right];
      built = {left.least.cwiseMin(right.least), left.most.cwiseMax(right.most), united(left.cone, right.cone)};
      node.intensity = first.intensity + second.intensity;
      node.isInfinite = first.isInfinite && second.isInfinite;
    }
    node.center = 0.5F * (built.least + built.most);
    node.radius = 0.5F * (built.most - built.least).norm();
    node.axis = built.cone.axis;
    node.cosSpread = std::cos(built.cone.spread);
    node.sinSpread = std::sin(built.cone.spread);
    m_nodes[index] = node;
    return built;
  }

  const std::vector<LightBounds>& m_lights;
  std::vector<LightTree::Node>& m_nodes;
  std::vector<Place> m_places;
  std::uint32_t m_firstFar = 0;
};

}  // namespace

LightTree::LightTree(const std::vector<LightBounds>& lights) : m_order(lights.size()), m_position(lights.size()) {
  if (lights.empty()) {
    return;
  }
  const TreeBuilder builder(lights, m_nodes);
  m_below.reserve(lights.size() + 1);
  m_below.push_back(0.0);
  const bool isBlack = !(m_nodes[0].intensity > 0.0F);
  for (std::uint32_t i = 0; i < m_order.size(); ++i) {
    m_order[i] = builder.places()[i].light;
    m_position[m_order[i]] = i;
    m_below.push_back(m_below.back() + (isBlack ? 1.0 : static_cast<double>(lights[m_order[i]].intensity)));
  }
}

namespace {

/// Cosine and sine of max(0, a - b), angles within 0 ... pi.
struct Angle {
  float cosine;
  float sine;
};
Angle less(const Angle& a, const Angle& b) {
  if (a.cosine >= b.cosine) {
    return {1.0F, 0.0F};
  }
  return {a.cosine * b.cosine + a.sine * b.sine, a.sine * b.cosine - a.cosine * b.sine};
}
Angle fromCosine(float cosine) {
  return {cosine, std::sqrt(std::max(0.0F, 1.0F - cosine * cosine))};
}

}  // namespace

float LightTree::importance(const Node& node, const Vec3& place, const Vec3& normal) {
  const Angle spread{node.cosSpread, node.sinSpread};
  if (node.isInfinite) {
    return node.intensity * std::max(0.0F, less(fromCosine(normal.dot(node.axis)), spread).cosine);
  }
  const Vec3 towards = node.center - place;
  const float squared = towards.squaredNorm();
  const float radiusSquared = node.radius * node.radius;
  if (squared <= radiusSquared) {
    return node.intensity / radiusSquared;
  }
  const float distance = std::sqrt(squared);
  const Angle seen{std::sqrt(1.0F - radiusSquared / squared), node.radius / distance};
  const float received = less(fromCosine(normal.dot(towards) / distance), seen).cosine;
  if (!(received > 0.0F)) {
    return 0.0F;
  }
  const Angle leaving = less(fromCosine(-node.axis.dot(towards) / distance), spread);
  return node.intensity * received * std::max(0.0F, less(leaving, seen).cosine) / squared;
}

std::uint32_t LightTree::draw(std::uint32_t begin, std::uint32_t end, double u) const {
  if (end - begin == 1) {
    return begin;
  }
  const double place = m_below[begin] + u * (m_below[end] - m_below[begin]);
  const auto first = m_below.begin() + begin + 1;
  const auto last = m_below.begin() + end;
  // A light of no intensity has an empty step, which is passed over; rounding may not carry beyond the range.
  return static_cast<std::uint32_t>(std::upper_bound(first, last, place) - m_below.begin()) - 1;
}

}  // namespace metamer::spectral_ref
