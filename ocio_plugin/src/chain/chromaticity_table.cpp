// SPDX-License-Identifier: Apache-2.0
#include "chain/chromaticity_table.h"

#include <algorithm>
#include <cmath>

#include "chain/chromaticity_probe.h"
#include "chain/chromaticity_samples.h"

namespace metamer::ocio {
namespace {

/// Weight of a sample beyond the spectral locus.
constexpr double kOutsideWeight = 0.1;
/// Probes along a side for the first placing of the ticks.
constexpr int kProbesPerSide = 129;
constexpr int kPlacings = 3;
/// Rounds of weighted least squares.
constexpr int kRounds = 2;
/// A sample's weight grows with its squared error, from this part of the 99th percentile to a little more than all of
/// it. Beyond it falls off again, to a point: what is out of reach anyhow is not to spoil the rest.
constexpr double kLeastPart = 0.3;
constexpr double kWithinReach = 1.2;
constexpr double kOutOfReach = 3.0;
constexpr double kQuantile = 0.99;
/// Errors beyond this are weighed by what they really are, within a factor, where the quadratic form misjudges them.
constexpr double kSmall = 0.05;
constexpr double kMostBeyond = 3.0;
/// The node along either coordinate that lies at white.
std::size_t whiteNode(const PlaneLattice& lattice, const Eigen::Vector2d& white) {
  std::array<int, 2> node{};
  for (int axis = 0; axis < 2; ++axis) {
    const auto& along = lattice.ticks[axis];
    const double half = 0.5 / tickSteps(static_cast<int>(along.size()));
    node[axis] = static_cast<int>(std::lower_bound(along.begin(), along.end() - 1, white[axis] - half) - along.begin());
  }
  return lattice.index(node[0], node[1]);
}

/// Errors of a lattice at the visible samples, 0 at the others.
struct Errors {
  std::vector<double> full;
  double quantile = 0;  ///< as many of the error protocol's probes are worse as the 99th percentile says

  Errors(const PlaneLattice& lattice, const std::vector<TableSample>& samples, const ChromaticityProbe& probe)
      : full(samples.size(), 0.0) {
    std::vector<std::size_t> order;
    double total = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      if (samples[k].exact.isVisible) {
        full[k] = probe.error(samples[k].exact, lattice.at(samples[k].fit.point));
        total += samples[k].area;
        order.push_back(k);
      }
    }
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return full[a] < full[b]; });
    double sum = 0.0;
    for (const std::size_t k : order) {
      sum += samples[k].area;
      quantile = full[k];
      if (sum >= kQuantile * total) {
        break;
      }
    }
    quantile = std::max(quantile, 1e-9);
  }
};

/// Solves the nodes, again and again with more weight on what is far off.
void fitNodes(PlaneLattice& lattice, const std::vector<TableSample>& samples, std::size_t held,
              const ChromaticityProbe& probe, int rounds) {
  const std::vector<Eigen::Vector3d> start = lattice.nodes;
  std::vector<double> weights(samples.size(), 1.0);
  std::vector<LatticeSample> weighted(samples.size());
  for (int round = 1;; ++round) {
    for (std::size_t k = 0; k < samples.size(); ++k) {
      weighted[k] = samples[k].fit;
      weighted[k].metric *= samples[k].exact.isVisible ? weights[k] : kOutsideWeight;
    }
    lattice.nodes = start;
    fitLattice(lattice, weighted, held);
    if (round == rounds) {
      return;
    }
    const Errors errors(lattice, samples, probe);
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      if (!samples[k].exact.isVisible) {
        continue;
      }
      const LatticeSample& sample = samples[k].fit;
      const Eigen::Vector3d deviation = lattice.at(sample.point) - sample.value;
      const double quadratic = std::sqrt(std::max(0.0, deviation.dot(sample.metric * deviation)));
      const double ratio = errors.full[k] / errors.quantile;
      const double excess = std::clamp(ratio, kWithinReach, kOutOfReach) / kWithinReach;
      const double part = std::clamp(ratio, kLeastPart, 1.0) / (excess * excess);
      const double beyond =
          quadratic > kSmall ? std::clamp(errors.full[k] / quadratic, 1.0 / kMostBeyond, kMostBeyond) : 1.0;
      // Half way from the last weights, which keeps them from swinging.
      weights[k] = std::sqrt(weights[k]) * part * beyond;
      sum += weights[k];
      count += 1.0;
    }
    for (double& weight : weights) {
      weight *= count / sum;
    }
  }
}

}  // namespace

ChromaticityTable buildChromaticityTable(const sip::TransformSpec& spec, const sip::SpectralTransform& transform,
                                         int size, bool fitted) {
  ChromaticityTable table{chromaticityPlane(spec, transform), {}};
  const ChromaticityPlane& plane = table.plane;
  PlaneLattice& lattice = table.lattice;
  lattice.ticks = {evenTicks(kProbesPerSide), evenTicks(kProbesPerSide)};
  // Again from where the ticks then lie, which resolves what can be seen and its narrow strips.
  for (int placing = 0; placing < kPlacings; ++placing) {
    const PlaneTicks probes =
        placing == 0 ? lattice.ticks : PlaneTicks{subdivided(lattice.ticks[0], 2), subdivided(lattice.ticks[1], 2)};
    lattice.ticks = placeTicks(probes, plane, transform, size);
  }
  const ChromaticityProbe probe(plane, transform);
  sampleNodes(lattice, plane, probe);
  const std::vector<TableSample> samples = fitted ? takeSamples(lattice, probe) : std::vector<TableSample>{};
  if (samples.empty()) {
    return table;
  }
  const std::size_t white = whiteNode(lattice, plane.white);
  fitNodes(lattice, samples, white, probe, kRounds);
  // White lies beside its node by what ticks are rounded by, and a coarse lattice's slope is not the transform's.
  const auto answer = probe.ask(plane.white);
  if (answer.isUsable) {
    lattice.nodes[white] += answer.value - lattice.at(plane.white);
  }
  return table;
}

}  // namespace metamer::ocio
