// SPDX-License-Identifier: Apache-2.0
#include "pixels/skin_pixels.h"

#include <algorithm>
#include <utility>

#include "pixels/encoded_pixels.h"

namespace metamer::ofx {

namespace {

/// Brighter pixels stay: their result might be no number.
constexpr float kBrightest = 1e30F;

}  // namespace

SkinPixels::SkinPixels(skin::SkinLook look, std::optional<spectral::LogEncoding> encoding,
                       std::shared_ptr<const SignalTable> table, Quality quality)
    : m_look(std::move(look)),
      m_encoding(encoding),
      m_table(std::move(table)),
      m_quality(quality),
      m_cells(kCellsAKnot * (m_look.chromaticities().knots - 1)) {
  if (m_quality != Quality::Map || m_look.isIdentity()) {
    return;
  }
  const skin::SkinChromaticities& range = m_look.chromaticities();
  const Eigen::Array2d step = (range.high - range.low) / m_cells;
  m_changes.reserve(static_cast<std::size_t>((m_cells + 1) * (m_cells + 1)));
  for (int i = 0; i <= m_cells; ++i) {
    for (int j = 0; j <= m_cells; ++j) {
      const Eigen::Vector3f change = m_look.change(range.low + Eigen::Array2d(i, j) * step);
      m_changes.push_back({change[0], change[1], change[2], 0});
    }
  }
}

void SkinPixels::apply(std::span<const float> source, std::span<float> destination) const {
  if (!m_encoding) {
    applyLinear(source, destination);
    return;
  }
  throughEncoding(*m_encoding, m_quality == Quality::Map ? m_table.get() : nullptr, source, destination,
                  [this](std::span<const float> from, std::span<float> to) { applyLinear(from, to); });
}

void SkinPixels::applyLinear(std::span<const float> source, std::span<float> destination) const {
  if (m_quality == Quality::Map && !m_look.isIdentity()) {
    applyMap(source, destination);
    return;
  }
  for (std::size_t i = 0; i < source.size(); i += 4) {
    const Eigen::Vector3f result = m_look.apply(Eigen::Vector3f(source[i], source[i + 1], source[i + 2]));
    destination[i + 3] = source[i + 3];
    std::copy_n(result.data(), 3, &destination[i]);
  }
}

void SkinPixels::applyMap(std::span<const float> source, std::span<float> destination) const {
  using Lanes = Eigen::Array4f;
  Places places;
  for (std::size_t begin = 0; begin < source.size(); begin += 4 * kTogether) {
    const std::size_t count = std::min(kTogether, (source.size() - begin) / 4);
    findPlaces(&source[begin], count, places);
    for (std::size_t k = 0; k < count; ++k) {
      const float* const from = &source[begin + 4 * k];
      float* const to = &destination[begin + 4 * k];
      const float alpha = from[3];
      Lanes result = Lanes::Map(from);
      if (places.mean[k] > 0) {
        const Change* const near = &m_changes[static_cast<std::size_t>(places.knot[k])];
        const Change* const far = near + m_cells + 1;
        const auto lanes = [](const Change& change) { return Lanes::Map(change.data()); };
        const Lanes first = lanes(near[0]) + places.second[k] * (lanes(near[1]) - lanes(near[0]));
        const Lanes second = lanes(far[0]) + places.second[k] * (lanes(far[1]) - lanes(far[0]));
        result += places.mean[k] * (first + places.first[k] * (second - first));
      }
      Lanes::Map(to) = result;
      to[3] = alpha;
    }
  }
}

/// Plain loops over arrays, which compilers make vectors of.
void SkinPixels::findPlaces(const float* rgba, std::size_t count, Places& places) const {
  const skin::SkinChromaticities& range = m_look.chromaticities();
  const Eigen::Array2f low = range.low.cast<float>();
  const Eigen::Array2f scale = (m_cells / (range.high - range.low)).cast<float>();
  const auto most = static_cast<float>(m_cells);
  const float last = most - 1;
  const int row = m_cells + 1;
  // Between 0 and the table's end; what is no number is 0.
  const auto along = [most](float at) {
    const float least = at > 0 ? at : 0;
    return least < most ? least : most;
  };
  std::array<float, 4 * kTogether> pixels;
  std::copy_n(rgba, 4 * count, pixels.begin());
  std::fill(pixels.begin() + static_cast<std::ptrdiff_t>(4 * count), pixels.end(), 0.0F);
  for (std::size_t k = 0; k < kTogether; ++k) {
    const float red = pixels[4 * k];
    const float green = pixels[4 * k + 1];
    const float blue = pixels[4 * k + 2];
    const float mean = (red + green + blue) * (1.0F / 3.0F);
    const float inverse = 1 / mean;
    const float x = along(((red - green) * inverse - low[0]) * scale[0]);
    const float y = along(((blue - green) * inverse - low[1]) * scale[1]);
    const int i = static_cast<int>(x < last ? x : last);
    const int j = static_cast<int>(y < last ? y : last);
    places.first[k] = x - static_cast<float>(i);
    places.second[k] = y - static_cast<float>(j);
    places.knot[k] = i * row + j;
    // Written so that NaN, infinities and what may become one have none.
    places.mean[k] = mean <= kBrightest ? mean : 0;
  }
}

std::optional<DeviceForm> SkinPixels::deviceForm() const {
  if (m_changes.empty()) {
    return std::nullopt;
  }
  return DeviceForm{DeviceForm::Kernel::Skin, &m_resident, m_encoding ? &m_table->resident() : nullptr};
}

sip::DeviceTables SkinPixels::deviceTables() const {
  const skin::SkinChromaticities& range = m_look.chromaticities();
  const Eigen::Array2f low = range.low.cast<float>();
  const Eigen::Array2f scale = (m_cells / (range.high - range.low)).cast<float>();
  sip::DeviceTables tables;
  tables.nodes.push_back({low[0], low[1], scale[0], scale[1]});
  tables.nodes.insert(tables.nodes.end(), m_changes.begin(), m_changes.end());
  tables.cells = {static_cast<std::uint32_t>(m_cells)};
  return tables;
}

}  // namespace metamer::ofx
