// SPDX-License-Identifier: Apache-2.0
#include "config_cores.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "config_spaces.h"
#include "matrix_operator.h"
#include "metamer/ocio/lut_writer.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/near_names.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

constexpr const char* kInterchangeRole = "aces_interchange";
constexpr const char* kInterchangeSpace = "ACES2065-1";
constexpr const char* kChart = "colorchecker";
constexpr int kChainSize = 65;
constexpr std::array<int, 8> kTableSizes = {9, 13, 17, 21, 25, 33, 49, 65};
constexpr double kRounding = 1e5;

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
    if (const auto found = facts.space(name)) {
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
    if (lowerCase(space.name) == lowerCase(recipe.space)) {
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
  // "day_to_night_0" of 050 and 000 is not a name: digits at the end go too.
  name.erase(name.find_last_not_of("0123456789 _-.") + 1);
  return name.empty() ? uses.front().recipe.name : name;
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

/// The first of nothing, a matrix and tables of rising size that holds a tolerance.
Baked cheapest(const sip::Recipe& recipe, const spectral::DataLibrary& library, int size,
               std::optional<double> tolerance) {
  const int largest = size != 0 ? size : kChainSize;
  BakeOptions options;
  options.size = largest;
  if (tolerance) {
    options.representation = Representation::Matrix;
    Baked baked = bake(recipe, library, options);
    if (baked.certificate.error.p99 <= *tolerance) {
      // A matrix that changes nothing comes from a recipe that does nothing.
      options.representation.reset();
      return baked.certificate.error.max < 1e-3 ? bake(recipe, library, options) : baked;
    }
    options.representation.reset();
    for (const int nodes : kTableSizes) {
      options.size = nodes;
      if (nodes < largest && (baked = bake(recipe, library, options)).certificate.error.p99 <= *tolerance) {
        return baked;
      }
    }
    options.size = largest;
  }
  return bake(recipe, library, options);
}

/// Tables with their values rounded, so that they are short as text.
OCIO::GroupTransformRcPtr rounded(const OCIO::ConstGroupTransformRcPtr& group) {
  const auto shorter = [](float value) { return static_cast<float>(std::round(value * kRounding) / kRounding); };
  auto copy = OCIO::DynamicPtrCast<OCIO::GroupTransform>(group->createEditableCopy());
  for (int k = 0; k < copy->getNumTransforms(); ++k) {
    const auto transform = copy->getTransform(k);
    std::array<float, 3> rgb{};
    if (const auto cube = OCIO::DynamicPtrCast<OCIO::Lut3DTransform>(transform)) {
      const unsigned long size = cube->getGridSize();
      for (unsigned long node = 0; node < size * size * size; ++node) {
        const std::array<unsigned long, 3> at = {node / (size * size), node / size % size, node % size};
        cube->getValue(at[0], at[1], at[2], rgb[0], rgb[1], rgb[2]);
        cube->setValue(at[0], at[1], at[2], shorter(rgb[0]), shorter(rgb[1]), shorter(rgb[2]));
      }
    } else if (const auto curve = OCIO::DynamicPtrCast<OCIO::Lut1DTransform>(transform)) {
      for (unsigned long entry = 0; entry < curve->getLength(); ++entry) {
        curve->getValue(entry, rgb[0], rgb[1], rgb[2]);
        curve->setValue(entry, shorter(rgb[0]), shorter(rgb[1]), shorter(rgb[2]));
      }
    }
  }
  return copy;
}

/// Lines of numbers without the spaces that align them.
std::string squeezed(const std::string& text) {
  std::string result;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string line = text.substr(begin, end - begin);
    if (line.find_first_not_of("0123456789+-.eE \n") != std::string::npos) {
      result += line;
    } else {
      for (std::size_t k = 0; k < line.size(); ++k) {
        const bool isNeeded = line[k] != ' ' || (!result.empty() && result.back() != '\n' && result.back() != ' ');
        result += isNeeded ? std::string(1, line[k]) : std::string();
      }
    }
    begin = end;
  }
  return result;
}

sip::TransformSpec specOf(const ConfigCore& core, const spectral::DataLibrary& library) {
  return sip::resolve(core.recipe, library, library.colourSpace(core.recipe.space).linear);
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
    const std::string key = common.folder.string() + "\n" + sip::toYaml(common);
    const auto [found, isNew] = coreOf.emplace(key, cores.size());
    if (isNew) {
      cores.push_back({"", recipe, place.processSpace, place.linearFromProcess, {}});
      cores.back().recipe.space = place.linearSpace;
    }
    ConfigCore& core = cores[found->second];
    core.recipe.adaptation = std::max(core.recipe.adaptation, recipe.adaptation);
    core.uses.push_back({recipe, place.pixelSpace, place.encoding});
  }
  std::set<std::string> names;
  for (ConfigCore& core : cores) {
    core.name = commonName(core.uses);
    if (!names.insert(lowerCase(core.name)).second) {
      core.name = core.uses.front().recipe.name;
      names.insert(lowerCase(core.name));
    }
    core.recipe.name = core.name;
  }
  return cores;
}

BakedCore bakeCore(const ConfigCore& core, const spectral::DataLibrary& library, int size,
                   std::optional<double> tolerance) {
  Baked baked = cheapest(core.recipe, library, size, tolerance);
  BakedCore result{baked.group, std::move(baked.certificate), ""};
  if (!asMatrix(result.group)) {
    const LutFormat& format = lutFormat("core.ctf", "");
    const LutDescription description{core.name, "metamer-" + sha256(sip::toYaml(core.recipe)).substr(0, 16),
                                     result.certificate.lines()};
    result.lutText = squeezed(lutText(format, rounded(result.group), result.certificate.size, description));
    result.certificate.format = format.name;
    result.certificate.sha256 = sha256(result.lutText);
  }
  return result;
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
  ConfigCore onLinear = core;
  onLinear.linearFromProcess.reset();
  auto group = OCIO::GroupTransform::Create();
  for (const ConfigStep& step : stepsOf(onLinear, use, baked, "", library)) {
    if (const auto* matrix = std::get_if<Eigen::Matrix3d>(&step)) {
      group->appendTransform(matrixOperator(*matrix));
    } else {
      auto file = OCIO::FileTransform::Create();
      file->setSrc(std::filesystem::absolute(lutFile).string().c_str());
      file->setInterpolation(OCIO::INTERP_TETRAHEDRAL);
      group->appendTransform(file);
    }
  }
  Certificate certificate = baked.certificate;
  certificate.recipe = use.recipe;
  sip::TransformSpec spec = specOf(core, library);
  spec.adaptation = use.recipe.adaptation;
  const PixelProcessor processor(group);
  certificate.error = sip::ErrorProtocol(spec, library.reflectances(kChart).samples, certificate.probes)
                          .measure([&](std::span<float> rgba) { processor.apply(rgba); });
  return certificate;
}

}  // namespace metamer::ocio
