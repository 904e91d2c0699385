// SPDX-License-Identifier: Apache-2.0
#include "chromaticity_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chromaticity_probe.h"
#include "parallel.h"

namespace metamer::ocio {
namespace {

/// Weight of a sample beyond what reflectances can make.
constexpr double kOutsideWeight = 1e-3;
/// Probes along a side for the first placing of the ticks.
constexpr int kProbesPerSide = 129;
/// Samples along a side of a cell.
constexpr int kSamplesPerSide = 4;
/// Samples of the ring close to the border for each tick, and their share against all others together: about that among
/// the error protocol's probes, and half as much again because its largest errors lie there.
constexpr int kRingPerTick = 16;
constexpr double kRingShare = 0.14;
/// Times that the ticks are moved toward what errs; rounds of weighted least squares for each, and at the end.
constexpr int kMoves = 5;
constexpr int kRoundsOfAMove = 2;
constexpr int kRounds = 5;
/// A sample's weight grows with its squared error, from this part of the 99th percentile to a little more than all of
/// it. Beyond it falls off again, to a point: what is out of reach anyhow is not to spoil the rest.
constexpr double kLeastPart = 0.3;
constexpr double kWithinReach = 1.2;
constexpr double kOutOfReach = 3.0;
constexpr double kQuantile = 0.99;
/// Errors beyond this are weighed by what they really are, within a factor, where the quadratic form misjudges them.
constexpr double kSmall = 0.05;
constexpr double kMostBeyond = 3.0;
/// Power of an error, up to a part of the 99th percentile, that draws ticks to its strip.
constexpr double kStripPower = 5.0;
constexpr double kMostPart = 1.5;
/// A largest error of so many 99th percentiles is as bad as they are.
constexpr double kMaximumToQuantile = 6.0;

void sampleNodes(PlaneLattice& lattice, const ChromaticityPlane& plane, const ChromaticityProbe& probe) {
  lattice.nodes.resize(lattice.ticks[0].size() * lattice.ticks[1].size());
  parallelFor(lattice.size(), [&](int i) {
    for (int j = 0; j < lattice.size(); ++j) {
      const Eigen::Vector2d point = lattice.place(i, j);
      Eigen::Vector3d& node = lattice.nodes[lattice.index(i, j)];
      node = {point.x(), point.y(), 0.0};
      // Where the transform has no amount: its value at a point nearer to white.
      constexpr int kParts = 64;
      for (int part = kParts; part > 0; --part) {
        const auto answer = probe.ask(plane.white + static_cast<double>(part) / kParts * (point - plane.white));
        if (answer.isUsable) {
          node = answer.value;
          break;
        }
      }
    }
  });
}

struct TableSample {
  LatticeSample fit;
  ChromaticityProbe::Answer exact;
  double area = 0;  ///< in CIE xy: its share among the error protocol's probes
};

/// Adds the ring to samples that are spread over the whole plane.
void addRing(std::vector<TableSample>& samples, int size, const ChromaticityProbe& probe) {
  double total = 0.0;
  for (const auto& sample : samples) {
    total += sample.exact.isFeasible ? sample.area : 0.0;
  }
  const std::vector<Eigen::Vector2d> ring = probe.ring(kRingPerTick * size);
  for (const Eigen::Vector2d& point : ring) {
    const auto answer = probe.askFeasible(point);
    if (answer.isUsable) {
      const Eigen::Matrix3d metric = probe.metric(answer);
      if (metric.allFinite()) {
        samples.push_back(
            {{point, answer.value, metric}, answer, kRingShare * total / static_cast<double>(ring.size())});
      }
    }
  }
}

std::vector<TableSample> takeSamples(const PlaneLattice& lattice, const ChromaticityProbe& probe) {
  const int side = kSamplesPerSide * (lattice.size() - 1);
  const auto width = [&](int axis, int k) {
    const auto cell = static_cast<std::size_t>(k / kSamplesPerSide);
    return lattice.ticks[axis][cell + 1] - lattice.ticks[axis][cell];
  };
  const auto centre = [&](int axis, int k) {
    const double within = (k % kSamplesPerSide + 0.5) / kSamplesPerSide;
    return lattice.ticks[axis][static_cast<std::size_t>(k / kSamplesPerSide)] + within * width(axis, k);
  };
  std::vector<std::vector<TableSample>> rows(static_cast<std::size_t>(side));
  parallelFor(side, [&](int i) {
    for (int j = 0; j < side; ++j) {
      const Eigen::Vector2d point(centre(0, i), centre(1, j));
      // Beyond what reflectances can make one sample a cell is enough.
      const bool isFirst = i % kSamplesPerSide == 1 && j % kSamplesPerSide == 1;
      const auto answer = isFirst ? probe.ask(point) : probe.askFeasible(point);
      if (answer.isUsable) {
        const Eigen::Matrix3d metric = probe.metric(answer);
        if (metric.allFinite()) {
          rows[static_cast<std::size_t>(i)].push_back(
              {{point, answer.value, metric}, answer, probe.xyArea(point, width(0, i) * width(1, j))});
        }
      }
    }
  });
  std::vector<TableSample> samples;
  for (const auto& row : rows) {
    samples.insert(samples.end(), row.begin(), row.end());
  }
  addRing(samples, lattice.size(), probe);
  return samples;
}

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

/// Errors of a lattice at the feasible samples, 0 at the others.
struct Errors {
  std::vector<double> full;
  double quantile = 0;  ///< as many of the error protocol's probes are worse as the 99th percentile says
  double largest = 0;

  Errors(const PlaneLattice& lattice, const std::vector<TableSample>& samples, const ChromaticityProbe& probe)
      : full(samples.size(), 0.0) {
    std::vector<std::size_t> order;
    double total = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      if (samples[k].exact.isFeasible) {
        full[k] = probe.error(samples[k].exact, lattice.at(samples[k].fit.point));
        largest = std::max(largest, full[k]);
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

  /// What is to be made small.
  double badness() const { return std::max(quantile, largest / kMaximumToQuantile); }
};

/// Solves the nodes, again and again with more weight on what is far off.
Errors fitNodes(PlaneLattice& lattice, const std::vector<TableSample>& samples, std::size_t held,
                const ChromaticityProbe& probe, int rounds) {
  const std::vector<Eigen::Vector3d> start = lattice.nodes;
  std::vector<double> weights(samples.size(), 1.0);
  std::vector<LatticeSample> weighted(samples.size());
  for (int round = 1;; ++round) {
    for (std::size_t k = 0; k < samples.size(); ++k) {
      weighted[k] = samples[k].fit;
      weighted[k].metric *= samples[k].exact.isFeasible ? weights[k] : kOutsideWeight;
    }
    lattice.nodes = start;
    fitLattice(lattice, weighted, held);
    Errors errors(lattice, samples, probe);
    if (round == rounds) {
      return errors;
    }
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      if (!samples[k].exact.isFeasible) {
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

/// How much of the errors lies between one tick and the next.
PlaneTicks stripErrors(const PlaneLattice& lattice, const std::vector<TableSample>& samples, const Errors& errors) {
  PlaneTicks strips;
  for (int axis = 0; axis < 2; ++axis) {
    const auto& along = lattice.ticks[axis];
    strips[axis].assign(along.size() - 1, 0.0);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      const auto above = std::upper_bound(along.begin() + 1, along.end() - 1, samples[k].fit.point[axis]);
      const double part = std::min(errors.full[k] / errors.quantile, kMostPart);
      strips[axis][static_cast<std::size_t>(above - along.begin()) - 1] +=
          samples[k].area * std::pow(part, kStripPower);
    }
  }
  return strips;
}

}  // namespace

ChromaticityTable buildChromaticityTable(const sip::TransformSpec& spec, const sip::SpectralTransform& transform,
                                         int size, bool fitted) {
  const auto planes = chromaticityPlanes(spec, transform);
  std::vector<PlacedTicks> placed;
  placed.reserve(planes.size());
  for (const auto& plane : planes) {
    placed.push_back(placeTicks({evenTicks(kProbesPerSide), evenTicks(kProbesPerSide)}, plane, transform, size));
  }
  const auto best = std::min_element(placed.begin(), placed.end(),
                                     [](const auto& p, const auto& q) { return p.bending < q.bending; });
  ChromaticityTable table{planes[static_cast<std::size_t>(best - placed.begin())], {best->ticks, {}}};
  // Again from where the ticks now lie, which resolves the narrow strips.
  const PlaneTicks probes = {subdivided(table.lattice.ticks[0], 2), subdivided(table.lattice.ticks[1], 2)};
  table.lattice.ticks = placeTicks(probes, table.plane, transform, size).ticks;
  const ChromaticityProbe probe(table.plane, transform);
  sampleNodes(table.lattice, table.plane, probe);
  if (!fitted) {
    return table;
  }
  PlaneLattice lattice = table.lattice;
  double least = std::numeric_limits<double>::infinity();
  for (int move = 0; move <= kMoves; ++move) {
    const std::vector<TableSample> samples = takeSamples(lattice, probe);
    if (samples.empty()) {
      return table;
    }
    const std::vector<Eigen::Vector3d> own = lattice.nodes;
    const Errors errors = fitNodes(lattice, samples, whiteNode(lattice, table.plane.white), probe, kRoundsOfAMove);
    if (errors.badness() < least) {
      least = errors.badness();
      table.lattice = {lattice.ticks, own};
    }
    lattice.ticks = movedTicks(lattice.ticks, stripErrors(lattice, samples, errors), table.plane.white);
    sampleNodes(lattice, table.plane, probe);
  }
  fitNodes(table.lattice, takeSamples(table.lattice, probe), whiteNode(table.lattice, table.plane.white), probe,
           kRounds);
  return table;
}

}  // namespace metamer::ocio
