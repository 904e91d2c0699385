// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <cmath>
#include <iostream>
#include <memory>

#include "library.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/naming_file.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/stage/emitter_model.h"
#include "metamer/stage/panel_eotf.h"
#include "positive_number.h"
#include "stage/stage_commands.h"
#include "stage/stage_json.h"
#include "stage_pictures/chart_picture.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

struct SampleOptions {
  std::string picture;
  std::string output;
  std::string checkPicture;
  std::vector<std::string> corners;
  std::string reflectances = "colorchecker";
  int columns = 6;
  int rows = 4;
  double saturation = 0;
};

Eigen::Vector2d cornerOf(const std::string& text) {
  Eigen::Vector2d corner;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, corner.x());
  const bool hasComma = first.ec == std::errc() && first.ptr != end && *first.ptr == ',';
  const auto second = hasComma ? std::from_chars(first.ptr + 1, end, corner.y()) : first;
  if (!hasComma || second.ec != std::errc() || second.ptr != end) {
    throw InputError("--corners", "corner", text, "must be a pixel x,y, such as 120,80.5");
  }
  return corner;
}

void sample(const SampleOptions& options) {
  spectral::requireWritable(spectral::pathOf(options.output));
  spectral::requireWritable(spectral::pathOf(options.checkPicture));
  const auto library = openLibrary();
  stage::StageLayout layout;
  layout.columns = options.columns;
  layout.rows = options.rows;
  layout.reflectances = options.reflectances;
  const ChartReader reader(layout, library, {},
                           options.saturation > 0 ? std::optional<double>(options.saturation) : std::nullopt);
  stage::StageChart chart{spectral::pathOf(options.picture), {}};
  for (const std::string& text : options.corners) {
    chart.corners.push_back(cornerOf(text));
  }
  std::vector<std::string> notes;
  const stage::ChartTable table = reader.read(chart, notes, spectral::pathOf(options.checkPicture));
  std::string text = "patch,R,G,B\n";
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const auto rgb = table.rgb.col(static_cast<Eigen::Index>(i));
    text += "\"" + table.names[i] + "\"";
    for (const double value : rgb) {
      text += std::isfinite(value) ? spectral::formatted(",%.9g", value) : std::string(",");
    }
    text += "\n";
  }
  spectral::writeWholeFile(spectral::pathOf(options.output), text);
  for (const std::string& note : notes) {
    std::cout << "note: " << note << '\n';
  }
}

void linearity(const std::string& file, double tolerance, const std::string& output) {
  spectral::requireWritable(spectral::pathOf(output));
  const stage::DriveSeries series = stage::parseDriveSeries(spectral::readTextFile(spectral::pathOf(file)), file);
  const stage::PanelLinearity judged = spectral::namingFile(file, [&] { return stage::judgeLinearity(series); });
  const bool isLinear = judged.deviation <= tolerance;
  if (!output.empty()) {
    writeJson(spectral::pathOf(output), {{"linear", isLinear},
                                         {"gain", judged.gain},
                                         {"black", judged.black},
                                         {"exponent", judged.exponent},
                                         {"deviation", judged.deviation},
                                         {"worst_drive", judged.worstDrive},
                                         {"hue_drift_degrees", judged.hueDrift},
                                         {"tolerance", tolerance}});
  }
  std::cout << spectral::formatted(
      "%s: farthest from a straight line by %.2f %% of full, at drive %g; exponent %.3f, black %.4g, "
      "hue drift %.2f degrees\n",
      isLinear ? "linear" : "not linear", 100 * judged.deviation, judged.worstDrive, judged.exponent, judged.black,
      judged.hueDrift);
  if (!isLinear) {
    throw InputError(
        file, "deviation", spectral::formatted("%.4g", judged.deviation),
        spectral::formatted("is above %.4g: the panel is not linear; send it drives through the inverse of its "
                            "curve (exponent %.3f), or set it to linear",
                            tolerance, judged.exponent));
  }
}

void emitter(const std::string& model, const std::string& output) {
  const auto found = stage::emitterFromModel(model);
  if (!found) {
    throw InputError("", "model", model,
                     "must be led:PEAK:WIDTH or phosphor:PUMP:PUMP_WIDTH:PEAK:WIDTH:PUMP_SHARE, in nm");
  }
  std::string text = "# a model of an emitter, not a measurement\nwavelength_nm," + found->spectrum.name() + "\n";
  for (std::size_t i = 0; i < found->spectrum.values().size(); ++i) {
    text += spectral::formatted("%g,%.9g\n", found->spectrum.wavelengthsNm()[i], found->spectrum.values()[i]);
  }
  spectral::writeWholeFile(spectral::pathOf(output), text);
}

}  // namespace

void addStageSample(CLI::App& stage) {
  CLI::App* command = stage.add_subcommand("sample", "Patch values of a photographed chart");
  const auto options = std::make_shared<SampleOptions>();
  command->add_option("PICTURE", options->picture, "Linear picture, any format OIIO reads")->required();
  command
      ->add_option("--corners", options->corners,
                   "The chart's four corners as pixels x,y: the first patch's outer corner, along its row, and round")
      ->required()
      ->expected(4);
  command->add_option("-o,--output", options->output, "CSV to write: patch,R,G,B")->required();
  command->add_option("--check-picture", options->checkPicture, "Picture to write: the sampled squares drawn in");
  command->add_option("--columns", options->columns, "Patches along the first row; 6 by default")
      ->check(CLI::Range(1, 1000));
  command->add_option("--rows", options->rows, "Rows of patches; 4 by default")->check(CLI::Range(1, 1000));
  command->add_option("--reflectances", options->reflectances,
                      "What the chart is: SET or FILE; colorchecker by default");
  command->add_option("--saturation", options->saturation, "From this value on a pixel is clipped")
      ->check(positiveNumber());
  command->callback([options] { sample(*options); });
}

void addStageLinearity(CLI::App& stage) {
  CLI::App* command = stage.add_subcommand("linearity", "Whether a panel's light is proportional to what is sent");
  struct Options {
    std::string series;
    std::string output;
    double tolerance = 0.02;
  };
  const auto options = std::make_shared<Options>();
  command
      ->add_option("SERIES", options->series,
                   "CSV with the header patch,R,G,B: one channel's drives (in place of patch) as the camera saw them")
      ->required();
  command->add_option("--tolerance", options->tolerance, "Largest distance from a straight line, of full; 0.02")
      ->check(positiveNumber());
  command->add_option("--json", options->output, "JSON to write");
  command->callback([options] { linearity(options->series, options->tolerance, options->output); });
}

void addStageEmitter(CLI::App& stage) {
  CLI::App* command = stage.add_subcommand("emitter", "A model LED as a spectrum, where none was measured");
  struct Options {
    std::string model;
    std::string output;
  };
  const auto options = std::make_shared<Options>();
  command
      ->add_option("MODEL", options->model, "led:PEAK:WIDTH or phosphor:PUMP:PUMP_WIDTH:PEAK:WIDTH:PUMP_SHARE, in nm")
      ->required();
  command->add_option("-o,--output", options->output, "CSV to write")->required();
  command->callback([options] { emitter(options->model, options->output); });
}

}  // namespace metamer::lutgen
