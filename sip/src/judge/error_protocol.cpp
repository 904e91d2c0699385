// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/error_protocol.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <utility>

#include "metamer/sip/band_weights.h"
#include "metamer/sip/colour_differences.h"
#include "metamer/sip/even_spread.h"
#include "metamer/sip/probe_limits.h"
#include "metamer/sip/spectral_locus.h"
#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/quantile.h"

namespace metamer::sip {

namespace {

constexpr double kProbeLuminance = 0.18;
constexpr double kRingFraction = 0.97;
/// Probes round which a larger error is looked for, and the steps in xy.
constexpr std::size_t kSearched = 12;
constexpr double kLongestStep = 0.016;
constexpr double kShortestStep = 0.001;

std::string label(const char* kind, double a, double b) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%s %.4f %.4f", kind, a, b);
  return text.data();
}

ErrorProtocol::Options checked(const ErrorProtocol::Options& options) {
  spectral::requireWithin("chromaticities", options.chromaticityCount, 0, kMostProbes);
  spectral::requireWithin("ring", options.ringCount, 0, kMostProbes);
  spectral::requireWithin("lowest stop", options.lowestStop, -kMostStops, options.highestStop);
  spectral::requireWithin("highest stop", options.highestStop, options.lowestStop, kMostStops);
  return options;
}

std::string atStop(const std::string& probe, int stop) {
  return probe + " at " + (stop >= 0 ? "+" : "") + std::to_string(stop) + " stops";
}

}  // namespace

ErrorProtocol::ErrorProtocol(const TransformSpec& spec, const std::vector<spectral::Spectrum>& chart,
                             const Options& options)
    : m_options(checked(options)),
      m_converged(spec, kConvergedBandCount),
      m_locus(spec.standardObserver),
      m_xyzFromRgb(spec.space.xyzFromRgb()),
      m_white(m_converged.whiteXyz()) {
  const Eigen::Matrix3d rgbFromXyz = spec.space.rgbFromXyz();
  const Eigen::Vector2d white = spectral::chromaticity(spec.space.whiteXyz());
  const auto add = [&](std::string name, const Eigen::Vector3d& rgb) {
    if (!options.insideGamutOnly || rgb.minCoeff() >= 0.0) {
      m_probes.push_back({std::move(name), rgb});
    }
  };
  const auto colourAt = [&](const Eigen::Vector2d& xy) -> Eigen::Vector3d {
    return rgbFromXyz * spectral::xyzFromChromaticity(xy, kProbeLuminance);
  };

  const std::array<double, 2> step = {1.0 / kPlasticNumber, 1.0 / (kPlasticNumber * kPlasticNumber)};
  for (int i = 0, kept = 0; kept < options.chromaticityCount && i < 64 * options.chromaticityCount; ++i) {
    const double u = std::fmod(0.5 + step[0] * (i + 1), 1.0);
    const double v = std::fmod(0.5 + step[1] * (i + 1), 1.0);
    const Eigen::Vector2d xy = inTriangle(spec.space.primaries, u, v);
    if (m_locus.contains(xy)) {
      add(label("xy", xy.x(), xy.y()), colourAt(xy));
      ++kept;
    }
  }

  // The patches as the input pipeline sees them.
  const PreparedPipeline input = prepare(spec.input, spec.training, spec.standardObserver);
  const Eigen::Matrix3d rgbFromResponse = m_converged.responseFromRgb().inverse();
  for (const auto& patch : chart) {
    const Eigen::Vector3d response = input.curves.transpose() * patch.onDomain().cwiseProduct(input.light);
    add("patch " + patch.name(), rgbFromResponse * response.cwiseQuotient(input.white));
  }

  for (int i = 0; i < options.ringCount; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / options.ringCount;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    const Eigen::Vector2d xy = white + kRingFraction * m_locus.distanceFrom(white, direction) * direction;
    add(label("ring", xy.x(), xy.y()), colourAt(xy));
  }
  m_expected = resultsOf(m_converged);
}

std::vector<Eigen::Vector3d> ErrorProtocol::resultsOf(const SpectralTransform& transform) const {
  std::vector<Eigen::Vector3d> results;
  results.reserve(m_probes.size());
  for (const Probe& probe : m_probes) {
    results.push_back(probe.rgb);
  }
  transform.apply(results);
  return results;
}

ErrorProtocol::Report ErrorProtocol::measure(const std::function<void(std::span<float> rgba)>& candidate) const {
  return compare(m_expected, candidate);
}

ErrorProtocol::Report ErrorProtocol::measureAgainst(const SpectralTransform& reference,
                                                    const std::function<void(std::span<float> rgba)>& candidate) const {
  return compare(resultsOf(reference), candidate);
}

std::vector<Eigen::Vector3d> ErrorProtocol::labOf(const std::vector<Eigen::Vector3d>& rgb) const {
  std::vector<Eigen::Vector3d> lab;
  lab.reserve(rgb.size());
  for (const Eigen::Vector3d& one : rgb) {
    lab.push_back(spectral::lab(m_xyzFromRgb * one, m_white));
  }
  return lab;
}

std::vector<double> ErrorProtocol::errorsOf(const std::vector<Eigen::Vector3d>& expectedLab,
                                            std::span<const float> rgba, double exposure) const {
  std::vector<Eigen::Vector3d> results;
  results.reserve(expectedLab.size());
  for (std::size_t i = 0; i < expectedLab.size(); ++i) {
    results.emplace_back(Eigen::Map<const Eigen::Vector3f>(rgba.data() + 4 * i).cast<double>() / exposure);
  }
  std::vector<double> errors(expectedLab.size());
  ColourDifferences(m_xyzFromRgb, m_white).measure(expectedLab, results, errors);
  return errors;
}

ErrorProtocol::Report ErrorProtocol::search(const std::function<void(std::span<float> rgba)>& candidate) const {
  std::vector<Peak> peaks(m_probes.size());
  Report report = compare(m_expected, candidate, &peaks);
  std::vector<std::size_t> order(m_probes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t count = std::min(kSearched, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                    [&](std::size_t a, std::size_t b) { return peaks[a].error > peaks[b].error; });
  const Eigen::Matrix3d rgbFromXyz = m_xyzFromRgb.inverse();
  for (std::size_t k = 0; k < count; ++k) {
    const auto [found, stop] = peaks[order[k]];
    const double exposure = std::ldexp(1.0, stop);
    const Eigen::Vector3d start = m_xyzFromRgb * m_probes[order[k]].rgb;
    Eigen::Vector2d best = spectral::chromaticity(start);
    double most = found;
    for (double step = kLongestStep; step >= kShortestStep; step *= 0.5) {
      std::vector<Eigen::Vector2d> places;
      std::vector<Eigen::Vector3d> colours;
      std::vector<float> pixels;
      for (int direction = 0; direction < 8; ++direction) {
        const double angle = std::numbers::pi / 4.0 * direction;
        const Eigen::Vector2d xy = best + step * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        if (!(xy.y() > 0.0) || !m_locus.contains(xy)) {
          continue;
        }
        const Eigen::Vector3d rgb = rgbFromXyz * spectral::xyzFromChromaticity(xy, start.y());
        if ((m_options.insideGamutOnly && rgb.minCoeff() < 0.0) ||
            exposure * rgb.maxCoeff() > m_options.largestComponent) {
          continue;
        }
        places.push_back(xy);
        colours.push_back(rgb);
        for (const double channel : {rgb[0], rgb[1], rgb[2], 1.0 / exposure}) {
          pixels.push_back(static_cast<float>(exposure * channel));
        }
      }
      std::vector<Eigen::Vector3d> expected = colours;
      m_converged.apply(expected);
      candidate(pixels);
      const std::vector<double> errors = errorsOf(labOf(expected), pixels, exposure);
      for (std::size_t i = 0; i < places.size(); ++i) {
        const double error = errors[i];
        if (error > most) {
          most = error;
          best = places[i];
        }
        if (error > report.max) {
          report.max = error;
          report.worstProbe = atStop(label("near xy", places[i].x(), places[i].y()), stop);
          report.worstRgb = exposure * colours[i];
        }
      }
    }
  }
  return report;
}

ErrorProtocol::Report ErrorProtocol::compare(const std::vector<Eigen::Vector3d>& expectedRgb,
                                             const std::function<void(std::span<float> rgba)>& candidate,
                                             std::vector<Peak>* peaks) const {
  const std::vector<Eigen::Vector3d> expected = labOf(expectedRgb);
  Report report;
  std::vector<double> errors;
  std::vector<float> pixels(4 * m_probes.size());
  for (int stop = m_options.lowestStop; stop <= m_options.highestStop; ++stop) {
    const double exposure = std::ldexp(1.0, stop);
    for (std::size_t i = 0; i < m_probes.size(); ++i) {
      Eigen::Map<Eigen::Vector4f>(pixels.data() + 4 * i) << (exposure * m_probes[i].rgb).cast<float>(), 1.0F;
    }
    candidate(pixels);
    const std::vector<double> here = errorsOf(expected, pixels, exposure);
    for (std::size_t i = 0; i < m_probes.size(); ++i) {
      if (exposure * m_probes[i].rgb.maxCoeff() > m_options.largestComponent) {
        continue;
      }
      const double error = here[i];
      if (errors.empty() || error > report.max) {
        report.max = error;
        report.worstProbe = atStop(m_probes[i].name, stop);
        report.worstRgb = exposure * m_probes[i].rgb;
      }
      if (peaks != nullptr && error > (*peaks)[i].error) {
        (*peaks)[i] = {error, stop};
      }
      errors.push_back(error);
      report.mean += error;
    }
  }
  if (errors.empty()) {
    return report;
  }
  report.count = errors.size();
  report.mean /= static_cast<double>(errors.size());
  report.p99 = spectral::quantile(std::move(errors), 0.99);
  return report;
}

}  // namespace metamer::sip
