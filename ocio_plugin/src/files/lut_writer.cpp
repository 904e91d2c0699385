// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/lut_writer.h"

#include <algorithm>

#include "cube/shaper_curve.h"
#include "files/baker_text.h"
#include "files/cube_text.h"
#include "files/operators_text.h"
#include "metamer/ocio/log_cube.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/text.h"
#include "operators/grey_ramp.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;
using Content = LutFormat::Content;

/// Entries of a curve: a step of 12 bits each.
constexpr int kCurveEntries = 4096;

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

OCIO::ConstGroupTransformRcPtr withoutFirst(const OCIO::ConstGroupTransformRcPtr& group) {
  auto rest = OCIO::GroupTransform::Create();
  for (int k = 1; k < group->getNumTransforms(); ++k) {
    rest->appendTransform(group->getTransform(k)->createEditableCopy());
  }
  return rest;
}

/// Of a curve, four floats each; none of no curve.
std::vector<float> entriesOf(const OCIO::ConstLut1DTransformRcPtr& curve) {
  std::vector<float> entries(curve ? 4 * curve->getLength() : 0);
  for (std::size_t at = 0; at < entries.size(); at += 4) {
    curve->getValue(at / 4, entries[at], entries[at + 1], entries[at + 2]);
  }
  return entries;
}

/// The group along the three axes of channels, four floats an entry.
std::vector<float> curves(const OCIO::ConstGroupTransformRcPtr& group, int count) {
  if (OCIO::Config::CreateRaw()->getProcessor(group)->hasChannelCrosstalk()) {
    throw InputError("", "format", "spi1d",
                     "holds curves, and this transform mixes channels; name a format with a 3-D table");
  }
  return greyRamp(group, count);
}

/// By OCIO's own writer, for operators.
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
  try {
    return operatorsText(copy, format.name);
  } catch (const OCIO::Exception& error) {
    throw InputError("", "format", format.name, std::string("cannot hold this transform: ") + error.what());
  }
}

}  // namespace

const std::vector<LutFormat>& lutFormats() {
  static const std::vector<LutFormat> formats = {
      {"Color Transform Format", ".ctf", "OCIO operators; exposure-invariant, scene-linear pixels", Content::Operators,
       true, true},
      {"Academy/ASC Common LUT Format", ".clf", "CLF operators: log, curve, 3-D table, antilog", Content::Operators,
       true, true},
      {"iridas_cube", ".cube", "3-D table, log in and out (Adobe, Iridas)", Content::Cube},
      {"resolve_cube", ".cube", "curve and 3-D table, log in and out (Resolve)", Content::Cube, true, true},
      {"cinespace", ".csp", "curve and 3-D table, log in and out (Cinespace)", Content::Cube, true, true},
      {"flame", ".3dl", "3-D table of 12 bits, log in and out (Flame)", Content::Cube, false},
      {"lustre", ".3dl", "3-D table of 12 bits, log in and out (Lustre)", Content::Cube, false},
      {"houdini", ".lut", "curve and 3-D table, log in and out (Houdini)", Content::Cube, true, true},
      {"iridas_itx", ".itx", "3-D table, log in and out (Iridas)", Content::Cube},
      {"spi3d", ".spi3d", "3-D table, log in and out (Imageworks)", Content::Cube},
      {"truelight", ".cub", "3-D table, log in and out (Truelight)", Content::Cube},
      {"spi1d", ".spi1d", "curves, log in and out (Imageworks); only what leaves channels apart", Content::Curves},
  };
  return formats;
}

const LutFormat& lutFormatNamed(const std::string& formatName) {
  const auto& formats = lutFormats();
  const std::string wanted = spectral::lowerCase(formatName);
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const LutFormat& format) {
    return spectral::lowerCase(format.name) == wanted || format.extension == "." + wanted;
  });
  if (found == formats.end()) {
    throw InputError("", "format", formatName, "unknown; the formats are " + allFormats());
  }
  return *found;
}

const LutFormat& lutFormat(const std::filesystem::path& file, const std::string& formatName) {
  const std::string extension = spectral::lowerCase(spectral::utf8(file.extension()));
  if (formatName.empty()) {
    const auto& formats = lutFormats();
    const auto found = std::find_if(formats.begin(), formats.end(),
                                    [&](const LutFormat& format) { return format.extension == extension; });
    if (found == formats.end()) {
      throw InputError(spectral::utf8(file), "extension", extension, "unknown; the formats are " + allFormats());
    }
    return *found;
  }
  const LutFormat& format = lutFormatNamed(formatName);
  if (format.extension != extension && !spectral::isStream(file)) {
    throw InputError(spectral::utf8(file), "extension", extension,
                     "is not that of " + format.name + "; name the file *" + format.extension);
  }
  return format;
}

std::string lutText(const LutFormat& format, const OCIO::ConstGroupTransformRcPtr& group, int size,
                    const LutDescription& description, int shaperSize) {
  if (shaperSize != 0) {
    spectral::requireWithin("shaper size", shaperSize, kFewestCurveEntries, kMostCurveEntries);
  }
  if (format.content == Content::Operators) {
    return groupText(format, group, description);
  }
  if (format.content == Content::Curves) {
    return spi1dText(curves(group, shaperSize > 0 ? shaperSize : kCurveEntries));
  }
  spectral::requireWithin("size", size, kSmallestTable, kLargestTable);
  const OCIO::ConstLut1DTransformRcPtr curve = format.holdsShaperCurve ? leadingShaperCurve(group) : nullptr;
  if (format.extension != ".cube" && format.name != "spi3d") {
    return bakerText(format.name, group, curve, size, shaperSize, description);
  }
  if (format.name == "resolve_cube") {
    return resolveCubeText(entriesOf(curve), tabulated(curve ? withoutFirst(group) : group, size), size, description);
  }
  const std::vector<float> nodes = tabulated(group, size);
  return format.name == "spi3d" ? spi3dText(nodes, size) : iridasCubeText(nodes, size, description);
}

}  // namespace metamer::ocio
