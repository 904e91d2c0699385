// SPDX-License-Identifier: Apache-2.0
#include "scene_file/ply_check.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/text.h"
#include "scene_file/polygon_budget.h"

namespace metamer::spectral_ref {
namespace {

using spectral::InputError;

constexpr std::size_t kLongestLine = 1000;
constexpr std::size_t kMostHeaderLines = 1000;
constexpr std::uint64_t kMostItems = 4'000'000'000U;

/// A number's type: its bytes, and how they are read.
struct Type {
  int bytes = 0;
  bool isSigned = false;
  bool isFloating = false;
};

Type typeNamed(const std::string& name) {
  const auto is = [&](const char* a, const char* b) { return name == a || name == b; };
  return is("char", "int8")        ? Type{1, true, false}
         : is("uchar", "uint8")    ? Type{1, false, false}
         : is("short", "int16")    ? Type{2, true, false}
         : is("ushort", "uint16")  ? Type{2, false, false}
         : is("int", "int32")      ? Type{4, true, false}
         : is("uint", "uint32")    ? Type{4, false, false}
         : is("float", "float32")  ? Type{4, true, true}
         : is("double", "float64") ? Type{8, true, true}
                                   : Type{};
}

struct Property {
  Type type;
  std::optional<Type> count;  ///< of a list
  bool isIndices = false;     ///< a face's vertices
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Form { Ascii, LittleEndian, BigEndian };

struct Header {
  Form form = Form::Ascii;
  std::vector<Element> elements;
  std::uint64_t vertices = 0;
};

class PlyChecker {
 public:
  explicit PlyChecker(const std::filesystem::path& file)
      : m_where(spectral::utf8(file)), m_stream(file, std::ios::binary) {}

  void check() {
    readHeader();
    for (const Element& element : m_header.elements) {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        m_place = element.name + " " + std::to_string(i);
        for (const Property& property : element.properties) {
          readProperty(property);
        }
      }
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& field, const std::string& value, const std::string& remedy) const {
    throw InputError(m_where, field, value, remedy);
  }

  std::string headerLine() {
    std::string line;
    for (int c = m_stream.get(); c != '\n'; c = m_stream.get()) {
      if (c == std::char_traits<char>::eof()) {
        refuse("header", "", "is cut short: no end_header; export the mesh again");
      }
      if (line.size() == kLongestLine) {
        refuse("header", "", "has a line of more than 1000 characters; the file is no PLY mesh");
      }
      line += static_cast<char>(c);
    }
    return std::string(spectral::trimmed(line));
  }

  void readHeader() {
    if (headerLine() != "ply") {
      refuse("header", "", "does not begin with 'ply'; the file is no PLY mesh");
    }
    bool hasForm = false;
    for (std::size_t lines = 0;; ++lines) {
      if (lines == kMostHeaderLines) {
        refuse("header", "", "is cut short: no end_header in 1000 lines; export the mesh again");
      }
      const std::string line = headerLine();
      std::istringstream words(line);
      std::string word;
      words >> word;
      if (word == "end_header") {
        break;
      }
      if (word == "format") {
        std::string form;
        words >> form;
        hasForm = form == "ascii" || form == "binary_little_endian" || form == "binary_big_endian";
        m_header.form = form == "ascii"               ? Form::Ascii
                        : form == "binary_big_endian" ? Form::BigEndian
                                                      : Form::LittleEndian;
      } else if (word == "element") {
        readElement(words, line);
      } else if (word == "property") {
        readPropertyLine(words, line);
      } else if (!word.empty() && word != "comment" && word != "obj_info") {
        refuse("header", spectral::shortened(line, 40),
               "is no line of a PLY header: end_header may be missing; export the mesh again");
      }
    }
    if (!hasForm) {
      refuse("format", "", "must be ascii, binary_little_endian or binary_big_endian");
    }
  }

  void readElement(std::istringstream& words, const std::string& line) {
    Element element;
    std::string count;
    words >> element.name >> count;
    const std::optional<double> number = spectral::parseNumber(count);
    if (element.name.empty() || !number || *number < 0 || *number > static_cast<double>(kMostItems) ||
        *number != std::floor(*number)) {
      refuse("element", spectral::shortened(line, 40), "must be a name and a count");
    }
    element.count = static_cast<std::uint64_t>(*number);
    if (element.name == "vertex") {
      m_header.vertices = element.count;
    }
    m_header.elements.push_back(std::move(element));
  }

  void readPropertyLine(std::istringstream& words, const std::string& line) {
    std::string type;
    std::string name;
    words >> type;
    Property property;
    if (type == "list") {
      std::string count;
      words >> count >> type;
      property.count = typeNamed(count);
    }
    words >> name;
    property.type = typeNamed(type);
    property.isIndices = property.count.has_value() && (name == "vertex_indices" || name == "vertex_index");
    const bool isKnown =
        property.type.bytes > 0 && (!property.count || (property.count->bytes > 0 && !property.count->isFloating));
    if (!isKnown || name.empty() || m_header.elements.empty()) {
      refuse("property", spectral::shortened(line, 40), "must be a type and a name within an element");
    }
    m_header.elements.back().properties.push_back(property);
  }

  void readProperty(const Property& property) {
    if (!property.count) {
      readNumber(property.type);
      return;
    }
    const double count = readNumber(*property.count);
    if (!(count >= 0)) {
      refuse(m_place, spectral::numberText(count), "is no count of a list; export the mesh again");
    }
    if (property.isIndices && count == 0) {
      refuse(m_place, "0", "has no vertices; mend the mesh");  // Assimp's triangulation ends the program
    }
    if (property.isIndices &&
        !m_polygons.allows(static_cast<std::uint64_t>(std::min(count, static_cast<double>(kMostItems))))) {
      refuse(m_place, spectral::numberText(count), PolygonBudget::kRemedy);
    }
    for (double i = 0; i < count; ++i) {
      const double value = readNumber(property.type);
      if (property.isIndices &&
          !(value >= 0 && value < static_cast<double>(m_header.vertices) && value == std::floor(value))) {
        refuse(m_place + " vertex index", spectral::numberText(value),
               "is not one of the " + std::to_string(m_header.vertices) + " vertices, 0 to " +
                   std::to_string(m_header.vertices == 0 ? 0 : m_header.vertices - 1) + "; mend the mesh");
      }
    }
  }

  double readNumber(const Type& type) { return m_header.form == Form::Ascii ? readWord() : readBytes(type); }

  double readWord() {
    std::string word;
    int c = m_stream.get();
    while (c == ' ' || (c >= '\t' && c <= '\r')) {
      c = m_stream.get();
    }
    while (c != std::char_traits<char>::eof() && c != ' ' && !(c >= '\t' && c <= '\r') && word.size() < kLongestLine) {
      word += static_cast<char>(c);
      c = m_stream.get();
    }
    if (word.empty()) {
      refuse(m_place, "", "is cut short: the file ends here; export the mesh again");
    }
    // Coordinates that are no numbers are left to the reader, which drops their triangles.
    const std::optional<double> number = spectral::parseNumber(word);
    if (!number && !spectral::isNotFinite(word)) {
      refuse(m_place, spectral::shortened(word, 40), "must be a number");
    }
    return number.value_or(std::nan(""));
  }

  double readBytes(const Type& type) {
    std::array<unsigned char, 8> bytes{};
    m_stream.read(reinterpret_cast<char*>(bytes.data()), type.bytes);
    if (m_stream.gcount() != type.bytes) {
      refuse(m_place, "", "is cut short: the file ends here; export the mesh again");
    }
    std::uint64_t bits = 0;
    for (int i = 0; i < type.bytes; ++i) {
      const auto byte =
          std::uint64_t{bytes[static_cast<std::size_t>(m_header.form == Form::BigEndian ? i : type.bytes - 1 - i)]};
      bits = bits << 8U | byte;
    }
    if (type.isFloating) {
      return type.bytes == 4 ? static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                             : std::bit_cast<double>(bits);
    }
    const std::uint64_t sign = std::uint64_t{1} << (8U * static_cast<unsigned>(type.bytes) - 1U);
    return type.isSigned && (bits & sign) != 0 ? static_cast<double>(bits) - 2.0 * static_cast<double>(sign)
                                               : static_cast<double>(bits);
  }

  std::string m_where;
  std::ifstream m_stream;
  Header m_header;
  std::string m_place;
  PolygonBudget m_polygons;
};

}  // namespace

void checkPly(const std::filesystem::path& file) {
  PlyChecker(file).check();
}

}  // namespace metamer::spectral_ref
