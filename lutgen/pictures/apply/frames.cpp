// SPDX-License-Identifier: Apache-2.0
#include "apply/frames.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <regex>
#include <set>

#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/text.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

constexpr std::size_t kMostFrames = 1'000'000;
constexpr long long kFurthestFrame = 1'000'000'000;
constexpr int kDigitsOfOneMark = 4;

const std::regex& rangeForm() {
  static const std::regex form(R"(\s*(-?\d{1,10})(?:-(-?\d{1,10})(?:x(\d{1,10}))?)?\s*)");
  return form;
}

}  // namespace

std::optional<FramePattern> FramePattern::in(const std::string& name) {
  static const std::regex form(R"(%0?(\d*)d|\$F(\d*)|#+)");
  FramePattern pattern;
  pattern.m_name = name;
  for (auto match = std::sregex_iterator(name.begin(), name.end(), form); match != std::sregex_iterator(); ++match) {
    Place place{static_cast<std::size_t>(match->position()), static_cast<std::size_t>(match->length()), 1};
    const std::string digits = (*match)[1].str() + (*match)[2].str();
    if (match->str()[0] == '#') {
      place.digits = place.size == 1 ? kDigitsOfOneMark : static_cast<int>(place.size);
    } else if (!digits.empty()) {
      place.digits = static_cast<int>(spectral::parseNumber(digits.substr(0, 3)).value_or(1));
    }
    pattern.m_places.push_back(place);
  }
  return pattern.m_places.empty() ? std::nullopt : std::optional(pattern);
}

std::string FramePattern::file(int frame) const {
  std::string text;
  std::size_t at = 0;
  for (const Place& place : m_places) {
    text += m_name.substr(at, place.begin - at) + spectral::formatted("%0*d", place.digits, frame);
    at = place.begin + place.size;
  }
  return text + m_name.substr(at);
}

std::vector<int> FramePattern::framesThere() const {
  const std::filesystem::path path = spectral::pathOf(m_name);
  const std::string folder = spectral::utf8(path.parent_path());
  const std::size_t nameBegin = m_name.size() - spectral::utf8(path.filename()).size();
  if (m_places.size() != 1 || m_places[0].begin < nameBegin) {
    throw InputError(m_name, "frames", "", "cannot be looked up: say which, --frames 1001-1100");
  }
  const std::string before = m_name.substr(nameBegin, m_places[0].begin - nameBegin);
  const std::string after = m_name.substr(m_places[0].begin + m_places[0].size);
  std::vector<int> frames;
  std::error_code failure;
  for (std::filesystem::directory_iterator entry(spectral::pathOf(folder.empty() ? "." : folder), failure), end;
       !failure && entry != end; entry.increment(failure)) {
    const std::string name = spectral::utf8(entry->path().filename());
    if (name.size() <= before.size() + after.size() || name.rfind(before, 0) != 0 ||
        name.compare(name.size() - after.size(), after.size(), after) != 0) {
      continue;
    }
    const std::string digits = name.substr(before.size(), name.size() - before.size() - after.size());
    int frame = 0;
    const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), frame);
    if (error == std::errc() && stop == digits.data() + digits.size() &&
        spectral::utf8(spectral::pathOf(file(frame)).filename()) == name) {
      frames.push_back(frame);
    }
  }
  if (frames.empty()) {
    throw InputError(m_name, "frames", "", "there are none; check the path, or say which: --frames 1001-1100");
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

bool looksLikeFrames(const std::string& text) {
  static const std::regex form(R"([-0-9x,\s]*\d[-0-9x,\s]*)");
  return std::regex_match(text, form);
}

std::vector<int> framesFrom(const std::string& text) {
  std::vector<int> frames;
  std::set<int> seen;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string piece = text.substr(begin, end - begin);
    begin = end + 1;
    std::smatch match;
    if (!std::regex_match(piece, match, rangeForm())) {
      throw InputError("--frames", "frames", text, "write them as 1001-1100, 1-100x5 (every fifth) or 1,3,7-9");
    }
    const auto number = [&](std::size_t group) { return std::stoll(match[group].str()); };
    const long long first = number(1);
    const long long last = match[2].matched ? number(2) : first;
    const long long step = match[3].matched ? number(3) : 1;
    if (step < 1 || last < first) {
      throw InputError("--frames", "frames", text, "must rise, in steps of 1 or more: 1001-1100, 1-100x5");
    }
    if (static_cast<std::size_t>((last - first) / step) >= kMostFrames - frames.size()) {
      throw InputError("--frames", "frames", text, "are more than a million; give them in portions");
    }
    if (first < -kFurthestFrame || last > kFurthestFrame) {
      throw InputError("--frames", "frames", text, "lie beyond a thousand million; number them anew");
    }
    for (long long frame = first; frame <= last; frame += step) {
      if (seen.insert(static_cast<int>(frame)).second) {
        frames.push_back(static_cast<int>(frame));
      }
    }
  }
  return frames;
}

std::string framesText(const std::vector<int>& frames) {
  std::vector<std::string> ranges;
  for (std::size_t begin = 0; begin < frames.size();) {
    std::size_t end = begin;
    while (end + 1 < frames.size() && frames[end + 1] == frames[end] + 1) {
      ++end;
    }
    ranges.push_back(std::to_string(frames[begin]) + (end > begin ? "-" + std::to_string(frames[end]) : ""));
    begin = end + 1;
  }
  return spectral::joined(ranges);
}

}  // namespace metamer::lutgen
