// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "metamer/ocio/bake.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/working_space.h"

namespace metamer::ocio {

/// A recipe with all it names looked up and its engine built.
struct Prepared {
  WorkingSpace space;
  sip::TransformSpec spec;
  sip::SpectralTransform transform;
};

/// @throws spectral::InputError: a display's curve for a format whose pixels are linear, which it would end at white
void requireSignal(const LutFormat& format, const BakeOptions& options);

/// Nodes along a side: what was asked for, else what is usual. @throws spectral::InputError out of range
int tableSize(const BakeOptions& options, Representation representation, const LutFormat& format);

/// Whether a format has operators for the exposure-invariant chain.
bool holdsChain(const LutFormat& format);

/// Usual probes as the options want them: more for a full certificate, between other stops.
/// @throws spectral::InputError: stops that do not rise, or are too far away
sip::ErrorProtocol::Options probesWanted(sip::ErrorProtocol::Options probes, const BakeOptions& options);

/// The gamut and exposures that a format is judged over.
/// @throws spectral::InputError: stops that do not rise, a space that a table cannot be made for
sip::ErrorProtocol::Options probesOf(const LutFormat& format, const WorkingSpace& space, const BakeOptions& options);

/// A recipe as operators on what a file of a format holds, and the way there from the engine's pixels.
struct Operators {
  OCIO::GroupTransformRcPtr group;
  OCIO::ConstTransformRcPtr toPixels;
  OCIO::ConstTransformRcPtr fromPixels;
};

/// The operators of a representation. Says in `certificate`, whose probes are set, what they are.
Operators operatorsFor(const Prepared& prepared, const BakeOptions& options, const LutFormat& format,
                       Representation representation, Certificate& certificate);

/// Runs linear pixels of the engine through a transform of pixels of the working space, or of a cube's signal.
class Candidate {
 public:
  /// @param toPixels, fromPixels  null: pixels are the engine's
  Candidate(PixelProcessor processor, const OCIO::ConstTransformRcPtr& toPixels,
            const OCIO::ConstTransformRcPtr& fromPixels)
      : m_processor(std::move(processor)) {
    if (toPixels) {
      m_toPixels.emplace(toPixels);
      m_fromPixels.emplace(fromPixels);
    }
  }
  void operator()(std::span<float> rgba) const {
    if (m_toPixels) {
      m_toPixels->apply(rgba);
    }
    m_processor.apply(rgba);
    if (m_fromPixels) {
      m_fromPixels->apply(rgba);
    }
  }

 private:
  PixelProcessor m_processor;
  std::optional<PixelProcessor> m_toPixels;
  std::optional<PixelProcessor> m_fromPixels;
};

}  // namespace metamer::ocio
