// SPDX-License-Identifier: Apache-2.0
#include "files/baker_text.h"

#include <sstream>

#include "metamer/spectral/input_error.h"

namespace metamer::ocio {
namespace {

constexpr const char* kInput = "signal";
constexpr const char* kAxes = "axes";
constexpr const char* kOutput = "transformed";

void addSpace(OCIO::Config& config, const char* name, const OCIO::ConstTransformRcPtr& fromSignal) {
  auto space = OCIO::ColorSpace::Create();
  space->setName(name);
  if (fromSignal) {
    space->setTransform(fromSignal, OCIO::COLORSPACE_DIR_FROM_REFERENCE);
  }
  config.addColorSpace(space);
}

/// What the baker needs to be asked: a config of the signal, of that behind the group, and of a table's axes where
/// there is a 1-D shaper.
OCIO::ConstConfigRcPtr configOf(const OCIO::ConstGroupTransformRcPtr& group,
                                const OCIO::ConstTransformRcPtr& shaperCurve) {
  auto config = OCIO::Config::CreateRaw()->createEditableCopy();
  addSpace(*config, kInput, nullptr);
  addSpace(*config, kOutput, group);
  if (shaperCurve) {
    addSpace(*config, kAxes, shaperCurve);
  }
  return config;
}

std::string commentLines(const LutDescription& description) {
  std::string text = "# " + description.name + "\n";
  for (const auto& line : description.lines) {
    text += "# " + line + "\n";
  }
  return text;
}

/// Where "#" lines may stand: at the front, or behind a header that must come first.
std::string withComments(std::string text, const std::string& formatName, const LutDescription& description) {
  if (formatName == "flame" || formatName == "iridas_itx") {
    return commentLines(description) + text;
  }
  const std::string last = formatName == "truelight" ? "# width" : formatName == "lustre" ? "Mesh" : "";
  const std::size_t at = last.empty() ? std::string::npos : text.find(last);
  if (at != std::string::npos) {
    text.insert(text.find('\n', at) + 1, commentLines(description));
  }
  return text;
}

}  // namespace

std::string bakerText(const std::string& formatName, const OCIO::ConstGroupTransformRcPtr& group,
                      const OCIO::ConstLut1DTransformRcPtr& shaperCurve, int size, int shaperSize,
                      const LutDescription& description) {
  std::ostringstream text;
  try {
    auto baker = OCIO::Baker::Create();
    baker->setConfig(configOf(group, shaperCurve));
    baker->setFormat(formatName.c_str());
    baker->setInputSpace(kInput);
    baker->setTargetSpace(kOutput);
    if (size > 0) {
      baker->setCubeSize(size);
    }
    if (shaperCurve) {
      baker->setShaperSpace(kAxes);
      baker->setShaperSize(static_cast<int>(shaperCurve->getLength()));
    } else if (shaperSize > 0) {
      baker->setShaperSize(shaperSize);
    }
    // Cinespace alone has a place for metadata.
    baker->getFormatMetadata().addChildElement(OCIO::METADATA_DESCRIPTION, description.name.c_str());
    for (const auto& line : description.lines) {
      baker->getFormatMetadata().addChildElement(OCIO::METADATA_DESCRIPTION, line.c_str());
    }
    baker->bake(text);
  } catch (const OCIO::Exception& error) {
    throw spectral::InputError("", "format", formatName, std::string("cannot hold this transform: ") + error.what());
  }
  return withComments(std::move(text).str(), formatName, description);
}

}  // namespace metamer::ocio
