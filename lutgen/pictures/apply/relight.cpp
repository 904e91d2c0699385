// SPDX-License-Identifier: Apache-2.0
#include "apply/relight.h"

#include <algorithm>
#include <cstring>
#include <fstream>

#include "apply/picture_clues.h"
#include "exr/exr_change.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/text.h"

namespace metamer::lutgen {
namespace {

namespace fs = std::filesystem;
using spectral::InputError;

bool isExrName(const fs::path& file) {
  const std::string extension = spectral::lowerCase(spectral::utf8(file.extension()));
  return extension == ".exr" || extension == ".sxr" || extension == ".mxr";
}

/// The first bytes, or all. @throws spectral::InputError where it is no file that can be read
std::string bytesOf(const fs::path& file, std::size_t most) {
  std::error_code failure;
  const fs::file_status status = fs::status(file, failure);
  if (!fs::exists(status)) {
    throw InputError(spectral::utf8(file), "", "", "is not there; check the path");
  }
  if (!fs::is_regular_file(status)) {
    throw InputError(spectral::utf8(file), "", "", "is a folder, pipe or device; name a picture");
  }
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(std::min<std::uint64_t>(fs::file_size(file, failure), most), '\0');
  if (failure || !stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    throw InputError(spectral::utf8(file), "", "", "cannot be read; check its permissions");
  }
  return bytes;
}

std::vector<PartFacts> factsOf(const ExrFile& file) {
  std::vector<PartFacts> facts;
  for (const ExrPart& part : file.parts) {
    PartFacts own{part.name, part.view, {}, part.isDeep, {}};
    if (const ExrAttribute* views = part.find("multiView"); views != nullptr && views->type == "stringvector") {
      const std::string_view bytes = views->value;
      std::uint32_t length = 0;
      for (std::size_t at = 0; at + 4 <= bytes.size(); at += 4 + length) {
        std::memcpy(&length, bytes.data() + at, 4);
        own.views.emplace_back(bytes.substr(at + 4, length));
      }
    }
    for (const ExrChannel& channel : part.channels) {
      own.channels.push_back(
          {channel.name, channel.type != ExrType::Uint, channel.xSampling != 1 || channel.ySampling != 1});
    }
    facts.push_back(std::move(own));
  }
  return facts;
}

SpaceClues cluesOf(const ExrPart& part) {
  SpaceClues clues;
  clues.format = "openexr";
  for (const char* name : {"colorInteropID", "oiio:ColorSpace"}) {
    const ExrAttribute* attribute = part.find(name);
    if (attribute != nullptr && attribute->type == "string" && clues.named.empty()) {
      clues.named = attribute->value;
    }
  }
  if (const ExrAttribute* xy = part.find("chromaticities"); xy != nullptr && xy->value.size() == 32) {
    clues.chromaticities.emplace();
    std::memcpy(clues.chromaticities->data(), xy->value.data(), 32);
  }
  return clues;
}

std::optional<ExrType> exrTypeOf(const std::string& name) {
  if (name == "half") {
    return ExrType::Half;
  }
  if (name == "float") {
    return ExrType::Float;
  }
  if (!name.empty()) {
    throw InputError("-d", "type", name, "is not held by OpenEXR; write half or float");
  }
  return std::nullopt;
}

std::optional<ExrCompression> exrCompressionOf(const std::string& name) {
  const auto& names = exrCompressionNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (!name.empty() && found == names.end()) {
    throw InputError("--compression", "name", name, "is not known to OpenEXR; write " + spectral::joined(names));
  }
  return name.empty() ? std::nullopt : std::optional(static_cast<ExrCompression>(found - names.begin()));
}

void checkCompression(const std::string& name, const std::string& format) {
  static const std::vector<std::string> ofTiff = {"none", "lzw", "zip", "packbits"};
  if (format == "openexr") {
    exrCompressionOf(name);
  } else if (!name.empty() && format != "tiff") {
    throw InputError("--compression", "name", name, "is for OpenEXR and TIFF; leave it out");
  } else if (!name.empty() && std::find(ofTiff.begin(), ofTiff.end(), name) == ofTiff.end()) {
    throw InputError("--compression", "name", name, "is not known to TIFF; write " + spectral::joined(ofTiff));
  }
}

}  // namespace

Relighter::Relighter(std::string name, PictureRequest request, const spectral::DataLibrary& library,
                     const ocio::ConfigSource& config)
    : m_name(std::move(name)), m_request(std::move(request)), m_library(library) {
  if (!m_request.type.empty()) {
    m_type = sampleTypeNamed(m_request.type);
  }
  if (!m_request.pictureSpace.empty()) {
    m_stated = pictureSpaceNamed(m_request.pictureSpace, "--picture-space", library, config);
  }
  if (!m_request.outputSpace.empty()) {
    m_output = pictureSpaceNamed(m_request.outputSpace, "--output-space", library, config);
  }
}

std::uint64_t Relighter::check(const fs::path& input, const fs::path& output) const {
  const std::string format = formatOf(output);
  if (format.empty()) {
    throw InputError(spectral::utf8(output), "format", spectral::utf8(output.extension()),
                     "is not known; write .exr, .tif, .png, .jpg or .dpx");
  }
  checkCompression(m_request.compression, format);
  if (isExr(bytesOf(input, 4)) && isExrName(output)) {
    exrTypeOf(m_request.type);
    const std::string bytes = bytesOf(input, ~std::size_t{0});
    chooseLayers(factsOf(readExrFile(bytes, spectral::utf8(input), m_request.mostPixels)), m_request.layers,
                 spectral::utf8(input));
    return 2 * bytes.size();
  }
  if (format == "openexr") {
    exrTypeOf(m_request.type);
  }
  AnyPicture picture(input, m_request.mostPixels);
  picture.plan(output, chooseLayers(picture.facts(), m_request.layers, spectral::utf8(input)),
               m_type ? &*m_type : nullptr, m_request.compression);
  return 3 * picture.bytes();
}

void Relighter::use(const AppliedTransform& transform) {
  m_transform = &transform;
  if (!transform.pixels && (m_stated || m_output)) {
    throw InputError(transform.name, "pixels", "",
                     "are not known: no certificate lies beside the LUT; say what it takes: --space NAME");
  }
}

void Relighter::note(const std::string& text) {
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_notes.insert(text);
}

Relighter::Spaces Relighter::spacesOf(const SpaceClues& clues, const std::string& outputFormat) {
  Spaces spaces;
  std::string doubt;
  spaces.from = m_stated;
  const bool isRecipe = m_transform->isRecipe;
  if (!m_stated) {
    spaces.from = pictureSpaceOf(clues, m_name, m_library, doubt);
  }
  if (!m_transform->pixels) {
    note(m_name + ": a LUT without a certificate is applied to the values as they are; --space says what it takes");
    return {};
  }
  const std::string own = m_transform->pixels->name;
  if (!spaces.from && !isRecipe) {
    note(m_name + ": it does not say what its pixels are: taken as the LUT's; --picture-space names what they are");
  } else if (!spaces.from && !clues.isFloat && m_transform->pixels->isLinear()) {
    spaces.from = pictureSpaceNamed("sRGB", m_name, m_library, ocio::ConfigSource());
    note(m_name + ": it does not say what its pixels are: taken as sRGB; --picture-space names what they are");
  } else if (!spaces.from) {
    note(m_name + ": it does not say what its pixels are: taken as the recipe's, " + own +
         "; --picture-space names what they are");
  } else if (!m_stated && isRecipe && !m_transform->pixels->isLinear() && isSrgbFormat(clues.format)) {
    note(m_name + ": taken as sRGB, as such files are; if its pixels are the recipe's: --picture-space \"" + own +
         "\"");
  }
  if (!doubt.empty()) {
    note(doubt);
  }
  const bool isLinear = spaces.from ? spaces.from->isLinear() : m_transform->pixels->isLinear();
  if (m_output) {
    spaces.to = m_output;
  } else if (outputFormat != clues.format && isSrgbFormat(outputFormat) && isLinear && (isRecipe || spaces.from)) {
    spaces.to = pictureSpaceNamed("sRGB", m_name, m_library, ocio::ConfigSource());
    note(m_name + ": written as sRGB, as such files are; --output-space names another");
  } else if (outputFormat != clues.format && outputFormat == "openexr" && spaces.from && !isLinear) {
    spaces.to = PictureSpace{spaces.from->linear.name, spaces.from->linear, {}, {}};
  }
  if (spaces.to && !spaces.from && !isRecipe) {
    throw InputError("--output-space", "space", m_request.outputSpace,
                     "cannot be reached from pixels that are not known; say what they are: --picture-space NAME");
  }
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_pixelsText = spaces.from ? spaces.from->name : own;
  return spaces;
}

void Relighter::relight(const fs::path& input, const fs::path& output, int threads) {
  if (isExrName(output) && isExr(bytesOf(input, 4))) {
    relightExr(bytesOf(input, ~std::size_t{0}), input, output, threads);
  } else {
    relightAny(input, output, threads);
  }
}

void Relighter::relightExr(const std::string& bytes, const fs::path& input, const fs::path& output, int threads) {
  const ExrFile file = readExrFile(bytes, spectral::utf8(input), m_request.mostPixels);
  ExrChange change;
  const std::vector<ColourLayer> layers = chooseLayers(factsOf(file), m_request.layers, spectral::utf8(input));
  for (const ColourLayer& layer : layers) {
    change.colours.push_back({layer.part, layer.channels, layer.alpha});
  }
  const Spaces spaces = spacesOf(cluesOf(file.parts[static_cast<std::size_t>(layers[0].part)]), "openexr");
  change.pixels = pixelFunction(*m_transform, spaces.from, spaces.to);
  change.type = exrTypeOf(m_request.type);
  change.compression = exrCompressionOf(m_request.compression);
  if (spaces.to) {
    change.chromaticities = chromaticitiesOf(spaces.to->linear);
  }
  if (losesOtherChannels(file, change)) {
    note(m_name + ": its compression is lossy, so other channels lose a little too; --compression zip keeps them");
  }
  spectral::writeWholeFile(output, changedExr(file, change, threads));
}

void Relighter::relightAny(const fs::path& input, const fs::path& output, int threads) {
  AnyPicture picture(input, m_request.mostPixels);
  const std::vector<ColourLayer> layers = chooseLayers(picture.facts(), m_request.layers, spectral::utf8(input));
  const std::string format = formatOf(output);
  picture.plan(output, layers, m_type ? &*m_type : nullptr, m_request.compression);
  const Spaces spaces = spacesOf(cluesOf(picture, layers[0]), format);
  if (spaces.to) {
    const bool isSrgb = spectral::lowerCase(spaces.to->name) == "srgb";
    picture.describe(isSrgb                  ? "sRGB"
                     : spaces.to->isLinear() ? "Linear"
                                             : "",
                     format == "openexr" ? std::optional(chromaticitiesOf(spaces.to->linear)) : std::nullopt);
  }
  picture.write(output, pixelFunction(*m_transform, spaces.from, spaces.to), threads);
}

std::set<std::string> Relighter::notes() const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  return m_notes;
}

std::string Relighter::pixelsText() const {
  const std::lock_guard<std::mutex> lock(m_mutex);
  return m_pixelsText;
}

}  // namespace metamer::lutgen
