// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/measure.h"

#include <OpenImageIO/imageio.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/picture_file.h"

namespace metamer::spectral_ref {
namespace {

struct MeasureArguments {
  std::string file;
  std::vector<std::string> patches;
  std::string grid;
  std::string region;
  double inset = 0.25;
  bool json = false;
};

/// Whole numbers between separators, exactly `count` of them.
std::vector<int> parseIntegers(const std::string& flag, const std::string& text, char separator, std::size_t count) {
  std::vector<int> values;
  const char* place = text.data();
  const char* end = place + text.size();
  while (values.size() < count) {
    int value = 0;
    const auto parsed = std::from_chars(place, end, value);
    const bool isLast = values.size() + 1 == count;
    if (parsed.ec != std::errc() || (isLast ? parsed.ptr != end : parsed.ptr == end || *parsed.ptr != separator)) {
      break;
    }
    values.push_back(value);
    place = isLast ? parsed.ptr : parsed.ptr + 1;
  }
  if (values.size() != count) {
    throw CLI::ValidationError(
        flag, "'" + text + "' must be " + std::to_string(count) + " whole numbers, separated by '" + separator + "'");
  }
  return values;
}

PatchArea wholePicture(const std::string& file) {
  spectral::requirePictureFile(file);
  const auto input = OIIO::ImageInput::open(file);
  if (!input) {
    const std::string reason = OIIO::geterror();
    throw spectral::InputError(file, "", "", "cannot be read: " + spectral::pictureReason(reason));
  }
  return {"picture", 0, 0, input->spec().width, input->spec().height};
}

std::vector<PatchArea> gridOf(const MeasureArguments& arguments, const PatchArea& region) {
  const std::vector<int> size = parseIntegers("--grid", arguments.grid, 'x', 2);
  if (size[0] < 1 || size[1] < 1) {
    throw CLI::ValidationError("--grid", "'" + arguments.grid + "' must be COLUMNSxROWS, such as 6x4");
  }
  std::vector<PatchArea> areas;
  const double width = static_cast<double>(region.width) / size[0];
  const double height = static_cast<double>(region.height) / size[1];
  for (int row = 0; row < size[1]; ++row) {
    for (int column = 0; column < size[0]; ++column) {
      PatchArea area;
      area.name = std::to_string(row * size[0] + column + 1);
      area.x = region.x + static_cast<int>(std::ceil((column + arguments.inset) * width));
      area.y = region.y + static_cast<int>(std::ceil((row + arguments.inset) * height));
      area.width = region.x + static_cast<int>(std::floor((column + 1 - arguments.inset) * width)) - area.x;
      area.height = region.y + static_cast<int>(std::floor((row + 1 - arguments.inset) * height)) - area.y;
      areas.push_back(area);
    }
  }
  return areas;
}

std::vector<PatchArea> areasOf(const MeasureArguments& arguments) {
  std::vector<PatchArea> areas;
  for (const std::string& text : arguments.patches) {
    const std::size_t equals = text.find('=');
    const std::string numbers = equals == std::string::npos ? text : text.substr(equals + 1);
    const std::vector<int> values = parseIntegers("--patch", numbers, ',', 4);
    areas.push_back(
        {equals == std::string::npos ? text : text.substr(0, equals), values[0], values[1], values[2], values[3]});
  }
  PatchArea region = wholePicture(arguments.file);
  if (!arguments.region.empty()) {
    const std::vector<int> values = parseIntegers("--region", arguments.region, ',', 4);
    region = {"region", values[0], values[1], values[2], values[3]};
  }
  if (!arguments.grid.empty()) {
    const std::vector<PatchArea> grid = gridOf(arguments, region);
    areas.insert(areas.end(), grid.begin(), grid.end());
  }
  if (areas.empty()) {
    areas.push_back(region);
  }
  return areas;
}

/// JSON has no NaN.
nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

void measureFile(const MeasureArguments& arguments) {
  const Measurement measurement = measure(spectral::pathOf(arguments.file), areasOf(arguments));
  if (!arguments.json) {
    std::printf("%-16s %14s %14s %14s %14s %14s\n", "patch", "R", "G", "B", "Y", "+- 95 %");
    for (const PatchMean& patch : measurement.patches) {
      std::printf("%-16s %14.7g %14.7g %14.7g %14.7g %14.7g\n", patch.area.name.c_str(), patch.colour[0],
                  patch.colour[1], patch.colour[2], patch.luminance, patch.halfWidth);
    }
    std::fflush(stdout);
    return;
  }
  nlohmann::json json = {{"file", arguments.file}, {"wavelengths", measurement.wavelengthsNm}};
  json["patches"] = nlohmann::json::array();
  for (const PatchMean& patch : measurement.patches) {
    const double half = patch.halfWidth;
    json["patches"].push_back({{"name", patch.area.name},
                               {"area", {patch.area.x, patch.area.y, patch.area.width, patch.area.height}},
                               {"rgb", patch.colour},
                               {"Y", patch.luminance},
                               {"variance", number(patch.variance)},
                               {"degreesOfFreedom", patch.degrees},
                               {"interval95", {number(patch.luminance - half), number(patch.luminance + half)}},
                               {"radiance", patch.bins}});
  }
  std::cout << json.dump(2) << '\n';
}

}  // namespace

void addMeasure(CLI::App& application) {
  CLI::App* command = application.add_subcommand("measure", "Patch means of a render, with 95 % intervals of Y");
  const auto arguments = std::make_shared<MeasureArguments>();
  command->add_option("FILE", arguments->file, "Picture of spectral_ref render")->required();
  command->add_option("--patch", arguments->patches, "[NAME=]X,Y,WIDTH,HEIGHT in pixels from the top left; repeatable");
  command->add_option("--grid", arguments->grid, "COLUMNSxROWS equal patches of the region, such as 6x4");
  command->add_option("--region", arguments->region, "X,Y,WIDTH,HEIGHT of the grid; the whole picture by default");
  command->add_option("--inset", arguments->inset, "Share of a grid cell left out on every side; 0.25 by default")
      ->check(CLI::Range(0.0, 0.49));
  command->add_flag("--json", arguments->json, "JSON on stdout, with spectral bins");
  command->callback([arguments] { measureFile(*arguments); });
}

}  // namespace metamer::spectral_ref
