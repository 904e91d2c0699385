// SPDX-License-Identifier: Apache-2.0
#include "chain/chromaticity_table.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "chain/chromaticity_probe.h"
#include "chain/chromaticity_samples.h"

namespace metamer::ocio {
namespace {

/// Weight of a sample beyond what reflectances can make.
constexpr double kOutsideWeight = 1e-3;
/// Probes along a side for the first placing of the ticks.
constexpr int kProbesPerSide = 129;
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
/// A plane on which the transform bends so much more than on the best is not tried.
constexpr double kMostBending = 1.5;
/// A small table, quickly made, is finished on every plane whose first draft is about as good as the best.
constexpr double kCloseDraft = 1.4;
constexpr int kMostSizeTriedTwice = 33;
/// Of a larger one only a first draft is made on every plane. Where they are this much alike, the plane that amplifies
/// rounding least is finished.
constexpr double kAlikeDraft = 1.15;
/// A largest error of so many 99th percentiles is as bad as they are.
constexpr double kMaximumToQuantile = 6.0;

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

/// A table on its way: its nodes are solved for the ticks that it has so far.
struct Draft {
  ChromaticityTable table;
  std::vector<TableSample> samples;
  std::optional<Errors> errors;  ///< at the samples; none where there are none

  double quantile() const { return errors ? errors->quantile : std::numeric_limits<double>::infinity(); }
};

/// Nodes with the transform's values, and samples to judge them by.
void sample(Draft& draft, const ChromaticityProbe& probe) {
  sampleNodes(draft.table.lattice, draft.table.plane, probe);
  draft.samples = takeSamples(draft.table.lattice, probe);
}

void solveNodes(Draft& draft, const ChromaticityProbe& probe, int rounds) {
  PlaneLattice& lattice = draft.table.lattice;
  draft.errors = fitNodes(lattice, draft.samples, whiteNode(lattice, draft.table.plane.white), probe, rounds);
}

/// The table of a plane before its ticks are moved.
Draft firstDraft(const ChromaticityPlane& plane, const PlaneTicks& placed, const sip::SpectralTransform& transform,
                 bool fitted) {
  Draft draft{{plane, {placed, {}}}, {}, {}};
  PlaneLattice& lattice = draft.table.lattice;
  // Again from where the ticks now lie, which resolves the narrow strips.
  const PlaneTicks probes = {subdivided(placed[0], 2), subdivided(placed[1], 2)};
  lattice.ticks = placeTicks(probes, plane, transform, lattice.size()).ticks;
  const ChromaticityProbe probe(plane, transform);
  sample(draft, probe);
  if (!draft.samples.empty() && fitted) {
    solveNodes(draft, probe, kRoundsOfAMove);
  } else if (!draft.samples.empty()) {
    draft.errors.emplace(lattice, draft.samples, probe);
  }
  return draft;
}

/// Moves the ticks toward what errs, again and again, and solves the nodes for the best.
void finish(Draft& draft, const sip::SpectralTransform& transform) {
  const ChromaticityPlane& plane = draft.table.plane;
  const ChromaticityProbe probe(plane, transform);
  Draft moved = draft;
  PlaneTicks best = draft.table.lattice.ticks;
  double least = draft.errors->badness();
  for (int move = 0; move < kMoves; ++move) {
    PlaneLattice& lattice = moved.table.lattice;
    lattice.ticks = movedTicks(lattice.ticks, stripErrors(lattice, moved.samples, *moved.errors), plane.white);
    sample(moved, probe);
    solveNodes(moved, probe, kRoundsOfAMove);
    if (moved.errors->badness() < least) {
      least = moved.errors->badness();
      best = lattice.ticks;
    }
  }
  PlaneLattice& lattice = draft.table.lattice;
  lattice.ticks = best;
  sample(draft, probe);
  solveNodes(draft, probe, kRounds);
  // White lies beside its node by what ticks are rounded by, and a coarse lattice's slope is not the transform's.
  const auto answer = probe.ask(plane.white);
  if (answer.isUsable) {
    lattice.nodes[whiteNode(lattice, plane.white)] += answer.value - lattice.at(plane.white);
  }
}

/// What a plane makes of the rounding of float32 on the way in and out, at most.
double amplification(const ChromaticityPlane& plane) {
  const auto condition = [](const Eigen::Matrix3d& matrix) {
    const Eigen::Vector3d singular = Eigen::JacobiSVD<Eigen::Matrix3d>(matrix).singularValues();
    return singular[0] / singular[2];
  };
  return condition(plane.input.fromRgb) * condition(plane.output.fromRgb);
}

/// First drafts on the planes worth trying, the best one first.
std::vector<Draft> firstDrafts(const sip::TransformSpec& spec, const sip::SpectralTransform& transform, int size,
                               bool fitted) {
  const auto planes = chromaticityPlanes(spec, transform);
  std::vector<PlacedTicks> placed;
  placed.reserve(planes.size());
  double leastBending = std::numeric_limits<double>::infinity();
  for (const auto& plane : planes) {
    placed.push_back(placeTicks({evenTicks(kProbesPerSide), evenTicks(kProbesPerSide)}, plane, transform, size));
    leastBending = std::min(leastBending, placed.back().bending);
  }
  std::vector<Draft> drafts;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    if (placed[k].bending <= kMostBending * leastBending) {
      drafts.push_back(firstDraft(planes[k], placed[k].ticks, transform, fitted));
    }
  }
  std::stable_sort(drafts.begin(), drafts.end(),
                   [](const Draft& p, const Draft& q) { return p.quantile() < q.quantile(); });
  const double alike = kAlikeDraft * drafts.front().quantile();
  const auto end = std::find_if(drafts.begin(), drafts.end(), [=](const Draft& p) { return p.quantile() > alike; });
  std::iter_swap(drafts.begin(), std::min_element(drafts.begin(), end, [](const Draft& p, const Draft& q) {
                   return amplification(p.table.plane) < amplification(q.table.plane);
                 }));
  return drafts;
}

}  // namespace

ChromaticityTable buildChromaticityTable(const sip::TransformSpec& spec, const sip::SpectralTransform& transform,
                                         int size, bool fitted) {
  std::vector<Draft> drafts = firstDrafts(spec, transform, size, fitted);
  if (!fitted || !drafts.front().errors) {
    return std::move(drafts.front().table);
  }
  const double close = kCloseDraft * drafts.front().quantile();
  finish(drafts.front(), transform);
  std::size_t best = 0;
  for (std::size_t k = 1; k < drafts.size() && size <= kMostSizeTriedTwice && drafts[k].quantile() <= close; ++k) {
    finish(drafts[k], transform);
    best = drafts[k].quantile() < drafts[best].quantile() ? k : best;
  }
  return std::move(drafts[best].table);
}

}  // namespace metamer::ocio
