// SPDX-License-Identifier: Apache-2.0
#include "exr/exr_file.h"

#include <algorithm>

#include "exr/exr_reader.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

constexpr std::string_view kMagic("\x76\x2f\x31\x01", 4);
constexpr std::uint32_t kTiledFlag = 0x200;
constexpr std::uint32_t kDeepFlag = 0x800;
constexpr std::uint32_t kMultiPartFlag = 0x1000;
/// Sizes of chunks are 32-bit numbers in the file.
constexpr std::uint64_t kMostChunkBytes = 0x7fffffff;

[[noreturn]] void refuse(const std::string& file, const std::string& field, const std::string& value,
                         const std::string& remedy) {
  throw InputError(file, field, value, remedy);
}

/// Reads one part's header.
class HeaderReader {
 public:
  HeaderReader(ExrReader& reader, const std::string& file) : m_reader(reader), m_file(file) {}

  /// Without attributes where it is the empty header that ends a list of parts.
  ExrPart part() {
    ExrPart part;
    for (std::string name = m_reader.text(); !name.empty(); name = m_reader.text()) {
      ExrAttribute attribute{name, m_reader.text(), {}};
      const auto size = m_reader.number<std::int32_t>();
      if (size < 0) {
        refuse(m_file, "header", name, "is damaged: an attribute of negative size; write the picture again");
      }
      attribute.value = m_reader.take(static_cast<std::uint64_t>(size));
      part.attributes.push_back(std::move(attribute));
    }
    return part;
  }

  void interpret(ExrPart& part, std::uint32_t version, bool isMultiPart) {
    part.isTiled = (version & kTiledFlag) != 0;
    part.isDeep = (version & kDeepFlag) != 0;
    if (const ExrAttribute* type = part.find("type"); type != nullptr && (isMultiPart || part.isDeep)) {
      part.isTiled = type->value == "tiledimage" || type->value == "deeptile";
      part.isDeep = type->value == "deepscanline" || type->value == "deeptile";
      if (!part.isTiled && !part.isDeep && type->value != "scanlineimage") {
        refuse(m_file, "part type", type->value, "is not known; write scan lines or tiles");
      }
    }
    readText(part, "name", part.name);
    readText(part, "view", part.view);
    readChannels(part);
    const auto compression = value<std::uint8_t>(part, "compression", 1);
    if (compression[0] >= exrCompressionNames().size()) {
      refuse(m_file, "compression", std::to_string(compression[0]),
             "is not known; write it as one of " + exrCompressionNames()[3] + ", " + exrCompressionNames()[4]);
    }
    part.compression = static_cast<ExrCompression>(compression[0]);
    const auto window = value<std::int32_t>(part, "dataWindow", 4);
    part.dataWindow = {window[0], window[1], window[2], window[3]};
    if (part.dataWindow.width() < 1 || part.dataWindow.height() < 1) {
      refuse(m_file, "data window", sizeText(part), "is empty; write the picture again");
    }
    if (part.isTiled) {
      const auto tiles = value<std::uint8_t>(part, "tiles", 9);
      std::memcpy(part.tileSize.data(), tiles.data(), 8);
      part.roundsUp = (tiles[8] >> 4) != 0;
      if (part.tileSize[0] < 1 || part.tileSize[1] < 1) {
        refuse(m_file, "tile size", std::to_string(part.tileSize[0]), "is not above 0; write the picture again");
      }
    }
  }

  static std::string sizeText(const ExrPart& part) {
    return std::to_string(part.dataWindow.width()) + " x " + std::to_string(part.dataWindow.height());
  }

  /// How many chunks a part has.
  std::uint64_t chunkCount(const ExrPart& part) {
    if (part.isDeep || (part.isTiled && part.find("chunkCount") != nullptr)) {
      const auto count = value<std::int32_t>(part, "chunkCount", 1)[0];
      return count < 0 ? 0 : static_cast<std::uint64_t>(count);
    }
    if (!part.isTiled) {
      const std::int64_t rows = rowsPerChunk(part.compression);
      return static_cast<std::uint64_t>((part.dataWindow.height() + rows - 1) / rows);
    }
    return tileCount(part, value<std::uint8_t>(part, "tiles", 9)[8] & 0xF);
  }

 private:
  template <typename Number>
  std::vector<Number> value(const ExrPart& part, const std::string& name, std::size_t count) {
    const ExrAttribute* attribute = part.find(name);
    if (attribute == nullptr || attribute->value.size() != count * sizeof(Number)) {
      refuse(m_file, "header", name, "is missing or damaged; write the picture again");
    }
    std::vector<Number> numbers(count);
    std::memcpy(numbers.data(), attribute->value.data(), attribute->value.size());
    return numbers;
  }

  static void readText(const ExrPart& part, const std::string& name, std::string& text) {
    if (const ExrAttribute* attribute = part.find(name); attribute != nullptr && attribute->type == "string") {
      text = attribute->value;
    }
  }

  void readChannels(ExrPart& part) {
    const ExrAttribute* list = part.find("channels");
    if (list == nullptr) {
      refuse(m_file, "header", "channels", "is missing; write the picture again");
    }
    ExrReader reader(list->value, m_file);
    for (std::string name = reader.text(); !name.empty(); name = reader.text()) {
      ExrChannel channel{name};
      channel.typeAt = reader.position();
      const auto type = reader.number<std::uint32_t>();
      channel.isPerceptual = (reader.number<std::uint32_t>() & 0xFF) != 0;
      channel.xSampling = reader.number<std::int32_t>();
      channel.ySampling = reader.number<std::int32_t>();
      if (type > 2 || channel.xSampling < 1 || channel.ySampling < 1) {
        refuse(m_file, "channel", name, "is damaged: of no known type; write the picture again");
      }
      channel.type = static_cast<ExrType>(type);
      part.channels.push_back(std::move(channel));
    }
  }

  std::uint64_t tileCount(const ExrPart& part, int mode) {
    const auto levels = [&](std::int64_t size) {
      int count = 1;
      while (exrLevelSize(size, count - 1, part.roundsUp) > 1) {
        ++count;
      }
      return count;
    };
    const auto tiles = [&](std::int64_t size, int level, std::size_t side) {
      const std::int64_t tile = part.tileSize[side];
      return static_cast<std::uint64_t>((exrLevelSize(size, level, part.roundsUp) + tile - 1) / tile);
    };
    const std::int64_t width = part.dataWindow.width();
    const std::int64_t height = part.dataWindow.height();
    if (mode > 2) {
      refuse(m_file, "tiles", std::to_string(mode), "have levels of an unknown kind; write the picture again");
    }
    std::uint64_t count = 0;
    if (mode < 2) {
      const int last = mode == 0 ? 1 : levels(std::max(width, height));
      for (int level = 0; level < last; ++level) {
        count += tiles(width, level, 0) * tiles(height, level, 1);
      }
      return count;
    }
    for (int y = 0; y < levels(height); ++y) {
      for (int x = 0; x < levels(width); ++x) {
        count += tiles(width, x, 0) * tiles(height, y, 1);
      }
    }
    return count;
  }

  ExrReader& m_reader;
  const std::string& m_file;
};

/// Bytes of the largest chunk, unpacked.
std::uint64_t largestChunk(const ExrPart& part) {
  const auto width = static_cast<std::uint64_t>(part.isTiled ? part.tileSize[0] : part.dataWindow.width());
  const auto rows = static_cast<std::uint64_t>(
      part.isTiled ? part.tileSize[1]
                   : std::min<std::int64_t>(rowsPerChunk(part.compression), part.dataWindow.height()));
  std::uint64_t pixel = 0;
  for (const ExrChannel& channel : part.channels) {
    pixel += sizeOf(channel.type);
  }
  // Each factor is below 2^31, 2^31 and the file's size: divide, do not multiply.
  return pixel == 0 || width <= kMostChunkBytes / pixel / rows ? width * rows * pixel : kMostChunkBytes + 1;
}

}  // namespace

const std::vector<std::string>& exrCompressionNames() {
  static const std::vector<std::string> names = {"none",  "rle", "zips", "zip",  "piz",
                                                 "pxr24", "b44", "b44a", "dwaa", "dwab"};
  return names;
}

int rowsPerChunk(ExrCompression compression) {
  constexpr std::array<int, 10> rows = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
  return rows.at(static_cast<std::size_t>(compression));
}

const ExrAttribute* ExrPart::find(std::string_view attribute) const {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const ExrAttribute& candidate) { return candidate.name == attribute; });
  return found == attributes.end() ? nullptr : &*found;
}

void ExrPart::set(const std::string& attribute, const std::string& attributeType, const std::string& value) {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const ExrAttribute& candidate) { return candidate.name == attribute; });
  if (found == attributes.end()) {
    attributes.push_back({attribute, attributeType, value});
  } else {
    found->value = value;
  }
}

std::int64_t exrLevelSize(std::int64_t size, int level, bool roundsUp) {
  const std::int64_t divisor = std::int64_t{1} << std::clamp(level, 0, 40);
  return std::max<std::int64_t>((size + (roundsUp ? divisor - 1 : 0)) / divisor, 1);
}

bool isExr(std::string_view bytes) {
  return bytes.substr(0, kMagic.size()) == kMagic;
}

ExrFile readExrFile(std::string_view bytes, const std::string& name, std::int64_t mostPixels) {
  ExrFile file;
  file.name = name;
  file.bytes = bytes;
  ExrReader reader(file.bytes, file.name);
  if (reader.take(4) != kMagic) {
    refuse(name, "", "", "cannot be read: it is no OpenEXR file");
  }
  file.version = reader.number<std::uint32_t>();
  if ((file.version & 0xFF) != 2) {
    refuse(name, "version", std::to_string(file.version & 0xFF), "cannot be read: version 2 is known");
  }
  file.isMultiPart = (file.version & kMultiPartFlag) != 0;
  HeaderReader headers(reader, file.name);
  do {
    ExrPart part = headers.part();
    if (part.attributes.empty()) {
      break;
    }
    headers.interpret(part, file.version, file.isMultiPart);
    const ExrBox& window = part.dataWindow;
    if (window.width() > mostPixels / window.height() || largestChunk(part) > kMostChunkBytes) {
      refuse(name, "data window", HeaderReader::sizeText(part),
             "is larger than " + std::to_string(mostPixels) + " pixels; --max-pixels allows more");
    }
    file.parts.push_back(std::move(part));
  } while (file.isMultiPart);
  if (file.parts.empty()) {
    refuse(name, "header", "", "has no part; write the picture again");
  }
  for (ExrPart& part : file.parts) {
    const std::uint64_t count = headers.chunkCount(part);
    if (count > reader.left() / 8) {
      reader.take(reader.left() + 1);  // says that the file is cut short
    }
    part.chunkOffsets.resize(count);
    for (std::uint64_t& offset : part.chunkOffsets) {
      offset = reader.number<std::uint64_t>();
    }
    const auto missing = std::count(part.chunkOffsets.begin(), part.chunkOffsets.end(), std::uint64_t{0});
    if (missing > 0) {
      refuse(name, "chunks", std::to_string(missing) + " of " + std::to_string(count),
             "are missing: whoever wrote it did not finish; render it again");
    }
  }
  return file;
}

std::string exrHeader(const ExrFile& file) {
  std::string bytes(kMagic);
  putNumber(bytes, file.version);
  for (const ExrPart& part : file.parts) {
    for (const ExrAttribute& attribute : part.attributes) {
      bytes.append(attribute.name).append(1, '\0').append(attribute.type).append(1, '\0');
      putNumber(bytes, static_cast<std::int32_t>(attribute.value.size()));
      bytes.append(attribute.value);
    }
    bytes.append(1, '\0');
  }
  return file.isMultiPart ? bytes.append(1, '\0') : bytes;
}

}  // namespace metamer::lutgen
