// SPDX-License-Identifier: Apache-2.0
#include "metamer/validation/validation.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <map>

#include "loop/validation_noise.h"
#include "loop/validation_scenes.h"
#include "loop/validation_wall.h"
#include "metamer/ocio/bake.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/validation/foliage.h"

namespace metamer::validation {
namespace {

using Eigen::Vector3d;
using spectral::DomainSamples;

constexpr const char* kChart = "colorchecker";
constexpr double kBrightest = 0.95;
constexpr std::size_t kMostLeaves = 16;

Chart chartOf(const std::vector<spectral::Spectrum>& samples) {
  Chart chart;
  for (const spectral::Spectrum& sample : samples) {
    chart.names.push_back(sample.name());
    chart.reflectances.push_back(sample.onDomain());
  }
  return chart;
}

Chart skinAndFoliage(const spectral::DataLibrary& library) {
  Chart chart = chartOf(library.reflectances("skin").samples);
  for (const spectral::Spectrum& sample : foliageAmong(library.reflectances("tm30").samples)) {
    if (chart.names.size() < kMostLeaves) {
      chart.names.push_back(sample.name() + " (leaf)");
      chart.reflectances.push_back(sample.onDomain());
    }
  }
  return chart;
}

Chart perfectReflectors(const Chart& like) {
  return {like.names, std::vector<DomainSamples>(like.names.size(), DomainSamples::Ones())};
}

/// One side of a recipe: what it sees, and what becomes of it in the working space.
struct Side {
  sip::PreparedPipeline pipeline;
  spectral::Observer observer;
  Eigen::Matrix3d rgbFromResponse;
  std::map<std::size_t, Eigen::RowVectorXd> geometry;  ///< by number of patches
};

/// The recipe's two sides, its exact engine and its baked transform.
class Validator {
 public:
  Validator(const sip::Recipe& recipe, const spectral::DataLibrary& library, const ValidationOptions& options)
      : m_options(options),
        m_spec(sip::resolve(recipe, library)),
        m_engine(m_spec, sip::kConvergedBandCount),
        m_baked(ocio::bake(recipe, library, {}).group),
        m_input{prepare(m_spec.input, m_spec.training, m_spec.standardObserver), m_spec.input.observer, {}, {}},
        m_output{prepare(m_spec.output, m_spec.training, m_spec.standardObserver),
                 m_spec.output.observer,
                 m_engine.rgbFromOutputResponse(),
                 {}} {
    m_input.rgbFromResponse = m_engine.responseFromRgb().inverse() * m_input.pipeline.white.cwiseInverse().asDiagonal();
    const auto& chart = library.reflectances(kChart);
    const auto named = [&](const char* name) {
      return std::find_if(chart.samples.begin(), chart.samples.end(), [&](const auto& s) { return s.name() == name; })
          ->onDomain();
    };
    m_walls = {named("red"), named("green"), named("neutral 8 (.23 D)")};
  }

  /// The reflectances that the engine itself takes a chart's colours to have, made dark enough to exist.
  Chart smoothed(const Chart& chart) const {
    Chart result = chart;
    for (DomainSamples& reflectance : result.reflectances) {
      const Eigen::VectorXd guessed = m_engine.reflectance(rgbOf(reflectance, m_input)).cwiseMax(0.0);
      reflectance = guessed * std::min(1.0, kBrightest / guessed.maxCoeff());
    }
    return result;
  }

  SceneValidation run(const std::string& name, const std::string& about, const Chart& chart, Stage stage) {
    SceneValidation result{name, about, stage == Stage::OpenBox, {}};
    const auto input = rgbOf(chart, stage, m_input);
    const auto truth = rgbOf(chart, stage, m_output);
    for (std::size_t i = 0; i < chart.names.size(); ++i) {
      PatchValidation patch;
      patch.name = chart.names[i];
      std::vector<Vector3d> differences;
      Vector3d rgb = Vector3d::Zero();
      Vector3d wanted = Vector3d::Zero();
      for (std::size_t k = 0; k < input.size(); ++k) {
        const auto column = static_cast<Eigen::Index>(i);
        rgb += input[k].col(column) / static_cast<double>(input.size());
        wanted += truth[k].col(column) / static_cast<double>(truth.size());
        differences.push_back(lab(baked(input[k].col(column))) - lab(truth[k].col(column)));
      }
      const Vector3d exact = m_engine.apply(rgb);
      const Vector3d file = baked(rgb);
      patch.total = spectral::deltaE2000(lab(file), lab(wanted));
      patch.engine = spectral::deltaE2000(lab(exact), lab(wanted));
      patch.representation = spectral::deltaE2000(lab(file), lab(exact));
      patch.noise = intervalOfMean(lab(wanted), differences);
      const DomainSamples& reflectance = chart.reflectances[i];
      const Vector3d known = rgbOf(reflectance, m_output);
      const Vector3d guessed = m_engine.apply(rgbOf(reflectance, m_input));
      patch.metamerism = spectral::deltaE2000(lab(guessed), lab(known));
      result.patches.push_back(patch);
    }
    return result;
  }

  WallValidation wall(const Chart& chart) const {
    return validateWall(chart, m_input.pipeline, m_input.observer, m_walls, m_options);
  }

 private:
  /// RGB of a surface known by its spectrum.
  static Vector3d rgbOf(const DomainSamples& reflectance, const Side& side) {
    return side.rgbFromResponse * (side.pipeline.curves.transpose() * side.pipeline.light.cwiseProduct(reflectance));
  }

  std::vector<Eigen::Matrix3Xd> render(const Chart& chart, Stage stage, const Side& side) const {
    return renderPatches(sceneOf(chart, stage, side.pipeline.light, side.observer, m_walls), chart,
                         m_options.replicates, m_options.samples, m_options.seed, m_options.threads);
  }

  /// What a perfect reflector in each patch's place sends, over what it would without geometry. The same for all
  /// channels, so their mean is the best estimate; and for all charts of as many patches, so it is rendered once.
  const Eigen::RowVectorXd& geometryOf(const Chart& chart, Side& side) const {
    const auto [place, isNew] = side.geometry.try_emplace(chart.names.size());
    if (isNew) {
      const Eigen::Matrix3Xd white = meanOf(render(perfectReflectors(chart), Stage::SmallLamp, side));
      place->second = (side.pipeline.white.cwiseInverse().asDiagonal() * white).colwise().mean();
    }
    return place->second;
  }

  /// RGB of the patches, a matrix a replicate: responses over the patches' geometry.
  std::vector<Eigen::Matrix3Xd> rgbOf(const Chart& chart, Stage stage, Side& side) const {
    const Eigen::RowVectorXd exposure = geometryOf(chart, side).cwiseInverse();
    auto rendered = render(chart, stage, side);
    for (auto& one : rendered) {
      one = (side.rgbFromResponse * one * exposure.asDiagonal()).eval();
    }
    return rendered;
  }

  Vector3d baked(const Vector3d& rgb) const {
    std::array<float, 4> pixel{};
    Eigen::Map<Eigen::Vector3f>(pixel.data()) = rgb.cast<float>();
    m_baked.apply(pixel);
    return Eigen::Map<const Eigen::Vector3f>(pixel.data()).cast<double>();
  }

  Vector3d lab(const Vector3d& rgb) const {
    return spectral::lab(m_spec.space.xyzFromRgb() * rgb, m_spec.space.whiteXyz());
  }

  ValidationOptions m_options;
  sip::TransformSpec m_spec;
  sip::SpectralTransform m_engine;
  ocio::PixelProcessor m_baked;
  Side m_input;
  Side m_output;
  std::array<DomainSamples, 3> m_walls;
};

}  // namespace

Validation validate(const sip::Recipe& recipe, const spectral::DataLibrary& library, const ValidationOptions& options) {
  sip::Recipe linear = recipe;
  linear.space = "ACEScg";
  Validator validator(linear, library, options);
  const Chart chart = chartOf(library.reflectances(kChart).samples);
  Validation result;
  result.scenes.push_back(validator.run("smooth objects",
                                        "the chart's colours with the engine's own spectra, direct light",
                                        validator.smoothed(chart), Stage::SmallLamp));
  result.scenes.push_back(validator.run("chart", "24 measured patches, direct light", chart, Stage::SmallLamp));
  result.scenes.push_back(
      validator.run("skin and leaves", "measured samples, direct light", skinAndFoliage(library), Stage::SmallLamp));
  result.scenes.push_back(
      validator.run("box", "the measured chart between a red and a green wall", chart, Stage::OpenBox));
  result.wall = validator.wall(chart);
  return result;
}

}  // namespace metamer::validation
