// SPDX-License-Identifier: Apache-2.0
// The plug-in on a CUDA card: whether it draws the processor's bits, and how long a frame takes beside the processor's
// two threads and beside a copy of the frame on the card. Needs NVIDIA's driver and nothing else: the plug-in brings
// PTX along.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "cuda_card_host.h"
#include "frame.h"

namespace {

using namespace bare_host;
using Settings = std::map<std::string, Properties::Value>;

constexpr int kCardFrames = 50;
constexpr int kProcessorFrames = 3;

struct Look {
  const char* name;
  Settings settings;
};

const std::vector<Look> kLooks = {
    {"D65 to HP1", {{"outputIlluminant", "HP1"}}},
    {"FL11 to D65", {{"inputIlluminant", "FL11"}, {"outputIlluminant", "D65"}}},
    {"D65 to LED-RGB1, adapted", {{"outputIlluminant", "LED-RGB1"}, {"adaptation", 1.0}}},
    {"A to D65, half mixed", {{"inputIlluminant", "A"}, {"outputIlluminant", "D65"}, {"mix", 0.5}}},
};

/// Repeatable numbers in 0 ... 1, by place (the finaliser of SplitMix64).
double number(std::uint64_t place) {
  place += 0x9E3779B97F4A7C15U;
  place = (place ^ (place >> 30U)) * 0xBF58476D1CE4E5B9U;
  place = (place ^ (place >> 27U)) * 0x94D049BB133111EBU;
  return static_cast<double>((place ^ (place >> 31U)) >> 11U) * 0x1p-53;
}

/// Colours of any exposure over 40 stops, some negative; one of 64 holds what no picture should.
Frame::Rgba anyPixel(int x, int y) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kOddities[] = {kInfinity,
                                 -kInfinity,
                                 std::numeric_limits<float>::quiet_NaN(),
                                 std::numeric_limits<float>::denorm_min(),
                                 -0.0F,
                                 0.0F,
                                 65504.0F,
                                 3e38F};
  const std::uint64_t place = (static_cast<std::uint64_t>(y) << 32U) + static_cast<std::uint64_t>(x) * 8U;
  const double stops = 40 * number(place) - 20;
  Frame::Rgba pixel{};
  for (std::size_t c = 0; c < 3; ++c) {
    pixel[c] = static_cast<float>(std::exp2(stops) * (1.2 * number(place + 1 + c) - 0.1));
  }
  pixel[3] = static_cast<float>(number(place + 4));
  if (number(place + 5) < 1.0 / 64) {
    pixel[static_cast<std::size_t>(3 * number(place + 6))] = kOddities[static_cast<std::size_t>(8 * number(place + 7))];
  }
  return pixel;
}

double seconds(const std::chrono::steady_clock::time_point& since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void require(OfxStatus status, const Instance& effect) {
  if (status != kOfxStatOK) {
    throw std::runtime_error("a render answers " + std::to_string(status) + ": " + effect.message());
  }
}

class Card {
 public:
  explicit Card(const OfxRectI& window) : m_window(window), m_source({.bounds = window}), m_output({.bounds = window}) {
    m_source.fill(anyPixel);
  }

  /// Bytes that a frame of four floats a pixel has.
  std::size_t frameBytes() const {
    return static_cast<std::size_t>(m_window.x2) * static_cast<std::size_t>(m_window.y2) * 4 * sizeof(float);
  }

  double copySeconds() const {
    const DeviceFrame from(m_card, m_source);
    const DeviceFrame to(m_card, m_output);
    m_card.copy(to.image().data, from.image().data, frameBytes());
    m_card.wait();
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < kCardFrames; ++k) {
      m_card.copy(to.image().data, from.image().data, frameBytes());
    }
    m_card.wait();
    return seconds(begin) / kCardFrames;
  }

  /// Whether the card draws the processor's bits; prints both times.
  bool draw(const Look& look, double copySeconds) {
    const Host host(builtLibrary(), {.threads = 2, .device = "Cuda"});
    const auto effect = host.create(0, look.settings);
    Frame expected({.bounds = m_window});
    effect->connect("Source", m_source.image());
    effect->connect("Output", expected.image());
    require(effect->render(m_window), *effect);  // its map is made here
    std::vector<double> times;
    for (int k = 0; k < kProcessorFrames; ++k) {
      const auto begin = std::chrono::steady_clock::now();
      require(effect->render(m_window), *effect);
      times.push_back(seconds(begin));
    }
    const double processor = median(times);

    const DeviceFrame source(m_card, m_source);
    const DeviceFrame output(m_card, m_output);
    effect->connect("Source", source.image());
    effect->connect("Output", output.image());
    effect->useDevice("Cuda", m_card.queue(0));
    require(effect->render(m_window), *effect);  // its tables are uploaded here
    m_card.wait();
    const auto begin = std::chrono::steady_clock::now();
    for (int k = 0; k < kCardFrames; ++k) {
      require(effect->render(m_window), *effect);
    }
    m_card.wait();
    const double card = seconds(begin) / kCardFrames;

    const bool isGuarded = output.bring();
    const bool areEqual = isGuarded && std::memcmp(m_output.image().data, expected.image().data, frameBytes()) == 0;
    std::printf(
        "%s: bits %s; card %.3f ms, processor's two threads %.1f ms (%.1f times), a copy %.3f ms (%.2f times)\n",
        look.name,
        areEqual    ? "equal"
        : isGuarded ? "DIFFER"
                    : "BEYOND THE IMAGE",
        card * 1e3, processor * 1e3, processor / card, copySeconds * 1e3, card / copySeconds);
    return areEqual;
  }

  const std::string& name() const { return m_card.cardName(); }

 private:
  const CudaCardHost m_card;
  OfxRectI m_window;
  Frame m_source;
  Frame m_output;
};

}  // namespace

int main(int count, char** arguments) {
  const int width = count == 3 ? std::atoi(arguments[1]) : 3840;
  const int height = count == 3 ? std::atoi(arguments[2]) : 2160;
  if ((count != 1 && count != 3) || width < 1 || height < 1) {
    std::fprintf(stderr, "usage: metamer_cuda_card [WIDTH HEIGHT]    (3840 2160)\n");
    return 2;
  }
  try {
    Card card({0, 0, width, height});
    std::printf("%s, %d x %d, RGBA float\n", card.name().c_str(), width, height);
    const double copy = card.copySeconds();
    bool areEqual = true;
    for (const Look& look : kLooks) {
      areEqual = card.draw(look, copy) && areEqual;
    }
    return areEqual ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "metamer_cuda_card: %s\n", error.what());
    return 2;
  }
}
