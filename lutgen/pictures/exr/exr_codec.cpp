// SPDX-License-Identifier: Apache-2.0
#include "exr/exr_codec.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "exr/exr_reader.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::string_view bytes) : IStream("chunk"), m_bytes(bytes) {}

  bool read(char buffer[], int count) override {
    if (count < 0 || m_position + static_cast<std::uint64_t>(count) > m_bytes.size()) {
      throw std::runtime_error("the chunk is cut short");
    }
    std::memcpy(buffer, m_bytes.data() + m_position, static_cast<std::size_t>(count));
    m_position += static_cast<std::uint64_t>(count);
    return m_position < m_bytes.size();
  }
  std::uint64_t tellg() override { return m_position; }
  void seekg(std::uint64_t position) override { m_position = std::min<std::uint64_t>(position, m_bytes.size()); }

 private:
  std::string_view m_bytes;
  std::uint64_t m_position = 0;
};

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : OStream("chunk") {}

  void write(const char buffer[], int count) override {
    const std::size_t end = m_position + static_cast<std::size_t>(count);
    m_bytes.resize(std::max(m_bytes.size(), end));
    std::memcpy(m_bytes.data() + m_position, buffer, static_cast<std::size_t>(count));
    m_position = end;
  }
  std::uint64_t tellp() override { return m_position; }
  void seekp(std::uint64_t position) override { m_position = position; }
  const std::string& bytes() const { return m_bytes; }

 private:
  std::string m_bytes;
  std::size_t m_position = 0;
};

/// Samples as planes, one a channel: rows of all channels are alike there, subsampled or not.
class Planes {
 public:
  Planes(const ExrPart& part, const ExrRectangle& rectangle)
      : m_part(part), m_rectangle(rectangle), m_planes(part.channels.size()) {
    for (std::size_t c = 0; c < m_planes.size(); ++c) {
      std::size_t bytes = 0;
      for (int y = 0; y < rectangle.height; ++y) {
        bytes += exrRowBytes({part.channels[c]}, rectangle, rectangle.y + y);
      }
      m_planes[c].resize(bytes);
    }
  }

  void take(const std::string& samples) {
    eachRow([&](std::size_t at, char* plane, std::size_t bytes) { std::memcpy(plane, samples.data() + at, bytes); });
  }

  std::string samples() {
    std::string all(exrBytes(m_part.channels, m_rectangle), '\0');
    eachRow([&](std::size_t at, const char* plane, std::size_t bytes) { std::memcpy(all.data() + at, plane, bytes); });
    return all;
  }

  Imf::FrameBuffer frameBuffer() {
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < m_planes.size(); ++c) {
      const ExrChannel& channel = m_part.channels[c];
      const std::size_t size = sizeOf(channel.type);
      const std::size_t row = size * (static_cast<std::size_t>(m_rectangle.width - 1) / channel.xSampling + 1);
      // The library adds (x / sampling) * stride and the same of y, where x and y begin at the window's corner.
      const auto shift = static_cast<std::ptrdiff_t>(size) * (m_rectangle.x / channel.xSampling) +
                         static_cast<std::ptrdiff_t>(row) * (m_rectangle.y / channel.ySampling);
      buffer.insert(channel.name, Imf::Slice(static_cast<Imf::PixelType>(channel.type), m_planes[c].data() - shift,
                                             size, row, channel.xSampling, channel.ySampling));
    }
    return buffer;
  }

 private:
  template <typename Body>
  void eachRow(const Body& body) {
    std::size_t at = 0;
    std::vector<std::size_t> done(m_planes.size());
    for (int y = 0; y < m_rectangle.height; ++y) {
      for (std::size_t c = 0; c < m_planes.size(); ++c) {
        const std::size_t bytes = exrRowBytes({m_part.channels[c]}, m_rectangle, m_rectangle.y + y);
        body(at, m_planes[c].data() + done[c], bytes);
        at += bytes;
        done[c] += bytes;
      }
    }
  }

  const ExrPart& m_part;
  ExrRectangle m_rectangle;
  std::vector<std::string> m_planes;
};

/// The header of a file with this chunk alone.
Imf::Header headerOf(const ExrPart& part, const ExrRectangle& rectangle) {
  const Imath::Box2i window({rectangle.x, rectangle.y},
                            {rectangle.x + rectangle.width - 1, rectangle.y + rectangle.height - 1});
  Imf::Header header(window, window, 1.0F, {0.0F, 0.0F}, 1.0F, Imf::INCREASING_Y,
                     static_cast<Imf::Compression>(part.compression));
  for (const ExrChannel& channel : part.channels) {
    header.channels().insert(channel.name, Imf::Channel(static_cast<Imf::PixelType>(channel.type), channel.xSampling,
                                                        channel.ySampling, channel.isPerceptual));
  }
  if (part.isTiled) {
    header.setTileDescription({static_cast<unsigned>(part.tileSize[0]), static_cast<unsigned>(part.tileSize[1])});
  }
  if (const ExrAttribute* level = part.find("dwaCompressionLevel"); level != nullptr && level->value.size() == 4) {
    float value = 0;
    std::memcpy(&value, level->value.data(), 4);
    header.dwaCompressionLevel() = value;
  }
  return header;
}

[[noreturn]] void refuse(const std::string& file, const ExrPart& part, const std::exception& failure) {
  throw InputError(file, "compression", exrCompressionNames()[static_cast<std::size_t>(part.compression)],
                   "fails: " + spectral::shortened(spectral::oneLine(failure.what()), 120) +
                       "; write the picture again, or choose --compression zip");
}

bool isOwn(ExrCompression compression) {
  return compression == ExrCompression::Zip || compression == ExrCompression::Zips;
}

/// The library's own file of one chunk, made of samples.
std::string chunkFile(const ExrPart& part, const ExrRectangle& rectangle, Planes& planes) {
  MemoryOutput stream;
  const Imf::Header header = headerOf(part, rectangle);
  if (part.isTiled) {
    Imf::TiledOutputFile output(stream, header, 0);
    output.setFrameBuffer(planes.frameBuffer());
    output.writeTile(0, 0);
  } else {
    Imf::OutputFile output(stream, header, 0);
    output.setFrameBuffer(planes.frameBuffer());
    output.writePixels(rectangle.height);
  }
  return stream.bytes();
}

}  // namespace

std::string unpackedChunk(const ExrPart& part, const ExrRectangle& rectangle, std::string_view packed,
                          const std::string& file) {
  const std::size_t size = exrBytes(part.channels, rectangle);
  if (packed.size() == size) {
    return std::string(packed);
  }
  if (isOwn(part.compression) || part.compression == ExrCompression::None) {
    std::string samples = isOwn(part.compression) ? unzippedBlock(packed, size) : std::string();
    if (samples.size() != size) {
      throw InputError(file, "pixels", "",
                       "are damaged from row " + std::to_string(rectangle.y) + " on; write the picture again");
    }
    return samples;
  }
  try {
    // A header alone, and the chunk behind it.
    ExrFile small;
    small.parts.push_back(part);
    ExrPart& own = small.parts[0];
    const auto drop = [](const ExrAttribute& attribute) {
      return attribute.name == "type" || attribute.name == "chunkCount" || attribute.name == "name";
    };
    own.attributes.erase(std::remove_if(own.attributes.begin(), own.attributes.end(), drop), own.attributes.end());
    std::string window;
    for (const int corner :
         {rectangle.x, rectangle.y, rectangle.x + rectangle.width - 1, rectangle.y + rectangle.height - 1}) {
      putNumber(window, static_cast<std::int32_t>(corner));
    }
    own.set("dataWindow", "box2i", window);
    own.set("displayWindow", "box2i", window);
    own.set("lineOrder", "lineOrder", std::string(1, '\0'));
    if (part.isTiled) {
      std::string tiles;
      putNumber(tiles, static_cast<std::int32_t>(part.tileSize[0]));
      putNumber(tiles, static_cast<std::int32_t>(part.tileSize[1]));
      own.set("tiles", "tiledesc", tiles.append(1, '\0'));
      small.version |= 0x200;
    }
    small.version |= 0x400;
    std::string bytes = exrHeader(small);
    putNumber(bytes, static_cast<std::uint64_t>(bytes.size() + 8));
    for (int k = 0; k < (part.isTiled ? 4 : 1); ++k) {
      putNumber(bytes, static_cast<std::int32_t>(part.isTiled ? 0 : rectangle.y));
    }
    putNumber(bytes, static_cast<std::uint32_t>(packed.size()));
    bytes.append(packed);
    MemoryInput stream(bytes);
    Imf::InputFile input(stream, 0);
    Planes planes(part, rectangle);
    input.setFrameBuffer(planes.frameBuffer());
    input.readPixels(rectangle.y, rectangle.y + rectangle.height - 1);
    return planes.samples();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& failure) {
    refuse(file, part, failure);
  }
}

std::string packedChunk(const ExrPart& part, const ExrRectangle& rectangle, const std::string& samples,
                        const std::string& file, int zipLevel) {
  if (part.compression == ExrCompression::None) {
    return samples;
  }
  if (isOwn(part.compression)) {
    return zippedBlock(samples, zipLevel);
  }
  try {
    Planes planes(part, rectangle);
    planes.take(samples);
    const std::string bytes = chunkFile(part, rectangle, planes);
    const ExrFile small = readExrFile(bytes, "chunk", std::int64_t{1} << 40);
    ExrReader reader(bytes, small.name, small.parts.at(0).chunkOffsets.at(0));
    reader.take(part.isTiled ? 16 : 4);
    return std::string(reader.take(reader.number<std::uint32_t>()));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& failure) {
    refuse(file, part, failure);
  }
}

}  // namespace metamer::lutgen
