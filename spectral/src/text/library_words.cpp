// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/library_words.h"

#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

/// Line breaks and runs of blanks as one blank.
std::string inOneLine(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool isBlank = c == ' ' || c == '\n' || c == '\r' || c == '\t';
    if (!isBlank) {
      line += c;
    } else if (!line.empty() && line.back() != ' ') {
      line += ' ';
    }
  }
  return std::string(trimmed(line));
}

/// Takes `from` and all up to the end of the next `to` away, wherever they stand.
std::string without(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at)) {
    const std::size_t end = to.empty() ? at + from.size() : text.find(to, at + from.size());
    if (end == std::string::npos) {
      break;
    }
    text.erase(at, end + to.size() - at);
  }
  return text;
}

bool startsWith(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

std::string withoutStop(std::string text) {
  while (!text.empty() && (text.back() == '.' || text.back() == ' ')) {
    text.pop_back();
  }
  return text;
}

}  // namespace

std::string pictureReason(const std::string& said) {
  std::string reason = inOneLine(said);
  reason = std::string(trimmed(without(reason, "Could not open file:", "")));
  // Said twice: once by the reader, once by who asked it.
  for (std::size_t half = reason.find(' '); half != std::string::npos; half = reason.find(' ', half + 1)) {
    if (reason.substr(0, half) == trimmed(reason.substr(half))) {
      reason.resize(half);
      break;
    }
  }
  if (reason.find("could not find a format reader") != std::string::npos) {
    return "is no picture of a format that is read; write .exr, .png, .tif, .dpx or .jpg";
  }
  constexpr std::size_t kMost = 120;
  if (reason.find("not supported") != std::string::npos || reason.find("nsupported") != std::string::npos) {
    return shortened(withoutStop(reason), kMost) + "; write it in another way";
  }
  reason = shortened(withoutStop(reason), kMost);
  return (reason.empty() ? "" : reason + "; ") + std::string("it is damaged, cut short or none: write it again");
}

std::string colourReason(const std::string& said) {
  std::string reason = inOneLine(said);
  reason = without(reason, "Error: Loading the OCIO profile ", "failed. ");
  reason = without(reason, "The specified transform file '", "could not be loaded.");
  reason = without(reason, "yaml-cpp: error at ", "");
  reason = without(reason, "All formats have been tried. (Enable debug log for errors from all formats.)", "");
  reason = without(reason, "All formats have been tried including formats registered for the given extension.", "");
  reason = without(reason, "These formats gave the following errors:", "");
  reason = std::string(trimmed(reason));
  // Of the formats of an extension the first one's reason.
  const std::string failed = "' failed with: ";
  if (const std::size_t first = reason.find(failed); first != std::string::npos) {
    reason = reason.substr(first + failed.size());
    if (const std::size_t second = reason.find(failed); second != std::string::npos) {
      reason.resize(reason.rfind('\'', second - 1));
    }
    for (const char* end : {"). ", "file. "}) {
      const std::size_t at = startsWith(reason, "Error parsing ") ? reason.find(end) : std::string::npos;
      if (at != std::string::npos) {
        reason.erase(0, at + std::string(end).size());
      }
    }
    reason = without(without(reason, "Error is: ", ""), "CTF/CLF parsing error: ", "");
  }
  if (reason.find("Cycle detected") != std::string::npos) {
    return "its transforms lead back to themselves; take one of them out of the circle";
  }
  reason = withoutStop(reason);
  constexpr std::size_t kMost = 150;
  return reason.empty() ? "is no file of a kind that OpenColorIO reads; export it again" : shortened(reason, kMost);
}

}  // namespace metamer::spectral
