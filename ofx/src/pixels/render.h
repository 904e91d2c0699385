// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "host/host.h"
#include "pixels/image.h"
#include "pixels/pixel_transform.h"

namespace metamer::ofx {

enum class FieldToRender { Whole, Lower, Upper };

/// The rows of a window that are the field's: from the first, which may lie above the window, at this step. Even rows
/// are the lower field's.
int firstRow(FieldToRender field, const OfxRectI& window);
inline int rowStep(FieldToRender field) {
  return field == FieldToRender::Whole ? 1 : 2;
}

/// One render call: what is read, where it goes, how much of it.
struct RenderJob {
  PixelView output;
  PixelView source;  ///< no data: transparent black
  PixelView mask;    ///< no data: everywhere 1
  bool hasMask = false;
  OfxRectI window{};
  FieldToRender field = FieldToRender::Whole;
  Premultiplication premultiplication = Premultiplication::Unpremultiplied;
  double mix = 1.0;                           ///< 0: the source, 1: the result
  const PixelTransform* transform = nullptr;  ///< none: copies the source
};

/// Renders the part of the window that the output holds, on as many threads as the host or the machine grants. The
/// result does not depend on their number, on the window, or on where a row begins.
///
/// Outside the source's bounds pixels are transparent black, outside the mask's the mask is 0. `isAborted` is polled
/// from one thread, before anything else and between rows; what is not yet rendered is then left as it was.
void render(const HostSuites& host, const RenderJob& job, const std::function<bool()>& isAborted);

}  // namespace metamer::ofx
