// SPDX-License-Identifier: Apache-2.0
#include "cube.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstdio>
#include <functional>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/srgb_curve.h"
#include "metamer/spectral/text.h"

namespace metamer::playground {
namespace {

constexpr const char* kScreen = "sRGB";
constexpr const char* kScreenPrimaries = "Rec.709";
constexpr int kMostNodes = 65;

struct Signal {
  spectral::RgbSpace space;
  std::function<double(double)> encode;
  std::function<double(double)> decode;
};

Signal signalOf(const spectral::DataLibrary& library, const std::string& name) {
  if (name == kScreen) {
    return {library.colourSpace(kScreenPrimaries).linear, spectral::srgbFromLinear, spectral::linearFromSrgb};
  }
  const spectral::ColourSpace space = library.colourSpace(name);
  if (!space.encoding) {
    throw spectral::InputError("cube", "space", name,
                               "has no log curve; take one of " + spectral::joined(cubeSpaces(library)));
  }
  const spectral::LogEncoding curve = *space.encoding;
  return {space.linear, [curve](double linear) { return encode(curve, linear); },
          [curve](double signal) { return decode(curve, signal); }};
}

}  // namespace

std::vector<std::string> cubeSpaces(const spectral::DataLibrary& library) {
  std::vector<std::string> names = {kScreen};
  for (const spectral::ColourSpace& space : library.colourSpaces()) {
    if (space.encoding) {
      names.push_back(space.name);
    }
  }
  return names;
}

std::string cubeText(Session& session, const std::string& space, int size) {
  if (size < 2 || size > kMostNodes) {
    throw spectral::InputError("cube", "size", std::to_string(size), "must be from 2 to 65");
  }
  const Signal signal = signalOf(session.library(), space);
  const sip::SpectralTransform transform = session.transformIn(signal.space);
  std::vector<double> levels;
  for (int node = 0; node < size; ++node) {
    levels.push_back(signal.decode(node / static_cast<double>(size - 1)));
  }
  std::vector<Eigen::Vector3d> nodes;
  for (const double blue : levels) {
    for (const double green : levels) {
      for (const double red : levels) {
        nodes.emplace_back(red, green, blue);
      }
    }
  }
  transform.apply(nodes);
  std::string text = "# metamer: " + session.spec().input.illuminant.name() + " to " +
                     session.spec().output.illuminant.name() + ", " + space + " in and out\nLUT_3D_SIZE " +
                     std::to_string(size) + "\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 1 1\n";
  for (const Eigen::Vector3d& node : nodes) {
    char line[96];
    const int length = std::snprintf(line, sizeof line, "%.7f %.7f %.7f\n", signal.encode(node[0]),
                                     signal.encode(node[1]), signal.encode(node[2]));
    text.append(line, static_cast<std::size_t>(length));
  }
  return text;
}

}  // namespace metamer::playground
