// SPDX-License-Identifier: Apache-2.0
#include "report/film_view.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "metamer/ocio/pixel_processor.h"
#include "metamer/spectral/input_error.h"

namespace metamer::lutgen {
namespace {

namespace OCIO = OCIO_NAMESPACE;

/// Name and style, the newest first.
constexpr std::array<std::pair<const char*, const char*>, 2> kStyles{
    {{"ACES 2.0", "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-100nit-REC709_2.0"},
     {"ACES 1.0", "ACES-OUTPUT - ACES2065-1_to_CIE-XYZ-D65 - SDR-VIDEO_1.0"}}};
constexpr const char* kScreen = "DISPLAY - CIE-XYZ-D65_to_sRGB";

bool has(const char* style) {
  const auto registry = OCIO::BuiltinTransformRegistry::Get();
  for (std::size_t k = 0; k < registry->getNumBuiltins(); ++k) {
    if (std::strcmp(registry->getBuiltinStyle(k), style) == 0) {
      return true;
    }
  }
  return false;
}

ocio::PixelProcessor processorOf(const char* style, OCIO::TransformDirection direction) {
  auto group = OCIO::GroupTransform::Create();
  for (const char* each : {style, kScreen}) {
    auto step = OCIO::BuiltinTransform::Create();
    step->setStyle(each);
    group->appendTransform(step);
  }
  group->setDirection(direction);
  return ocio::PixelProcessor(group);
}

/// What is no number, and what the transform makes of odd colours, is 0 ... 1.
void clip(std::span<float> rgba, float highest) {
  for (float& value : rgba) {
    value = std::isnan(value) ? 0.0F : std::clamp(value, 0.0F, highest);
  }
}

}  // namespace

FilmView::FilmView(const spectral::RgbSpace& space, const spectral::RgbSpace& aces) {
  const auto* found = std::find_if(kStyles.begin(), kStyles.end(), [](const auto& each) { return has(each.second); });
  if (found == kStyles.end()) {
    throw spectral::InputError("OpenColorIO", "view", kStyles[0].first, "is not in this release; link 2.1 or newer");
  }
  m_name = found->first;
  const auto show = processorOf(found->second, OCIO::TRANSFORM_DIR_FORWARD);
  const auto undo = processorOf(found->second, OCIO::TRANSFORM_DIR_INVERSE);
  m_show = inTurn({between(space, aces), [show](std::span<float> rgba) {
                     show.apply(rgba);
                     clip(rgba, 1.0F);
                   }});
  m_undo = inTurn({[undo](std::span<float> rgba) { undo.apply(rgba); }, between(aces, space)});
}

void FilmView::undo(std::span<float> rgba) const {
  clip(rgba, kBrightest);
  m_undo(rgba);
}

}  // namespace metamer::lutgen
