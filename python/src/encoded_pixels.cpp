// SPDX-License-Identifier: Apache-2.0
#include "encoded_pixels.h"

#include <algorithm>

namespace metamer::python {

PixelFunction onEncoded(const PixelFunction& linear, std::optional<spectral::LogEncoding> encoding) {
  if (!encoding) {
    return linear;
  }
  const auto curve = [code = *encoding](std::span<float> rgba, auto&& numberOf) {
    for (std::size_t i = 0; i < rgba.size(); ++i) {
      if (i % 4 != 3) {
        rgba[i] = static_cast<float>(numberOf(code, rgba[i]));
      }
    }
  };
  return {[=](std::span<const float> source, std::span<float> destination) {
            if (source.data() != destination.data()) {
              std::copy(source.begin(), source.end(), destination.begin());
            }
            curve(destination, spectral::decode);
            linear.rgba(destination, destination);
            curve(destination, spectral::encode);
          },
          [code = *encoding, onLight = linear.colours](std::span<Eigen::Vector3d> colours) {
            for (Eigen::Vector3d& colour : colours) {
              colour = colour.unaryExpr([code](double value) { return spectral::decode(code, value); }).eval();
            }
            onLight(colours);
            for (Eigen::Vector3d& colour : colours) {
              colour = colour.unaryExpr([code](double value) { return spectral::encode(code, value); }).eval();
            }
          }};
}

}  // namespace metamer::python
