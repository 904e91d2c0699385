// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "effects/shared_cache.h"
#include "metamer/spectral/colour_space.h"
#include "metamer/spectral/log_encoding.h"
#include "pixels/signal_table.h"
#include "pixels/spectral_pixels.h"

namespace metamer::ofx {

/// The tables of log curves that an effect has asked for. Safe for any thread.
class SignalTables {
 public:
  /// @return none where the space is linear or pixels are exact: they need no table
  std::shared_ptr<const SignalTable> get(const spectral::ColourSpace& space, Quality quality) const {
    if (!space.encoding || quality != Quality::Map) {
      return nullptr;
    }
    return m_tables.get(spectral::nameOf(*space.encoding), [&] {
      return SharedCache<SignalTable>::Built{std::make_shared<const SignalTable>(*space.encoding), {}};
    });
  }

 private:
  static constexpr std::size_t kKeptTables = 16;
  mutable SharedCache<SignalTable> m_tables{kKeptTables};
};

}  // namespace metamer::ofx
