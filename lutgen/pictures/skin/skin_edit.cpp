// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>

#include "apply/frame_report.h"
#include "apply/picture_clues.h"
#include "library.h"
#include "metamer/skin/skin_colours.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/naming_file.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/text.h"
#include "positive_number.h"
#include "run.h"
#include "skin/skin_commands.h"
#include "skin/skin_maps.h"
#include "skin/skin_steps.h"

namespace metamer::lutgen {
namespace {

namespace fs = std::filesystem;
using spectral::InputError;

struct EditOptions {
  std::string maps;
  std::string output;
  std::string frames;
  std::string outputSpace;
  std::string type;
  std::string compression;
  SkinCapture capture;
  SkinStepOptions steps;
  std::int64_t mostPixels = std::int64_t{1} << 31;
  int threads = 0;
};

class Editing {
 public:
  Editing(const EditOptions& options, std::vector<SkinStep> steps)
      : m_options(options),
        m_steps(std::move(steps)),
        m_library(openLibrary()),
        m_config(ocio::ConfigSource::environment()) {
    if (!options.outputSpace.empty()) {
      m_to = pictureSpaceNamed(options.outputSpace, "--output-space", m_library, m_config);
    }
    if (!options.type.empty()) {
      m_type = sampleTypeNamed(options.type);
    } else if (isSrgbFormat(formatOf(spectral::pathOf(options.output)))) {
      m_type = sampleTypeNamed("uint8");  // no floats there
    }
  }

  /// Reads the header of the first picture, and makes what all need.
  void begin(const Frame& first) {
    AnyPicture picture(first.input, m_options.mostPixels);
    const SkinMapsPlace place = findSkinMaps(picture, spectral::utf8(first.input));
    m_bytes = 4 * picture.bytes();
    m_from = spaceOf(picture, place, first.input);
    m_capture = captureOf(picture, place);
    spectral::namingFile(m_capture.illuminant,
                         [&] { m_colours.emplace(m_library, skinView(m_capture, m_from->linear, m_library)); });
    if (!m_to && isSrgbFormat(formatOf(first.output))) {
      m_to = pictureSpaceNamed("sRGB", m_options.output, m_library, ocio::ConfigSource());
      note({m_options.output + ": written as sRGB, as such files are; --output-space names another"});
    }
    if (m_to) {
      m_written = inTurn({between(m_from->linear, m_to->linear), m_to->encode});
    }
  }

  /// That a frame takes, as the first does.
  std::uint64_t bytes() const { return m_bytes; }

  void edit(const Frame& frame, int threads) {
    AnyPicture picture(frame.input, m_options.mostPixels);
    const SkinMapsPlace place = findSkinMaps(picture, spectral::utf8(frame.input));
    const SkinCapture capture = captureOf(picture, place);
    if (spaceOf(picture, place, frame.input).name != m_from->name || capture.text() != m_capture.text()) {
      throw InputError(spectral::utf8(frame.input), "capture", capture.text(),
                       "is another than that of the frames before; edit it by itself");
    }
    const OIIO::ImageSpec spec = picture.spec(place.part);
    const std::vector<std::string> names = skinMapsHeader(picture, place.part).channels;
    for (const std::string& name : names) {
      if (spec.channelindex(name) >= 0) {
        throw InputError(spectral::utf8(frame.input), "channel", name, "is there beside the maps; take it away");
      }
    }
    picture.load();
    std::vector<skin::SkinPixel> pixels = skinPixels(picture, place);
    picture.exchange(place.part, place.channels, names);
    setSkinMapsHeader(picture, place.part, {{}, {}});
    const int first = picture.spec(place.part).nchannels - 3;
    describe(picture, place.part);
    picture.plan(frame.output, {{"", place.part, {first, first + 1, first + 2}, -1}}, m_type ? &*m_type : nullptr,
                 m_options.compression);
    const std::vector<skin::SkinPixel> before = pixels;
    for (const SkinStep& step : m_steps) {
      runSkinStep(step, pixels, spec.width, spec.height * spec.depth, frame.number);
    }
    std::vector<float> rgb(3 * pixels.size());
    m_colours->colour(pixels, rgb, threads);
    changeColours(rgb, m_written);
    picture.put(place.part, first, rgb);
    picture.save(frame.output, threads);
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_pixels += pixels.size();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      m_edited += pixels[i].skin != before[i].skin ? 1 : 0;
      m_unusable += std::isfinite(rgb[3 * i]) && std::isfinite(rgb[3 * i + 1]) && std::isfinite(rgb[3 * i + 2]) ? 0 : 1;
    }
  }

  void report(std::size_t frames) const {
    const double share = static_cast<double>(m_edited) / static_cast<double>(std::max<std::size_t>(m_pixels, 1));
    summarise(spectral::formatted("%s: %zu %s, %zu %s, %.0f %% of the pixels changed%s, %s", m_options.output.c_str(),
                                  frames, frames == 1 ? "picture" : "frames", m_steps.size(),
                                  m_steps.size() == 1 ? "edit" : "edits", 100 * share,
                                  m_unusable > 0 ? spectral::formatted(", %zu no number", m_unusable).c_str() : "",
                                  (m_to ? m_to->name : m_from->name).c_str()));
  }

 private:
  SkinCapture captureOf(const AnyPicture& picture, const SkinMapsPlace& place) const {
    return m_options.capture.orElse(skinMapsHeader(picture, place.part).capture).orElse(kUsualCapture);
  }

  /// Maps are linear: the residual's space is that of their chromaticities.
  PictureSpace spaceOf(const AnyPicture& picture, const SkinMapsPlace& place, const fs::path& file) const {
    SpaceClues clues;
    clues.format = "openexr";
    std::array<float, 8> xy{};
    if (picture.spec(place.part).getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), xy.data())) {
      clues.chromaticities = xy;
    }
    std::string doubt;
    const auto said = pictureSpaceOf(clues, spectral::utf8(file), m_library, doubt);
    return said ? *said : pictureSpaceNamed("Rec.709", spectral::utf8(file), m_library, ocio::ConfigSource());
  }

  void describe(AnyPicture& picture, int part) const {
    const PictureSpace& written = m_to ? *m_to : *m_from;
    const bool isSrgb = spectral::lowerCase(written.name) == "srgb";
    const bool isExr = formatOf(spectral::pathOf(m_options.output)) == "openexr";
    picture.describe(isSrgb               ? "sRGB"
                     : written.isLinear() ? "Linear"
                                          : "",
                     isExr ? std::optional(chromaticitiesOf(written.linear)) : std::nullopt, part);
  }

  const EditOptions& m_options;
  const std::vector<SkinStep> m_steps;
  const spectral::DataLibrary m_library;
  const ocio::ConfigSource m_config;
  SkinCapture m_capture;
  std::uint64_t m_bytes = 0;
  std::optional<PictureSpace> m_from;
  std::optional<PictureSpace> m_to;
  std::optional<SampleType> m_type;
  std::optional<skin::SkinColours> m_colours;
  PixelFunction m_written;
  std::mutex m_mutex;
  std::size_t m_pixels = 0;
  std::size_t m_edited = 0;
  std::size_t m_unusable = 0;
};

void edit(const EditOptions& options, const CLI::App& command) {
  std::vector<SkinStep> steps = skinSteps(command, options.steps);
  if (formatOf(spectral::pathOf(options.output)).empty()) {
    throw InputError(options.output, "format", spectral::utf8(spectral::pathOf(options.output).extension()),
                     "is not known; write .exr, .tif, .png, .jpg or .dpx");
  }
  const std::vector<Frame> frames = framesOf(options.maps, options.output, options.frames);
  Editing editing(options, std::move(steps));
  editing.begin(frames[0]);
  const ThreadShare share = shareThreads(options.threads, frames.size(), editing.bytes());
  {
    FrameReport report("lutgen skin edit", frames.size());
    forEachFrame(
        frames, share, [&](const Frame& frame) { editing.edit(frame, share.inFrame); },
        [&](const Frame& frame, std::size_t count) { report.done(frame, count); });
  }
  editing.report(frames.size());
}

}  // namespace

void addSkinEdit(CLI::App& skin) {
  CLI::App* command = skin.add_subcommand("edit", "An albedo picture from its maps, edited; without edits, as it was");
  const auto options = std::make_shared<EditOptions>();
  command->add_option("MAPS", options->maps, "Maps of lutgen skin estimate; frames: maps.####.exr")->required();
  command->add_option("-o,--output", options->output, "Picture to write, in the albedo's space")->required();
  addSkinSteps(*command, options->steps);
  addSkinCapture(*command, options->capture, "what the maps say");
  command->add_option("--output-space", options->outputSpace, "What to write; left out: linear, in the albedo's space");
  command->add_option("-d,--type", options->type,
                      "Type of the written colours: half, float, uint8, uint10, uint12, uint16; left out: float, in "
                      "PNG and JPEG uint8");
  command->add_option("--compression", options->compression,
                      "Compression of the written file: zip, piz, dwaa ...; left out: as it is");
  command->add_option("--frames", options->frames, "Frames: 1001-1100, 1-100x5, 1,3,7-9; left out: all that are there");
  command->add_option("--threads", options->threads, "Threads; 0: as many as the machine has")
      ->check(CLI::Range(0, 256));
  command->add_option("--max-pixels", options->mostPixels, "Largest picture that is read; default 2147483648")
      ->check(positiveNumber());
  command->callback([options, command] { edit(*options, *command); });
}

}  // namespace metamer::lutgen
