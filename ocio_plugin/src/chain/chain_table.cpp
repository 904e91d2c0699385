// SPDX-License-Identifier: Apache-2.0
#include "chain/chain_table.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "chain/chain_probe.h"
#include "chain/lattice_fit.h"
#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

/// Places in a cell where its table is judged, two in either triangle.
constexpr std::array<std::array<double, 2>, 4> kPlaces = {
    {{0.5, 1.0 / 6.0}, {5.0 / 6.0, 0.5}, {1.0 / 6.0, 0.5}, {0.5, 5.0 / 6.0}}};
/// Rounds of weighted least squares. A sample's weight grows with its error, from this part of the 99th percentile to a
/// little more than all of it.
constexpr int kRounds = 2;
constexpr double kQuantile = 0.99;
constexpr double kLeastPart = 0.3;
constexpr double kMostPart = 1.2;
/// At a saturation of 2 a value stands for no colour. The last nodes stand for those this much nearer than the last but
/// one: not nearer, or a table of few nodes would shoot up between them.
constexpr double kNearer = 0.4;

bool isPositive(const Eigen::Vector3d& ratio) {
  return ratio.allFinite() && ratio.minCoeff() > 0.0;
}

Eigen::Vector3d logOf(const Eigen::Vector3d& ratio) {
  return ratio.unaryExpr([](double value) { return std::log2(value); });
}

void sampleNodes(ChainTable& table, const ChainProbe& probe) {
  const auto& hues = table.ticks[0];
  std::vector<double> saturations = table.ticks[1];
  saturations.back() = 1.0 - kNearer * (1.0 - saturations[saturations.size() - 2]);
  table.above.resize(hues.size() * saturations.size());
  table.below.resize(table.above.size());
  parallelFor(static_cast<int>(hues.size()), [&](int i) {
    std::vector<Eigen::Vector2d> points;
    for (std::size_t j = 0; j < saturations.size(); ++j) {
      // Round the neutral axis and where hue closes, nodes are one colour.
      const bool isWrapped = i + 1 == static_cast<int>(hues.size());
      points.emplace_back(j == 0 || isWrapped ? 0.0 : hues[i], saturations[j]);
    }
    const auto put = [&](std::vector<Eigen::Vector3d>& side, double value) {
      const auto ratios = probe.ratiosAt(points, value);
      std::copy(ratios.begin(), ratios.end(), side.begin() + static_cast<std::ptrdiff_t>(i * saturations.size()));
    };
    put(table.above, 1.0);
    put(table.below, -1.0);
  });
}

/// The lights' side of a table as logarithms, on its way to be solved.
class Fit {
 public:
  Fit(ChainTable& table, const ChainProbe& probe) : m_table(table), m_lattice{{table.ticks[0], table.ticks[1]}, {}} {
    m_lattice.nodes.reserve(table.above.size());
    for (const Eigen::Vector3d& ratio : table.above) {
      m_lattice.nodes.push_back(isPositive(ratio) ? logOf(ratio) : Eigen::Vector3d::Zero());
    }
    takeSamples(probe);
    nameUnknowns();
  }

  void solve(const ChainProbe& probe);

 private:
  void takeSamples(const ChainProbe& probe);
  void nameUnknowns();

  ChainTable& m_table;
  PlaneLattice m_lattice;
  std::vector<LatticeSample> m_samples;
  std::vector<int> m_unknowns;
};

void Fit::takeSamples(const ChainProbe& probe) {
  const std::vector<double>& hues = m_lattice.ticks[0];
  const std::vector<double>& saturations = m_lattice.ticks[1];
  std::vector<std::vector<LatticeSample>> strips(hues.size() - 1);
  parallelFor(static_cast<int>(strips.size()), [&](int i) {
    std::vector<Eigen::Vector2d> points;
    for (std::size_t j = 0; j + 1 < saturations.size() && saturations[j + 1] <= 0.5; ++j) {
      for (const auto& [u, v] : kPlaces) {
        const Eigen::Vector2d point(hues[i] + u * (hues[i + 1] - hues[i]),
                                    saturations[j] + v * (saturations[j + 1] - saturations[j]));
        const auto nodes = m_lattice.stencil(point).node;
        if (!probe.isLight(point) ||
            !std::all_of(nodes.begin(), nodes.end(), [&](std::size_t k) { return isPositive(m_table.above[k]); })) {
          continue;
        }
        points.push_back(point);
      }
    }
    const std::vector<Eigen::Vector3d> ratios = probe.ratiosAt(points, 1.0);
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (isPositive(ratios[k])) {
        const Eigen::Vector3d log = logOf(ratios[k]);
        strips[i].push_back({points[k], log, probe.metric(points[k], log)});
      }
    }
  });
  for (auto& strip : strips) {
    m_samples.insert(m_samples.end(), strip.begin(), strip.end());
  }
}

/// White keeps its value, as does what no sample touches; where hue closes, both ends are one.
void Fit::nameUnknowns() {
  constexpr int kHeld = -1;
  const std::size_t saturations = m_lattice.ticks[1].size();
  const std::size_t last = m_lattice.nodes.size() - saturations;
  m_unknowns.assign(m_lattice.nodes.size(), kHeld);
  const auto first = [&](std::size_t node) { return node >= last ? node - last : node; };
  std::vector<char> isTouched(m_lattice.nodes.size(), 0);
  for (const LatticeSample& sample : m_samples) {
    for (const std::size_t node : m_lattice.stencil(sample.point).node) {
      isTouched[first(node)] = node % saturations != 0;
    }
  }
  int count = 0;
  for (std::size_t node = 0; node < m_unknowns.size(); ++node) {
    m_unknowns[node] = node >= last ? m_unknowns[node - last] : isTouched[node] != 0 ? count++ : kHeld;
  }
}

void Fit::solve(const ChainProbe& probe) {
  if (m_samples.empty()) {
    return;
  }
  const std::vector<Eigen::Vector3d> start = m_lattice.nodes;
  std::vector<LatticeSample> weighted = m_samples;
  std::vector<double> errors(m_samples.size());
  for (int round = 1;; ++round) {
    m_lattice.nodes = start;
    fitLattice(m_lattice, weighted, m_unknowns);
    if (round == kRounds) {
      break;
    }
    for (std::size_t k = 0; k < errors.size(); ++k) {
      errors[k] = probe.difference(m_samples[k].point, m_samples[k].value, m_lattice.at(m_samples[k].point));
    }
    std::vector<double> sorted = errors;
    const auto rank = static_cast<std::ptrdiff_t>(kQuantile * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), sorted.begin() + rank, sorted.end());
    const double quantile = std::max(sorted[static_cast<std::size_t>(rank)], 1e-9);
    for (std::size_t k = 0; k < errors.size(); ++k) {
      weighted[k].metric *= std::clamp(errors[k] / quantile, kLeastPart, kMostPart);
    }
  }
  for (std::size_t node = 0; node < m_unknowns.size(); ++node) {
    if (m_unknowns[node] >= 0) {
      m_table.above[node] = m_lattice.nodes[node].unaryExpr([](double log) { return std::exp2(log); });
    }
  }
}

}  // namespace

ChainTable buildChainTable(const sip::TransformSpec& spec, const sip::SpectralTransform& transform, int size,
                           bool fitted) {
  ChainTable table{chainFrame(spec, transform), {}, {}, {}};
  const ChainProbe probe(table.frame, spec, transform);
  table.ticks = placeTicks(probe, size);
  sampleNodes(table, probe);
  if (fitted) {
    Fit(table, probe).solve(probe);
  }
  return table;
}

}  // namespace metamer::ocio
