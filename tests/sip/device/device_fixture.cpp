// SPDX-License-Identifier: Apache-2.0
#include "sip/device/device_fixture.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

void add(std::vector<DeviceCase>& cases, const std::string& name, const TransformSpec& spec) {
  HomogeneousMap map = buildHomogeneousMap(SpectralTransform(spec, 81));
  DeviceTables tables = deviceTables(map);
  cases.push_back({name, std::move(map), std::move(tables)});
}

std::vector<DeviceCase> makeCases() {
  std::vector<DeviceCase> cases;
  for (const auto& [inputLight, outputLight] : lightPairs()) {
    add(cases, inputLight + " -> " + outputLight, specOf(inputLight, outputLight));
  }
  for (const auto& [inputLight, outputLight] : {std::pair{"D65", "HP1"}, {"D65", "LED-RGB1"}, {"FL11", "D50"}}) {
    add(cases, std::string(inputLight) + " -> " + outputLight + ", natural", naturalSpecOf(inputLight, outputLight));
  }
  for (const char* const camera : {"Nikon D5100", "ACES RICD"}) {
    TransformSpec spec = specOf("D65", "A");
    spec.input.observer = testLibrary().observer(camera);
    spec.training = samplesOf("rawtoaces 190");
    add(cases, std::string("D65 -> A, ") + camera, spec);
  }
  add(cases, "nothing", specOf("D65", "D65"));
  return cases;
}

}  // namespace

const std::vector<DeviceCase>& deviceCases() {
  static const std::vector<DeviceCase> cases = makeCases();
  return cases;
}

std::vector<float> pixelsOfEveryKind(std::size_t count, unsigned seed) {
  using Limits = std::numeric_limits<float>;
  constexpr std::array kHard = {0.0F,
                                -0.0F,
                                Limits::denorm_min(),
                                -Limits::denorm_min(),
                                1e-40F,
                                -3e-39F,
                                Limits::min(),
                                Limits::max(),
                                -Limits::max(),
                                Limits::infinity(),
                                1e30F,
                                -Limits::infinity(),
                                65504.0F,
                                1e-30F,
                                Limits::quiet_NaN(),
                                1.0F,
                                -1.0F,
                                0.18F};
  std::mt19937 random(seed);
  const auto uniform = [&random] { return static_cast<float>(unitRandom(random)); };
  std::vector<float> pixels;
  pixels.reserve(4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const float exposure = std::exp2(40.0F * uniform() - 20.0F);
    // Colours as of surfaces, of the whole gamut, beyond it, beyond all light.
    const float low = std::array{0.3F, 0.0F, -0.3F, -1.0F}[i % 4];
    for (int k = 0; k < 3; ++k) {
      const bool isHard = i % 16 == 5 && uniform() < 0.6F;
      pixels.push_back(isHard ? kHard[static_cast<std::size_t>(uniform() * kHard.size())]
                              : exposure * (low + (1.0F - low) * uniform()));
    }
    pixels.push_back(uniform());
  }
  return pixels;
}

std::size_t differingBits(std::span<const float> expected, std::span<const float> given, std::string& first) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (std::bit_cast<std::uint32_t>(expected[i]) != std::bit_cast<std::uint32_t>(given[i]) && ++count == 1) {
      first = "float " + std::to_string(i) + ": " + std::to_string(expected[i]) + " became " + std::to_string(given[i]);
    }
  }
  return count;
}

}  // namespace metamer::sip
