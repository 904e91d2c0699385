// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "library.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "picture_commands.h"
#include "progress.h"
#include "report/live.h"
#include "report/page.h"
#include "run.h"

namespace metamer::lutgen {
namespace {

/// More would make a page that no mail takes.
constexpr int kMostPictures = 8;

struct ReportArguments {
  std::string recipe;
  std::string output;
  std::vector<std::string> pictures;
  std::string pictureSpace;
  bool isLive = false;
};

void report(const ReportArguments& arguments) {
  if (arguments.pictures.size() > kMostPictures) {
    throw CLI::ValidationError("--picture", spectral::formatted("%zu are given; a page takes %d at most",
                                                                arguments.pictures.size(), kMostPictures));
  }
  if (!arguments.pictureSpace.empty() && arguments.pictures.empty()) {
    throw CLI::ValidationError("--picture-space", "says what the pixels of --picture are; give one");
  }
  spectral::PendingFile file(spectral::pathOf(arguments.output));
  if (file.isStream()) {
    standardOutput();
  }
  const auto library = openLibrary();
  const auto config = ocio::ConfigSource::environment();
  PageContents contents;
  contents.recipe = sip::readRecipe(spectral::pathOf(arguments.recipe));
  if (arguments.isLive) {
    contents.live = livePage(contents.recipe);
  }
  const PictureSpace pixels = pictureSpaceNamed(contents.recipe.space, "recipe", library, config);
  const sip::TransformSpec spec = sip::resolve(contents.recipe, library, pixels.linear);
  note(sip::notesOf(contents.recipe, spec));
  const sip::SpectralTransform transform(spec);
  const Screen screen(pixels.linear, library.colourSpace("Rec.709").linear);
  const FilmView film(pixels.linear, library.colourSpace("ACES2065-1").linear);
  const WorkFolder folder;
  contents.hasOwnPhotographs = arguments.pictures.empty();
  contents.pictures = contents.hasOwnPhotographs
                          ? ownPhotographs(pixels, film, library, folder)
                          : shownPictures(arguments.pictures, arguments.pictureSpace, pixels, library, config);
  {
    Progress progress(arguments.output);
    contents.forms =
        bakedForms(contents.recipe, library, config, folder, [&progress](double share) { progress.show(0.8 * share); });
  }
  relight(contents.pictures, transform, contents.forms, screen, film, folder,
          arguments.isLive ? kLargestJpegBesideEngine : kLargestJpeg);
  contents.view = film.name();
  contents.spectra = spectraCharts(spec, screen);
  contents.field = fieldChart(spec, transform, screen);
  contents.groups = knownSurfaces(spec, transform, library);
  for (const SurfaceGroup& group : contents.groups) {
    contents.surfaces.push_back(surfaceChart(group, screen));
  }
  for (const BakedForm& form : contents.forms) {
    contents.maps.push_back(errorChart(form.comparison, pixels.linear, screen, form.label));
  }
  const std::string html = htmlOf(contents);
  file.write(html);
  file.commit();
  summarise(spectral::formatted("%s: %zu pictures, %zu kB, p99 %.3g as .ctf", arguments.output.c_str(),
                                contents.pictures.size(), html.size() / 1000,
                                contents.forms.front().certificate.error.p99));
}

}  // namespace

void addReport(CLI::App& application) {
  CLI::App* command = kReport.addTo(application);
  const auto arguments = std::make_shared<ReportArguments>();
  command->add_option("RECIPE", arguments->recipe, "Recipe file")->required();
  command->add_option("-o,--output", arguments->output, "HTML file to write")->required();
  command
      ->add_option("--picture", arguments->pictures,
                   "Picture to show before and after, in place of two photographs; may be repeated, 8 at most")
      ->expected(1)
      ->take_all();
  command->add_option("--picture-space", arguments->pictureSpace,
                      "What the pictures' pixels are, where the files do not say: sRGB, ACEScct, \"Gamma 2.4\" ...");
  command->add_flag("--live", arguments->isLive,
                    "With the playground in the page: other lights, gels and pictures, by the engine itself");
  command->callback([arguments] { report(*arguments); });
}

}  // namespace metamer::lutgen
