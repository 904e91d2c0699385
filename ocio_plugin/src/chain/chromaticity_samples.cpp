// SPDX-License-Identifier: Apache-2.0
#include "chain/chromaticity_samples.h"

#include <algorithm>

#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

/// Samples along a side of a cell.
constexpr int kSamplesPerSide = 4;
/// Samples of the ring close to the border for each tick, and their share against all others together: about that among
/// the error protocol's probes, and half as much again because its largest errors lie there.
constexpr int kRingPerTick = 16;
constexpr double kRingShare = 0.14;

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

}  // namespace

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

}  // namespace metamer::ocio
