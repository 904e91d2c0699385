// SPDX-License-Identifier: Apache-2.0
#include "lights/light_branches.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace metamer::spectral_ref {
namespace {

template <std::size_t count>
float sumOf(const std::array<float, count>& values) {
  float sum = 0;
  for (const float value : values) {
    sum += value;
  }
  return sum;
}

/// As std::max, by value: vector lanes are filled by it.
float larger(float a, float b) {
  return a > b ? a : b;
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

/// LightTree::importance of each child, in steps that all take, so that they fill vector lanes: lengths are cosines and
/// sines times the distance, and there is but one division.
LightBranches::Each<float> LightBranches::importances(const Node& node, const LitPoint& point) {
  constexpr float kTiny = 1e-20F;
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
    const float inverse = 1.0F / larger(squared, radiusSquared);
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

LightBranches::Leaf LightBranches::descend(const LitPoint& point, double u) const {
  Leaf leaf{0, 0, 1.0F, u};
  std::uint32_t index = 0;
  do {
    const Node& node = m_nodes[index];
    const Each<float> importance = importances(node, point);
    const float sum = sumOf(importance);
    if (!(sum > 0.0F)) {
      return {};
    }
    const double place = leaf.u * static_cast<double>(sum);
    double start = 0;
    double below = 0;
    std::size_t chosen = 0;
    for (std::size_t k = 0; k < kWidth && place >= below; ++k) {
      if (importance[k] > 0.0F) {
        chosen = k;
        start = below;
        below += static_cast<double>(importance[k]);
      }
    }
    leaf.u = std::clamp((place - start) / static_cast<double>(importance[chosen]), 0.0, 1.0 - 0x1p-53);
    leaf.probability *= importance[chosen] / sum;
    leaf.begin = node.begin[chosen];
    leaf.end = node.end[chosen];
    index = node.child[chosen];
  } while (index != kLeaf);
  return leaf;
}

LightBranches::Leaf LightBranches::leafOf(const LitPoint& point, std::uint32_t position) const {
  Leaf leaf{0, 0, 1.0F, 0.0};
  std::uint32_t index = 0;
  do {
    const Node& node = m_nodes[index];
    const Each<float> importance = importances(node, point);
    const float sum = sumOf(importance);
    std::size_t k = 0;
    while (node.end[k] <= position) {
      ++k;
    }
    leaf.probability *= sum > 0.0F ? importance[k] / sum : 0.0F;
    leaf.begin = node.begin[k];
    leaf.end = node.end[k];
    index = node.child[k];
  } while (index != kLeaf);
  return leaf;
}

}  // namespace metamer::spectral_ref
