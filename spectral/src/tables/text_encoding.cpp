// SPDX-License-Identifier: Apache-2.0
#include "tables/text_encoding.h"

#include <cstdint>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

bool startsWith(std::string_view bytes, std::string_view mark) {
  return bytes.substr(0, mark.size()) == mark;
}

void append(std::string& text, std::uint32_t codePoint) {
  const auto put = [&](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (codePoint < 0x80U) {
    put(codePoint);
  } else if (codePoint < 0x800U) {
    put(0xC0U | codePoint >> 6U);
    put(0x80U | (codePoint & 0x3FU));
  } else if (codePoint < 0x10000U) {
    put(0xE0U | codePoint >> 12U);
    put(0x80U | (codePoint >> 6U & 0x3FU));
    put(0x80U | (codePoint & 0x3FU));
  } else {
    put(0xF0U | codePoint >> 18U);
    put(0x80U | (codePoint >> 12U & 0x3FU));
    put(0x80U | (codePoint >> 6U & 0x3FU));
    put(0x80U | (codePoint & 0x3FU));
  }
}

std::string fromUtf16(std::string_view bytes, bool bigEndian, const std::string& where) {
  const auto refuse = [&](std::size_t at) {
    throw InputError(where, "text encoding", "UTF-16",
                     "byte " + std::to_string(at + 1) + " is no character; save the file as UTF-8");
  };
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(bytes[at]);
    const auto second = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<std::uint32_t>(bigEndian ? first << 8 | second : second << 8 | first);
  };
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t at = 2; at < bytes.size(); at += 2) {
    if (at + 1 == bytes.size()) {
      refuse(at);
    }
    std::uint32_t codePoint = unit(at);
    if (codePoint >= 0xD800U && codePoint < 0xE000U) {
      const bool isPair = codePoint < 0xDC00U && at + 3 < bytes.size() && (unit(at + 2) & 0xFC00U) == 0xDC00U;
      if (!isPair) {
        refuse(at);
      }
      codePoint = 0x10000U + ((codePoint & 0x3FFU) << 10U) + (unit(at + 2) & 0x3FFU);
      at += 2;
    }
    if (codePoint == 0) {
      refuse(at);
    }
    append(text, codePoint);
  }
  return text;
}

std::string fromLatin1(std::string_view bytes) {
  std::string text;
  text.reserve(bytes.size() + bytes.size() / 8);
  for (const char byte : bytes) {
    append(text, static_cast<unsigned char>(byte));
  }
  return text;
}

}  // namespace

std::string decodedTable(std::string_view bytes, const std::string& where) {
  // The zip archive of .xlsx and .ods, and the compound file of the older .xls.
  if (startsWith(bytes, "PK\x03\x04") || startsWith(bytes, "\xD0\xCF\x11\xE0")) {
    throw InputError(where, "format", "spreadsheet", "is a spreadsheet program's own file; save the sheet as CSV");
  }
  const bool isUtf32 = startsWith(bytes, std::string_view("\xFF\xFE\0\0", 4));
  if (!isUtf32 && (startsWith(bytes, "\xFF\xFE") || startsWith(bytes, "\xFE\xFF"))) {
    return fromUtf16(bytes, bytes.front() == '\xFE', where);
  }
  const bool isLatin1 = bytes.find('\0') == std::string_view::npos && !isUtf8(bytes);
  return isLatin1 ? fromLatin1(bytes) : std::string(checkedUtf8(bytes, where));
}

}  // namespace metamer::spectral
