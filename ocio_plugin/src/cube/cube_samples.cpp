// SPDX-License-Identifier: Apache-2.0
#include "cube/cube_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "metamer/ocio/pixel_processor.h"
#include "metamer/sip/even_spread.h"
#include "metamer/spectral/colorimetry.h"
#include "operators/parallel.h"
#include "operators/perceptual_form.h"

namespace metamer::ocio {
namespace {

constexpr double kLuminance = 0.18;
/// Chromaticities, and exposures of each a stop.
constexpr int kChromaticityCount = 8000;
constexpr int kExposuresPerStop = 1;
/// Stops beyond the range that samples reach. Half a stop, so that what is judged at a stop lies in the middle of what
/// is fitted, and some more: the ends, of which the dark one is the hardest, else lie at the border of what is weighed.
constexpr double kBeyond = 0.8;
/// Noise of black: colours, and how far from black they reach, denser toward it.
constexpr int kNoiseCount = 2000;
constexpr double kNoiseReach = 0.006;
/// Luminance of the grey against which they are judged.
constexpr double kNoiseGrey = 0.005;
/// Chromaticities, or colours of noise, a task.
constexpr int kBlock = 250;
static_assert(kChromaticityCount % kBlock == 0 && kNoiseCount % kBlock == 0);
/// Tasks that put the samples in order.
constexpr int kParts = 8;
/// Step of the signal to see its slope by, and of light to see CIEDE2000's.
constexpr float kSignalStep = 1.0F / 2048;
constexpr double kLightStep = 1e-3;

constexpr double kGolden = 1.61803398874989484820;

/// The k-th chromaticity of an even spread over a gamut, at the protocol's luminance.
Eigen::Vector3d spreadColour(const spectral::RgbSpace& space, const Eigen::Matrix3d& rgbFromXyz, int k) {
  const double u = std::fmod(0.25 + (k + 1) / sip::kPlasticNumber, 1.0);
  const double v = std::fmod(0.75 + (k + 1) / (sip::kPlasticNumber * sip::kPlasticNumber), 1.0);
  return rgbFromXyz * spectral::xyzFromChromaticity(sip::inTriangle(space.primaries, u, v), kLuminance);
}

/// The k-th colour of black's noise: an even spread over a cube (Roberts' R3 sequence), drawn in toward black.
Eigen::Vector3d noiseColour(int k) {
  constexpr double kRatio = 1.22074408460575947536;
  Eigen::Vector3d colour;
  double part = 1.0;
  for (double& channel : colour) {
    part /= kRatio;
    const double even = 2.0 * std::fmod(0.5 + (k + 1) * part, 1.0) - 1.0;
    channel = kNoiseReach * even * std::abs(even);
  }
  return colour;
}

/// One chromaticity: what goes in, what should come out, and how the eye judges deviations from it.
struct Direction {
  Eigen::Vector3d in;
  Eigen::Vector3d out;
  Eigen::Matrix3d form;
  Eigen::Vector3f lab;
};

class Sampler {
 public:
  Sampler(const sip::SpectralTransform& transform, const Signal& axes, const Signal& signal, int size,
          double lowestStop, double highestStop)
      : m_transform(transform),
        m_toEngine(signal.toEngine),
        m_fromEngine(signal.fromEngine),
        m_axesFromEngine(axes.fromEngine),
        m_xyzFromRgb(transform.space().xyzFromRgb()),
        m_rgbFromXyz(transform.space().rgbFromXyz()),
        m_white(transform.whiteXyz()),
        m_size(size),
        m_lowest(lowestStop - kBeyond),
        m_count(std::max(1, static_cast<int>(std::lround((highestStop + kBeyond - m_lowest) * kExposuresPerStop)))),
        m_step((highestStop + kBeyond - m_lowest) / m_count) {}

  /// Samples of chromaticities first ... last - 1, at all exposures.
  void run(int first, int last, std::vector<CubeSample>& samples) const {
    std::vector<Direction> directions;
    std::vector<double> phase;
    std::vector<int> indices;
    std::vector<Eigen::Vector3d> colours;
    for (int k = first; k < last; ++k) {
      const Eigen::Vector3d in = spreadColour(m_transform.space(), m_rgbFromXyz, k);
      if (in.allFinite() && in.minCoeff() >= 0.0) {
        indices.push_back(k);
        colours.push_back(in);
      }
    }
    std::vector<Eigen::Vector3d> results = colours;
    m_transform.apply(results);
    for (std::size_t i = 0; i < colours.size(); ++i) {
      const Eigen::Vector3d& out = results[i];
      const Eigen::Matrix3d form = perceptual(out);
      if (out.allFinite() && form.allFinite()) {
        directions.push_back({colours[i], out, form, spectral::lab(m_xyzFromRgb * out, m_white).cast<float>()});
        phase.push_back(std::fmod((indices[i] + 1) / kGolden, 1.0));
      }
    }
    for (int exposure = 0; exposure < m_count; ++exposure) {
      std::vector<double> gains;
      gains.reserve(phase.size());
      for (const double start : phase) {
        gains.push_back(
            std::exp2(m_lowest + m_step * (exposure + std::fmod(start + exposure / sip::kPlasticNumber, 1.0))));
      }
      addExposure(directions, gains, samples);
    }
  }

  /// Samples of black's noise, colours first ... last - 1.
  void runNoise(int first, int last, std::vector<CubeSample>& samples) const {
    std::vector<Eigen::Vector3d> colours;
    for (int k = first; k < last; ++k) {
      colours.push_back(noiseColour(k));
    }
    std::vector<Eigen::Vector3d> results = colours;
    m_transform.apply(results);
    const Eigen::Matrix3d form = perceptual(m_transform.apply(Eigen::Vector3d(kNoiseGrey, kNoiseGrey, kNoiseGrey)));
    std::vector<Direction> directions;
    for (std::size_t k = 0; k < colours.size(); ++k) {
      directions.push_back({colours[k], results[k], form, Eigen::Vector3f::Zero()});
    }
    addExposure(directions, std::vector<double>(colours.size(), 1.0), samples);
    for (CubeSample& sample : samples) {
      sample.isNoise = true;
    }
  }

 private:
  Eigen::Matrix3d perceptual(const Eigen::Vector3d& out) const {
    const Eigen::Vector3d lab = spectral::lab(m_xyzFromRgb * out, m_white);
    const double step = kLightStep * std::max(out.cwiseAbs().maxCoeff(), 1e-6);
    return perceptualForm(
        [&](const Eigen::Vector3d& deviation) {
          return spectral::difference2000(lab, spectral::lab(m_xyzFromRgb * (out + deviation), m_white));
        },
        step);
  }

  void addExposure(const std::vector<Direction>& directions, const std::vector<double>& gains,
                   std::vector<CubeSample>& samples) const {
    const std::size_t count = directions.size();
    std::vector<float> in;
    std::vector<float> out;
    const auto put = [](std::vector<float>& rgba, const Eigen::Vector3d& rgb) {
      for (const double value : {rgb[0], rgb[1], rgb[2], 1.0}) {
        rgba.push_back(static_cast<float>(value));
      }
    };
    for (std::size_t k = 0; k < count; ++k) {
      put(in, gains[k] * directions[k].in);
      put(out, gains[k] * directions[k].out);
    }
    m_axesFromEngine.apply(in);
    m_fromEngine.apply(out);
    // Slopes of light by signal, one channel of the signal moved at a time.
    std::array<std::vector<float>, 6> moved;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t side = 0; side < 2; ++side) {
        auto& pixels = moved[2 * axis + side];
        pixels = out;
        for (std::size_t k = 0; k < count; ++k) {
          pixels[4 * k + axis] += side == 0 ? kSignalStep : -kSignalStep;
        }
        m_toEngine.apply(pixels);
      }
    }
    for (std::size_t k = 0; k < count; ++k) {
      const Eigen::Map<const Eigen::Vector3f> from(in.data() + 4 * k);
      const Eigen::Map<const Eigen::Vector3f> target(out.data() + 4 * k);
      Eigen::Matrix3d slope;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Eigen::Map<const Eigen::Vector3f> up(moved[2 * axis].data() + 4 * k);
        const Eigen::Map<const Eigen::Vector3f> down(moved[2 * axis + 1].data() + 4 * k);
        slope.col(static_cast<Eigen::Index>(axis)) = (up - down).cast<double>() / (2.0 * kSignalStep * gains[k]);
      }
      const Eigen::Matrix3d metric = slope.transpose() * directions[k].form * slope;
      // Beyond its ends a table clips, whatever it holds.
      if (from.minCoeff() < 0.0F || from.maxCoeff() > 1.0F || !target.allFinite() || !metric.allFinite()) {
        continue;
      }
      CubeSample sample;
      sample.stencil = cubeStencil(from, m_size);
      sample.target = target;
      sample.metric.setZero();
      sample.metric.topRows<3>() = metric.cast<float>();
      sample.lab = directions[k].lab;
      sample.gain = static_cast<float>(gains[k]);
      samples.push_back(sample);
    }
  }

  const sip::SpectralTransform& m_transform;
  PixelProcessor m_toEngine;
  PixelProcessor m_fromEngine;
  PixelProcessor m_axesFromEngine;
  Eigen::Matrix3d m_xyzFromRgb;
  Eigen::Matrix3d m_rgbFromXyz;
  Eigen::Vector3d m_white;
  int m_size;
  double m_lowest;
  int m_count;
  double m_step;
};

/// By node: what is added up lies together in memory. A counting sort, which keeps the order within a node; each part
/// of it fills a range of nodes.
std::vector<CubeSample> byNode(const std::vector<std::vector<CubeSample>>& blocks, int size) {
  const auto side = static_cast<std::size_t>(size);
  std::vector<std::size_t> start(side * side * side + 1, 0);
  for (const auto& block : blocks) {
    for (const auto& sample : block) {
      ++start[sample.stencil.node + 1];
    }
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<CubeSample> samples(start.back());
  std::array<std::size_t, kParts + 1> firstNode{};
  for (std::size_t part = 1; part <= kParts; ++part) {
    const auto at = std::upper_bound(start.begin(), start.end(), samples.size() * part / kParts);
    firstNode[part] = part == kParts ? start.size() - 1 : static_cast<std::size_t>(at - start.begin()) - 1;
  }
  parallelFor(kParts, [&](int part) {
    const std::size_t first = firstNode[static_cast<std::size_t>(part)];
    const std::size_t last = firstNode[static_cast<std::size_t>(part) + 1];
    for (const auto& block : blocks) {
      for (const auto& sample : block) {
        if (sample.stencil.node >= first && sample.stencil.node < last) {
          samples[start[sample.stencil.node]++] = sample;
        }
      }
    }
  });
  return samples;
}

}  // namespace

void CubeJudge::errors(std::span<const CubeSample> samples, std::span<float> rgba, std::span<float> result) const {
  m_toEngine.apply(rgba);
  std::vector<Eigen::Vector3d> wanted;
  std::vector<Eigen::Vector3d> light;
  wanted.reserve(samples.size());
  light.reserve(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    wanted.push_back(samples[k].lab.cast<double>());
    light.emplace_back(Eigen::Map<const Eigen::Vector3f>(rgba.data() + 4 * k).cast<double>() /
                       static_cast<double>(samples[k].gain));
  }
  std::vector<double> errors(samples.size());
  m_differences.measure(wanted, light, errors);
  std::transform(errors.begin(), errors.end(), result.begin(),
                 [](double error) { return std::isfinite(error) ? static_cast<float>(error) : 0.0F; });
}

std::vector<CubeSample> cubeSamples(const sip::SpectralTransform& transform, const Signal& axes, const Signal& signal,
                                    int size, double lowestStop, double highestStop) {
  const Sampler sampler(transform, axes, signal, size, lowestStop, highestStop);
  constexpr int kBlocks = kChromaticityCount / kBlock;
  constexpr int kNoiseBlocks = kNoiseCount / kBlock;
  std::vector<std::vector<CubeSample>> blocks(kBlocks + kNoiseBlocks);
  parallelFor(kBlocks + kNoiseBlocks, [&](int block) {
    auto& samples = blocks[static_cast<std::size_t>(block)];
    if (block < kBlocks) {
      sampler.run(block * kBlock, (block + 1) * kBlock, samples);
    } else {
      sampler.runNoise((block - kBlocks) * kBlock, (block - kBlocks + 1) * kBlock, samples);
    }
  });
  return byNode(blocks, size);
}

}  // namespace metamer::ocio
