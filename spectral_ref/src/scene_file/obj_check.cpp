// SPDX-License-Identifier: Apache-2.0
#include "scene_file/obj_check.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/text.h"
#include "scene_file/polygon_budget.h"

namespace metamer::spectral_ref {
namespace {

using spectral::InputError;

constexpr std::size_t kLongestLine = 1U << 20U;
constexpr std::string_view kSpaces = " \t\r\f\v";

/// Positions, texture coordinates and normals: what the numbers of a face's corner count, in their order.
using Counts = std::array<std::int64_t, 3>;
constexpr std::array<std::string_view, 3> kLists = {"v", "vt", "vn"};

std::vector<std::string_view> wordsOf(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t begin = line.find_first_not_of(kSpaces); begin != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kSpaces, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kSpaces, end);
  }
  return words;
}

/// Materials by parts: Assimp looks every part up for every material.
constexpr std::uint64_t kMostLookUps = 30'000'000;

/// nan and inf, as printf writes them: triangles of such places are left out with a warning.
bool isNoNumber(std::string_view word) {
  word.remove_prefix(!word.empty() && (word[0] == '-' || word[0] == '+') ? 1 : 0);
  const std::string name = spectral::lowerCase(word);
  return name == "nan" || name == "inf" || name == "infinity";
}

class ObjCheck {
 public:
  explicit ObjCheck(const std::filesystem::path& file) : m_file(file), m_stream(file, std::ios::binary) {}

  void run() {
    std::string line;
    while (readLine(line)) {
      const std::vector<std::string_view> words = wordsOf(line);
      if (words.empty()) {
        continue;
      }
      for (std::size_t list = 0; list < kLists.size(); ++list) {
        if (words[0] == kLists[list]) {
          checkNumbers(words, list == 1 ? 1 : 3);
          ++m_counts[list];
        }
      }
      if (words[0] == "f" || words[0] == "l" || words[0] == "p") {
        checkCorners(words);
      }
      if (words[0] == "f" && !m_polygons.allows(words.size() - 1)) {
        refuse("face", std::to_string(words.size() - 1), PolygonBudget::kRemedy);
      }
      if (words[0] == "o" || words[0] == "usemtl") {
        addPart(words);
      }
    }
    // A face may come before its vertices.
    for (std::size_t list = 0; list < kLists.size(); ++list) {
      if (m_largest[list] > m_counts[list]) {
        m_line = m_lineOfLargest[list];
        refuse("face", std::to_string(m_largest[list]),
               "names what is not there: the file has " + std::to_string(m_counts[list]) + " '" +
                   std::string(kLists[list]) + "'; write the mesh anew, it may be cut short");
      }
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& remedy) const {
    throw InputError(spectral::utf8(m_file) + ":" + std::to_string(m_line), field, value, remedy);
  }

  /// A line with those that a backslash joins to it.
  bool readLine(std::string& line) {
    line.clear();
    std::string part;
    while (std::getline(m_stream, part)) {
      ++m_line;
      if (part.find('\0') != std::string::npos) {
        refuse("text", "", "has bytes that are no text; this is no OBJ file");
      }
      if (line.size() + part.size() > kLongestLine) {
        refuse("line", "", "is longer than a million bytes; this is no OBJ file");
      }
      const std::size_t last = part.find_last_not_of(kSpaces);
      if (last == std::string::npos || part[last] != '\\') {
        line += part;
        return true;
      }
      line.append(part, 0, last).append(" ");
    }
    return !line.empty();
  }

  void checkNumbers(const std::vector<std::string_view>& words, std::size_t fewest) const {
    for (std::size_t k = 1; k <= fewest; ++k) {
      if (k >= words.size() || !(spectral::parseNumber(words[k]) || isNoNumber(words[k]))) {
        refuse(std::string(words[0]), k < words.size() ? std::string(words[k]) : "",
               "must have " + std::to_string(fewest) + " numbers; write the mesh anew, it may be cut short");
      }
    }
  }

  void addPart(const std::vector<std::string_view>& words) {
    ++m_parts;
    if (words[0] == "usemtl" && words.size() > 1) {
      m_materials.emplace(words[1]);
    }
    if (m_parts * m_materials.size() > kMostLookUps) {
      refuse("usemtl", std::to_string(m_materials.size()),
             "materials in " + std::to_string(m_parts) + " parts take too long to read; export fewer");
    }
  }

  void checkCorners(const std::vector<std::string_view>& words) {
    if (words.size() < 2) {
      refuse(std::string(words[0]), "", "has no corner; write the mesh anew, it may be cut short");
    }
    for (std::size_t k = 1; k < words.size(); ++k) {
      const std::string_view corner = words[k];
      std::size_t begin = 0;
      for (std::size_t list = 0; begin <= corner.size(); ++list) {
        const std::size_t end = std::min(corner.find('/', begin), corner.size());
        if (list >= kLists.size() || (list == 0 && end == begin)) {
          refuse("corner", std::string(corner), "must be V, V/VT, V//VN or V/VT/VN; mend the mesh");
        }
        if (end > begin) {
          checkIndex(corner.substr(begin, end - begin), corner, list);
        }
        begin = end + 1;
      }
    }
  }

  void checkIndex(std::string_view text, std::string_view corner, std::size_t list) {
    std::int64_t index = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), index);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + text.size() || index == 0) {
      refuse("corner", std::string(corner), "must name vertices by whole numbers from 1; mend the mesh");
    }
    if (-index > m_counts[list]) {
      refuse("corner", std::string(corner),
             "counts back beyond the first '" + std::string(kLists[list]) + "'; mend the mesh");
    }
    if (index > m_largest[list]) {
      m_largest[list] = index;
      m_lineOfLargest[list] = m_line;
    }
  }

  std::filesystem::path m_file;
  std::ifstream m_stream;
  std::size_t m_line = 0;
  PolygonBudget m_polygons;
  std::uint64_t m_parts = 0;
  std::set<std::string> m_materials;
  Counts m_counts{};
  Counts m_largest{};
  std::array<std::size_t, 3> m_lineOfLargest{};
};

}  // namespace

void checkObj(const std::filesystem::path& file) {
  ObjCheck(file).run();
}

}  // namespace metamer::spectral_ref
