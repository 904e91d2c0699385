// SPDX-License-Identifier: Apache-2.0
#include "lights/light_branches.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace metamer::spectral_ref {
namespace {

/// Sums of eight numbers by half, quarter and eighth: who draws by them and who states the probability add up alike.
struct Sums {
  explicit Sums(const std::array<float, 8>& eighths)
      : quarters{eighths[0] + eighths[1], eighths[2] + eighths[3], eighths[4] + eighths[5], eighths[6] + eighths[7]},
        halves{quarters[0] + quarters[1], quarters[2] + quarters[3]},
        all(halves[0] + halves[1]) {}
  std::array<float, 4> quarters;
  std::array<float, 2> halves;
  float all;
};

/// Asks for all of something in memory before it is needed.
template <typename T>
void prefetch(const T& object) {
#ifdef __GNUC__
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < sizeof(T); at += kLine) {
    __builtin_prefetch(reinterpret_cast<const char*>(&object) + at);  // NOLINT
  }
#else
  static_cast<void>(object);
#endif
}

}  // namespace

LightBranches::LightBranches(const LightTree& tree) {
  const auto leafSize = static_cast<std::uint32_t>((tree.lightCount() + kMostLeaves - 1) / kMostLeaves);
  m_nodes.emplace_back();
  add(tree, 0, 0, leafSize);
}

/// Fills a node with the up to eight nodes of the tree below `root` that come of opening the largest ones.
void LightBranches::add(const LightTree& tree, std::uint32_t root, std::size_t index, std::uint32_t leafSize) {
  const auto lights = [&](std::uint32_t child) { return tree.node(child).end - tree.node(child).begin; };
  std::vector<std::uint32_t> children{root};
  while (children.size() < kWidth) {
    const auto largest = std::max_element(children.begin(), children.end(),
                                          [&](std::uint32_t a, std::uint32_t b) { return lights(a) < lights(b); });
    const std::uint32_t opened = *largest;
    if (lights(opened) <= leafSize) {
      break;
    }
    *largest = opened + 1;
    children.insert(largest + 1, tree.node(opened).right);
  }
  Node node;
  node.begin.fill(kBehindAll);
  node.end.fill(kBehindAll);
  for (std::size_t k = 0; k < children.size(); ++k) {
    const LightTree::Node& from = tree.node(children[k]);
    for (std::size_t i = 0; i < 3; ++i) {
      node.center[i][k] = (from.isInfinite ? from.axis : from.center)[static_cast<Eigen::Index>(i)];
      node.axis[i][k] = from.axis[static_cast<Eigen::Index>(i)];
    }
    node.radius[k] = from.isInfinite ? from.sinSpread : from.radius;
    node.cosSpread[k] = from.cosSpread;
    node.sinSpread[k] = from.sinSpread;
    node.intensity[k] = from.intensity;
    node.isInfinite[k] = from.isInfinite ? 1.0F : 0.0F;
    node.begin[k] = from.begin;
    node.end[k] = from.end;
    if (lights(children[k]) > leafSize) {
      node.child[k] = static_cast<std::uint32_t>(m_nodes.size());
      m_nodes.emplace_back();
      add(tree, children[k], node.child[k], leafSize);
    }
  }
  m_nodes[index] = node;
}

/// About what each child may give, as LightTree::importance, in steps that all take, so that they fill vector lanes:
/// lengths are cosines and sines times the distance, and there is but one division.
///
/// Only a tenth of a ball's radius keeps the distance from nothing: all of it would have a point amid many lights take
/// those at the ball's rim for as near as the ones beside it.
LightBranches::Each<float> LightBranches::importances(const Node& node, const LitPoint& point) {
  constexpr float kTiny = 1e-20F;
  constexpr float kCore = 0.1F;  // of the radius, squares
  const float leastSine = point.isTwoSided ? std::numeric_limits<float>::infinity() : 0.0F;
  const Vec3 place = point.place;
  const Vec3 normal = point.normal;
  Each<float> result;
  for (std::size_t k = 0; k < kWidth; ++k) {
    const float far = node.isInfinite[k];
    const float near = 1.0F - far;
    const float radius = node.radius[k];
    const float x = node.center[0][k] - near * place.x();
    const float y = node.center[1][k] - near * place.y();
    const float z = node.center[2][k] - near * place.z();
    const float squared = larger(x * x + y * y + z * z, kTiny);
    const float radiusSquared = larger(radius * radius, kTiny);
    const float inverse = 1.0F / (squared + kCore * radiusSquared);
    const float beyond = squared - radiusSquared;  // not above zero: the point lies inside
    const float seenCosine = far * node.cosSpread[k] + near * std::sqrt(larger(beyond, 0.0F));
    // The receiver's cosine at best: of the angle from its normal, less the one that the node is seen under.
    const float up = normal.x() * x + normal.y() * y + normal.z() * z;
    const float across = std::sqrt(larger(squared - up * up, 0.0F));
    const float turned = larger(up * seenCosine + across * radius, 0.0F) * inverse;
    const float received = across * seenCosine - up * radius <= leastSine ? 1.0F : turned;
    // The light's at best: less the spread of its normals as well.
    const float along = -(node.axis[0][k] * x + node.axis[1][k] * y + node.axis[2][k] * z);
    const float aside = std::sqrt(larger(squared - along * along, 0.0F));
    const float cosine = along * node.cosSpread[k] + aside * node.sinSpread[k];
    const float sine = aside * node.cosSpread[k] - along * node.sinSpread[k];
    const float leaving = larger(cosine * seenCosine + sine * radius, 0.0F) * inverse;
    const float outside = sine <= 0.0F ? 1.0F : leaving;
    const float given = cosine >= seenCosine ? 1.0F : outside;
    const float both = beyond <= 0.0F ? 1.0F : given * received;
    result[k] = node.intensity[k] * (far > 0.0F ? received : both * inverse);
  }
  return result;
}

/// Goes on to a child. @return  its node, or kLeaf: there the way ends
std::uint32_t LightBranches::step(const Node& node, const LitPoint& point, Leaf& leaf) {
  const Each<float> importance = importances(node, point);
  const Sums sums(importance);
  if (!(sums.all > 0.0F)) {
    leaf.probability = 0.0F;
    return kLeaf;
  }
  double place = leaf.u * static_cast<double>(sums.all);
  std::size_t chosen = 0;
  // Without a branch: which way it goes is chance.
  const auto choose = [&](const auto& parts) {
    chosen *= 2;
    const bool isSecond = place >= static_cast<double>(parts[chosen]) && parts[chosen + 1] > 0.0F;
    place -= isSecond ? static_cast<double>(parts[chosen]) : 0.0;
    chosen += isSecond ? 1U : 0U;
  };
  choose(sums.halves);
  choose(sums.quarters);
  choose(importance);
  leaf.u = std::clamp(place / static_cast<double>(importance[chosen]), 0.0, 1.0 - 0x1p-53);
  leaf.probability *= importance[chosen] / sums.all;
  leaf.begin = node.begin[chosen];
  leaf.end = node.end[chosen];
  return node.child[chosen];
}

void LightBranches::descend(std::span<const LitPoint> points, std::span<Leaf> leaves) const {
  assert(points.size() == leaves.size() && points.size() <= kMostTogether);
  std::array<std::uint32_t, kMostTogether> nodes{};
  std::array<std::size_t, kMostTogether> active{};
  std::size_t count = points.size();
  for (std::size_t i = 0; i < count; ++i) {
    active[i] = i;
    leaves[i].probability = 1.0F;
  }
  while (count > 0) {
    std::size_t left = 0;
    for (std::size_t n = 0; n < count; ++n) {
      const std::size_t i = active[n];
      nodes[i] = step(m_nodes[nodes[i]], points[i], leaves[i]);
      if (nodes[i] != kLeaf) {
        prefetch(m_nodes[nodes[i]]);
        active[left++] = i;
      }
    }
    count = left;
  }
}

LightBranches::Leaf LightBranches::leafOf(const LitPoint& point, std::uint32_t position) const {
  Leaf leaf{0, 0, 1.0F, 0.0};
  std::uint32_t index = 0;
  do {
    const Node& node = m_nodes[index];
    const Each<float> importance = importances(node, point);
    const float sum = Sums(importance).all;
    std::size_t k = 0;
    for (const std::uint32_t end : node.end) {
      k += end <= position ? 1U : 0U;
    }
    leaf.probability *= sum > 0.0F ? importance[k] / sum : 0.0F;
    leaf.begin = node.begin[k];
    leaf.end = node.end[k];
    index = node.child[k];
  } while (index != kLeaf);
  return leaf;
}

}  // namespace metamer::spectral_ref
