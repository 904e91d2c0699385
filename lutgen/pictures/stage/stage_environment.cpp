// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/parallel.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include "library.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/naming_file.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/stage/environment_drive.h"
#include "metamer/stage/patch_names.h"
#include "positive_number.h"
#include "progress.h"
#include "stage/fixture_options.h"
#include "stage/stage_commands.h"
#include "stage/stage_json.h"
#include "stage_pictures/chart_picture.h"
#include "stage_pictures/drive_picture.h"
#include "stage_pictures/environment_picture.h"
#include "stage_pictures/light_list.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

/// Rows that are in memory at once.
constexpr int kRowsAtOnce = 64;
/// Rows a thread takes at a time.
constexpr int kRowsOfChunk = 4;

struct EnvironmentOptions {
  std::string environment;
  std::string output;
  std::vector<std::string> emitterCharts;
  std::vector<std::string> sceneCharts;
  std::string whitePatch = "white";
  std::vector<double> square;
  FixtureLimits limits;
  std::string lights;
  std::string lightsOutput;
  int threads = 0;
  bool progress = false;
};

/// "FILE@x,y,z"; without a direction the chart looks along +z.
struct SceneChartName {
  std::string file;
  Eigen::Vector3d facing{0, 0, 1};
};

SceneChartName sceneChartName(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos) {
    return {text};
  }
  SceneChartName name{text.substr(0, at)};
  const char* cursor = text.data() + at + 1;
  const char* end = text.data() + text.size();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto parsed = std::from_chars(cursor, end, name.facing[k]);
    const bool isLast = k == 2;
    if (parsed.ec != std::errc() || (isLast ? parsed.ptr != end : parsed.ptr == end || *parsed.ptr != ',')) {
      throw InputError("--scene-chart", "direction", text, "must be FILE@x,y,z, such as front.csv@0,0,1");
    }
    cursor = parsed.ptr + (isLast ? 0 : 1);
  }
  return name;
}

/// What is drive-ready, and the emitters' names.
struct Stage {
  std::unique_ptr<stage::EnvironmentDriver> driver;
  std::vector<std::string> names;
  std::vector<stage::ExcludedPatch> excluded;
};

Stage readStageCharts(const EnvironmentOptions& options, const spectral::DataLibrary& library) {
  const ChartReader reader({}, library, {});
  std::vector<std::string> notes;
  std::vector<stage::ChartTable> tables;
  Stage stage;
  for (const std::string& file : options.emitterCharts) {
    tables.push_back(reader.read({spectral::pathOf(file), {}}, notes));
    stage.names.push_back(spectral::utf8(spectral::pathOf(file).stem()));
  }
  std::vector<SceneChartName> scenes;
  for (const std::string& text : options.sceneCharts) {
    scenes.push_back(sceneChartName(text));
    tables.push_back(reader.read({spectral::pathOf(scenes.back().file), {}}, notes));
  }
  const auto aligned = stage::alignCharts(tables, std::nullopt);
  stage.excluded = aligned.excluded;
  if (aligned.names.empty()) {
    throw InputError("--scene-chart", "charts", "", "no patch is in all charts with values that can be used");
  }
  const double beta = options.square.empty()
                          ? 1
                          : stage::calibrationSquareBeta(options.square[0], options.square[1], options.square[2]);
  std::vector<Eigen::Matrix3Xd> emitters;
  for (std::size_t k = 0; k < options.emitterCharts.size(); ++k) {
    emitters.emplace_back(beta * aligned.charts[k]);
  }
  std::vector<stage::SceneChart> sceneCharts;
  for (std::size_t d = 0; d < scenes.size(); ++d) {
    sceneCharts.push_back({aligned.charts[options.emitterCharts.size() + d], scenes[d].facing});
  }
  const int white = stage::patchNamed(aligned.names, options.whitePatch);
  if (white < 0) {
    throw InputError("--white-patch", "patch", options.whitePatch, "is not among the charts' patches, or was left out");
  }
  stage::DriveLimits limits = limitsOf(options.limits, options.emitterCharts.size());
  stage.driver = std::make_unique<stage::EnvironmentDriver>(emitters, sceneCharts, white, std::move(limits));
  return stage;
}

void solveRows(const stage::EnvironmentDriver& driver, const stage::LatLong& layout, int first, int count,
               const Eigen::Matrix3Xf& rgb, std::vector<float>& drives, int threads) {
  const auto emitters = static_cast<std::size_t>(driver.emitterCount());
  drives.resize(static_cast<std::size_t>(rgb.cols()) * emitters);
  OIIO::parallel_for_chunked(
      0, count, kRowsOfChunk,
      [&](std::int64_t begin, std::int64_t end) {
        stage::EnvironmentDriver::Memory memory;
        std::array<double, stage::kMostEnvironmentEmitters> result{};
        for (auto row = static_cast<int>(begin); row < end; ++row) {
          memory.startRow();
          for (int column = 0; column < layout.width; ++column) {
            const Eigen::Index pixel = static_cast<Eigen::Index>(row) * layout.width + column;
            driver.solve(rgb.col(pixel).cast<double>(), layout.direction(column, first + row), memory, result.data());
            std::transform(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(emitters),
                           drives.begin() + pixel * static_cast<std::ptrdiff_t>(emitters),
                           [](double drive) { return static_cast<float>(drive); });
          }
        }
      },
      OIIO::parallel_options(threads));
}

void drive(const EnvironmentOptions& options) {
  const auto library = openLibrary();
  if (options.output.empty() && options.lightsOutput.empty()) {
    throw CLI::ValidationError("-o", "or --lights-output is needed");
  }
  spectral::requireWritable(spectral::pathOf(options.lightsOutput));
  const Stage stage =
      spectral::namingFile(options.sceneCharts.front(), [&] { return readStageCharts(options, library); });
  EnvironmentPicture environment(spectral::pathOf(options.environment));
  const stage::LatLong layout = environment.layout();
  std::unique_ptr<LightList> lights;
  if (!options.lights.empty()) {
    lights = std::make_unique<LightList>(spectral::pathOf(options.lights), layout);
  }
  std::unique_ptr<DrivePicture> output;
  if (!options.output.empty()) {
    output = std::make_unique<DrivePicture>(spectral::pathOf(options.output), layout, stage.names);
  }
  Progress progress("environment", options.progress);
  Eigen::Matrix3Xf rgb;
  std::vector<float> drives;
  std::size_t unusable = 0;
  for (int first = 0; first < layout.height; first += kRowsAtOnce) {
    const int count = std::min(kRowsAtOnce, layout.height - first);
    environment.read(first, count, rgb);
    for (float& value : rgb.reshaped()) {
      const bool isUsable = std::isfinite(value) && value >= 0;
      unusable += isUsable ? 0 : 1;
      value = isUsable ? value : 0.0F;
    }
    if (lights) {
      lights->addRows(first, count, rgb);
    }
    if (output) {
      solveRows(*stage.driver, layout, first, count, rgb, drives, options.threads);
      output->write(first, count, drives);
    }
    progress.show(static_cast<double>(first + count) / layout.height);
  }
  if (output) {
    output->close();
  }
  if (lights) {
    spectral::writeWholeFile(spectral::pathOf(options.lightsOutput), lights->drivesAsCsv(*stage.driver, stage.names));
  }
  for (const stage::ExcludedPatch& patch : stage.excluded) {
    std::cout << "excluded: " << patch.name << ": " << patch.reason << '\n';
  }
  if (unusable > 0) {
    std::cout << spectral::formatted(
        "note: %zu values of the environment are negative or not finite; they count as black\n", unusable);
  }
}

}  // namespace

void addStageEnvironment(CLI::App& stage) {
  CLI::App* command =
      stage.add_subcommand("environment", "Drives of multispectral lights for every direction of an HDR environment");
  const auto options = std::make_shared<EnvironmentOptions>();
  command->add_option("ENVIRONMENT", options->environment, "HDR lat-long, camera RGB, any format OIIO reads")
      ->required();
  command->add_option("-o,--output", options->output, "EXR to write: one channel of drives an emitter");
  command->add_option("--emitter-charts", options->emitterCharts, "The chart under each emitter at a drive of 1: CSV")
      ->required()
      ->expected(1, stage::kMostEnvironmentEmitters);
  command
      ->add_option("--scene-chart", options->sceneCharts,
                   "The chart in the real place, and where it looked: FILE[@x,y,z]; repeat for more directions")
      ->required()
      ->expected(1, 64);
  command->add_option("--white-patch", options->whitePatch,
                      "Patch that has the environment's colour; white by default");
  command
      ->add_option("--square", options->square,
                   "Width, height and distance of the square that lit the emitters' charts; without it, a whole sphere")
      ->expected(3)
      ->check(positiveNumber());
  addFixtureLimits(*command, options->limits);
  CLI::Option* lights =
      command->add_option("--lights", options->lights, "Positions of lights: CSV with the header name,x,y,z");
  command->add_option("--lights-output", options->lightsOutput, "CSV to write: drives of each light")->needs(lights);
  lights->needs("--lights-output");
  command->add_option("--threads", options->threads, "Threads; 0: as many as the machine has")
      ->check(CLI::Range(0, 1024));
  command->add_flag("--progress", options->progress, "Show progress even where stderr is no terminal");
  command->callback([options] { drive(*options); });
}

}  // namespace metamer::lutgen
