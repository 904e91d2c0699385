// SPDX-License-Identifier: Apache-2.0
#include "files/operators_text.h"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <vector>

#include "metamer/spectral/input_error.h"

namespace metamer::ocio {
namespace {

/// Every entry of a table that stands in for another; no table of colours has it, and it is found in a text.
constexpr float kMark = -987654.5F;
constexpr const char* kMarkText = "-987654.5";

bool hasWholeNumbers(const OCIO::Lut3DTransform& table) {
  const OCIO::BitDepth depth = table.getFileOutputBitDepth();
  return depth != OCIO::BIT_DEPTH_F32 && depth != OCIO::BIT_DEPTH_UNKNOWN;
}

OCIO::TransformRcPtr standInOf(const OCIO::Lut3DTransform& table) {
  const auto standIn = OCIO::DynamicPtrCast<OCIO::Lut3DTransform>(table.createEditableCopy());
  standIn->setGridSize(2);
  for (unsigned long node = 0; node < 8; ++node) {
    standIn->setValue(node / 4, node / 2 % 2, node % 2, kMark, kMark, kMark);
  }
  return standIn;
}

/// The group with tables of two nodes in the places of its 3-D tables, which are added to `tables` in their order. A
/// table whose file has whole numbers stays.
OCIO::GroupTransformRcPtr withoutTables(const OCIO::GroupTransform& group,
                                        std::vector<OCIO::ConstLut3DTransformRcPtr>& tables) {
  // The copy's list is its own, what the list holds is not.
  auto copy = OCIO::DynamicPtrCast<OCIO::GroupTransform>(group.createEditableCopy());
  for (int k = 0; k < group.getNumTransforms(); ++k) {
    const OCIO::ConstTransformRcPtr one = group.getTransform(k);
    if (const auto inner = OCIO::DynamicPtrCast<const OCIO::GroupTransform>(one)) {
      copy->getTransform(k) = withoutTables(*inner, tables);
    } else if (const auto table = OCIO::DynamicPtrCast<const OCIO::Lut3DTransform>(one);
               table && !hasWholeNumbers(*table)) {
      tables.push_back(table);
      copy->getTransform(k) = standInOf(*table);
    }
  }
  return copy;
}

/// An array's entries in OpenColorIO's layout: eight digits, each column as wide as the widest number so far.
class Column {
 public:
  void append(std::string& text, float value) {
    char digits[32];
    const char* const end =
        std::to_chars(digits, digits + sizeof digits, static_cast<double>(value), std::chars_format::general, 8).ptr;
    const auto length = static_cast<std::size_t>(end - digits);
    text.append(m_width > length ? m_width - length : 0, ' ').append(digits, length);
    m_width = std::max(m_width, length);
  }

 private:
  std::size_t m_width = 11;
};

std::string arrayText(const OCIO::Lut3DTransform& table) {
  const unsigned long size = table.getGridSize();
  const std::string side = std::to_string(size) + ' ';
  std::string text = "<Array dim=\"" + side + side + side + "3\">\n";
  constexpr std::size_t kUsualLine = 48;
  text.reserve(text.size() + kUsualLine * size * size * size);
  Column column;
  for (unsigned long red = 0; red < size; ++red) {
    for (unsigned long green = 0; green < size; ++green) {
      for (unsigned long blue = 0; blue < size; ++blue) {
        float rgb[3];
        table.getValue(red, green, blue, rgb[0], rgb[1], rgb[2]);
        for (int channel = 0; channel < 3; ++channel) {
          column.append(text, rgb[channel]);
          text += channel < 2 ? ' ' : '\n';
        }
      }
    }
  }
  return text;
}

}  // namespace

std::string operatorsText(const OCIO::ConstGroupTransformRcPtr& group, const std::string& formatName) {
  std::vector<OCIO::ConstLut3DTransformRcPtr> tables;
  // An id that is not there is made by OpenColorIO, from all entries.
  const bool hasId = *group->getFormatMetadata().getID() != '\0';
  const OCIO::ConstGroupTransformRcPtr frame = hasId ? withoutTables(*group, tables) : group;
  std::ostringstream stream;
  frame->write(OCIO::Config::CreateRaw(), formatName.c_str(), stream);
  const std::string written = std::move(stream).str();

  std::string text;
  std::size_t from = 0;
  for (const OCIO::ConstLut3DTransformRcPtr& table : tables) {
    const std::size_t mark = written.find(kMarkText, from);
    const std::size_t begin = written.rfind("<Array", mark);
    const std::size_t line = written.rfind('\n', written.find("</Array>", mark));
    if (mark == std::string::npos || begin == std::string::npos || line == std::string::npos) {
      throw spectral::InputError("OpenColorIO", "release", OCIO::GetVersion(), "writes 3-D tables in another way");
    }
    text.append(written, from, begin - from).append(arrayText(*table));
    from = line + 1;
  }
  return text.append(written, from);
}

}  // namespace metamer::ocio
