// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "apply/picture_clues.h"
#include "library.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/naming_file.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "run.h"
#include "skin/skin_capture.h"
#include "skin/skin_chart.h"
#include "skin/skin_commands.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

struct SampleOptions {
  std::string spectra;
  std::string colours;
  std::string picture;
  std::string spectralPicture;
  std::string space = "Rec.709";
  SkinCapture capture;
  std::vector<int> grid;
  int count = 24;
  std::uint32_t seed = 1;
  int patch = 32;
};

void requireFormat(const std::string& file, bool isExrOnly) {
  const std::string format = file.empty() ? "openexr" : formatOf(spectral::pathOf(file));
  if (format.empty() || (isExrOnly && format != "openexr")) {
    throw InputError(file, "format", spectral::utf8(spectral::pathOf(file).extension()),
                     isExrOnly ? "holds no spectra; write .exr" : "is not known; write .exr, .tif or .png");
  }
}

void sample(const SampleOptions& options) {
  const std::vector<std::string> files = {options.spectra, options.colours, options.picture, options.spectralPicture};
  std::string written;
  for (const std::string& file : files) {
    spectral::requireWritable(spectral::pathOf(file));
    written += (file.empty() || written.empty() ? "" : ", ") + file;
  }
  if (written.empty()) {
    throw CLI::ValidationError("-o", "or --colours, --chart, --spectral is needed");
  }
  requireFormat(options.picture, false);
  requireFormat(options.spectralPicture, true);
  const auto library = openLibrary();
  const spectral::ColourSpace space = library.colourSpace(options.space);
  if (space.encoding) {
    throw InputError("--space", "space", options.space, "is a log; name a linear one: lutgen list spaces");
  }
  const SkinCapture capture = options.capture.orElse(kUsualCapture);
  const auto colours = spectral::namingFile(
      capture.illuminant, [&] { return skin::SkinColours(library, skinView(capture, space.linear, library)); });
  int columns = options.grid.empty() ? 1 : options.grid[0];
  std::vector<skin::SkinParameters> skins = options.grid.empty()
                                                ? drawnSkins(colours.prior(), options.count, options.seed, columns)
                                                : griddedSkins(colours.prior(), options.grid[0], options.grid[1]);
  const SkinChart chart = skinChart(colours, std::move(skins), columns);
  if (!options.spectra.empty()) {
    spectral::writeWholeFile(spectral::pathOf(options.spectra), skinSpectraCsv(chart));
  }
  if (!options.colours.empty()) {
    spectral::writeWholeFile(spectral::pathOf(options.colours), skinColoursCsv(chart, space.linear));
  }
  if (!options.picture.empty()) {
    writeSkinChart(chart, space.linear, options.patch, false, spectral::pathOf(options.picture));
  }
  if (!options.spectralPicture.empty()) {
    writeSkinChart(chart, space.linear, options.patch, true, spectral::pathOf(options.spectralPicture));
  }
  summarise(spectral::formatted("%s: %zu skins, %s, %s", written.c_str(), chart.skins.size(), capture.text().c_str(),
                                space.linear.name.c_str()));
}

}  // namespace

void addSkinSample(CLI::App& skin) {
  CLI::App* command = skin.add_subcommand("sample", "A chart of skins: spectra, colours, pictures");
  const auto options = std::make_shared<SampleOptions>();
  command->add_option("-o,--output", options->spectra, "CSV of reflectances to write, a column a skin");
  command->add_option("--colours", options->colours, "CSV to write: linear RGB, L*a*b* and parameters, a row a skin");
  command->add_option("--chart", options->picture, "Picture to write, a square a skin");
  command->add_option("--spectral", options->spectralPicture, "EXR to write: the chart, a channel a wavelength");
  command->add_option("--count", options->count, "Skins drawn as people have them; 24 by default")
      ->check(CLI::Range(1, 10000));
  command->add_option("--seed", options->seed, "Of the draws; 1 by default");
  command
      ->add_option("--grid", options->grid,
                   "COLUMNS ROWS of melanin and blood, evenly as people have them, in place of draws")
      ->expected(2)
      ->check(CLI::Range(1, 100))
      ->excludes("--count");
  addSkinCapture(*command, options->capture, "D65, CIE 1931 2");
  command->add_option("--space", options->space, "Linear space of the colours; Rec.709 by default");
  command->add_option("--patch", options->patch, "Pixels along a square's side; 32 by default")
      ->check(CLI::Range(1, 1000));
  command->callback([options] { sample(*options); });
}

}  // namespace metamer::lutgen
