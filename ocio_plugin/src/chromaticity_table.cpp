// SPDX-License-Identifier: Apache-2.0
#include "chromaticity_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "metamer/spectral/colorimetry.h"
#include "parallel.h"
#include "perceptual_form.h"

namespace metamer::ocio {
namespace {

/// Where deviations are judged: the error protocol's luminance.
constexpr double kLuminance = 0.18;
/// Weight of a sample beyond what reflectances can make.
constexpr double kOutsideWeight = 1e-3;
/// Deviation of coordinates that the metric is taken by.
constexpr double kStep = 1e-3;
/// Probes along a side for the first placing of the ticks.
constexpr int kProbesPerSide = 129;
/// Times that they are placed again, by probes that follow them.
constexpr int kRefinements = 1;
/// Power mean over a strip of the bending in it; and the least density of ticks against the mean.
constexpr double kBendingPower = 1.5;
constexpr double kLeastDensity = 0.3;
/// Samples along a side of a cell.
constexpr int kSamplesPerSide = 4;

bool usable(const Eigen::Vector3d& value) {
  return value.allFinite() && value.cwiseAbs().maxCoeff() < 1e3;
}

/// The colour at a point of the plane, at the protocol's luminance.
Eigen::Vector3d colourAt(const ChromaticityPlane& plane, const Eigen::RowVector3d& luminance,
                         const Eigen::Vector2d& point) {
  const Eigen::Vector3d rgb = plane.input.colour({point.x(), point.y(), 0.0});
  const double y = luminance * rgb;
  return rgb * (kLuminance / std::max(y, 0.01 * rgb.norm()));
}

/// What a node or sample should hold: output chromaticity, and output over input amount in stops.
Eigen::Vector3d tableValue(const ChromaticityPlane& plane, const Eigen::Vector3d& in, const Eigen::Vector3d& out) {
  Eigen::Vector3d value = plane.output.coordinates(out);
  value[2] -= plane.input.coordinates(in)[2];
  return value;
}

/// CIEDE2000 as a quadratic form of small deviations of the output coordinates.
Eigen::Matrix3d perceptualMetric(const ChromaticityPlane& plane, const Eigen::Matrix3d& xyzFromRgb,
                                 const Eigen::Vector3d& white, const Eigen::Vector3d& out) {
  const Eigen::Vector3d centre = plane.output.coordinates(out);
  const Eigen::Vector3d lab = spectral::lab(xyzFromRgb * out, white);
  return perceptualForm(
      [&](const Eigen::Vector3d& deviation) {
        return spectral::deltaE2000(lab, spectral::lab(xyzFromRgb * plane.output.colour(centre + deviation), white));
      },
      kStep);
}

/// The transform at a point; where it has no amount there, at a point nearer to white.
Eigen::Vector3d valueAt(const ChromaticityPlane& plane, const sip::SpectralTransform& transform,
                        const Eigen::RowVector3d& luminance, const Eigen::Vector2d& point) {
  for (double t = 1.0; t > 0.0; t -= 1.0 / 64.0) {
    const Eigen::Vector3d in = colourAt(plane, luminance, plane.white + t * (point - plane.white));
    Eigen::Vector3d value = tableValue(plane, in, transform.apply(in));
    if (usable(value)) {
      return value;
    }
  }
  return {point.x(), point.y(), 0.0};
}

void sampleNodes(PlaneLattice& lattice, const ChromaticityPlane& plane, const sip::SpectralTransform& transform) {
  const Eigen::RowVector3d luminance = transform.space().xyzFromRgb().row(1);
  lattice.nodes.resize(lattice.ticks[0].size() * lattice.ticks[1].size());
  parallelFor(lattice.size(), [&](int i) {
    for (int j = 0; j < lattice.size(); ++j) {
      lattice.nodes[lattice.index(i, j)] = valueAt(plane, transform, luminance, lattice.place(i, j));
    }
  });
}

/// Ticks spread so that a cumulated density grows by equal steps on either side of white, which gets a tick.
/// @param at       rising positions 0 ... 1
/// @param density  between a position and the next
std::vector<double> spreadTicks(const std::vector<double>& at, const std::vector<double>& density, double white,
                                int count) {
  std::vector<double> sum(at.size(), 0.0);
  for (std::size_t k = 1; k < at.size(); ++k) {
    sum[k] = sum[k - 1] + density[k - 1] * (at[k] - at[k - 1]);
  }
  const auto interpolate = [](const std::vector<double>& x, const std::vector<double>& y, double value) {
    const auto above = std::clamp<std::ptrdiff_t>(std::upper_bound(x.begin(), x.end(), value) - x.begin(), 1,
                                                  static_cast<std::ptrdiff_t>(x.size()) - 1);
    const double t = (value - x[above - 1]) / (x[above] - x[above - 1]);
    return y[above - 1] + t * (y[above] - y[above - 1]);
  };
  const double atWhite = interpolate(at, sum, white);
  const int below = std::clamp(static_cast<int>(std::lround((count - 1) * atWhite / sum.back())), 1, count - 2);
  const double steps = tickSteps(count);
  std::vector<double> ticks;
  for (int k = 0; k < count; ++k) {
    const double target =
        k <= below ? atWhite * k / below : atWhite + (sum.back() - atWhite) * (k - below) / (count - 1 - below);
    // On the curve's entries, so that a look-up in it bends nowhere else.
    double tick = std::round(interpolate(sum, at, target) * steps) / steps;
    tick = std::max(tick, ticks.empty() ? 0.0 : ticks.back() + 1.0 / steps);
    ticks.push_back(std::min(tick, 1.0 - static_cast<double>(count - 1 - k) / steps));
  }
  return ticks;
}

struct PlacedTicks {
  std::array<std::vector<double>, 2> ticks;
  double bending = 0;  ///< what is left to err, up to a factor that depends on the count alone
};

/// Ticks that crowd where the transform bends, along either coordinate, as seen on a grid of probes.
PlacedTicks placeTicks(const std::array<std::vector<double>, 2>& probes, const ChromaticityPlane& plane,
                       const sip::SpectralTransform& transform, int count) {
  const Eigen::Matrix3d xyzFromRgb = transform.space().xyzFromRgb();
  const Eigen::RowVector3d luminance = xyzFromRgb.row(1);
  struct Probe {
    bool feasible = false;
    Eigen::Vector3d value;
    Eigen::Matrix3d metric;
  };
  const std::size_t rows = probes[0].size();
  const std::size_t columns = probes[1].size();
  std::vector<Probe> grid(rows * columns);
  parallelFor(static_cast<int>(rows), [&](int i) {
    for (std::size_t j = 0; j < columns; ++j) {
      const Eigen::Vector3d in = colourAt(plane, luminance, {probes[0][i], probes[1][j]});
      if (!plane.isFeasible(in)) {
        continue;
      }
      Probe& probe = grid[static_cast<std::size_t>(i) * columns + j];
      const Eigen::Vector3d out = transform.apply(in);
      probe.value = tableValue(plane, in, out);
      if (usable(probe.value)) {
        probe.metric = perceptualMetric(plane, xyzFromRgb, transform.whiteXyz(), out);
        probe.feasible = probe.metric.allFinite();
      }
    }
  });
  PlacedTicks result;
  for (int axis = 0; axis < 2; ++axis) {
    const auto& at = probes[axis];
    const std::size_t across = probes[1 - axis].size();
    const auto probe = [&](std::size_t along, std::size_t other) -> const Probe& {
      return axis == 0 ? grid[along * columns + other] : grid[other * columns + along];
    };
    std::vector<double> density(at.size() - 1, 0.0);
    for (std::size_t k = 1; k + 1 < at.size(); ++k) {
      double bending = 0.0;
      for (std::size_t other = 0; other < across; ++other) {
        const Probe& before = probe(k - 1, other);
        const Probe& here = probe(k, other);
        const Probe& after = probe(k + 1, other);
        if (before.feasible && here.feasible && after.feasible) {
          const double left = at[k] - at[k - 1];
          const double right = at[k + 1] - at[k];
          const Eigen::Vector3d second =
              2.0 / (left + right) * ((after.value - here.value) / right - (here.value - before.value) / left);
          bending += std::pow(std::max(0.0, second.dot(here.metric * second)), 0.5 * kBendingPower);
        }
      }
      const double needed = std::pow(bending / static_cast<double>(across), 0.5 / kBendingPower);
      density[k - 1] = std::max(density[k - 1], needed);
      density[k] = std::max(density[k], needed);
    }
    // The outermost strips have no probe beyond them to bend against.
    const auto isBent = [](double value) { return value > 0.0; };
    const auto first = std::find_if(density.begin(), density.end(), isBent);
    if (first != density.end()) {
      std::fill(density.begin(), first, *first);
      const auto last = std::find_if(density.rbegin(), density.rend(), isBent);
      std::fill(density.rbegin(), last, *last);
    }
    double mean = 0.0;
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
      mean += density[k] * (at[k + 1] - at[k]);
    }
    double total = 0.0;
    for (std::size_t k = 0; k + 1 < at.size(); ++k) {
      density[k] = std::max(density[k], kLeastDensity * mean) + 1e-12;
      total += density[k] * (at[k + 1] - at[k]);
    }
    result.ticks[axis] = spreadTicks(at, density, plane.white[axis], count);
    result.bending += total * total;
  }
  return result;
}

std::vector<double> evenTicks(int count) {
  std::vector<double> ticks;
  ticks.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) {
    ticks.push_back(static_cast<double>(k) / (count - 1));
  }
  return ticks;
}

/// Ticks with others evenly between.
std::vector<double> subdivided(const std::vector<double>& ticks, int parts) {
  std::vector<double> result;
  for (std::size_t k = 0; k + 1 < ticks.size(); ++k) {
    for (int part = 0; part < parts; ++part) {
      result.push_back(ticks[k] + (ticks[k + 1] - ticks[k]) * part / parts);
    }
  }
  result.push_back(ticks.back());
  return result;
}

std::vector<LatticeSample> takeSamples(const PlaneLattice& lattice, const ChromaticityPlane& plane,
                                       const sip::SpectralTransform& transform) {
  const Eigen::Matrix3d xyzFromRgb = transform.space().xyzFromRgb();
  const Eigen::RowVector3d luminance = xyzFromRgb.row(1);
  const Eigen::Vector3d white = transform.whiteXyz();
  const int side = kSamplesPerSide * (lattice.size() - 1);
  const auto centre = [&](int axis, int k) {
    const auto cell = static_cast<std::size_t>(k / kSamplesPerSide);
    const double within = (k % kSamplesPerSide + 0.5) / kSamplesPerSide;
    return lattice.ticks[axis][cell] + within * (lattice.ticks[axis][cell + 1] - lattice.ticks[axis][cell]);
  };
  std::vector<std::vector<LatticeSample>> rows(static_cast<std::size_t>(side));
  parallelFor(side, [&](int i) {
    for (int j = 0; j < side; ++j) {
      const Eigen::Vector2d point(centre(0, i), centre(1, j));
      const Eigen::Vector3d in = colourAt(plane, luminance, point);
      const bool feasible = plane.isFeasible(in);
      if (!feasible && (i % kSamplesPerSide != 1 || j % kSamplesPerSide != 1)) {
        continue;
      }
      const Eigen::Vector3d out = transform.apply(in);
      const Eigen::Vector3d value = tableValue(plane, in, out);
      if (usable(value)) {
        const Eigen::Matrix3d metric = perceptualMetric(plane, xyzFromRgb, white, out);
        if (metric.allFinite()) {
          rows[static_cast<std::size_t>(i)].push_back({point, value, feasible ? metric : kOutsideWeight * metric});
        }
      }
    }
  });
  std::vector<LatticeSample> samples;
  for (const auto& row : rows) {
    samples.insert(samples.end(), row.begin(), row.end());
  }
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
  for (int round = 0; round < kRefinements; ++round) {
    const std::array probes = {subdivided(table.lattice.ticks[0], 2), subdivided(table.lattice.ticks[1], 2)};
    table.lattice.ticks = placeTicks(probes, table.plane, transform, size).ticks;
  }
  sampleNodes(table.lattice, table.plane, transform);
  if (fitted) {
    fitLattice(table.lattice, takeSamples(table.lattice, table.plane, transform),
               whiteNode(table.lattice, table.plane.white));
  }
  return table;
}

}  // namespace metamer::ocio
