// SPDX-License-Identifier: Apache-2.0
// What JavaScript calls. Text is UTF-8 and ends with 0; what comes back stays until the next call. Where a call fails,
// the JSON has "error", a line of words, and nothing else.
#include <emscripten.h>

#include <memory>
#include <string>

#include "cube.h"
#include "findings.h"
#include "picture.h"
#include "session.h"

namespace {

using namespace metamer::playground;
using nlohmann::json;

std::unique_ptr<Session> session;
Picture picture;

/// Runs a body that gives JSON, and keeps its text.
template <typename Body>
const char* answer(Body body) {
  static std::string text;
  json result;
  try {
    result = body();
  } catch (const std::exception& error) {
    result = {{"error", error.what()}};
  }
  text = result.dump(-1, ' ', false, json::error_handler_t::replace);
  return text.c_str();
}

}  // namespace

extern "C" {

/// Begins. JSON: namesOf().
EMSCRIPTEN_KEEPALIVE const char* metamer_open(const char* tables) {
  return answer([&] {
    session = std::make_unique<Session>(tables);
    return namesOf(session->library());
  });
}

/// JSON: empty.
EMSCRIPTEN_KEEPALIVE const char* metamer_set(const char* recipe) {
  return answer([&] {
    session->setRecipe(recipe);
    return json::object();
  });
}

/// JSON: findingsOf().
EMSCRIPTEN_KEEPALIVE const char* metamer_findings() {
  return answer([] { return findingsOf(*session); });
}

/// Room for the sRGB codes (red, green, blue, alpha) of a picture; metamer_decode() takes them over.
EMSCRIPTEN_KEEPALIVE std::uint8_t* metamer_picture(int pixelCount) {
  return picture.room(static_cast<std::size_t>(pixelCount)).data();
}
EMSCRIPTEN_KEEPALIVE void metamer_decode() {
  picture.decode();
}

/// The picture through the recipe, of linear Rec.709; before there is one, what showing it will need. JSON: `at`, where
/// its codes lie, and `solves`.
EMSCRIPTEN_KEEPALIVE const char* metamer_show(double tolerance) {
  return answer([&] {
    const auto& map = session->map(tolerance);
    const auto shown = picture.through(map);
    return json{{"at", reinterpret_cast<std::uintptr_t>(shown.data())}, {"solves", map.statistics.solves}};
  });
}

/// Linear pixels (red, green, blue, alpha) of the recipe's space, in place: through the exact engine, or where a
/// tolerance above 0 is given through the map. JSON: empty.
EMSCRIPTEN_KEEPALIVE const char* metamer_apply(float* rgba, int pixelCount, double tolerance) {
  return answer([&] {
    const std::span<float> pixels(rgba, 4 * static_cast<std::size_t>(pixelCount));
    if (tolerance > 0.0) {
      session->map(tolerance).apply(pixels);
    } else {
      session->transform().apply(pixels);
    }
    return json::object();
  });
}

/// JSON: `text` of a .cube.
EMSCRIPTEN_KEEPALIVE const char* metamer_cube(const char* space, int size) {
  return answer([&] { return json{{"text", cubeText(*session, space, size)}}; });
}

}  // extern "C"
