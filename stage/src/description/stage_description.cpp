// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/stage_description.h"

#include <cmath>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"
#include "metamer/spectral/yaml_value.h"
#include "metamer/stage/chart_grid.h"
#include "metamer/stage/skin_priority.h"

namespace metamer::stage {
namespace {

using spectral::InputError;
using spectral::YamlMap;
using spectral::YamlValue;

constexpr const char* kDocument = "stage";
constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};
/// Stage files may not be larger than this.
constexpr std::uintmax_t kLargestStageBytes = 1u << 20;
constexpr double kLargestValue = 1e9;
/// Relative noise above this is no capture.
constexpr double kLargestNoise = 0.5;
constexpr double kSmallestLengthM = 1e-3;
constexpr double kLargestLengthM = 1e3;
constexpr double kLargestPixel = 1e6;

/// `count` numbers of a list.
std::vector<double> numbersOf(const YamlValue& value, std::size_t count, double low, double high,
                              const std::string& example) {
  if (!value.isSequence() || value.size() != count) {
    throw value.error("must be a list of " + std::to_string(count) + " numbers, such as " + example);
  }
  return value.numbers(low, high);
}

Eigen::Vector3d colourOf(const YamlValue& value) {
  const auto values = numbersOf(value, 3, -kLargestValue, kLargestValue, "[0.8, 0.1, 0.0]");
  return {values[0], values[1], values[2]};
}

std::vector<std::string> namesOf(const YamlMap& section, const std::string& key) {
  std::vector<std::string> result;
  if (const auto value = section.find(key)) {
    if (!value->isSequence()) {
      throw value->error("must be a list of names, such as [dark skin]");
    }
    for (const YamlValue& item : value->items()) {
      result.push_back(item.text());
    }
  }
  return result;
}

std::vector<Eigen::Vector2d> cornersOf(const YamlValue& value) {
  if (!value.isSequence() || value.size() != 4) {
    throw value.error("must be four pixels, such as [[100, 80], [700, 90], [690, 480], [110, 470]]");
  }
  std::vector<Eigen::Vector2d> result;
  for (const YamlValue& item : value.items()) {
    const auto values = numbersOf(item, 2, -kLargestPixel, kLargestPixel, "[100, 80]");
    result.emplace_back(values[0], values[1]);
  }
  return result;
}

/// Reads what may name a file; knows the stage's folder.
class StageReader {
 public:
  explicit StageReader(std::filesystem::path folder) : m_folder(std::move(folder)) {}

  std::filesystem::path file(const YamlValue& value) const {
    const std::filesystem::path path = spectral::pathOf(value.text());
    return path.is_absolute() ? path : m_folder / path;
  }

  StageChart chart(const YamlMap& charts, const char* key, const std::vector<Eigen::Vector2d>& common) const {
    const YamlValue value = charts.require(
        key, std::string("is missing; give a CSV of the chart's patches, such as '") + key + ": " + key + ".csv'");
    StageChart result;
    result.corners = common;
    if (!value.isMap()) {
      result.file = file(value);
      return result;
    }
    const YamlMap own(value, {"file", "corners"});
    result.file = file(own.require("file", "is missing; name the picture or CSV"));
    if (const auto given = own.find("corners")) {
      result.corners = cornersOf(*given);
    }
    return result;
  }

  StagePrimary primary(const YamlMap& primaries, const char* key) const {
    const YamlValue value = primaries.require(
        key, std::string("is missing; give what the camera saw, such as '") + key + ": [0.8, 0.1, 0.0]'");
    StagePrimary result;
    if (!value.isMap()) {
      result.value = colourOf(value);
      return result;
    }
    const YamlMap own(value, {"file", "box"});
    result.file = file(own.require("file", "is missing; name the picture of the wall"));
    const auto box = numbersOf(own.require("box", "is missing; give the patch's pixels, [left, top, right, bottom]"), 4,
                               0, kLargestPixel, "[100, 80, 200, 180]");
    for (std::size_t i = 0; i < 4; ++i) {
      result.box[i] = static_cast<int>(std::lround(box[i]));
    }
    return result;
  }

  StageRamp ramp(const YamlValue& value) const {
    if (!value.isSequence()) {
      return {file(value), std::nullopt};
    }
    const auto rows = value.items();
    DriveSeries series;
    series.rgb.resize(3, static_cast<Eigen::Index>(rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto values = numbersOf(rows[i], 4, -kLargestValue, kLargestValue, "[0.25, 0.1, 0.02, 0]");
      if (values[0] < 0) {
        throw rows[i].error(spectral::shortestNumber(values[0]), "must be the drive that was sent, a number from 0");
      }
      series.drives.push_back(values[0]);
      series.rgb.col(static_cast<Eigen::Index>(i)) << values[1], values[2], values[3];
    }
    return {{}, series};
  }

 private:
  std::filesystem::path m_folder;
};

StageSpectra readSpectra(const YamlValue& value) {
  const YamlMap section(value, {"emitters", "camera", "reflectances", "target"});
  StageSpectra spectra;
  const YamlMap emitters(section.require("emitters", "is missing; give the wall's three channels"),
                         {"red", "green", "blue"});
  for (std::size_t k = 0; k < 3; ++k) {
    spectra.emitters[k] =
        emitters.require(kChannels[k], "is missing; give its spectrum: a file, a name or a model").text();
  }
  spectra.camera = section.require("camera", "is missing; see: lutgen list observers").text();
  spectra.target = section.require("target", "is missing; see: lutgen list illuminants").text();
  section.read("reflectances", spectra.reflectances);
  return spectra;
}

void readCaptures(const StageReader& reader, const YamlMap& top, StageDescription& stage) {
  const YamlMap primaries(
      top.require("primaries", "is missing; give the wall's patches as the camera saw them, or 'spectra'"),
      {"red", "green", "blue"});
  const YamlMap charts(
      top.require("charts", "is missing; give the chart under each channel and in the real place, or 'spectra'"),
      {"red", "green", "blue", "target", "corners", "columns", "rows", "names", "reflectances"});
  std::vector<Eigen::Vector2d> common;
  if (const auto corners = charts.find("corners")) {
    common = cornersOf(*corners);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    stage.primaries[k] = reader.primary(primaries, kChannels[k]);
    stage.charts[k] = reader.chart(charts, kChannels[k], common);
  }
  stage.target = reader.chart(charts, "target", common);
  double columns = stage.layout.columns;
  double rows = stage.layout.rows;
  charts.read("columns", columns, 1, ChartGrid::kMostAlong);
  charts.read("rows", rows, 1, ChartGrid::kMostAlong);
  stage.layout.columns = static_cast<int>(columns);
  stage.layout.rows = static_cast<int>(rows);
  charts.read("reflectances", stage.layout.reflectances);
  stage.layout.names = namesOf(charts, "names");
}

void readEnvironment(const StageReader& reader, const YamlValue& value, StageDescription& stage) {
  const YamlMap section(value, {"white", "file", "facing", "white_reflectance"});
  if (const auto white = section.find("white")) {
    stage.environmentWhite = colourOf(*white);
  }
  if (const auto file = section.find("file")) {
    if (stage.environmentWhite) {
      throw file->error("stands beside environment.white; keep one");
    }
    stage.environmentFile = reader.file(*file);
  }
  if (const auto facing = section.find("facing")) {
    stage.facing = colourOf(*facing);
    if (!(stage.facing.norm() > 0)) {
      throw facing->error("[0, 0, 0]", "must be a direction, such as [0, 0, 1]");
    }
  }
  section.read("white_reflectance", stage.whiteReflectance, 1e-3, 1);
}

CaptureNoise readNoise(const YamlValue& value) {
  CaptureNoise noise;
  if (!value.isMap()) {
    noise.relative = value.number(0, kLargestNoise);
    return noise;
  }
  const YamlMap section(value, {"relative", "floor"});
  section.read("relative", noise.relative, 0, kLargestNoise);
  section.read("floor", noise.floor, 0, kLargestValue);
  return noise;
}

void readQ(const YamlValue& value, StageDescription& stage) {
  const YamlMap section(
      value, {"preserve_white", "white_patch", "skin_patches", "skin_weight", "skin_priority", "max_condition"});
  section.read("preserve_white", stage.preserveWhite);
  section.read("white_patch", stage.whitePatch);
  section.read("skin_weight", stage.skinWeight, 0, 1e6);
  section.read("skin_priority", stage.skinPriority, 0, kLargestSkinWeight);
  if (const auto largest = section.find("max_condition")) {
    stage.largestCondition = largest->number(1, 1e12);
  }
  stage.skinPatches = namesOf(section, "skin_patches");
}

}  // namespace

StageDescription readStage(const std::filesystem::path& file) {
  std::error_code none;
  const auto size = std::filesystem::file_size(file, none);
  if (!none && std::filesystem::is_regular_file(file, none) && size > kLargestStageBytes) {
    throw InputError(spectral::utf8(file), "size", std::to_string(size),
                     "is more than a stage file may have (" + std::to_string(kLargestStageBytes) + " bytes)");
  }
  StageDescription stage = parseStage(spectral::readTextFile(file), spectral::utf8(file), file.parent_path());
  if (stage.name.empty()) {
    stage.name = spectral::utf8(file.stem());
  }
  return stage;
}

StageDescription parseStage(const std::string& text, const std::string& where, const std::filesystem::path& folder) {
  const StageReader reader(folder);
  const YamlMap top(YamlValue::parse(text, where, {.name = kDocument}),
                    {"metamer_stage", "name", "primaries", "charts", "spectra", "calibration_square", "environment",
                     "black_level", "q", "noise", "saturation", "exclude", "colour_space", "ramps"});
  top.requireVersion();
  StageDescription stage;
  stage.folder = folder;
  stage.where = where;
  top.read("name", stage.name);
  top.read("colour_space", stage.colourSpace);
  if (const auto spectra = top.find("spectra")) {
    stage.spectra = readSpectra(*spectra);
    for (const char* key : {"primaries", "charts"}) {
      if (const auto given = top.find(key)) {
        throw given->error("", "stands beside spectra, which make it; keep one");
      }
    }
  } else {
    readCaptures(reader, top, stage);
  }
  if (const auto square = top.find("calibration_square")) {
    const YamlMap section(*square, {"width_m", "height_m", "distance_m"});
    section.read("width_m", stage.widthM, kSmallestLengthM, kLargestLengthM);
    section.read("height_m", stage.heightM, kSmallestLengthM, kLargestLengthM);
    section.read("distance_m", stage.distanceM, kSmallestLengthM, kLargestLengthM);
  }
  if (const auto environment = top.find("environment")) {
    readEnvironment(reader, *environment, stage);
  }
  if (const auto ramps = top.find("ramps")) {
    const YamlMap section(*ramps, {"red", "green", "blue"});
    for (std::size_t k = 0; k < 3; ++k) {
      stage.ramps[k] = reader.ramp(section.require(
          kChannels[k], "is missing; give what the camera saw of the channel's ramp, a CSV (patch,R,G,B)"));
    }
  }
  if (const auto black = top.find("black_level")) {
    stage.blackLevel = colourOf(*black);
  }
  if (const auto q = top.find("q")) {
    readQ(*q, stage);
  }
  if (const auto noise = top.find("noise")) {
    stage.noise = readNoise(*noise);
  }
  if (const auto saturation = top.find("saturation")) {
    stage.saturation = saturation->number(1e-9, kLargestValue);
  }
  stage.excluded = namesOf(top, "exclude");
  return stage;
}

}  // namespace metamer::stage
