// SPDX-License-Identifier: Apache-2.0
#include "lights/light_cuts.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace metamer::spectral_ref {
namespace {

constexpr double kTwo32 = 4294967296.0;
using Importances = Eigen::Array<float, static_cast<int>(LightCuts::kReceivers), 1>;

struct Member {
  std::uint32_t node;
  Importances importance;
};

}  // namespace

bool LightCuts::isWide(const LightTree::Node& node, const Vec3& place) {
  // The sine of the half angle that it is seen under.
  return node.isInfinite ? node.cosSpread < 0.0F || node.sinSpread > kNear
                         : node.radius * node.radius > kNear * kNear * (node.center - place).squaredNorm();
}

LightCuts::LightCuts(const LightTree& tree, std::size_t blocks)
    : m_tree(tree), m_headers(blocks), m_clusters(blocks * kClusters) {}

void LightCuts::build(std::size_t block, const std::vector<LitPoint>& receivers) {
  assert(receivers.size() <= kReceivers);
  Header& header = m_headers[block];
  const auto memberOf = [&](std::uint32_t index) {
    Member member{index, Importances::Zero()};
    const LightTree::Node& node = m_tree.node(index);
    for (std::size_t r = 0; r < receivers.size(); ++r) {
      member.importance[static_cast<Eigen::Index>(r)] =
          LightTree::importance(node, receivers[r].place, receivers[r].normal);
      if (node.right == 0 && isWide(node, receivers[r].place)) {
        header.isNear = true;
      }
    }
    return member;
  };
  std::vector<Member> cut{memberOf(0)};
  cut.reserve(kClusters);
  Importances total = cut[0].importance;
  const auto inverse = [&] { return (total > 0.0F).select(1.0F / total, 0.0F).eval(); };
  // The cluster that gives most is opened next: a heap of shares, made anew as totals fall, which the first bounds put
  // far too high.
  using Place = std::pair<float, std::size_t>;
  std::vector<Place> open;
  const auto offer = [&](std::size_t i) {
    const float weight = (cut[i].importance * inverse()).sum();
    if (weight > 0.0F && m_tree.node(cut[i].node).right != 0) {
      open.emplace_back(weight, i);
      std::push_heap(open.begin(), open.end());
    }
  };
  std::size_t renewal = 1;
  while (cut.size() < kClusters) {
    if (cut.size() >= renewal) {
      renewal = cut.size() + cut.size() / 2 + 1;
      total = Importances::Zero();
      for (const Member& member : cut) {
        total += member.importance;
      }
      open.clear();
      for (std::size_t i = 0; i < cut.size(); ++i) {
        offer(i);
      }
    }
    if (open.empty()) {
      break;
    }
    std::pop_heap(open.begin(), open.end());
    const std::size_t widest = open.back().second;
    open.pop_back();
    const std::uint32_t parent = cut[widest].node;
    cut[widest] = memberOf(parent + 1);
    cut.push_back(memberOf(m_tree.node(parent).right));
    offer(widest);
    offer(cut.size() - 1);
  }
  total = Importances::Zero();
  for (const Member& member : cut) {
    total += member.importance;
  }
  std::sort(cut.begin(), cut.end(),
            [&](const Member& a, const Member& b) { return m_tree.node(a.node).begin < m_tree.node(b.node).begin; });
  const Importances scale = inverse();
  const auto lit = static_cast<float>((total > 0.0F).count());
  double below = 0;
  Cluster* clusters = m_clusters.data() + block * kClusters;
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const LightTree::Node& node = m_tree.node(cut[i].node);
    const double byIntensity = m_tree.share(node.begin, node.end);
    const double byImportance = lit > 0.0F ? static_cast<double>((cut[i].importance * scale).sum() / lit) : byIntensity;
    below += (1.0 - kDefensive) * byImportance + kDefensive * byIntensity;
    // At least one chance each, so that no light is out of reach.
    const std::uint32_t least = i > 0 ? clusters[i - 1].below + 1 : 1U;
    const double most = kTwo32 - static_cast<double>(cut.size() - i);
    clusters[i] = {node.end, std::max(least, static_cast<std::uint32_t>(std::min(below * kTwo32, most)))};
  }
  header.count = static_cast<std::uint8_t>(cut.size());
}

LightCuts::Span LightCuts::spanOf(std::size_t block, std::size_t index) const {
  const Cluster* clusters = m_clusters.data() + block * kClusters;
  const bool isLast = index + 1 == m_headers[block].count;
  const std::uint32_t below = index > 0 ? clusters[index - 1].below : 0U;
  return {index > 0 ? clusters[index - 1].end : 0U, clusters[index].end, below,
          (isLast ? kTwo32 : static_cast<double>(clusters[index].below)) - static_cast<double>(below)};
}

LightCuts::Choice LightCuts::choose(std::size_t block, std::uint32_t bits) const {
  const Cluster* clusters = m_clusters.data() + block * kClusters;
  const Cluster* last = clusters + m_headers[block].count - 1;
  const Cluster* found = std::upper_bound(
      clusters, last, bits, [](std::uint32_t value, const Cluster& cluster) { return value < cluster.below; });
  const Span span = spanOf(block, static_cast<std::size_t>(found - clusters));
  const double u = (static_cast<double>(bits - span.below) + 0.5) / span.chances;
  return choiceIn(span, m_tree.draw(span.begin, span.end, u));
}

LightCuts::Choice LightCuts::choiceIn(const Span& span, std::uint32_t position) const {
  const double cluster = m_tree.share(span.begin, span.end);
  const double share = cluster > 0.0 ? m_tree.share(position, position + 1) / cluster : 0.0;
  return {m_tree.lightAt(position), static_cast<float>(span.chances / kTwo32 * share)};
}

float LightCuts::probability(std::size_t block, std::uint32_t light) const {
  const std::uint32_t position = m_tree.positionOf(light);
  const Cluster* clusters = m_clusters.data() + block * kClusters;
  const Cluster* last = clusters + m_headers[block].count - 1;
  const Cluster* found = std::upper_bound(
      clusters, last, position, [](std::uint32_t value, const Cluster& cluster) { return value < cluster.end; });
  return choiceIn(spanOf(block, static_cast<std::size_t>(found - clusters)), position).probability;
}

}  // namespace metamer::spectral_ref
