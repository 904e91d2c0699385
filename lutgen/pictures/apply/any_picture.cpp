// SPDX-License-Identifier: Apache-2.0
#include "apply/any_picture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/parallel.h>
#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "apply/sample_types.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/picture_file.h"
#include "metamer/spectral/text.h"

namespace metamer::lutgen {
namespace {

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;
using spectral::InputError;

constexpr float kLargestHalf = 65504.0F;

std::unique_ptr<ImageInput> opened(const std::string& file) {
  // Straight alpha, where the file has it, stays straight.
  ImageSpec hints;
  hints.attribute("oiio:UnassociatedAlpha", 1);
  spectral::requirePictureFile(file);
  auto input = ImageInput::open(file, &hints);
  if (!input) {
    throw InputError(file, "", "", "cannot be read: " + spectral::pictureReason(OIIO::geterror()));
  }
  return input;
}

std::unique_ptr<ImageOutput> outputFor(const std::string& file) {
  auto output = ImageOutput::create(file);
  if (!output) {
    OIIO::geterror();
    throw InputError(file, "format", spectral::utf8(spectral::pathOf(file).extension()),
                     "is not known; write .exr, .tif, .png, .jpg or .dpx");
  }
  return output;
}

bool isWhole(TypeDesc type) {
  return type.basetype == TypeDesc::UINT32 || type.basetype == TypeDesc::INT32 || type.basetype == TypeDesc::UINT64 ||
         type.basetype == TypeDesc::INT64;
}

/// Bits of the full code, where they are fewer than those of the type.
int bitsOf(const ImageSpec& spec) {
  const int bits = spec.get_int_attribute("oiio:BitsPerSample", 0);
  return spec.format == TypeDesc::UINT16 && bits > 8 && bits < 16 ? bits : 0;
}

/// The value of the nearest code of `bits` bits, as the 16-bit code that stands for it.
float nearestCode(float value, int bits) {
  const int most = (1 << bits) - 1;
  const int code = static_cast<int>(std::lround(std::clamp(value, 0.0F, 1.0F) * static_cast<float>(most)));
  return static_cast<float>((code << (16 - bits)) | (code >> (2 * bits - 16))) / 65535.0F;
}

}  // namespace

SampleType sampleTypeNamed(const std::string& name) {
  if (name == "uint8") {
    return {TypeDesc::UINT8};
  }
  if (name == "uint10" || name == "uint12") {
    return {TypeDesc::UINT16, name == "uint10" ? 10 : 12};
  }
  if (name == "uint16") {
    return {TypeDesc::UINT16};
  }
  if (name == "half") {
    return {TypeDesc::HALF};
  }
  if (name == "float") {
    return {TypeDesc::FLOAT};
  }
  throw InputError("-d", "type", name, "write half, float, uint8, uint10, uint12 or uint16");
}

AnyPicture::AnyPicture(const std::filesystem::path& file, std::int64_t mostPixels) : m_file(spectral::utf8(file)) {
  const auto input = opened(m_file);
  m_format = input->format_name();
  for (int index = 0; input->seek_subimage(index, 0); ++index) {
    const ImageSpec& spec = input->spec();
    const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height);
    if (spec.width < 1 || spec.height < 1 || spec.depth < 1 ||
        static_cast<std::int64_t>(spec.width) > mostPixels / spec.height / spec.depth) {
      throw InputError(m_file, "size", size,
                       "is larger than " + std::to_string(mostPixels) + " pixels; --max-pixels allows more");
    }
    m_parts.push_back({spec, spec, {}, {}});
    // 0 where the system does not say, such as in a chroot without /proc.
    if (const auto memory = OIIO::Sysutil::physical_memory(); memory > 0 && bytes() > memory / 3) {
      throw InputError(m_file, "size", size, "is more than the memory of this machine holds; crop the picture");
    }
    if (input->seek_subimage(index, 1)) {
      throw InputError(m_file, "MIP levels", "", "would be lost; apply to the picture that they were made from");
    }
  }
  if (m_parts.empty()) {
    throw InputError(m_file, "", "", "cannot be read: " + spectral::pictureReason(input->geterror()));
  }
}

std::uint64_t AnyPicture::bytes() const {
  std::uint64_t sum = 0;
  for (const Part& part : m_parts) {
    sum += part.before.image_bytes(true);
  }
  return sum;
}

std::vector<PartFacts> AnyPicture::facts() const {
  std::vector<PartFacts> facts;
  for (const Part& part : m_parts) {
    const ImageSpec& spec = part.before;
    PartFacts own;
    own.name = m_parts.size() > 1 ? std::string(spec.get_string_attribute("oiio:subimagename")) : "";
    own.view = std::string(spec.get_string_attribute("view"));
    own.isDeep = spec.deep;
    for (int c = 0; c < spec.nchannels; ++c) {
      own.channels.push_back({spec.channelnames[static_cast<std::size_t>(c)], !isWhole(typeOf(spec, c)), false});
    }
    facts.push_back(std::move(own));
  }
  return facts;
}

void AnyPicture::plan(const std::filesystem::path& outputFile, const std::vector<ColourLayer>& layers,
                      const SampleType* type, const std::string& compression) {
  const std::string name = spectral::utf8(outputFile);
  const auto output = outputFor(name);
  const std::string format = output->format_name();
  const auto refuse = [&](const std::string& field, const std::string& value, const std::string& remedy) {
    throw InputError(name, field, value, remedy);
  };
  if (m_parts.size() > 1 && !output->supports("multiimage")) {
    refuse("parts", std::to_string(m_parts.size()), format + " holds one; write .exr or .tif");
  }
  for (std::size_t p = 0; p < m_parts.size(); ++p) {
    Part& part = m_parts[p];
    std::copy_if(layers.begin(), layers.end(), std::back_inserter(part.layers),
                 [&](const ColourLayer& layer) { return layer.part == static_cast<int>(p); });
    ImageSpec& after = part.after;
    if (after.deep) {
      refuse("pixels", "deep", "of a part are written to OpenEXR only; write .exr");
    }
    if (!output->supports("tiles")) {
      after.tile_width = after.tile_height = after.tile_depth = 0;
    }
    const bool isCropped = after.x != after.full_x || after.y != after.full_y || after.width != after.full_width ||
                           after.height != after.full_height;
    if (isCropped && !output->supports("displaywindow")) {
      refuse("data window", std::to_string(after.width) + " x " + std::to_string(after.height),
             "differs from the display window, which " + format + " does not hold; write .exr or .tif");
    }
    if (type != nullptr && (!output->supports("channelformats") || part.layers.empty())) {
      after.channelformats.clear();
      after.format = part.layers.empty() ? after.format : type->type;
    } else if (type != nullptr) {
      // Types that OpenEXR has stay.
      after.format = type->type;
      after.channelformats.clear();
      for (int c = 0; c < after.nchannels; ++c) {
        const TypeDesc own = typeOf(part.before, c);
        after.channelformats.push_back(isExrType(own) ? own : type->type);
      }
      for (const ColourLayer& layer : part.layers) {
        for (const int channel : {layer.channels[0], layer.channels[1], layer.channels[2], layer.alpha}) {
          if (channel >= 0) {
            after.channelformats[static_cast<std::size_t>(channel)] = type->type;
          }
        }
      }
    } else if (!after.channelformats.empty() && !output->supports("channelformats")) {
      const bool hasWhole = std::any_of(after.channelformats.begin(), after.channelformats.end(), isWhole);
      if (hasWhole) {
        refuse("types", "", format + " has one type for all channels, and the picture whole numbers too; write .exr");
      }
      after.format = TypeDesc::FLOAT;
      after.channelformats.clear();
    }
    if (type != nullptr) {
      after.erase_attribute("oiio:BitsPerSample");
      if (type->bits > 0) {
        after.attribute("oiio:BitsPerSample", type->bits);
      }
    }
    if (!compression.empty()) {
      after.attribute("compression", compression);
    } else if (format != m_format) {
      after.erase_attribute("compression");
    }
    if (type == nullptr && format != m_format) {
      after.erase_attribute("oiio:BitsPerSample");
    }
    // What the format makes of a pixel of this type and these channels.
    ImageSpec probe = after;
    probe.x = probe.y = probe.full_x = probe.full_y = 0;
    probe.width = probe.height = probe.full_width = probe.full_height = 16;
    const auto test = outputFor(name);
    OIIO::Filesystem::IOVecOutput memory;
    if (!test->supports("ioproxy")) {
      continue;
    }
    test->set_ioproxy(&memory);
    if (!test->open(name, probe)) {
      refuse("channels", std::to_string(after.nchannels),
             "cannot be written: " + spectral::shortened(test->geterror(), 120) + "; write .exr or .tif");
    }
    const TypeDesc held = test->spec().format;
    // Some libraries print a complaint where a file is closed without its pixels.
    const std::vector<char> black(probe.image_bytes(true));
    test->write_image(TypeDesc::UNKNOWN, black.data());
    test->close();
    if (held != after.format) {
      refuse("type", after.format.c_str(), "is not held by " + format + "; say which to write: -d " + held.c_str());
    }
  }
}

void AnyPicture::describe(const std::string& oiioSpace, const std::optional<std::array<float, 8>>& chromaticities,
                          std::optional<int> onlyPart) {
  for (std::size_t p = 0; p < m_parts.size(); ++p) {
    if (onlyPart && static_cast<int>(p) != *onlyPart) {
      continue;
    }
    ImageSpec& after = m_parts[p].after;
    for (const char* name : {"oiio:ColorSpace", "oiio:Gamma", "colorInteropID", "ICCProfile"}) {
      after.erase_attribute(name);
    }
    if (!oiioSpace.empty()) {
      after.attribute("oiio:ColorSpace", oiioSpace);
    }
    if (chromaticities) {
      after.attribute("chromaticities", TypeDesc(TypeDesc::FLOAT, 8), chromaticities->data());
    }
  }
}

void AnyPicture::read(ImageInput& input, std::size_t index) {
  Part& part = m_parts[index];
  part.samples.resize(part.before.image_bytes(true));
  if (!input.read_image(static_cast<int>(index), 0, 0, part.before.nchannels, TypeDesc::UNKNOWN, part.samples.data())) {
    throw InputError(m_file, "", "", "cannot be read: " + spectral::pictureReason(input.geterror()));
  }
}

void AnyPicture::change(Part& part, const PixelFunction& pixels, int threads) const {
  const ImageSpec& before = part.before;
  const ImageSpec& after = part.after;
  bool keepsTypes = bitsOf(before) == bitsOf(after);
  for (int c = 0; c < before.nchannels; ++c) {
    keepsTypes = keepsTypes && typeOf(before, c) == typeOf(after, c);
  }
  if (keepsTypes && (!pixels || part.layers.empty())) {
    return;
  }
  const auto width = static_cast<std::size_t>(before.width);
  const std::size_t inPixel = before.pixel_bytes(true);
  const std::size_t outPixel = after.pixel_bytes(true);
  std::vector<char> changed = keepsTypes ? part.samples : std::vector<char>(after.image_bytes(true));
  const int bits = bitsOf(after);
  const auto row = [&](std::int64_t y) {
    const char* in = part.samples.data() + static_cast<std::size_t>(y) * width * inPixel;
    char* out = changed.data() + static_cast<std::size_t>(y) * width * outPixel;
    std::vector<float> line(width);
    const auto gather = [&](int c) {
      const std::size_t offset = offsetOf(before, c);
      for (std::size_t x = 0; x < width; ++x) {
        OIIO::convert_pixel_values(typeOf(before, c), in + x * inPixel + offset, TypeDesc::FLOAT, &line[x], 1);
      }
    };
    const auto put = [&](int c, std::size_t x, float value) {
      const TypeDesc type = typeOf(after, c);
      if (type == TypeDesc::HALF && std::isfinite(value)) {
        value = std::clamp(value, -kLargestHalf, kLargestHalf);
      } else if (bits > 0) {
        value = nearestCode(value, bits);
      }
      OIIO::convert_pixel_values(TypeDesc::FLOAT, &value, type, out + x * outPixel + offsetOf(after, c), 1);
    };
    for (int c = 0; c < before.nchannels && !keepsTypes; ++c) {
      if (typeOf(before, c) == typeOf(after, c) && bits == bitsOf(before)) {
        for (std::size_t x = 0; x < width; ++x) {
          std::copy_n(in + x * inPixel + offsetOf(before, c), typeOf(before, c).size(),
                      out + x * outPixel + offsetOf(after, c));
        }
      } else {
        gather(c);
        for (std::size_t x = 0; x < width; ++x) {
          put(c, x, line[x]);
        }
      }
    }
    for (const ColourLayer& layer : part.layers) {
      if (!pixels) {
        break;
      }
      std::vector<float> rgba(4 * width, 1.0F);
      std::vector<char> isFinite(width, 1);
      for (std::size_t k = 0; k < 3; ++k) {
        gather(layer.channels[k]);
        for (std::size_t x = 0; x < width; ++x) {
          rgba[4 * x + k] = line[x];
          isFinite[x] = static_cast<char>(isFinite[x] != 0 && std::isfinite(line[x]));
        }
      }
      pixels(rgba);
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t x = 0; x < width; ++x) {
          if (isFinite[x] != 0) {
            put(layer.channels[k], x, rgba[4 * x + k]);
          }
        }
      }
    }
  };
  OIIO::parallel_for_chunked(
      0, static_cast<std::int64_t>(before.height) * before.depth, 4,
      [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t y = begin; y < end; ++y) {
          row(y);
        }
      },
      OIIO::parallel_options(threads));
  part.samples = std::move(changed);
}

void AnyPicture::writeParts(ImageOutput& output, const std::string& path, const std::string& name) const {
  std::vector<ImageSpec> specs;
  for (const Part& part : m_parts) {
    specs.push_back(part.after);
  }
  const auto require = [&](bool isDone) {
    if (!isDone) {
      throw InputError(name, "output", "", "cannot be written: " + spectral::shortened(output.geterror(), 160));
    }
  };
  require(specs.size() == 1 ? output.open(path, specs[0])
                            : output.open(path, static_cast<int>(specs.size()), specs.data()));
  for (std::size_t p = 0; p < m_parts.size(); ++p) {
    require(p == 0 || output.open(path, specs[p], ImageOutput::AppendSubimage));
    require(output.write_image(TypeDesc::UNKNOWN, m_parts[p].samples.data()));
  }
  require(output.close());
}

void AnyPicture::write(const std::filesystem::path& outputFile, const PixelFunction& pixels, int threads) {
  const auto input = opened(m_file);
  for (std::size_t p = 0; p < m_parts.size(); ++p) {
    read(*input, p);
    change(m_parts[p], pixels, threads);
  }
  writeWhole(outputFile);
}

void AnyPicture::load() {
  const auto input = opened(m_file);
  for (std::size_t p = 0; p < m_parts.size(); ++p) {
    read(*input, p);
  }
}

void AnyPicture::save(const std::filesystem::path& outputFile, int threads) {
  for (Part& part : m_parts) {
    change(part, {}, threads);
  }
  writeWhole(outputFile);
}

void AnyPicture::writeWhole(const std::filesystem::path& outputFile) const {
  spectral::PendingFile pending(outputFile);
  const std::string name = spectral::utf8(outputFile);
  const auto output = outputFor(name);
  // OpenImageIO's TIFF reads back what it wrote, which its memory does not do.
  const bool isInMemory = output->supports("ioproxy") && output->format_name() != std::string_view("tiff");
  if (isInMemory) {
    // In memory first: what the library writes to a full disk may go unsaid.
    OIIO::Filesystem::IOVecOutput memory;
    output->set_ioproxy(&memory);
    writeParts(*output, name, name);
    pending.write({reinterpret_cast<const char*>(memory.buffer().data()), memory.buffer().size()});
  } else {
    writeParts(*output, spectral::utf8(pending.path()), name);
    // Read again, as the library may not say that the disk is full.
    const auto again = ImageInput::open(spectral::utf8(pending.path()));
    std::vector<char> samples(again ? again->spec().image_bytes(true) : 0);
    if (!again || again->spec().width != m_parts[0].after.width ||
        !again->read_image(0, 0, 0, again->spec().nchannels, TypeDesc::UNKNOWN, samples.data())) {
      OIIO::geterror();
      throw InputError(name, "output", "", "cannot be written whole: make room and try again");
    }
  }
  pending.commit();
}

}  // namespace metamer::lutgen
