// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "apply/any_picture.h"
#include "apply/frames.h"
#include "apply/picture_clues.h"
#include "apply/picture_space.h"
#include "exr/exr_reader.h"
#include "exr/exr_strips.h"
#include "library.h"
#include "metamer/sip/scene_uplift.h"
#include "metamer/sip/tabulated_uplift.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_picture.h"
#include "metamer/spectral/text.h"
#include "picture_commands.h"
#include "positive_number.h"
#include "uplift/spectral_rows.h"

namespace metamer::lutgen {
namespace {

namespace fs = std::filesystem;
using spectral::InputError;

/// The visible range and some more: names of channels sort as numbers do.
constexpr int kLeastNm = 300;
constexpr int kMostNm = 999;

struct UpliftOptions {
  std::string picture;
  std::string output;
  std::string method = "natural";
  std::string pictureSpace;
  std::string layer;
  std::string type = "half";
  std::string compression = "zip";
  std::string wavelengths = "380-780x10";
  std::int64_t mostPixels = std::int64_t{1} << 31;
  int threads = 0;
};

std::vector<int> wavelengthsFrom(const std::string& text) {
  const char* remedy = "write whole nm from 300 to 999, rising: 380-780x10, 400-700x5, 450,550,650";
  std::vector<int> all;
  try {
    all = framesFrom(text);
  } catch (const InputError&) {
    throw InputError("--wavelengths", "nm", text, remedy);
  }
  if (all.empty() || all.front() < kLeastNm || all.back() > kMostNm || !std::is_sorted(all.begin(), all.end())) {
    throw InputError("--wavelengths", "nm", text, remedy);
  }
  return all;
}

/// What is taken from the picture; its samples in the file's types are not kept.
struct Source {
  int width = 0;
  ExrBox dataWindow;
  ExrBox displayWindow;
  float pixelAspectRatio = 1;
  std::optional<PictureSpace> space;
  std::vector<float> rgb;    ///< linear
  std::vector<float> alpha;  ///< empty: none
};

PictureSpace spaceOf(const AnyPicture& picture, const ColourLayer& layer, const UpliftOptions& options,
                     const spectral::DataLibrary& library) {
  if (!options.pictureSpace.empty()) {
    return pictureSpaceNamed(options.pictureSpace, "--picture-space", library, ocio::ConfigSource::environment());
  }
  const SpaceClues clues = cluesOf(picture, layer);
  std::string doubt;
  const auto said = pictureSpaceOf(clues, options.picture, library, doubt);
  if (said) {
    note(doubt.empty() ? std::vector<std::string>{} : std::vector<std::string>{doubt});
    return *said;
  }
  const char* taken = clues.isFloat ? "Rec.709" : "sRGB";
  note({options.picture + ": it does not say what its pixels are: taken as " + taken +
        "; --picture-space names what they are"});
  return pictureSpaceNamed(taken, options.picture, library, ocio::ConfigSource());
}

ExrBox boxOf(int x, int y, int width, int height) {
  return {x, y, x + width - 1, y + height - 1};
}

Source sourceOf(const UpliftOptions& options, const spectral::DataLibrary& library) {
  AnyPicture picture(spectral::pathOf(options.picture), options.mostPixels);
  LayerRequest request;
  if (!options.layer.empty()) {
    request.layers = {options.layer};
  }
  const std::vector<ColourLayer> layers = chooseLayers(picture.facts(), request, options.picture);
  if (layers.size() > 1) {
    throw InputError(options.picture, "layers", "", "are several (views); name one: --layer NAME");
  }
  const ColourLayer& layer = layers[0];
  const OIIO::ImageSpec& spec = picture.spec(layer.part);
  if (spec.deep || spec.depth > 1) {
    throw InputError(options.picture, "pixels", spec.deep ? "deep" : "volume",
                     "have no rows; flatten the picture first");
  }
  Source source;
  source.width = spec.width;
  source.dataWindow = boxOf(spec.x, spec.y, spec.width, spec.height);
  source.displayWindow = boxOf(spec.full_x, spec.full_y, spec.full_width, spec.full_height);
  source.pixelAspectRatio = spec.get_float_attribute("PixelAspectRatio", 1.0F);
  source.space = spaceOf(picture, layer, options, library);
  picture.load();
  source.rgb = picture.values(layer.part, {layer.channels.begin(), layer.channels.end()});
  if (layer.alpha >= 0) {
    source.alpha = picture.values(layer.part, {layer.alpha});
  }
  return source;
}

/// The rows of a file: the colours as they are, linear, with their spectra.
class UpliftedPicture {
 public:
  UpliftedPicture(const Source& source, const spectral::Uplift& uplift, const spectral::RgbSpace& rec709,
                  const std::vector<int>& wavelengths, ExrType type)
      : m_source(source),
        m_rows(uplift, between(source.space->linear, rec709), wavelengths),
        m_bands(wavelengths.size()),
        m_type(type) {}

  void fill(const ExrRectangle& strip, char* samples) {
    const auto width = static_cast<std::size_t>(m_source.width);
    std::vector<float> spectra(m_bands * width);
    std::vector<float> rgba(4 * width, 1.0F);
    std::vector<float> rgb(3 * width);
    std::vector<float> plane(width);
    const auto put = [&](std::span<const float> values) {
      putSamples(samples, m_type, values);
      samples += values.size() * sizeOf(m_type);
    };
    for (int y = strip.y; y < strip.y + strip.height; ++y) {
      const std::size_t first = static_cast<std::size_t>(y - m_source.dataWindow.yMin) * width;
      std::copy_n(&m_source.rgb[3 * first], 3 * width, rgb.begin());
      if (m_source.space->decode) {
        decode(rgb, rgba);
      }
      std::span<const float> alpha;
      if (!m_source.alpha.empty()) {
        alpha = std::span(m_source.alpha).subspan(first, width);
        put(alpha);
      }
      m_rows.spectra(rgb, alpha, spectra);
      for (const std::size_t k : {2U, 1U, 0U}) {
        for (std::size_t x = 0; x < width; ++x) {
          plane[x] = rgb[3 * x + k];
        }
        put(plane);
      }
      put(spectra);
    }
  }

  SpectralRows::Unphysical unphysical() const { return m_rows.unphysical(); }

 private:
  void decode(std::vector<float>& rgb, std::vector<float>& rgba) const {
    for (std::size_t x = 0; x < rgb.size() / 3; ++x) {
      std::copy_n(&rgb[3 * x], 3, &rgba[4 * x]);
    }
    m_source.space->decode(rgba);
    for (std::size_t x = 0; x < rgb.size() / 3; ++x) {
      std::copy_n(&rgba[4 * x], 3, &rgb[3 * x]);
    }
  }

  const Source& m_source;
  SpectralRows m_rows;
  std::size_t m_bands;
  ExrType m_type;
};

std::vector<ExrAttribute> attributesOf(const UpliftOptions& options, const spectral::RgbSpace& space) {
  std::string chromaticities;
  for (const float number : chromaticitiesOf(space)) {
    putNumber(chromaticities, number);
  }
  return {{"chromaticities", "chromaticities", chromaticities},
          {"metamer:uplift", "string", spectral::lowerCase(options.method)},
          {"spectralLayoutVersion", "string", "1.0"}};
}

std::string shareText(std::uint64_t pixels, std::size_t all) {
  return spectral::formatted("%.2g %%", 100 * static_cast<double>(pixels) / static_cast<double>(all));
}

/// What the spectra of a picture are that no surface has.
std::vector<std::string> notesOf(const SpectralRows::Unphysical& found, std::size_t pixels, const std::string& file) {
  std::vector<std::string> notes;
  const auto add = [&](std::uint64_t count, const std::string& what) {
    if (count > 0) {
      notes.push_back(file + ": " + shareText(count, pixels) + " of the pixels " + what);
    }
  };
  add(found.above, "have spectra above 1: brighter than what this method calls a surface");
  add(found.below, "have spectra below 0: colours that this method has no reflectance for");
  add(found.noNumbers, "are not numbers, and so are their spectra");
  return notes;
}

void uplift(const UpliftOptions& options) {
  if (formatOf(spectral::pathOf(options.output)) != "openexr") {
    throw InputError(options.output, "format", spectral::utf8(spectral::pathOf(options.output).extension()),
                     "holds no spectra; write .exr");
  }
  const std::vector<int> wavelengths = wavelengthsFrom(options.wavelengths);
  const auto library = openLibrary();
  std::unique_ptr<spectral::Uplift> method;
  try {
    method = sip::makeUplift(options.method, library);
  } catch (const InputError& error) {
    throw InputError("--method", "", "", error.what());
  }
  const Source source = sourceOf(options, library);
  const ExrType type = options.type == "half" ? ExrType::Half : ExrType::Float;
  if (type == ExrType::Half && sip::isSceneUplift(options.method)) {
    // A scene's spectra cost a solve each; a table's are as near as half floats are.
    method = sip::tabulated(std::move(method), library.colourSpace("ACES2065-1").linear);
  }
  UpliftedPicture picture(source, *method, library.colourSpace("Rec.709").linear, wavelengths, type);

  ExrStrips strips;
  const auto& compressions = exrCompressionNames();
  strips.compression = static_cast<ExrCompression>(
      std::find(compressions.begin(), compressions.end(), options.compression) - compressions.begin());
  strips.dataWindow = source.dataWindow;
  strips.displayWindow = source.displayWindow;
  strips.pixelAspectRatio = source.pixelAspectRatio;
  strips.attributes = attributesOf(options, source.space->linear);
  std::vector<std::string> names = {"B", "G", "R"};
  if (!source.alpha.empty()) {
    names.insert(names.begin(), "A");
  }
  for (const int nm : wavelengths) {
    names.push_back(spectral::channelOfWavelength(nm, spectral::SpectralQuantity::Reflectance));
  }
  for (const std::string& name : names) {
    strips.channels.push_back({name, type});
  }
  strips.fill = [&](const ExrRectangle& rows, char* samples) { picture.fill(rows, samples); };
  writeExrStrips(strips, spectral::pathOf(options.output), options.threads);

  note(notesOf(picture.unphysical(), source.rgb.size() / 3, options.output));
  summarise(spectral::formatted("%s: %d x %d, %zu wavelengths from %d to %d nm, %s, %s", options.output.c_str(),
                                source.width, static_cast<int>(source.dataWindow.height()), wavelengths.size(),
                                wavelengths.front(), wavelengths.back(), spectral::lowerCase(options.method).c_str(),
                                source.space->name.c_str()));
}

}  // namespace

void addUplift(CLI::App& application) {
  CLI::App* command = kUplift.addTo(application);
  const auto options = std::make_shared<UpliftOptions>();
  command->add_option("PICTURE", options->picture, "Colours of surfaces, any format OIIO reads")->required();
  command->add_option("-o,--output", options->output, "Spectral EXR to write")->required();
  command->add_option("--method", options->method,
                      "One of: " + spectral::joined(sip::upliftNames()) + "; left out: natural");
  command->add_option("--wavelengths", options->wavelengths, "nm of the channels; left out: 380-780x10");
  command->add_option("--picture-space", options->pictureSpace,
                      "What the pixels are, where the file does not say: sRGB, ACEScg, \"sRGB - Texture\" ...");
  command->add_option("--layer", options->layer, "Layer to take, of an EXR with several");
  command->add_option("-d,--type", options->type, "Type of the channels: half or float; left out: half")
      ->check(CLI::IsMember({"half", "float"}));
  command->add_option("--compression", options->compression, "zip, zips, piz, rle or none; left out: zip")
      ->check(CLI::IsMember({"zip", "zips", "piz", "rle", "none"}));
  command->add_option("--threads", options->threads, "Threads; 0: as many as the machine has")
      ->check(CLI::Range(0, 256));
  command->add_option("--max-pixels", options->mostPixels, "Largest picture that is read; default 2147483648")
      ->check(positiveNumber());
  command->callback([options] { uplift(*options); });
}

}  // namespace metamer::lutgen
