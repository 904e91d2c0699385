// SPDX-License-Identifier: Apache-2.0
#include "config/config_cores.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "bake/table_sizes.h"
#include "config/config_spaces.h"
#include "config/short_tables.h"
#include "metamer/ocio/log_cube.h"
#include "metamer/ocio/lut_writer.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/near_names.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/text.h"
#include "operators/interchange.h"
#include "operators/matrix_operator.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

constexpr double kLargestNeutralGain = 0.02;

/// Where a recipe's transform stands in a config.
struct Place {
  std::string linearSpace;  ///< built in: what is baked
  std::string processSpace;
  std::string pixelSpace;
  std::string encoding;
  std::optional<Eigen::Matrix3d> linearFromProcess;
};

std::optional<std::string> inConfig(const std::string& builtInSpace, const ConfigFacts& facts) {
  for (const std::string& name : namesInConfigs(builtInSpace)) {
    if (auto found = facts.space(name)) {
      return found;
    }
  }
  return std::nullopt;
}

Place placeOf(const sip::Recipe& recipe, const ConfigFacts& facts, const spectral::DataLibrary& library,
              const std::string& where) {
  const std::string interchange = facts.space(facts.roles.at(kInterchangeRole)).value();
  std::vector<std::string> known;
  for (const spectral::ColourSpace& space : library.colourSpaces()) {
    known.push_back(space.name);
    if (spectral::lowerCase(space.name) == spectral::lowerCase(recipe.space)) {
      Place place;
      place.linearSpace = space.linear.name;
      place.encoding = space.encoding ? "log" : "scene-linear";
      if (const auto process = inConfig(space.linear.name, facts)) {
        place.processSpace = *process;
      } else {
        place.processSpace = interchange;
        place.linearFromProcess = acesFromLinear(space.linear, library).inverse();
      }
      const auto pixels = inConfig(space.name, facts);
      place.pixelSpace = pixels.value_or(place.processSpace);
      if (!pixels) {
        place.encoding = "scene-linear";
      }
      return place;
    }
  }
  known.insert(known.end(), facts.spaceNames.begin(), facts.spaceNames.end());
  const auto own = facts.space(recipe.space);
  if (!own) {
    throw InputError(where, "space", recipe.space,
                     spectral::unknownNameRemedy(recipe.space, known, "lutgen list spaces"));
  }
  if (facts.dataSpaces.count(*own) != 0) {
    throw InputError(where, "space", recipe.space, "holds data, not colours; name another space");
  }
  return {kInterchangeSpace, interchange, *own, "", std::nullopt};
}

/// The text that the names have in common, short of separators at its end.
std::string commonName(const std::vector<CoreUse>& uses) {
  std::string name = uses.front().recipe.name;
  if (uses.size() == 1) {
    return name;
  }
  for (const CoreUse& use : uses) {
    const auto end = std::mismatch(name.begin(), name.end(), use.recipe.name.begin(), use.recipe.name.end()).first;
    name.erase(end, name.end());
  }
  // Of 000 and 050 the first digit is common: a number that has begun goes too, one that belongs to a name stays.
  const std::string separators = " _-.";
  const std::size_t number = name.find_last_not_of("0123456789");
  if (number != std::string::npos && separators.find(name[number]) != std::string::npos) {
    name.erase(number);
  }
  name.erase(name.find_last_not_of(separators) + 1);
  return name.empty() ? uses.front().recipe.name : name;
}

/// A table solved for one adaptation is off by more at others, the more the further.
double middleAdaptation(const std::vector<CoreUse>& uses) {
  std::vector<double> all;
  all.reserve(uses.size());
  for (const CoreUse& use : uses) {
    all.push_back(use.recipe.adaptation);
  }
  std::sort(all.begin(), all.end());
  return all[all.size() / 2];
}

/// Gain on the cones by adaptation, as the engine has it (docs of sip::SpectralTransform): D W/W_out + (1 - D) W/W_in.
Eigen::Matrix3d adaptationMatrix(const sip::TransformSpec& spec, double from, double to) {
  const sip::PreparedPipeline input = prepare(spec.input, spec.training, spec.standardObserver);
  const sip::PreparedPipeline output = prepare(spec.output, spec.training, spec.standardObserver);
  const Eigen::Matrix3d cones = spectral::lmsFromXyz(spec.cat);
  const Eigen::Array3d byInput = (cones * input.whiteXyz()).array().inverse();
  const Eigen::Array3d byOutput = (cones * output.whiteXyz()).array().inverse();
  const auto gain = [&](double adaptation) -> Eigen::Array3d {
    // Not 0 * infinity: with no adaptation the output's white does not matter.
    return adaptation > 0.0 ? (adaptation * byOutput + (1.0 - adaptation) * byInput).eval() : byInput;
  };
  const Eigen::Matrix3d lmsFromRgb = cones * spec.space.xyzFromRgb();
  return lmsFromRgb.inverse() * (gain(to) / gain(from)).matrix().asDiagonal() * lmsFromRgb;
}

/// A group of nothing but matrices as one; nothing where it has another operator.
std::optional<Eigen::Matrix3d> asMatrix(const OCIO::ConstGroupTransformRcPtr& group) {
  Eigen::Matrix3d product = Eigen::Matrix3d::Identity();
  for (int k = 0; k < group->getNumTransforms(); ++k) {
    const auto transform = group->getTransform(k);
    const auto matrix = OCIO::DynamicPtrCast<const OCIO::MatrixTransform>(transform);
    if (!matrix || matrix->getDirection() != OCIO::TRANSFORM_DIR_FORWARD) {
      return std::nullopt;
    }
    std::array<double, 4> offset{};
    std::array<double, 16> values{};
    matrix->getOffset(offset.data());
    matrix->getMatrix(values.data());
    if (offset != std::array<double, 4>{}) {
      return std::nullopt;
    }
    product = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data()).topLeftCorner<3, 3>() *
              product.eval();
  }
  return product;
}

sip::TransformSpec specOf(const ConfigCore& core, const spectral::DataLibrary& library) {
  return sip::resolve(core.recipe, library, library.colourSpace(core.recipe.space).linear);
}

/// What a use is off by with a transform as the core's, on the core's linear pixels.
sip::ErrorProtocol::Report errorOf(const ConfigCore& core, const CoreUse& use,
                                   const OCIO::ConstTransformRcPtr& transform,
                                   const sip::ErrorProtocol::Options& probes, const spectral::DataLibrary& library) {
  sip::TransformSpec spec = specOf(core, library);
  auto group = OCIO::GroupTransform::Create();
  group->appendTransform(transform->createEditableCopy());
  if (use.recipe.adaptation != core.recipe.adaptation) {
    group->appendTransform(matrixOperator(adaptationMatrix(spec, core.recipe.adaptation, use.recipe.adaptation)));
  }
  spec.adaptation = use.recipe.adaptation;
  const PixelProcessor processor(group);
  return sip::ErrorProtocol(spec, library.reflectances(sip::ErrorProtocol::kChart).samples, probes)
      .measure([&](std::span<float> rgba) { processor.apply(rgba); });
}

/// The first of nothing, a matrix and tables of rising size that holds a tolerance for all uses; the largest table
/// where none does, or without a tolerance.
Baked cheapest(const ConfigCore& core, const spectral::DataLibrary& library, int size,
               std::optional<double> tolerance) {
  BakeOptions options;
  const auto holds = [&](const Baked& baked) {
    return std::all_of(core.uses.begin(), core.uses.end(), [&](const CoreUse& use) {
      return errorOf(core, use, baked.group, baked.certificate.probes, library).p99 <= *tolerance;
    });
  };
  const int largest = size != 0 ? size : kChainSize;
  options.size = kSmallestTable;
  Baked baked = bake(core.recipe, library, options);
  if (baked.certificate.representation == Representation::Identity) {
    return baked;
  }
  if (tolerance) {
    options.representation = Representation::Matrix;
    baked = bake(core.recipe, library, options);
    if (holds(baked)) {
      return baked;
    }
    options.representation.reset();
    for (const int nodes : kSizesOfConfigs) {
      options.size = nodes;
      if (nodes < largest && holds(baked = bake(core.recipe, library, options))) {
        return baked;
      }
    }
  }
  options.size = largest;
  return bake(core.recipe, library, options);
}

/// A group whose last operator, a matrix, makes good what a file of it does to neutrals: a small table is off by some
/// thousandths where the transform is steep at white, and rounded numbers are by some hundred-thousandths.
OCIO::ConstGroupTransformRcPtr withExactNeutrals(const OCIO::ConstGroupTransformRcPtr& group,
                                                 const PixelProcessor& file, const sip::SpectralTransform& engine) {
  constexpr double kGrey = 0.18;
  std::array<float, 4> pixel = {static_cast<float>(kGrey), static_cast<float>(kGrey), static_cast<float>(kGrey), 1.0F};
  file.apply(pixel);
  const Eigen::Vector3d is(pixel[0], pixel[1], pixel[2]);
  const Eigen::Vector3d wanted = engine.apply(Eigen::Vector3d::Constant(kGrey));
  const Eigen::Vector3d gain = wanted.cwiseQuotient(is);
  auto copy = OCIO::DynamicPtrCast<OCIO::GroupTransform>(group->createEditableCopy());
  const auto last = OCIO::DynamicPtrCast<OCIO::MatrixTransform>(copy->getTransform(copy->getNumTransforms() - 1));
  // Anything larger is no small table's error: a light that leaves a channel next to nothing.
  if (!last || !((gain.array() - 1.0).abs().maxCoeff() < kLargestNeutralGain)) {
    return group;
  }
  std::array<double, 16> values{};
  last->getMatrix(values.data());
  for (std::size_t k = 0; k < 12; ++k) {
    values[k] *= gain[static_cast<Eigen::Index>(k / 4)];
  }
  last->setMatrix(values.data());
  return copy;
}

}  // namespace

std::vector<ConfigCore> coresOf(const std::vector<sip::Recipe>& recipes, const ConfigFacts& facts,
                                const spectral::DataLibrary& library, const std::string& where) {
  std::vector<ConfigCore> cores;
  std::map<std::string, std::size_t> coreOf;
  for (const sip::Recipe& recipe : recipes) {
    const Place place = placeOf(recipe, facts, library, where);
    sip::Recipe common = recipe;
    common.space = place.linearSpace;
    common.name = "core";
    common.adaptation = 0.0;
    const std::string key = spectral::utf8(common.folder) + "\n" + sip::toYaml(common);
    const auto [found, isNew] = coreOf.emplace(key, cores.size());
    if (isNew) {
      cores.push_back({"", recipe, place.processSpace, place.linearFromProcess, {}});
      cores.back().recipe.space = place.linearSpace;
    }
    ConfigCore& core = cores[found->second];
    core.uses.push_back({recipe, place.pixelSpace, place.encoding});
  }
  std::set<std::string> names;
  for (ConfigCore& core : cores) {
    core.recipe.adaptation = middleAdaptation(core.uses);
    core.name = commonName(core.uses);
    if (!names.insert(spectral::lowerCase(core.name)).second) {
      core.name = core.uses.front().recipe.name;
      names.insert(spectral::lowerCase(core.name));
    }
    core.recipe.name = core.name;
  }
  return cores;
}

std::vector<ConfigStep> stepsOf(const ConfigCore& core, const CoreUse& use, const BakedCore& baked,
                                const std::string& src, const spectral::DataLibrary& library) {
  if (baked.group->getNumTransforms() == 0) {
    return {};
  }
  Eigen::Matrix3d before = core.linearFromProcess.value_or(Eigen::Matrix3d::Identity());
  Eigen::Matrix3d after = before.inverse();
  if (use.recipe.adaptation != core.recipe.adaptation) {
    after = after * adaptationMatrix(specOf(core, library), core.recipe.adaptation, use.recipe.adaptation);
  }
  if (const auto matrix = asMatrix(baked.group)) {
    return {after * *matrix * before};
  }
  std::vector<ConfigStep> steps;
  if (core.linearFromProcess) {
    steps.emplace_back(before);
  }
  steps.emplace_back(src);
  if (core.linearFromProcess || use.recipe.adaptation != core.recipe.adaptation) {
    steps.emplace_back(after);
  }
  return steps;
}

Certificate certificateOf(const ConfigCore& core, const CoreUse& use, const BakedCore& baked,
                          const std::filesystem::path& lutFile, const spectral::DataLibrary& library) {
  OCIO::ConstTransformRcPtr transform = baked.group;
  if (!lutFile.empty()) {
    auto file = OCIO::FileTransform::Create();
    file->setSrc(spectral::utf8(std::filesystem::absolute(lutFile)).c_str());
    file->setInterpolation(OCIO::INTERP_TETRAHEDRAL);
    transform = file;
  }
  Certificate certificate = baked.certificate;
  certificate.recipe = use.recipe;
  certificate.error = errorOf(core, use, transform, certificate.probes, library);
  // Of the table's own adaptation, not of this recipe's.
  certificate.pixels = {};
  return certificate;
}

BakedCore bakeCore(const ConfigCore& core, const spectral::DataLibrary& library, int size,
                   std::optional<double> tolerance, const std::filesystem::path& folder) {
  Baked baked = cheapest(core, library, size, tolerance);
  BakedCore result{baked.group, std::move(baked.certificate), ""};
  if (asMatrix(result.group)) {
    return result;
  }
  const auto textOf = [&](const OCIO::ConstGroupTransformRcPtr& group) {
    const LutDescription description{core.name, "metamer-" + sha256(sip::toYaml(core.recipe)).substr(0, 16),
                                     result.certificate.lines()};
    return shortTables(lutText(lutFormat("core.ctf", ""), group, result.certificate.size, description));
  };
  spectral::PendingFile trial(folder / "trial.ctf");
  trial.write(textOf(result.group));
  result.group = withExactNeutrals(result.group, PixelProcessor::fromFile(trial.path()),
                                   sip::SpectralTransform(specOf(core, library)));
  result.lutText = textOf(result.group);
  result.certificate.format = lutFormat("core.ctf", "").name;
  result.certificate.sha256 = sha256(result.lutText);
  return result;
}

}  // namespace metamer::ocio
