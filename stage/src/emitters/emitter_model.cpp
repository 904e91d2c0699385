// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/emitter_model.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::stage {
namespace {

using spectral::InputError;
using spectral::Spectrum;

constexpr int kFirstNm = 360;
constexpr int kLastNm = 830;
constexpr double kSmallestWidthNm = 1;
constexpr double kLargestWidthNm = 300;
constexpr double kLargestPumpShare = 100;

double ohno(double wavelengthNm, double peakNm, double widthNm) {
  const double g = std::exp(-std::pow((wavelengthNm - peakNm) / widthNm, 2));
  return (g + 2 * std::pow(g, 5)) / 3;
}

void check(const std::string& name, const char* field, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw InputError(
        name, field, std::to_string(value),
        "must be from " + std::to_string(static_cast<int>(low)) + " to " + std::to_string(static_cast<int>(high)));
  }
}

template <typename Shape>
Spectrum sampled(const std::string& name, const Shape& shape) {
  std::vector<double> wavelengthsNm;
  std::vector<double> values;
  for (int nm = kFirstNm; nm <= kLastNm; ++nm) {
    wavelengthsNm.push_back(nm);
    values.push_back(shape(static_cast<double>(nm)));
  }
  return Spectrum(name, spectral::SpectralQuantity::SpectralPowerDistribution, std::move(wavelengthsNm),
                  std::move(values))
      .ofFormula();
}

/// The numbers behind the first colon of "led:620:18".
std::vector<double> parametersOf(const std::string& text, std::size_t count, const std::string& form) {
  std::vector<double> values;
  std::size_t at = text.find(':');
  while (at != std::string::npos) {
    const std::size_t end = std::min(text.find(':', at + 1), text.size());
    double value = 0;
    const auto parsed = std::from_chars(text.data() + at + 1, text.data() + end, value);
    if (parsed.ec != std::errc() || parsed.ptr != text.data() + end) {
      throw InputError("", "emitter", text, "must be " + form);
    }
    values.push_back(value);
    at = end < text.size() ? end : std::string::npos;
  }
  if (values.size() != count) {
    throw InputError("", "emitter", text, "must be " + form);
  }
  return values;
}

}  // namespace

Spectrum ledModel(double peakNm, double widthNm) {
  const std::string name = "led:" + spectral::shortestNumber(peakNm) + ":" + spectral::shortestNumber(widthNm);
  check(name, "peak", peakNm, kFirstNm, kLastNm);
  check(name, "width", widthNm, kSmallestWidthNm, kLargestWidthNm);
  return sampled(name, [&](double nm) { return ohno(nm, peakNm, widthNm); });
}

Spectrum phosphorModel(double pumpNm, double pumpWidthNm, double peakNm, double widthNm, double pumpShare) {
  const std::string name = "phosphor:" + spectral::shortestNumber(pumpNm) + ":" +
                           spectral::shortestNumber(pumpWidthNm) + ":" + spectral::shortestNumber(peakNm) + ":" +
                           spectral::shortestNumber(widthNm) + ":" + spectral::shortestNumber(pumpShare);
  check(name, "pump", pumpNm, kFirstNm, kLastNm);
  check(name, "pump width", pumpWidthNm, kSmallestWidthNm, kLargestWidthNm);
  check(name, "peak", peakNm, kFirstNm, kLastNm);
  check(name, "width", widthNm, kSmallestWidthNm, kLargestWidthNm);
  check(name, "pump share", pumpShare, 0, kLargestPumpShare);
  return sampled(name, [&](double nm) {
    const double phosphor = std::exp(-4 * std::numbers::ln2 * std::pow((nm - peakNm) / widthNm, 2));
    return pumpShare * ohno(nm, pumpNm, pumpWidthNm) + phosphor;
  });
}

std::optional<Emitter> emitterFromModel(const std::string& text) {
  if (text.rfind("led:", 0) == 0) {
    const auto p = parametersOf(text, 2, "led:PEAK:WIDTH in nm, such as led:620:18");
    return Emitter{ledModel(p[0], p[1]), true};
  }
  if (text.rfind("phosphor:", 0) == 0) {
    const auto p = parametersOf(
        text, 5, "phosphor:PUMP:PUMP_WIDTH:PEAK:WIDTH:PUMP_SHARE in nm, such as phosphor:450:20:560:120:0.8");
    return Emitter{phosphorModel(p[0], p[1], p[2], p[3], p[4]), true};
  }
  return std::nullopt;
}

std::vector<Emitter> emittersFrom(const std::string& text, const spectral::DataLibrary& library,
                                  const std::filesystem::path& folder) {
  if (auto model = emitterFromModel(text)) {
    return {*std::move(model)};
  }
  if (!spectral::hasSpectralExtension(spectral::pathOf(text))) {
    return {{library.illuminant(text, folder), false}};
  }
  const std::filesystem::path file = spectral::pathOf(text);
  std::vector<Emitter> emitters;
  for (Spectrum& spectrum :
       spectral::readSpectralFile(file.is_absolute() ? file : folder / file,
                                  spectral::SpectralQuantity::SpectralPowerDistribution, library.pictures())) {
    emitters.push_back({std::move(spectrum), false});
  }
  return emitters;
}

}  // namespace metamer::stage
