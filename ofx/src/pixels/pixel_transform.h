// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "pixels/device_form.h"

namespace metamer::ofx {

/// What a render is for. A draft is seen while a slider is drawn, and rendered again.
enum class RenderQuality { Final, Draft };

/// What an effect does to a pixel, ready to run. Immutable once prepared; shared between instances, frames, threads.
class PixelTransform {
 public:
  virtual ~PixelTransform() = default;

  /// Builds what apply() needs, where that takes time. Called before apply(), once by each render on its own object.
  virtual void prepare(RenderQuality /*quality*/) const {}

  /// Float RGBA, from `source` to `destination`, equal in length; the two are the same memory or do not overlap. Alpha
  /// is copied. A pixel with a colour component that is not finite is copied. The result of a pixel depends on nothing
  /// but the pixel.
  virtual void apply(std::span<const float> source, std::span<float> destination) const = 0;

  /// Nothing would change: hosts may skip the effect.
  virtual bool isIdentity() const = 0;

  /// Whether T(k c) = k T(c) for k > 0: premultiplied pixels may then be given as they are.
  virtual bool isHomogeneous() const = 0;

  /// What a device runs in the place of apply(), once that is prepared; its tables live as long as the transform. Empty
  /// where no kernel gives its bits.
  virtual std::optional<DeviceForm> deviceForm() const { return std::nullopt; }
};

}  // namespace metamer::ofx
