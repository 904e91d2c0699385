// SPDX-License-Identifier: Apache-2.0
#include <memory>

#include "apply/frame_report.h"
#include "apply/frames.h"
#include "apply/relight.h"
#include "apply/sequence.h"
#include "apply/transform.h"
#include "library.h"
#include "metamer/spectral/formatted.h"
#include "picture_commands.h"
#include "positive_number.h"
#include "run.h"

namespace metamer::lutgen {
namespace {

struct ApplyOptions {
  TransformRequest transform;
  std::vector<std::string> pictures;  ///< IN OUT, and the frames where they stand between or after
  std::string frames;
  std::string channels;
  PictureRequest picture;
};

std::vector<std::string> commaSeparated(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin <= text.size() && !text.empty();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

/// Takes frames that stand among the pictures for --frames.
void takeFrames(ApplyOptions& options) {
  if (options.pictures.size() < 3) {
    return;
  }
  for (std::size_t k = 1; k < 3; ++k) {
    if (looksLikeFrames(options.pictures[k])) {
      if (!options.frames.empty()) {
        throw CLI::ValidationError("--frames", "frames are given twice");
      }
      options.frames = options.pictures[k];
      options.pictures.erase(options.pictures.begin() + static_cast<std::ptrdiff_t>(k));
      return;
    }
  }
  throw CLI::ValidationError("apply", "three names where IN and OUT are wanted: '" + options.pictures[2] +
                                          "' is neither; frames are written as 1001-1100");
}

void apply(ApplyOptions options) {
  takeFrames(options);
  options.picture.layers.channels = commaSeparated(options.channels);
  const std::string& input = options.pictures[0];
  const std::string& output = options.pictures[1];
  const std::vector<Frame> frames = framesOf(input, output, options.frames);
  const auto library = openLibrary();
  const auto config = ocio::ConfigSource::environment();
  Relighter relighter(input, options.picture, library, config);
  const std::uint64_t bytes = relighter.check(frames[0].input, frames[0].output);
  const AppliedTransform transform = appliedTransform(options.transform, library, config);
  relighter.use(transform);
  const ThreadShare share = shareThreads(options.transform.threads, frames.size(), bytes);
  {
    FrameReport report("lutgen apply", frames.size());
    forEachFrame(
        frames, share, [&](const Frame& frame) { relighter.relight(frame.input, frame.output, share.inFrame); },
        [&](const Frame& frame, std::size_t count) { report.done(frame, count); });
  }
  const auto notes = relighter.notes();
  note({notes.begin(), notes.end()});
  const std::string pixels = relighter.pixelsText();
  summarise(spectral::formatted("%s: %zu %s, %s%s", output.c_str(), frames.size(),
                                frames.size() == 1 ? "picture" : "frames", transform.how.c_str(),
                                pixels.empty() ? "" : (", " + pixels).c_str()));
}

void addPictureOptions(CLI::App& command, ApplyOptions& options) {
  command.add_option("--frames", options.frames, "Frames: 1001-1100, 1-100x5, 1,3,7-9; left out: all that are there");
  command
      .add_option("--layer", options.picture.layers.layers,
                  "Layer to transform, of an EXR with several; may be repeated; left out: the one that is the picture")
      ->expected(1)
      ->take_all();
  command.add_option("--channels", options.channels,
                     "Channels of red, green and blue in place of a layer: a.R,a.G,a.B");
  command.add_option(
      "--picture-space", options.picture.pictureSpace,
      "What the pixels are, where the file does not say: sRGB, ACEScct, \"Gamma 2.4\", \"sRGB - Texture\" ...");
  command.add_option("--output-space", options.picture.outputSpace, "What to write; left out: as the picture is");
  command.add_option("-d,--type", options.picture.type,
                     "Type of the written colours: half, float, uint8, uint10, uint12, uint16; left out: as they are");
  command.add_option("--compression", options.picture.compression,
                     "Compression of the written file: zip, piz, dwaa ...; left out: as it is");
  command.add_option("--max-pixels", options.picture.mostPixels, "Largest picture that is read; default 2147483648")
      ->check(positiveNumber());
}

}  // namespace

void addApply(CLI::App& application) {
  CLI::App* command = kApply.addTo(application);
  const auto options = std::make_shared<ApplyOptions>();
  command->add_option("TRANSFORM", options->transform.transform, "Recipe (.yaml), or a LUT file that OpenColorIO reads")
      ->required();
  command
      ->add_option(
          "PICTURES", options->pictures,
          "IN OUT: a picture each, or frames: shot.####.exr out.####.exr (also shot.%04d.exr), with the frames "
          "after IN, or by --frames")
      ->required()
      ->expected(2, 3);
  command->add_option("--threads", options->transform.threads, "Threads; 0: as many as the machine has")
      ->check(CLI::Range(0, 1024));
  CLI::Option* engine =
      command
          ->add_option("--engine", options->transform.engine,
                       "exact: every pixel solved; map: a table within a tenth of a CIEDE2000, faster")
          ->check(CLI::IsMember({"exact", "map"}));
  addPictureOptions(*command, *options);
  addOverrides(*command, options->transform.overrides);
  command->callback([options, command, engine] {
    const auto given = command->get_options([engine](const CLI::Option* option) {
      const bool isOfRecipes = option->get_group().rfind("Recipe", 0) == 0 && option->get_name() != "--space";
      return option->count() > 0 && (option == engine || isOfRecipes);
    });
    options->transform.hasRecipeOptions = !given.empty();
    apply(*options);
  });
}

}  // namespace metamer::lutgen
