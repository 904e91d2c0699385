// SPDX-License-Identifier: Apache-2.0
#include "exr/exr_change.h"

#include <OpenImageIO/parallel.h>

#include <algorithm>
#include <cstring>
#include <exception>

#include "exr/exr_codec.h"
#include "exr/exr_reader.h"
#include "exr/exr_samples.h"
#include "metamer/spectral/input_error.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

/// A chunk as it stands in the file that is read.
struct Chunk {
  std::size_t index = 0;    ///< in the part's table
  std::string_view head;    ///< its coordinates, without the part's number and the size
  std::string_view packed;  ///< of deep parts with the sizes before it
};

/// Chunks that are changed together: as many as make whole chunks before and after.
struct Unit {
  int part = 0;
  bool isCopied = false;
  std::vector<Chunk> chunks;
  std::uint64_t order = 0;  ///< where the first lies in the file
};

/// A chunk as it is written, from its coordinates on.
struct Written {
  std::size_t index = 0;
  std::string bytes;
};

std::uint64_t rowsOf(const ExrPart& part) {
  return static_cast<std::uint64_t>(rowsPerChunk(part.compression));
}

class Changer {
 public:
  Changer(const ExrFile& file, const ExrChange& change)
      : m_in(file), m_change(change), m_out(headersAfter(file, change)) {
    for (std::size_t part = 0; part < m_in.parts.size(); ++part) {
      findUnits(static_cast<int>(part));
    }
    std::sort(m_units.begin(), m_units.end(), [](const Unit& a, const Unit& b) { return a.order < b.order; });
  }

  std::string run(int threads) {
    std::string bytes = exrHeader(m_out);
    const std::size_t tableAt = bytes.size();
    std::vector<std::size_t> tableOfPart;
    std::size_t entries = 0;
    for (const ExrPart& part : m_out.parts) {
      tableOfPart.push_back(entries);
      entries += part.chunkOffsets.size();
    }
    bytes.resize(tableAt + 8 * entries);
    bytes.reserve(bytes.size() + m_in.bytes.size());
    // A window of units at a time bounds what lies in memory unpacked.
    const std::size_t window = threads == 1 ? 1 : 8 * static_cast<std::size_t>(threads);
    for (std::size_t begin = 0; begin < m_units.size(); begin += window) {
      const std::size_t end = std::min(begin + window, m_units.size());
      const std::vector<std::vector<Written>> results = inParallel(begin, end, threads);
      for (std::size_t k = begin; k < end; ++k) {
        for (const Written& chunk : results[k - begin]) {
          const std::uint64_t offset = bytes.size();
          const auto part = static_cast<std::size_t>(m_units[k].part);
          std::memcpy(bytes.data() + tableAt + 8 * (tableOfPart[part] + chunk.index), &offset, 8);
          if (m_in.isMultiPart) {
            putNumber(bytes, static_cast<std::int32_t>(part));
          }
          bytes.append(chunk.bytes);
        }
      }
    }
    return bytes;
  }

 private:
  static ExrFile headersAfter(const ExrFile& file, const ExrChange& change) {
    ExrFile after = file;
    for (ExrPart& part : after.parts) {
      if (change.compression && !part.isDeep && *change.compression != part.compression) {
        part.compression = *change.compression;
        part.set("compression", "compression", std::string(1, static_cast<char>(part.compression)));
        if (!part.isTiled) {
          const std::uint64_t rows = rowsOf(part);
          const auto count = (static_cast<std::uint64_t>(part.dataWindow.height()) + rows - 1) / rows;
          part.chunkOffsets.resize(count);
          if (part.find("chunkCount") != nullptr) {
            std::string value;
            putNumber(value, static_cast<std::int32_t>(count));
            part.set("chunkCount", "int", value);
          }
        }
      }
    }
    for (const ExrColours& colours : change.colours) {
      ExrPart& part = after.parts[static_cast<std::size_t>(colours.part)];
      if (change.type) {
        std::string list = part.find("channels")->value;
        for (const int index : {colours.channels[0], colours.channels[1], colours.channels[2], colours.alpha}) {
          if (index >= 0) {
            ExrChannel& channel = part.channels[static_cast<std::size_t>(index)];
            channel.type = *change.type;
            std::memcpy(list.data() + channel.typeAt, &channel.type, 4);
          }
        }
        part.set("channels", "chlist", list);
      }
      if (change.chromaticities) {
        std::string value;
        for (const float number : *change.chromaticities) {
          putNumber(value, number);
        }
        part.set("chromaticities", "chromaticities", value);
      }
    }
    return after;
  }

  Chunk chunkAt(int partIndex, std::size_t index) const {
    const ExrPart& part = m_in.parts[static_cast<std::size_t>(partIndex)];
    ExrReader reader(m_in.bytes, m_in.name, part.chunkOffsets[index]);
    if (m_in.isMultiPart && reader.number<std::int32_t>() != partIndex) {
      throw InputError(m_in.name, "chunk", std::to_string(index),
                       "is of another part: damaged; write the picture again");
    }
    Chunk chunk{index, reader.take(part.isTiled ? 16 : 4), {}};
    if (part.isDeep) {
      const std::size_t start = reader.position();
      const auto table = reader.number<std::uint64_t>();
      const auto samples = reader.number<std::uint64_t>();
      reader.number<std::uint64_t>();
      reader.take(table);
      reader.take(samples);
      chunk.packed = m_in.bytes.substr(start, reader.position() - start);
    } else {
      chunk.packed = reader.take(reader.number<std::uint32_t>());
    }
    return chunk;
  }

  bool isChanged(int part) const {
    const ExrPart& before = m_in.parts[static_cast<std::size_t>(part)];
    const ExrPart& after = m_out.parts[static_cast<std::size_t>(part)];
    const bool hasColours =
        std::any_of(m_change.colours.begin(), m_change.colours.end(), [&](const auto& c) { return c.part == part; });
    return !before.isDeep &&
           (before.compression != after.compression || (hasColours && (m_change.pixels != nullptr || m_change.type)));
  }

  void findUnits(int partIndex) {
    const ExrPart& before = m_in.parts[static_cast<std::size_t>(partIndex)];
    const ExrPart& after = m_out.parts[static_cast<std::size_t>(partIndex)];
    const bool isChanged = this->isChanged(partIndex);
    std::size_t chunksOfUnit = 1;
    if (isChanged && !before.isTiled) {
      chunksOfUnit = std::max<std::size_t>(1, rowsOf(after) / rowsOf(before));
    }
    for (std::size_t begin = 0; begin < before.chunkOffsets.size(); begin += chunksOfUnit) {
      Unit unit;
      unit.part = partIndex;
      unit.isCopied = !isChanged;
      unit.order = before.chunkOffsets[begin];
      for (std::size_t k = begin; k < std::min(begin + chunksOfUnit, before.chunkOffsets.size()); ++k) {
        unit.order = std::min(unit.order, before.chunkOffsets[k]);
        unit.chunks.push_back(chunkAt(partIndex, k));
      }
      m_units.push_back(std::move(unit));
    }
  }

  /// Rows of chunk `index` of a part without tiles.
  static ExrRectangle rowsAt(const ExrPart& part, std::size_t index) {
    const ExrBox& box = part.dataWindow;
    const std::int64_t rows = rowsPerChunk(part.compression);
    const std::int64_t first = box.yMin + static_cast<std::int64_t>(index) * rows;
    return {box.xMin, static_cast<int>(first), static_cast<int>(box.width()),
            static_cast<int>(std::min<std::int64_t>(rows, box.yMax - first + 1))};
  }

  /// @param head  the tile's place and that of its level
  ExrRectangle tileAt(const ExrPart& part, std::string_view head) const {
    ExrReader reader(head, m_in.name);
    std::array<int, 4> place{};
    for (int& number : place) {
      number = reader.number<std::int32_t>();
    }
    const auto side = [&](std::int64_t size, int tile, int index, int level) {
      const std::int64_t begin = static_cast<std::int64_t>(tile) * index;
      const std::int64_t count = std::min<std::int64_t>(tile, exrLevelSize(size, level, part.roundsUp) - begin);
      if (index < 0 || level < 0 || level > 31 || count < 1) {
        throw InputError(m_in.name, "tile", std::to_string(index), "lies outside the picture; write the picture again");
      }
      return static_cast<int>(count);
    };
    return {0, 0, side(part.dataWindow.width(), part.tileSize[0], place[0], place[2]),
            side(part.dataWindow.height(), part.tileSize[1], place[1], place[3])};
  }

  std::string changed(const Unit& unit, std::string samples, const ExrRectangle& rectangle) const {
    std::vector<ExrColours> own;
    std::copy_if(m_change.colours.begin(), m_change.colours.end(), std::back_inserter(own),
                 [&](const ExrColours& colours) { return colours.part == unit.part; });
    const auto part = static_cast<std::size_t>(unit.part);
    if (own.empty() || (!m_change.pixels && !m_change.type)) {
      return samples;
    }
    return changedSamples(std::move(samples), rectangle, m_in.parts[part].channels, m_out.parts[part].channels, own,
                          m_change.pixels);
  }

  Written written(const Unit& unit, std::size_t index, std::string_view head, const ExrRectangle& rectangle,
                  const std::string& samples) const {
    const ExrPart& part = m_out.parts[static_cast<std::size_t>(unit.part)];
    const std::string packed = packedChunk(part, rectangle, samples, m_in.name);
    Written chunk{index, std::string(head)};
    putNumber(chunk.bytes, static_cast<std::uint32_t>(packed.size()));
    chunk.bytes.append(packed);
    return chunk;
  }

  std::vector<Written> result(const Unit& unit) const {
    const ExrPart& before = m_in.parts[static_cast<std::size_t>(unit.part)];
    const ExrPart& after = m_out.parts[static_cast<std::size_t>(unit.part)];
    std::vector<Written> chunks;
    if (unit.isCopied) {
      const Chunk& chunk = unit.chunks[0];
      chunks.push_back({chunk.index, std::string(chunk.head)});
      if (!before.isDeep) {
        putNumber(chunks[0].bytes, static_cast<std::uint32_t>(chunk.packed.size()));
      }
      chunks[0].bytes.append(chunk.packed);
      return chunks;
    }
    if (before.isTiled) {
      const Chunk& chunk = unit.chunks[0];
      const ExrRectangle tile = tileAt(before, chunk.head);
      const std::string samples = changed(unit, unpackedChunk(before, tile, chunk.packed, m_in.name), tile);
      chunks.push_back(written(unit, chunk.index, chunk.head, tile, samples));
      return chunks;
    }
    ExrRectangle all = rowsAt(before, unit.chunks[0].index);
    all.height = 0;
    std::string samples;
    for (const Chunk& chunk : unit.chunks) {
      const ExrRectangle rows = rowsAt(before, chunk.index);
      if (ExrReader(chunk.head, m_in.name).number<std::int32_t>() != rows.y) {
        throw InputError(m_in.name, "chunk", std::to_string(chunk.index),
                         "is not of row " + std::to_string(rows.y) + ": damaged; write the picture again");
      }
      std::string part = unpackedChunk(before, rows, chunk.packed, m_in.name);
      samples = samples.empty() ? std::move(part) : samples.append(part);
      all.height += rows.height;
    }
    samples = changed(unit, std::move(samples), all);
    std::size_t at = 0;
    for (int y = all.y; y < all.y + all.height;) {
      const auto index = static_cast<std::size_t>(y - before.dataWindow.yMin) / rowsOf(after);
      const ExrRectangle rows = rowsAt(after, index);
      const std::size_t size = exrBytes(after.channels, rows);
      std::string head;
      putNumber(head, static_cast<std::int32_t>(rows.y));
      const bool isAll = size == samples.size();
      chunks.push_back(written(unit, index, head, rows, isAll ? samples : samples.substr(at, size)));
      at += size;
      y += rows.height;
    }
    if (const ExrAttribute* order = before.find("lineOrder"); order != nullptr && order->value == std::string(1, 1)) {
      std::reverse(chunks.begin(), chunks.end());  // decreasing rows
    }
    return chunks;
  }

  std::vector<std::vector<Written>> inParallel(std::size_t begin, std::size_t end, int threads) const {
    std::vector<std::vector<Written>> results(end - begin);
    if (threads == 1) {
      for (std::size_t k = begin; k < end; ++k) {
        results[k - begin] = result(m_units[k]);
      }
      return results;
    }
    // The first failure by place, whatever the threads.
    std::vector<std::exception_ptr> failures(end - begin);
    OIIO::parallel_for_chunked(
        static_cast<std::int64_t>(begin), static_cast<std::int64_t>(end), 1,
        [&](std::int64_t first, std::int64_t last) {
          for (auto k = static_cast<std::size_t>(first); k < static_cast<std::size_t>(last); ++k) {
            try {
              results[k - begin] = result(m_units[k]);
            } catch (...) {
              failures[k - begin] = std::current_exception();
            }
          }
        },
        OIIO::parallel_options(threads));
    for (const std::exception_ptr& failure : failures) {
      if (failure) {
        std::rethrow_exception(failure);
      }
    }
    return results;
  }

  const ExrFile& m_in;
  const ExrChange& m_change;
  const ExrFile m_out;
  std::vector<Unit> m_units;
};

/// Whether packing again changes a channel that nobody changed.
bool isLossyFor(ExrCompression compression, const ExrChannel& channel) {
  switch (compression) {
    case ExrCompression::Pxr24:
      return channel.type == ExrType::Float;
    case ExrCompression::B44:
    case ExrCompression::B44a:
      return channel.type == ExrType::Half;
    case ExrCompression::Dwaa:
    case ExrCompression::Dwab: {
      const std::string last = channel.name.substr(channel.name.rfind('.') + 1);
      const std::array<std::string_view, 6> lossy = {"R", "G", "B", "Y", "RY", "BY"};
      return channel.type != ExrType::Uint && std::find(lossy.begin(), lossy.end(), last) != lossy.end();
    }
    default:
      return false;
  }
}

}  // namespace

std::string changedExr(const ExrFile& file, const ExrChange& change, int threads) {
  return Changer(file, change).run(threads);
}

bool losesOtherChannels(const ExrFile& file, const ExrChange& change) {
  for (std::size_t p = 0; p < file.parts.size(); ++p) {
    const ExrPart& part = file.parts[p];
    std::vector<bool> isColour(part.channels.size());
    bool hasColours = change.compression.has_value();
    for (const ExrColours& colours : change.colours) {
      if (colours.part == static_cast<int>(p)) {
        hasColours = true;
        for (const int channel : colours.channels) {
          isColour[static_cast<std::size_t>(channel)] = true;
        }
      }
    }
    for (std::size_t c = 0; hasColours && !part.isDeep && c < part.channels.size(); ++c) {
      if (!isColour[c] && isLossyFor(change.compression.value_or(part.compression), part.channels[c])) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace metamer::lutgen
