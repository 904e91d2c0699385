// SPDX-License-Identifier: Apache-2.0
#include "exr/zip_block.h"

#include <algorithm>
#include <array>
#include <memory>
#include <new>

#ifdef METAMER_HAS_LIBDEFLATE
#include <libdeflate.h>
#else
#include <zlib.h>
#endif
#ifdef METAMER_HAS_ISAL
#include <isa-l/igzip_lib.h>
#endif

namespace metamer::lutgen {
namespace {

#ifdef METAMER_HAS_LIBDEFLATE

struct Free {
  void operator()(libdeflate_compressor* compressor) const { libdeflate_free_compressor(compressor); }
  void operator()(libdeflate_decompressor* decompressor) const { libdeflate_free_decompressor(decompressor); }
};

bool inflateInto(std::string_view packed, std::string& bytes) {
  thread_local const std::unique_ptr<libdeflate_decompressor, Free> tool(libdeflate_alloc_decompressor());
  if (!tool) {
    throw std::bad_alloc();
  }
  // Without a place for the number of bytes, another number of bytes is a failure.
  return libdeflate_zlib_decompress(tool.get(), packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr) ==
         LIBDEFLATE_SUCCESS;
}

/// How many bytes came of it; 0 where it is damaged or they do not fit.
std::size_t inflateSome(std::string_view packed, std::string& bytes) {
  const std::unique_ptr<libdeflate_decompressor, Free> tool(libdeflate_alloc_decompressor());
  std::size_t size = 0;
  return tool && libdeflate_zlib_decompress(tool.get(), packed.data(), packed.size(), bytes.data(), bytes.size(),
                                            &size) == LIBDEFLATE_SUCCESS
             ? size
             : 0;
}

/// 0 where they do not fit.
std::size_t deflateInto(const std::string& bytes, std::string& packed, int level) {
  thread_local std::array<std::unique_ptr<libdeflate_compressor, Free>, 10> tools;
  auto& tool = tools.at(static_cast<std::size_t>(level));
  if (!tool) {
    tool.reset(libdeflate_alloc_compressor(level));
  }
  if (!tool) {
    throw std::bad_alloc();
  }
  return libdeflate_zlib_compress(tool.get(), bytes.data(), bytes.size(), packed.data(), packed.size());
}

#else

bool inflateInto(std::string_view packed, std::string& bytes) {
  auto size = static_cast<uLongf>(bytes.size());
  return uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                    static_cast<uLong>(packed.size())) == Z_OK &&
         size == bytes.size();
}

/// How many bytes came of it; 0 where it is damaged or they do not fit.
std::size_t inflateSome(std::string_view packed, std::string& bytes) {
  auto size = static_cast<uLongf>(bytes.size());
  return uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size, reinterpret_cast<const Bytef*>(packed.data()),
                    static_cast<uLong>(packed.size())) == Z_OK
             ? size
             : 0;
}

/// 0 where they do not fit.
std::size_t deflateInto(const std::string& bytes, std::string& packed, int level) {
  auto size = static_cast<uLongf>(packed.size());
  return compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                   static_cast<uLong>(bytes.size()), level) == Z_OK
             ? size
             : 0;
}

#endif

#ifdef METAMER_HAS_ISAL

/// For kFastZipLevel. 0 where they do not fit.
std::size_t deflateFast(std::string& bytes, std::string& packed) {
  thread_local const auto stream = std::make_unique<isal_zstream>();
  thread_local std::array<std::uint8_t, ISAL_DEF_LVL1_DEFAULT> room;
  isal_deflate_stateless_init(stream.get());
  stream->level = 1;
  stream->level_buf = room.data();
  stream->level_buf_size = room.size();
  stream->gzip_flag = IGZIP_ZLIB;
  stream->end_of_stream = 1;
  stream->next_in = reinterpret_cast<std::uint8_t*>(bytes.data());
  stream->avail_in = static_cast<std::uint32_t>(bytes.size());
  stream->next_out = reinterpret_cast<std::uint8_t*>(packed.data());
  stream->avail_out = static_cast<std::uint32_t>(packed.size());
  return isal_deflate_stateless(stream.get()) == COMP_OK ? stream->total_out : 0;
}

#else

std::size_t deflateFast(const std::string& bytes, std::string& packed) {
  return deflateInto(bytes, packed, kFastZipLevel);
}

#endif

}  // namespace

std::string unzippedBlock(std::string_view packed, std::size_t size) {
  thread_local std::string differences;
  differences.resize(size);
  if (size == 0 || !inflateInto(packed, differences)) {
    return {};
  }
  for (std::size_t k = 1; k < size; ++k) {
    differences[k] = static_cast<char>(differences[k - 1] + differences[k] - 128);
  }
  std::string block(size, '\0');
  const std::size_t half = (size + 1) / 2;
  for (std::size_t k = 0; k < size / 2; ++k) {
    block[2 * k] = differences[k];
    block[2 * k + 1] = differences[half + k];
  }
  if (size % 2 != 0) {
    block[size - 1] = differences[half - 1];
  }
  return block;
}

std::string inflated(std::string_view packed, std::size_t most) {
  std::string bytes;
  for (std::size_t size = std::min<std::size_t>(most, 1U << 16U);; size = std::min(most, 8 * size)) {
    bytes.resize(size);
    bytes.resize(inflateSome(packed, bytes));
    if (!bytes.empty() || size >= most) {
      return bytes;
    }
  }
}

std::string zippedBlock(std::string_view block, int level) {
  thread_local std::string differences;
  thread_local std::string packed;
  const std::size_t size = block.size();
  if (size < 2) {
    return std::string(block);
  }
  differences.resize(size);
  // Bytes of even places, then those of odd ones; each less the one before, which a compiler makes vectors of.
  const std::size_t half = (size + 1) / 2;
  const auto less = [](char here, char before) { return static_cast<char>(here - before + 128); };
  char* to = differences.data();
  to[0] = block[0];
  for (std::size_t k = 1; k < half; ++k) {
    to[k] = less(block[2 * k], block[2 * k - 2]);
  }
  to += half;
  to[0] = less(block[1], block[2 * half - 2]);
  for (std::size_t k = 1; k < size / 2; ++k) {
    to[k] = less(block[2 * k + 1], block[2 * k - 1]);
  }
  packed.resize(size - 1);
  const std::size_t packedSize =
      level == kFastZipLevel ? deflateFast(differences, packed) : deflateInto(differences, packed, level);
  return packedSize == 0 ? std::string(block) : packed.substr(0, packedSize);
}

}  // namespace metamer::lutgen
