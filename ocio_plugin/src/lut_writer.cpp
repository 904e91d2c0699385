// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/lut_writer.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "cube_text.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/spectral/input_error.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;
using Content = LutFormat::Content;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string allFormats() {
  std::string text;
  for (const auto& format : lutFormats()) {
    text += (text.empty() ? "" : ", ") + format.name + " (" + format.extension + ")";
  }
  return text;
}

/// The group at the nodes of a table over 0 ... 1, red fastest, four floats a node.
std::vector<float> tabulated(const OCIO::ConstGroupTransformRcPtr& group, int size) {
  std::vector<float> nodes;
  nodes.reserve(4 * static_cast<std::size_t>(size) * size * size);
  const auto at = [size](int k) { return static_cast<float>(static_cast<double>(k) / (size - 1)); };
  for (int blue = 0; blue < size; ++blue) {
    for (int green = 0; green < size; ++green) {
      for (int red = 0; red < size; ++red) {
        nodes.insert(nodes.end(), {at(red), at(green), at(blue), 1.0F});
      }
    }
  }
  PixelProcessor(group).apply(nodes);
  return nodes;
}

/// OCIO's own writer, for operators.
std::string groupText(const LutFormat& format, const OCIO::ConstGroupTransformRcPtr& group,
                      const LutDescription& description) {
  auto copy = OCIO::DynamicPtrCast<OCIO::GroupTransform>(group->createEditableCopy());
  // The formats have no empty process list: nothing is one matrix that changes nothing.
  if (copy->getNumTransforms() == 0) {
    copy->appendTransform(OCIO::MatrixTransform::Create());
  }
  auto& metadata = copy->getFormatMetadata();
  metadata.setID(description.id.c_str());
  metadata.setName(description.name.c_str());
  for (const auto& line : description.lines) {
    metadata.addChildElement(OCIO::METADATA_DESCRIPTION, line.c_str());
  }
  std::ostringstream text;
  try {
    copy->write(OCIO::Config::CreateRaw(), format.name.c_str(), text);
  } catch (const OCIO::Exception& error) {
    throw InputError("", "format", format.name, std::string("cannot hold this transform: ") + error.what());
  }
  return std::move(text).str();
}

}  // namespace

const std::vector<LutFormat>& lutFormats() {
  static const std::vector<LutFormat> formats = {
      {"Color Transform Format", ".ctf", "OCIO operators; exposure-invariant, scene-linear pixels", Content::Operators},
      {"Academy/ASC Common LUT Format", ".clf", "CLF operators: log, 3-D table, antilog", Content::Operators},
      {"iridas_cube", ".cube", "3-D table, log in and out (Adobe, Iridas)", Content::Cube},
      {"resolve_cube", ".cube", "3-D table, log in and out (Resolve)", Content::Cube},
  };
  return formats;
}

const LutFormat& lutFormat(const std::filesystem::path& file, const std::string& formatName) {
  const auto& formats = lutFormats();
  const std::string extension = lower(file.extension().string());
  const std::string wanted = lower(formatName);
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const LutFormat& format) {
    return wanted.empty() ? format.extension == extension
                          : lower(format.name) == wanted || format.extension == "." + wanted;
  });
  if (found == formats.end()) {
    const bool byName = !formatName.empty();
    throw InputError(byName ? "" : file.string(), byName ? "format" : "extension", byName ? formatName : extension,
                     "unknown; the formats are " + allFormats());
  }
  if (found->extension != extension) {
    throw InputError(file.string(), "extension", extension,
                     "is not that of " + found->name + "; name the file *" + found->extension);
  }
  return *found;
}

std::string lutText(const LutFormat& format, const OCIO::ConstGroupTransformRcPtr& group, int size,
                    const LutDescription& description) {
  if (format.content == Content::Operators) {
    return groupText(format, group, description);
  }
  const std::vector<float> nodes = tabulated(group, size);
  return format.name == "resolve_cube" ? resolveCubeText(nodes, size, description)
                                       : iridasCubeText(nodes, size, description);
}

}  // namespace metamer::ocio
