// SPDX-License-Identifier: Apache-2.0
#include "report/film_view.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "metamer/ocio/pixel_processor.h"
#include "metamer/spectral/input_error.h"
#include "report/page_parts.h"

namespace metamer::lutgen {
namespace {

namespace OCIO = OCIO_NAMESPACE;

/// Which transforms of OpenColorIO it is, the newest first: the demo's pictures (demo/pictures.py) read the same file.
nlohmann::json choice() {
  return nlohmann::json::parse(pagePart("film_view.json"));
}

bool has(const std::string& style) {
  const auto registry = OCIO::BuiltinTransformRegistry::Get();
  for (std::size_t k = 0; k < registry->getNumBuiltins(); ++k) {
    if (style == registry->getBuiltinStyle(k)) {
      return true;
    }
  }
  return false;
}

ocio::PixelProcessor processorOf(const std::string& style, const std::string& screen,
                                 OCIO::TransformDirection direction) {
  auto group = OCIO::GroupTransform::Create();
  for (const std::string& each : {style, screen}) {
    auto step = OCIO::BuiltinTransform::Create();
    step->setStyle(each.c_str());
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
  const nlohmann::json chosen = choice();
  const nlohmann::json& styles = chosen.at("styles");
  const auto found = std::find_if(styles.begin(), styles.end(), [](const auto& each) { return has(each.at("style")); });
  if (found == styles.end()) {
    throw spectral::InputError("OpenColorIO", "view", styles.front().at("name").get<std::string>(),
                               "is not in this release; link 2.1 or newer");
  }
  m_name = found->at("name");
  m_brightest = chosen.at("brightest");
  const auto show = processorOf(found->at("style"), chosen.at("screen"), OCIO::TRANSFORM_DIR_FORWARD);
  const auto undo = processorOf(found->at("style"), chosen.at("screen"), OCIO::TRANSFORM_DIR_INVERSE);
  m_show = inTurn({between(space, aces), [show](std::span<float> rgba) {
                     show.apply(rgba);
                     clip(rgba, 1.0F);
                   }});
  m_undo = inTurn({[undo](std::span<float> rgba) { undo.apply(rgba); }, between(aces, space)});
}

void FilmView::undo(std::span<float> rgba) const {
  clip(rgba, m_brightest);
  m_undo(rgba);
}

}  // namespace metamer::lutgen
