// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace metamer::lutgen {

/// Types of EXR samples, as the file numbers them.
enum class ExrType : std::uint32_t { Uint = 0, Half = 1, Float = 2 };

/// Bytes of a sample.
constexpr std::size_t sizeOf(ExrType type) {
  return type == ExrType::Half ? 2 : 4;
}

/// As the file numbers them.
enum class ExrCompression : std::uint8_t { None, Rle, Zips, Zip, Piz, Pxr24, B44, B44a, Dwaa, Dwab };

/// "none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab", in their order.
const std::vector<std::string>& exrCompressionNames();
/// Rows of a chunk where the part has no tiles.
int rowsPerChunk(ExrCompression compression);

struct ExrChannel {
  std::string name;
  ExrType type = ExrType::Half;
  int xSampling = 1;
  int ySampling = 1;
  bool isPerceptual = false;  ///< B44 packs such samples by their size, others by their logarithm
  std::size_t typeAt = 0;     ///< where its type stands in the value of the attribute "channels"
};

/// An attribute as it stands in the file.
struct ExrAttribute {
  std::string name;
  std::string type;
  std::string value;
};

/// Inclusive pixels.
struct ExrBox {
  int xMin = 0;
  int yMin = 0;
  int xMax = -1;
  int yMax = -1;

  std::int64_t width() const { return static_cast<std::int64_t>(xMax) - xMin + 1; }
  std::int64_t height() const { return static_cast<std::int64_t>(yMax) - yMin + 1; }
};

/// One part: its header, and where its chunks lie.
struct ExrPart {
  std::vector<ExrAttribute> attributes;  ///< all, in the file's order
  std::string name;                      ///< empty in files of one part
  std::string view;                      ///< of a stereo picture
  std::vector<ExrChannel> channels;      ///< in the file's order
  ExrCompression compression = ExrCompression::None;
  ExrBox dataWindow;
  bool isTiled = false;
  bool isDeep = false;
  std::array<int, 2> tileSize{};
  bool roundsUp = false;                    ///< sizes of a pyramid's levels
  std::vector<std::uint64_t> chunkOffsets;  ///< of the file's bytes, one a chunk

  /// Null where there is none.
  const ExrAttribute* find(std::string_view attribute) const;
  /// Replaces a value, or adds the attribute.
  void set(const std::string& attribute, const std::string& attributeType, const std::string& value);
};

/// An OpenEXR file as it lies in memory: headers read and checked, pixels still packed.
struct ExrFile {
  std::string name;        ///< for messages
  std::string_view bytes;  ///< outlive this
  std::uint32_t version = 2;
  bool isMultiPart = false;
  std::vector<ExrPart> parts;
};

/// Whether a file's bytes begin as an EXR's do.
bool isExr(std::string_view bytes);

/// @param mostPixels  refused beyond, in each part
/// @throws spectral::InputError: damaged, cut short, incomplete, of a kind or compression that is not known
ExrFile readExrFile(std::string_view bytes, const std::string& name, std::int64_t mostPixels);

/// Magic, version, headers and, in files of several parts, their end: what stands before the tables of offsets.
std::string exrHeader(const ExrFile& file);

/// Size of level `level` of a side of `size` pixels.
std::int64_t exrLevelSize(std::int64_t size, int level, bool roundsUp);

}  // namespace metamer::lutgen
