// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/stage_description.h"

#include <cmath>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/yaml_section.h"
#include "metamer/stage/chart_grid.h"
#include "metamer/stage/skin_priority.h"

namespace metamer::stage {
namespace {

using spectral::InputError;
using spectral::YamlNode;
using spectral::YamlSection;
using Kind = YamlNode::Kind;

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

/// Reads parts of a stage file; knows its folder.
class StageReader {
 public:
  StageReader(std::string where, std::filesystem::path folder)
      : m_where(std::move(where)), m_folder(std::move(folder)) {}

  YamlSection section(const YamlNode& node, const std::string& path, std::initializer_list<const char*> keys) const {
    return {node, m_where, path, keys, kDocument};
  }

  std::vector<double> numbers(const YamlSection& section, const YamlNode& node, const std::string& key,
                              std::size_t count, double low, double high, const std::string& example) const {
    if (node.kind != Kind::Sequence || node.items.size() != count) {
      throw section.error(node, section.named(key), node.text,
                          "must be a list of " + std::to_string(count) + " numbers, such as " + example);
    }
    std::vector<double> values;
    for (const YamlNode& item : node.items) {
      values.push_back(section.number(item, key, low, high));
    }
    return values;
  }

  Eigen::Vector3d colour(const YamlSection& section, const YamlNode& node, const std::string& key) const {
    const auto values = numbers(section, node, key, 3, -kLargestValue, kLargestValue, "[0.8, 0.1, 0.0]");
    return {values[0], values[1], values[2]};
  }

  std::vector<std::string> names(const YamlSection& section, const std::string& key) const {
    std::vector<std::string> result;
    if (const YamlNode* node = section.find(key)) {
      if (node->kind != Kind::Sequence) {
        throw section.error(*node, section.named(key), node->text, "must be a list of names, such as [dark skin]");
      }
      for (const YamlNode& item : node->items) {
        result.push_back(section.text(item, key));
      }
    }
    return result;
  }

  std::filesystem::path file(const std::string& text) const {
    const std::filesystem::path path = spectral::pathOf(text);
    return path.is_absolute() ? path : m_folder / path;
  }

  std::vector<Eigen::Vector2d> corners(const YamlSection& section, const YamlNode& node) const {
    const std::string form = "must be four pixels, such as [[100, 80], [700, 90], [690, 480], [110, 470]]";
    if (node.kind != Kind::Sequence || node.items.size() != 4) {
      throw section.error(node, section.named("corners"), node.text, form);
    }
    std::vector<Eigen::Vector2d> result;
    for (const YamlNode& item : node.items) {
      const auto values = numbers(section, item, "corners", 2, -kLargestPixel, kLargestPixel, "[100, 80]");
      result.emplace_back(values[0], values[1]);
    }
    return result;
  }

  StageChart chart(const YamlSection& charts, const char* key, const std::vector<Eigen::Vector2d>& common) const {
    const YamlNode& node = charts.require(
        key, std::string("is missing; give a CSV of the chart's patches, such as '") + key + ": " + key + ".csv'");
    StageChart result;
    result.corners = common;
    if (node.kind != Kind::Map) {
      result.file = file(charts.text(node, key));
      return result;
    }
    const YamlSection own = section(node, charts.named(key), {"file", "corners"});
    result.file = file(own.text(own.require("file", "is missing; name the picture or CSV"), "file"));
    if (const YamlNode* given = own.find("corners")) {
      result.corners = corners(own, *given);
    }
    return result;
  }

  StagePrimary primary(const YamlSection& primaries, const char* key) const {
    const YamlNode& node = primaries.require(
        key, std::string("is missing; give what the camera saw, such as '") + key + ": [0.8, 0.1, 0.0]'");
    StagePrimary result;
    if (node.kind != Kind::Map) {
      result.value = colour(primaries, node, key);
      return result;
    }
    const YamlSection own = section(node, primaries.named(key), {"file", "box"});
    result.file = file(own.text(own.require("file", "is missing; name the picture of the wall"), "file"));
    const auto box = numbers(own, own.require("box", "is missing; give the patch's pixels, [left, top, right, bottom]"),
                             "box", 4, 0, kLargestPixel, "[100, 80, 200, 180]");
    for (std::size_t i = 0; i < 4; ++i) {
      result.box[i] = static_cast<int>(std::lround(box[i]));
    }
    return result;
  }

  StageRamp ramp(const YamlSection& ramps, const YamlNode& node, const char* key) const {
    if (node.kind != Kind::Sequence) {
      return {file(ramps.text(node, key)), std::nullopt};
    }
    DriveSeries series;
    series.rgb.resize(3, static_cast<Eigen::Index>(node.items.size()));
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      const YamlNode& row = node.items[i];
      const auto values = numbers(ramps, row, key, 4, -kLargestValue, kLargestValue, "[0.25, 0.1, 0.02, 0]");
      if (values[0] < 0) {
        throw ramps.error(row, ramps.named(key), row.items[0].text, "must be the drive that was sent, a number from 0");
      }
      series.drives.push_back(values[0]);
      series.rgb.col(static_cast<Eigen::Index>(i)) << values[1], values[2], values[3];
    }
    return {{}, series};
  }

  const std::string& where() const { return m_where; }

 private:
  std::string m_where;
  std::filesystem::path m_folder;
};

StageSpectra readSpectra(const StageReader& reader, const YamlNode& node) {
  const YamlSection section = reader.section(node, "spectra", {"emitters", "camera", "reflectances", "target"});
  StageSpectra spectra;
  const YamlSection emitters = reader.section(section.require("emitters", "is missing; give the wall's three channels"),
                                              "spectra.emitters", {"red", "green", "blue"});
  for (std::size_t k = 0; k < 3; ++k) {
    spectra.emitters[k] = emitters.text(
        emitters.require(kChannels[k], "is missing; give its spectrum: a file, a name or a model"), kChannels[k]);
  }
  spectra.camera = section.text(section.require("camera", "is missing; see: lutgen list observers"), "camera");
  spectra.target = section.text(section.require("target", "is missing; see: lutgen list illuminants"), "target");
  section.read("reflectances", spectra.reflectances);
  return spectra;
}

void readCaptures(const StageReader& reader, const YamlSection& top, StageDescription& stage) {
  const YamlSection primaries = reader.section(
      top.require("primaries", "is missing; give the wall's patches as the camera saw them, or 'spectra'"), "primaries",
      {"red", "green", "blue"});
  const YamlSection charts = reader.section(
      top.require("charts", "is missing; give the chart under each channel and in the real place, or 'spectra'"),
      "charts", {"red", "green", "blue", "target", "corners", "columns", "rows", "names", "reflectances"});
  std::vector<Eigen::Vector2d> common;
  if (const YamlNode* corners = charts.find("corners")) {
    common = reader.corners(charts, *corners);
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
  stage.layout.names = reader.names(charts, "names");
}

void readEnvironment(const StageReader& reader, const YamlNode& node, StageDescription& stage) {
  const YamlSection section = reader.section(node, "environment", {"white", "file", "facing", "white_reflectance"});
  if (const YamlNode* white = section.find("white")) {
    stage.environmentWhite = reader.colour(section, *white, "white");
  }
  if (const YamlNode* file = section.find("file")) {
    if (stage.environmentWhite) {
      throw section.error(*file, "environment.file", file->text, "stands beside environment.white; keep one");
    }
    stage.environmentFile = reader.file(section.text(*file, "file"));
  }
  if (const YamlNode* facing = section.find("facing")) {
    stage.facing = reader.colour(section, *facing, "facing");
    if (!(stage.facing.norm() > 0)) {
      throw section.error(*facing, "environment.facing", "[0, 0, 0]", "must be a direction, such as [0, 0, 1]");
    }
  }
  section.read("white_reflectance", stage.whiteReflectance, 1e-3, 1);
}

CaptureNoise readNoise(const StageReader& reader, const YamlSection& top, const YamlNode& node) {
  CaptureNoise noise;
  if (node.kind != Kind::Map) {
    noise.relative = top.number(node, "noise", 0, kLargestNoise);
    return noise;
  }
  const YamlSection section = reader.section(node, "noise", {"relative", "floor"});
  section.read("relative", noise.relative, 0, kLargestNoise);
  section.read("floor", noise.floor, 0, kLargestValue);
  return noise;
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
  const YamlNode root = spectral::parseYaml(text, where, {.name = kDocument});
  const StageReader reader(where, folder);
  const YamlSection top =
      reader.section(root, "",
                     {"metamer_stage", "name", "primaries", "charts", "spectra", "calibration_square", "environment",
                      "black_level", "q", "noise", "saturation", "exclude", "colour_space", "ramps"});
  const YamlNode& version = top.require("metamer_stage", "is missing; a stage file starts with 'metamer_stage: 1'");
  if (version.kind != Kind::Scalar || version.text != "1") {
    throw top.error(version, "metamer_stage", version.text, "is a version this release does not read; it reads 1");
  }
  StageDescription stage;
  stage.folder = folder;
  stage.where = where;
  top.read("name", stage.name);
  top.read("colour_space", stage.colourSpace);
  if (const YamlNode* spectra = top.find("spectra")) {
    stage.spectra = readSpectra(reader, *spectra);
    for (const char* key : {"primaries", "charts"}) {
      if (const YamlNode* node = top.find(key)) {
        throw top.error(*node, key, "", "stands beside spectra, which make it; keep one");
      }
    }
  } else {
    readCaptures(reader, top, stage);
  }
  if (const YamlNode* square = top.find("calibration_square")) {
    const YamlSection section = reader.section(*square, "calibration_square", {"width_m", "height_m", "distance_m"});
    section.read("width_m", stage.widthM, kSmallestLengthM, kLargestLengthM);
    section.read("height_m", stage.heightM, kSmallestLengthM, kLargestLengthM);
    section.read("distance_m", stage.distanceM, kSmallestLengthM, kLargestLengthM);
  }
  if (const YamlNode* environment = top.find("environment")) {
    readEnvironment(reader, *environment, stage);
  }
  if (const YamlNode* ramps = top.find("ramps")) {
    const YamlSection section = reader.section(*ramps, "ramps", {"red", "green", "blue"});
    for (std::size_t k = 0; k < 3; ++k) {
      const YamlNode& node = section.require(
          kChannels[k], "is missing; give what the camera saw of the channel's ramp, a CSV (patch,R,G,B)");
      stage.ramps[k] = reader.ramp(section, node, kChannels[k]);
    }
  }
  if (const YamlNode* black = top.find("black_level")) {
    stage.blackLevel = reader.colour(top, *black, "black_level");
  }
  if (const YamlNode* q = top.find("q")) {
    const YamlSection section = reader.section(
        *q, "q", {"preserve_white", "white_patch", "skin_patches", "skin_weight", "skin_priority", "max_condition"});
    section.read("preserve_white", stage.preserveWhite);
    section.read("white_patch", stage.whitePatch);
    section.read("skin_weight", stage.skinWeight, 0, 1e6);
    section.read("skin_priority", stage.skinPriority, 0, kLargestSkinWeight);
    if (section.find("max_condition") != nullptr) {
      double largest = kDefaultLargestCondition;
      section.read("max_condition", largest, 1, 1e12);
      stage.largestCondition = largest;
    }
    stage.skinPatches = reader.names(section, "skin_patches");
  }
  if (const YamlNode* noise = top.find("noise")) {
    stage.noise = readNoise(reader, top, *noise);
  }
  if (top.find("saturation") != nullptr) {
    double saturation = 0;
    top.read("saturation", saturation, 1e-9, kLargestValue);
    stage.saturation = saturation;
  }
  stage.excluded = reader.names(top, "exclude");
  return stage;
}

}  // namespace metamer::stage
