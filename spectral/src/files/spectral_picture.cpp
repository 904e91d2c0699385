// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/spectral_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "files/sampled_rows.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr double kLightSpeed = 299792458.0;  // m/s
constexpr double kNmPerMetre = 1e9;

const char* prefixOf(SpectralQuantity quantity) {
  return quantity == SpectralQuantity::SpectralPowerDistribution ? "S0" : "T";
}

/// Power of ten of an SI prefix in front of a unit.
std::optional<double> prefixPower(const std::string& prefix) {
  constexpr std::array<std::pair<const char*, int>, 9> kPrefixes = {
      {{"", 0}, {"m", -3}, {"u", -6}, {"\xc2\xb5", -6}, {"n", -9}, {"p", -12}, {"k", 3}, {"G", 9}, {"T", 12}}};
  const auto* const found =
      std::find_if(kPrefixes.begin(), kPrefixes.end(), [&](const auto& one) { return prefix == one.first; });
  if (prefix == "M") {
    return 1e6;
  }
  return found == kPrefixes.end() ? std::nullopt : std::optional(std::pow(10.0, found->second));
}

std::optional<PicturePlace> placeOf(const std::string& text, const std::string& file) {
  if (text.empty()) {
    return std::nullopt;
  }
  const std::size_t comma = text.find(',');
  const auto x = parseNumber(trimmed(text.substr(0, comma)));
  const auto y = comma == std::string::npos ? std::nullopt : parseNumber(trimmed(text.substr(comma + 1)));
  constexpr double kMost = 1e6;
  for (const auto& one : {x, y}) {
    if (!one || std::floor(*one) != *one || std::abs(*one) > kMost) {
      throw InputError(file, "pixel", text,
                       "must be two whole numbers, FILE:x,y; without them it is the picture's mean");
    }
  }
  return PicturePlace{static_cast<int>(*x), static_cast<int>(*y)};
}

}  // namespace

std::optional<double> channelWavelengthNm(const std::string& channel, SpectralQuantity quantity) {
  const std::string prefix = prefixOf(quantity);
  std::size_t at = channel.rfind(prefix + ".");
  if (at == std::string::npos || (at > 0 && channel[at - 1] != '.')) {
    return std::nullopt;
  }
  at += prefix.size() + 1;
  const std::size_t end = std::min(channel.find_first_not_of("0123456789,.", at), channel.size());
  std::string number = channel.substr(at, end - at);
  std::replace(number.begin(), number.end(), ',', '.');
  const auto value = parseNumber(number);
  const std::string unit = channel.substr(end);
  if (!value || !(*value > 0.0)) {
    return std::nullopt;
  }
  for (const char* base : {"Hz", "m"}) {
    const std::size_t size = std::string(base).size();
    if (unit.size() < size || unit.substr(unit.size() - size) != base) {
      continue;
    }
    if (const auto power = prefixPower(unit.substr(0, unit.size() - size))) {
      return kNmPerMetre * (*base == 'H' ? kLightSpeed / (*value * *power) : *value * *power);
    }
  }
  return std::nullopt;
}

std::string channelOfWavelength(double nm, SpectralQuantity quantity) {
  std::string number = formatted("%.6f", nm);
  std::replace(number.begin(), number.end(), '.', ',');
  return std::string(prefixOf(quantity)) + "." + number + "nm";
}

std::vector<ChannelValue> readPictureChannels(const std::string& file, const std::string& place,
                                              const std::function<bool(const std::string& channel)>& isWanted,
                                              const PictureChannelReader& pictures) {
  if (!pictures) {
    throw InputError(file, "extension", ".exr",
                     "pictures are read by the programs lutgen and spectral_ref alone; give the spectrum as CSV here");
  }
  return pictures(file, placeOf(place, file), isWanted);
}

std::vector<Spectrum> readSpectralPicture(const std::string& file, const std::string& place, SpectralQuantity quantity,
                                          const PictureChannelReader& pictures) {
  if (quantity == SpectralQuantity::Sensitivity) {
    throw InputError(file, "quantity", "sensitivity", "is not what a picture holds; give a table");
  }
  const std::vector<ChannelValue> channels = readPictureChannels(
      file, place, [&](const std::string& channel) { return channelWavelengthNm(channel, quantity).has_value(); },
      pictures);
  if (channels.size() < 2) {
    const std::string prefix = prefixOf(quantity);
    throw InputError(file, "channels", "",
                     "are not spectral: a " + quantityName(quantity) + " has two or more named as '" + prefix +
                         ".550,000000nm' (JCGT 2021); give such a picture, or a table");
  }
  SampledRows rows;
  rows.where = file;
  rows.names = {stemOf(file)};
  std::vector<std::pair<double, double>> samples;
  samples.reserve(channels.size());
  for (const ChannelValue& channel : channels) {
    samples.emplace_back(*channelWavelengthNm(channel.name, quantity), channel.value);
  }
  std::sort(samples.begin(), samples.end());
  rows.columns.resize(1);
  for (const auto& [nm, value] : samples) {
    rows.wavelengthsNm.push_back(nm);
    rows.columns[0].push_back(value);
  }
  rows.rowWhere = [file, samples](std::size_t row) { return file + ": " + numberText(samples[row].first) + " nm"; };
  return spectraFromRows(std::move(rows), quantity, StatedScale::Unity);
}

}  // namespace metamer::spectral
