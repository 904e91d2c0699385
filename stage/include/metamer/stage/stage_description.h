// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "metamer/stage/panel_linearity.h"
#include "metamer/stage/wall_intervals.h"

namespace metamer::stage {

/// A chart as a stage file names it: a CSV of patches, or a picture with the chart's corners in it.
struct StageChart {
  std::filesystem::path file;
  std::vector<Eigen::Vector2d> corners;  ///< pixels, four: first patch's corner, then along its row, then round
};

/// A patch of the wall: its value, or a picture with a box of pixels to average.
struct StagePrimary {
  std::optional<Eigen::Vector3d> value;
  std::filesystem::path file;
  std::array<int, 4> box{};  ///< left, top, right, bottom; right and bottom are outside
};

/// What the camera saw of a channel at rising drives: a CSV (parseDriveSeries), or the numbers. Neither: no ramp.
struct StageRamp {
  std::filesystem::path file;
  std::optional<DriveSeries> series;

  bool isGiven() const { return !file.empty() || series.has_value(); }
};

/// The stage as measured spectra, in place of captures. Names or files, as DataLibrary takes them, or model LEDs.
struct StageSpectra {
  std::array<std::string, 3> emitters;
  std::string camera;
  std::string reflectances = "colorchecker";
  std::string target;
};

/// How patches lie on a photographed chart.
struct StageLayout {
  int columns = 6;
  int rows = 4;
  std::vector<std::string> names;  ///< row by row; empty: those of the reflectance set
  std::string reflectances = "colorchecker";
};

/// A stage to be solved, as its file says it (docs/led_stage.md). YAML:
///
///     metamer_stage: 1
///     primaries: {red: [0.82, 0.09, 0.01], green: [0.31, 0.90, 0.12], blue: [0.02, 0.14, 0.88]}
///     charts: {red: r.csv, green: g.csv, blue: b.csv, target: t.csv}
///     calibration_square: {width_m: 1, height_m: 1, distance_m: 1}
///     environment: {white: [1.1, 1.0, 0.8]}
///     black_level: [0, 0, 0]
///     q: {preserve_white: false, white_patch: white}
///     noise: 0.01
struct StageDescription {
  std::filesystem::path folder;  ///< where relative files are looked for: the stage file's own
  std::string where;             ///< what messages call it
  std::string name;
  std::optional<StageSpectra> spectra;
  std::array<StagePrimary, 3> primaries;
  std::array<StageChart, 3> charts;
  StageChart target;
  std::array<StageRamp, 3> ramps;
  StageLayout layout;
  double widthM = 1;
  double heightM = 1;
  double distanceM = 1;
  std::optional<Eigen::Vector3d> environmentWhite;
  std::filesystem::path environmentFile;  ///< HDR lat-long
  Eigen::Vector3d facing{0, 0, 1};        ///< where the chart looks in it
  double whiteReflectance = 1;            ///< of the white patch, where w_avg is taken from the target chart
  Eigen::Vector3d blackLevel = Eigen::Vector3d::Zero();
  bool preserveWhite = false;
  std::string whitePatch;
  std::vector<std::string> skinPatches;
  double skinWeight = 1;                   ///< of the chart's skin patches
  double skinPriority = 0;                 ///< of each virtual skin beside a patch's 1 (skin_priority.h)
  std::optional<double> largestCondition;  ///< of Q in N's inverse; without it chosen from the captures' noise
  std::optional<CaptureNoise> noise;       ///< of the captures; without it estimated from the charts
  std::optional<double> saturation;
  std::vector<std::string> excluded;
  std::string colourSpace;  ///< of the camera's linear RGB, for colour differences and configs; empty: not said
};

/// @throws spectral::InputError with file, line, field, value and remedy
StageDescription readStage(const std::filesystem::path& file);
StageDescription parseStage(const std::string& text, const std::string& where, const std::filesystem::path& folder);

}  // namespace metamer::stage
