// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/message_line.h"

#include <algorithm>
#include <array>

#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr std::string_view kMark = " ... ";

/// "/build/reposrc/ImfHeader.cpp:215," and the like: a source, with a path, perhaps with a line. What a message begins
/// with is the user's file, "grades/warm.cc:", unless it has a line.
bool isPlaceInSources(std::string_view word, bool isFirst) {
  constexpr std::array<std::string_view, 7> kExtensions = {".cpp", ".cc", ".cxx", ".c", ".hpp", ".h", ".inl"};
  if (word.find('/') == std::string_view::npos && word.find('\\') == std::string_view::npos) {
    return false;
  }
  const std::size_t end = word.find_last_not_of("0123456789:,;()[]'\"");
  const std::string_view path = word.substr(0, end + 1);
  const bool hasLine = word.find_first_of("0123456789", end + 1) != std::string_view::npos;
  if (isFirst && !hasLine) {
    return false;
  }
  return std::any_of(kExtensions.begin(), kExtensions.end(), [path](std::string_view extension) {
    return path.size() > extension.size() && path.substr(path.size() - extension.size()) == extension;
  });
}

bool continuesCharacter(char c) {
  return (static_cast<unsigned char>(c) & 0xc0U) == 0x80U;
}

}  // namespace

std::string messageLine(std::string_view message, std::size_t most) {
  const std::string plain = oneLine(message);
  std::string line;
  for (std::size_t begin = plain.find_first_not_of(' '); begin != std::string::npos;) {
    const std::size_t end = std::min(plain.find(' ', begin), plain.size());
    const std::string_view word = std::string_view(plain).substr(begin, end - begin);
    if (!isPlaceInSources(word, line.empty())) {
      line.append(line.empty() ? "" : " ").append(word);
    }
    begin = plain.find_first_not_of(' ', end);
  }
  if (line.size() <= most) {
    return line;
  }
  // What it is about stands at the start, what to do at the end.
  std::size_t head = (most - kMark.size()) / 2;
  std::size_t tail = line.size() - (most - kMark.size() - head);
  while (head > 0 && continuesCharacter(line[head])) {
    --head;
  }
  while (tail < line.size() && continuesCharacter(line[tail])) {
    ++tail;
  }
  return line.substr(0, head).append(kMark).append(line, tail);
}

}  // namespace metamer::spectral
