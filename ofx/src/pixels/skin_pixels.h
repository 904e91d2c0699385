// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "metamer/skin/skin_look.h"
#include "metamer/spectral/log_encoding.h"
#include "pixels/pixel_transform.h"
#include "pixels/signal_table.h"
#include "pixels/spectral_pixels.h"

namespace metamer::ofx {

/// A look of skin on the pixels of a colour space: by a table over chromaticity, or each pixel by the estimator.
class SkinPixels final : public PixelTransform {
 public:
  /// Cells of the table between two of the estimator's knots, whose kinks lie on the table's own.
  static constexpr int kCellsAKnot = 4;

  /// @param encoding  of the pixels; none: they are linear
  /// @param table     of that encoding, for Quality::Map; may be null otherwise
  SkinPixels(skin::SkinLook look, std::optional<spectral::LogEncoding> encoding,
             std::shared_ptr<const SignalTable> table, Quality quality);

  void apply(std::span<const float> source, std::span<float> destination) const override;
  bool isIdentity() const override { return m_look.isIdentity(); }
  bool isHomogeneous() const override { return !m_encoding; }
  std::optional<DeviceForm> deviceForm() const override;

 private:
  using Change = std::array<float, 4>;
  static constexpr std::size_t kTogether = 64;
  /// Where pixels lie in the table.
  struct Places {
    std::array<float, kTogether> mean;   ///< not above 0: the pixel stays
    std::array<float, kTogether> first;  ///< share of the next knot along each chromaticity
    std::array<float, kTogether> second;
    std::array<int, kTogether> knot;
  };

  void applyLinear(std::span<const float> source, std::span<float> destination) const;
  void applyMap(std::span<const float> source, std::span<float> destination) const;
  void findPlaces(const float* rgba, std::size_t count, Places& places) const;
  sip::DeviceTables deviceTables() const;

  skin::SkinLook m_look;
  std::optional<spectral::LogEncoding> m_encoding;
  std::shared_ptr<const SignalTable> m_table;
  Quality m_quality;
  int m_cells;                    ///< along each chromaticity
  std::vector<Change> m_changes;  ///< of a colour of mean one, by knot; the fourth is nothing
  ResidentTables m_resident{[this] { return deviceTables(); }};
};

}  // namespace metamer::ofx
