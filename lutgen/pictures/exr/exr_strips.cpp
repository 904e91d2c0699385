// SPDX-License-Identifier: Apache-2.0
#include "exr/exr_strips.h"

#include <OpenImageIO/parallel.h>
#include <OpenImageIO/sysutil.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>

#include "exr/exr_codec.h"
#include "exr/exr_reader.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/platform.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

/// Bytes one after another, and a table filled in at the end.
class Output {
 public:
  Output(const std::filesystem::path& path, std::string name)
      : m_name(std::move(name)), m_file(spectral::openFile(path, "wb")) {
    require(m_file != nullptr);
  }

  void write(std::string_view bytes) {
    require(std::fwrite(bytes.data(), 1, bytes.size(), m_file.get()) == bytes.size());
  }
  void rewrite(long position, std::string_view bytes) {
    require(std::fseek(m_file.get(), position, SEEK_SET) == 0);
    write(bytes);
  }
  void close() {
    require(std::fflush(m_file.get()) == 0);
    require(std::fclose(m_file.release()) == 0);
  }

 private:
  void require(bool isDone) const {
    if (!isDone) {
      throw InputError(m_name, "output", "",
                       "cannot be written: " + std::string(std::strerror(errno)) +
                           "; nothing is left behind, make room and try again");
    }
  }

  std::string m_name;
  std::unique_ptr<std::FILE, Close> m_file;
};

template <typename Number>
std::string numbers(const std::vector<Number>& all) {
  std::string bytes;
  for (const Number number : all) {
    putNumber(bytes, number);
  }
  return bytes;
}

std::string boxBytes(const ExrBox& box) {
  return numbers<std::int32_t>({box.xMin, box.yMin, box.xMax, box.yMax});
}

std::string channelList(const std::vector<ExrChannel>& channels) {
  std::string bytes;
  for (const ExrChannel& channel : channels) {
    bytes.append(channel.name).append(1, '\0');
    putNumber(bytes, static_cast<std::uint32_t>(channel.type));
    bytes.append(4, '\0');
    putNumber(bytes, static_cast<std::int32_t>(1));
    putNumber(bytes, static_cast<std::int32_t>(1));
  }
  return bytes.append(1, '\0');
}

ExrPart partOf(const ExrStrips& picture) {
  ExrPart part;
  part.channels = picture.channels;
  part.compression = picture.compression;
  part.dataWindow = picture.dataWindow;
  part.set("channels", "chlist", channelList(picture.channels));
  part.set("compression", "compression", std::string(1, static_cast<char>(picture.compression)));
  part.set("dataWindow", "box2i", boxBytes(picture.dataWindow));
  part.set("displayWindow", "box2i", boxBytes(picture.displayWindow));
  part.set("lineOrder", "lineOrder", std::string(1, '\0'));
  part.set("pixelAspectRatio", "float", numbers<float>({picture.pixelAspectRatio}));
  part.set("screenWindowCenter", "v2f", numbers<float>({0, 0}));
  part.set("screenWindowWidth", "float", numbers<float>({1}));
  for (const ExrAttribute& attribute : picture.attributes) {
    part.set(attribute.name, attribute.type, attribute.value);
  }
  return part;
}

/// The first failure by place, whatever the threads.
void inParallel(std::int64_t begin, std::int64_t end, int threads, const std::function<void(std::int64_t)>& body) {
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(end - begin));
  OIIO::parallel_for_chunked(
      begin, end, 1,
      [&](std::int64_t first, std::int64_t last) {
        for (std::int64_t k = first; k < last; ++k) {
          try {
            body(k);
          } catch (...) {
            failures[static_cast<std::size_t>(k - begin)] = std::current_exception();
          }
        }
      },
      OIIO::parallel_options(threads));
  for (const std::exception_ptr& failure : failures) {
    if (failure) {
      std::rethrow_exception(failure);
    }
  }
}

}  // namespace

void writeExrStrips(const ExrStrips& picture, const std::filesystem::path& file, int threads) {
  spectral::PendingFile pending(file);
  ExrFile whole;
  whole.name = spectral::utf8(file);
  whole.parts.push_back(partOf(picture));
  const ExrPart& part = whole.parts[0];
  const std::string header = exrHeader(whole);
  const std::int64_t rows = rowsPerChunk(part.compression);
  const std::int64_t chunks = (part.dataWindow.height() + rows - 1) / rows;

  Output output(pending.path(), whole.name);
  std::vector<std::uint64_t> offsets(static_cast<std::size_t>(chunks));
  output.write(header);
  output.write(numbers(offsets));
  std::uint64_t position = header.size() + 8 * offsets.size();
  // What lies in memory is a window of strips.
  const std::int64_t window =
      4 * static_cast<std::int64_t>(threads > 0 ? threads : OIIO::Sysutil::hardware_concurrency());
  std::vector<std::string> packed(static_cast<std::size_t>(window));
  for (std::int64_t begin = 0; begin < chunks; begin += window) {
    const std::int64_t end = std::min(begin + window, chunks);
    inParallel(begin, end, threads, [&](std::int64_t k) {
      const std::int64_t first = part.dataWindow.yMin + k * rows;
      const std::int64_t height = std::min<std::int64_t>(rows, part.dataWindow.yMax - first + 1);
      const ExrRectangle strip{part.dataWindow.xMin, static_cast<int>(first), static_cast<int>(part.dataWindow.width()),
                               static_cast<int>(height)};
      std::string samples(exrBytes(part.channels, strip), '\0');
      picture.fill(strip, samples.data());
      packed[static_cast<std::size_t>(k - begin)] = packedChunk(part, strip, samples, whole.name, kFastZipLevel);
    });
    for (std::int64_t k = begin; k < end; ++k) {
      const std::string& bytes = packed[static_cast<std::size_t>(k - begin)];
      std::string head;
      putNumber(head, static_cast<std::int32_t>(part.dataWindow.yMin + k * rows));
      putNumber(head, static_cast<std::uint32_t>(bytes.size()));
      output.write(head);
      output.write(bytes);
      offsets[static_cast<std::size_t>(k)] = position;
      position += head.size() + bytes.size();
    }
  }
  output.rewrite(static_cast<long>(header.size()), numbers(offsets));
  output.close();
  pending.commit();
}

}  // namespace metamer::lutgen
