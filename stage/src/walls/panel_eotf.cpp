// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/panel_eotf.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "metamer/spectral/input_error.h"
#include "metamer/stage/chart_table.h"

namespace metamer::stage {
namespace {

using spectral::InputError;

constexpr std::size_t kFewestSteps = 5;
/// Dead drives of a power that are tried, of full drive, and how finely. Others than dead ones are black's part.
constexpr double kMostDead = 0.3;
constexpr int kOffsetSteps = 600;
/// Light below this share of its own signal is black's noise to a logarithm.
constexpr double kLit = 0.05;

/// A ramp in order, drives of full, light above black.
struct Ramp {
  std::vector<double> drives, light, signal;
};

struct Power {
  double gamma = 1;
  double offset = 0;
  double full = 0;
  double residual = 0;
};

double rootMeanSquare(const Ramp& ramp, const auto& lightOf) {
  double sum = 0;
  for (std::size_t i = 0; i < ramp.drives.size(); ++i) {
    const double share = (lightOf(i) - ramp.light[i]) / ramp.signal[i];
    sum += share * share;
  }
  return std::sqrt(sum / static_cast<double>(ramp.drives.size()));
}

double raised(double drive, double offset, double gamma) {
  return std::pow(std::max((drive + offset) / (1 + offset), 0.0), gamma);
}

/// The power of one offset: a straight line of logarithms, each counted by how sure it is.
Power powerWith(double offset, const Ramp& ramp) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < ramp.drives.size(); ++i) {
    const double share = ramp.light[i] / ramp.signal[i];
    if (share > kLit && ramp.drives[i] + offset > 0) {
      const Eigen::Vector2d row(std::log((ramp.drives[i] + offset) / (1 + offset)), 1);
      normal += share * share * row * row.transpose();
      right += share * share * std::log(ramp.light[i]) * row;
    }
  }
  const Eigen::Vector2d line = normal.ldlt().solve(right);
  Power power{line[0], offset, std::exp(line[1]), 0};
  power.residual =
      rootMeanSquare(ramp, [&](std::size_t i) { return power.full * raised(ramp.drives[i], offset, power.gamma); });
  return power;
}

Power nearestPower(const Ramp& ramp) {
  Power best = powerWith(0, ramp);
  for (int step = 1; step <= kOffsetSteps; ++step) {
    const Power power = powerWith(-kMostDead * step / kOffsetSteps, ramp);
    if (power.gamma > 0 && power.residual < best.residual) {
      best = power;
    }
  }
  return best;
}

/// The rising values nearest to those given, by pooling neighbours that fall.
std::vector<double> rising(const std::vector<double>& values, const std::vector<double>& weights) {
  struct Pool {
    double mean, weight;
    std::size_t count;
  };
  std::vector<Pool> pools;
  for (std::size_t i = 0; i < values.size(); ++i) {
    pools.push_back({values[i], weights[i], 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean > pools.back().mean) {
      const Pool last = pools.back();
      pools.pop_back();
      Pool& joined = pools.back();
      joined.mean = (joined.mean * joined.weight + last.mean * last.weight) / (joined.weight + last.weight);
      joined.weight += last.weight;
      joined.count += last.count;
    }
  }
  std::vector<double> result;
  for (const Pool& pool : pools) {
    result.insert(result.end(), pool.count, pool.mean);
  }
  return result;
}

Ramp rampOf(const DriveSeries& series, double& black) {
  Eigen::Index strongest = 0;
  series.rgb.rowwise().maxCoeff().maxCoeff(&strongest);
  std::vector<std::size_t> order(series.drives.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return series.drives[a] < series.drives[b]; });
  const double full = series.drives[order.back()];
  if (series.drives[order.front()] != 0) {
    throw InputError("", "drives", "", "do not begin at 0; add what the camera sees of the unlit panel");
  }
  // Captures of one drive are one step, their mean.
  Ramp ramp;
  for (std::size_t first = 0; first < order.size();) {
    double sum = 0;
    std::size_t next = first;
    while (next < order.size() && series.drives[order[next]] == series.drives[order[first]]) {
      sum += series.rgb(strongest, static_cast<Eigen::Index>(order[next++]));
    }
    ramp.drives.push_back(series.drives[order[first]] / full);
    ramp.signal.push_back(sum / static_cast<double>(next - first));
    first = next;
  }
  if (ramp.drives.size() < kFewestSteps) {
    throw InputError("", "drives", std::to_string(ramp.drives.size()), "must be at least five different ones");
  }
  black = ramp.signal.front();
  const double least = 1e-6 * *std::max_element(ramp.signal.begin(), ramp.signal.end());
  for (double& signal : ramp.signal) {
    ramp.light.push_back(signal - black);
    signal = std::max(signal, least);
  }
  return ramp;
}

}  // namespace

double PanelEotf::lightOf(double drive) const {
  drive = std::clamp(drive, 0.0, 1.0);
  if (!isCurve) {
    return raised(drive, offset, gamma);
  }
  const auto above = std::upper_bound(drives.begin(), drives.end() - 1, drive) - drives.begin();
  const auto i = static_cast<std::size_t>(std::max<std::ptrdiff_t>(above, 1));
  // Between knots roots of light lie nearer to a line than light does.
  const double low = std::pow(light[i - 1], 1 / gamma);
  const double high = std::pow(light[i], 1 / gamma);
  return std::pow(std::lerp(low, high, (drive - drives[i - 1]) / (drives[i] - drives[i - 1])), gamma);
}

double PanelEotf::driveFor(double wanted) const {
  wanted = std::clamp(wanted, 0.0, 1.0);
  if (!isCurve) {
    return std::clamp(std::pow(wanted, 1 / gamma) * (1 + offset) - offset, 0.0, 1.0);
  }
  const auto at = std::lower_bound(light.begin(), light.end(), wanted) - light.begin();
  if (at == 0) {
    return 0;
  }
  const auto i = static_cast<std::size_t>(at);
  const double low = std::pow(light[i - 1], 1 / gamma);
  const double high = std::pow(light[i], 1 / gamma);
  return std::lerp(drives[i - 1], drives[i], (std::pow(wanted, 1 / gamma) - low) / (high - low));
}

PanelEotf fitEotf(const DriveSeries& series) {
  judgeLinearity(series);  // for what it refuses
  PanelEotf eotf;
  Ramp ramp = rampOf(series, eotf.black);
  const Power power = nearestPower(ramp);
  eotf.gamma = power.gamma;
  eotf.offset = power.offset;
  eotf.gain = power.full;
  eotf.residual = power.residual;
  eotf.drives = ramp.drives;
  if (!(power.residual <= kPowerHolds)) {
    eotf.isCurve = true;
    std::vector<double> weights;
    for (const double signal : ramp.signal) {
      weights.push_back(1 / (signal * signal));
    }
    const std::vector<double> curve = rising(ramp.light, weights);
    eotf.gain = curve.back();
    const double foot = curve.front();
    eotf.residual = rootMeanSquare(ramp, [&](std::size_t i) { return curve[i]; });
    for (const double value : curve) {
      eotf.light.push_back((value - foot) / (curve.back() - foot));
    }
  } else {
    for (const double drive : ramp.drives) {
      eotf.light.push_back(raised(drive, power.offset, power.gamma));
    }
  }
  return eotf;
}

PanelEotf fitEotf(const DriveSeries& series, const std::string& where) {
  try {
    return fitEotf(series);
  } catch (const spectral::InputError& error) {
    throw spectral::InputError(where, "", "", error.what());
  }
}

DriveSeries parseDriveSeries(const std::string& text, const std::string& where) {
  // A ramp has a chart's form: the drive stands where a patch's name does.
  const ChartTable table = parseChart(text, where);
  DriveSeries series;
  series.rgb = table.rgb;
  for (const std::string& name : table.names) {
    double drive = 0;
    const auto parsed = std::from_chars(name.data(), name.data() + name.size(), drive);
    if (parsed.ec != std::errc() || parsed.ptr != name.data() + name.size() || !(drive >= 0) || !std::isfinite(drive)) {
      throw InputError(where, "patch", name, "must be the drive that was sent, a number from 0");
    }
    series.drives.push_back(drive);
  }
  if (!table.rgb.allFinite()) {
    throw InputError(where, "value", "", "is missing; give every drive its R, G and B");
  }
  return series;
}

}  // namespace metamer::stage
