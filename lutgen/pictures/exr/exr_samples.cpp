// SPDX-License-Identifier: Apache-2.0
#include "exr/exr_samples.h"

#include <Imath/half.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace metamer::lutgen {
namespace {

/// How many multiples of `step` lie in `count` numbers from `first` on.
std::size_t multiples(int first, int count, int step) {
  const auto upTo = [step](std::int64_t end) { return end >= 0 ? end / step : -((-end + step - 1) / step); };
  return static_cast<std::size_t>(upTo(static_cast<std::int64_t>(first) + count - 1) -
                                  upTo(static_cast<std::int64_t>(first) - 1));
}

std::size_t samplesInRow(const ExrChannel& channel, const ExrRectangle& rectangle, int y) {
  if (y % channel.ySampling != 0) {
    return 0;
  }
  return channel.xSampling == 1 ? static_cast<std::size_t>(rectangle.width)
                                : multiples(rectangle.x, rectangle.width, channel.xSampling);
}

constexpr float kLargestHalf = 65504.0F;

Imath::half halfOf(float value) {
  // Infinities stay what they are; finite numbers stay finite.
  return Imath::half(std::isfinite(value) ? std::clamp(value, -kLargestHalf, kLargestHalf) : value);
}

/// As halfOf, of a finite number: bits from bits, without branches, which a compiler makes vectors of.
std::uint16_t halfBits(float value) {
  constexpr std::uint32_t kLeastNormal = 0x38800000;  // 2^-14
  constexpr std::uint32_t kRebias = 0x38000000;       // of the exponents: 127 - 15
  constexpr int kFewerBits = 13;
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t size = std::min(bits & 0x7FFFFFFFU, std::bit_cast<std::uint32_t>(kLargestHalf));
  const std::uint32_t rebiased = size - kRebias;
  const std::uint32_t normal = (rebiased + 0xFFFU + ((rebiased >> kFewerBits) & 1U)) >> kFewerBits;
  // A half's smallest step is the last place of 0.5.
  const std::uint32_t small = std::bit_cast<std::uint32_t>(std::bit_cast<float>(size) + 0.5F) - 0x3F000000U;
  return static_cast<std::uint16_t>((size >= kLeastNormal ? normal : small) | ((bits >> 16U) & 0x8000U));
}

/// Puts some numbers where all are finite. @return whether they are
template <std::size_t count>
bool putHalves(char* bytes, const float* values) {
  constexpr std::uint32_t kInfinite = 0x7F800000;
  std::uint32_t infinite = 0;
  std::array<std::uint16_t, count> halves;
  for (std::size_t k = 0; k < count; ++k) {
    infinite |= static_cast<std::uint32_t>((std::bit_cast<std::uint32_t>(values[k]) & kInfinite) == kInfinite);
    halves[k] = halfBits(values[k]);
  }
  if (infinite != 0) {
    return false;
  }
  std::memcpy(bytes, halves.data(), sizeof halves);
  return true;
}

/// Calls body(k, float) for each sample.
template <typename Body>
void readSamples(const char* bytes, ExrType type, std::size_t count, const Body& body) {
  for (std::size_t k = 0; k < count; ++k) {
    if (type == ExrType::Half) {
      std::uint16_t bits;
      std::memcpy(&bits, bytes + 2 * k, 2);
      body(k, imath_half_to_float(bits));
    } else {
      float value;
      std::memcpy(&value, bytes + 4 * k, 4);
      body(k, value);
    }
  }
}

void writeSample(char* bytes, ExrType type, std::size_t index, float value) {
  if (type == ExrType::Half) {
    const std::uint16_t bits = halfOf(value).bits();
    std::memcpy(bytes + 2 * index, &bits, 2);
  } else {
    std::memcpy(bytes + 4 * index, &value, 4);
  }
}

/// One row: pixels out of their channels, changed, and back.
class Row {
 public:
  explicit Row(int width) : m_rgba(4 * static_cast<std::size_t>(width)), m_isFinite(static_cast<std::size_t>(width)) {}

  /// @param bytes, types  of red, green, blue
  void change(const std::array<const char*, 3>& bytes, const std::array<ExrType, 3>& types,
              const PixelFunction& pixels) {
    std::fill(m_isFinite.begin(), m_isFinite.end(), char{1});
    for (std::size_t c = 0; c < 3; ++c) {
      readSamples(bytes[c], types[c], m_isFinite.size(), [&](std::size_t k, float value) {
        m_rgba[4 * k + c] = value;
        m_isFinite[k] = static_cast<char>(m_isFinite[k] & static_cast<char>(std::isfinite(value)));
      });
    }
    for (std::size_t k = 3; k < m_rgba.size(); k += 4) {
      m_rgba[k] = 1.0F;
    }
    if (pixels) {
      pixels(m_rgba);
    }
  }

  /// Leaves the samples of pixels that were not finite as they are.
  void write(const std::array<char*, 3>& bytes, const std::array<ExrType, 3>& types) const {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < m_isFinite.size(); ++k) {
        if (m_isFinite[k] != 0) {
          writeSample(bytes[c], types[c], k, m_rgba[4 * k + c]);
        }
      }
    }
  }

 private:
  std::vector<float> m_rgba;
  std::vector<char> m_isFinite;
};

}  // namespace

std::size_t exrRowBytes(const std::vector<ExrChannel>& channels, const ExrRectangle& rectangle, int y) {
  std::size_t bytes = 0;
  for (const ExrChannel& channel : channels) {
    bytes += samplesInRow(channel, rectangle, y) * sizeOf(channel.type);
  }
  return bytes;
}

std::size_t exrBytes(const std::vector<ExrChannel>& channels, const ExrRectangle& rectangle) {
  std::size_t bytes = 0;
  for (int y = 0; y < rectangle.height; ++y) {
    bytes += exrRowBytes(channels, rectangle, rectangle.y + y);
  }
  return bytes;
}

void putSamples(char* bytes, ExrType type, std::span<const float> values) {
  std::size_t k = 0;
  if (type == ExrType::Half) {
    constexpr std::size_t kTogether = 64;
    for (; k + kTogether <= values.size() && putHalves<kTogether>(bytes + 2 * k, &values[k]); k += kTogether) {
    }
  }
  for (; k < values.size(); ++k) {
    writeSample(bytes, type, k, values[k]);
  }
}

std::string changedSamples(std::string samples, const ExrRectangle& rectangle, const std::vector<ExrChannel>& before,
                           const std::vector<ExrChannel>& after, const std::vector<ExrColours>& colours,
                           const PixelFunction& pixels) {
  const bool keepsTypes = std::equal(before.begin(), before.end(), after.begin(),
                                     [](const ExrChannel& a, const ExrChannel& b) { return a.type == b.type; });
  std::string other;
  if (!keepsTypes) {
    other.resize(exrBytes(after, rectangle));
  }
  const char* in = samples.data();
  char* out = keepsTypes ? samples.data() : other.data();
  std::vector<std::size_t> inAt(before.size());
  std::vector<std::size_t> outAt(after.size());
  Row row(rectangle.width);
  std::size_t inRow = 0;
  std::size_t outRow = 0;
  for (int y = rectangle.y; y < rectangle.y + rectangle.height; ++y) {
    for (std::size_t c = 0; c < before.size(); ++c) {
      const std::size_t count = samplesInRow(before[c], rectangle, y);
      inAt[c] = inRow;
      outAt[c] = outRow;
      if (before[c].type != after[c].type) {
        readSamples(in + inRow, before[c].type, count,
                    [&](std::size_t k, float value) { writeSample(out + outRow, after[c].type, k, value); });
      } else if (!keepsTypes) {
        std::memcpy(out + outRow, in + inRow, count * sizeOf(before[c].type));
      }
      inRow += count * sizeOf(before[c].type);
      outRow += count * sizeOf(after[c].type);
    }
    for (const ExrColours& colour : colours) {
      std::array<const char*, 3> from{};
      std::array<char*, 3> to{};
      std::array<ExrType, 3> fromTypes{};
      std::array<ExrType, 3> toTypes{};
      for (std::size_t c = 0; c < 3; ++c) {
        const auto channel = static_cast<std::size_t>(colour.channels[c]);
        from[c] = in + inAt[channel];
        to[c] = out + outAt[channel];
        fromTypes[c] = before[channel].type;
        toTypes[c] = after[channel].type;
      }
      row.change(from, fromTypes, pixels);
      row.write(to, toTypes);
    }
  }
  return keepsTypes ? samples : other;
}

}  // namespace metamer::lutgen
