// SPDX-License-Identifier: Apache-2.0
#include "light_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/correlated_colour_temperature.h"
#include "metamer/spectral/illuminants.h"
#include "metamer/spectral/spectral_integral.h"
#include "metamer/spectral/spectral_similarity_index.h"

namespace metamer::lutgen {
namespace {

using spectral::Spectrum;
using Json = nlohmann::ordered_json;

/// Beyond it a light has no correlated colour temperature: CIE 015:2018, section 9.5.
constexpr double kFarthestDuv = 0.05;
/// Range of the search for it.
constexpr double kLowestKelvin = 1001;
constexpr double kHighestKelvin = 99000;
/// CIE daylight is defined from here to here.
constexpr double kLowestDaylight = 4000;
constexpr double kHighestDaylight = 25000;

struct Temperature {
  double kelvin = 0;
  double duv = 0;
  bool isOne = false;
};

Temperature temperatureOf(const Eigen::Vector3d& xyz, const spectral::Observer& observer) {
  if (!(xyz.y() > 0)) {
    return {};
  }
  const auto found = spectral::correlatedColourTemperature(xyz, observer.onDomain());
  return {found.cctK, found.duv,
          std::abs(found.duv) <= kFarthestDuv && found.cctK > kLowestKelvin && found.cctK < kHighestKelvin};
}

double rounded(double value, double step) {
  return std::round(value / step) * step;
}

/// The SSI to the nearer of the blackbody and the daylight of a temperature, with that reference's name.
void addSimilarity(Json& entry, const Spectrum& light, double kelvin, const spectral::DataLibrary& library) {
  const std::string temperature = std::to_string(std::lround(kelvin)) + " K";
  std::vector<std::string> references{temperature};
  if (kelvin >= kLowestDaylight && kelvin <= kHighestDaylight) {
    references.push_back("daylight " + temperature);
  }
  double best = -1e9;
  for (const std::string& reference : references) {
    const double index = spectral::spectralSimilarityIndex(light, library.illuminant(reference));
    if (index > best) {
      best = index;
      entry["ssi"] = std::max(0.0, index);
      entry["ssi_reference"] = reference;
    }
  }
}

void addLight(Json& entry, const Spectrum& light, const spectral::Observer& observer,
              const spectral::DataLibrary& library) {
  const Temperature temperature = temperatureOf(spectral::response(light, observer), observer);
  if (!temperature.isOne) {
    return;
  }
  entry["cct"] = std::lround(temperature.kelvin);
  entry["duv"] = rounded(temperature.duv, 1e-4);
  addSimilarity(entry, light, temperature.kelvin, library);
}

void addFilter(Json& entry, const Spectrum& filter, const spectral::Observer& observer,
               const spectral::DataLibrary& library) {
  for (const char* const name : {"D65", "A"}) {
    const Spectrum light = library.illuminant(name);
    const spectral::SeenLight seen = spectral::seenLight(light, {{filter, 1.0}}, observer);
    const Eigen::Vector3d xyz = seen.curves.transpose() * seen.light;
    if (name == std::string("D65")) {
      entry["transmission"] = rounded(xyz.y() / spectral::response(light, observer).y(), 1e-3);
    }
    const Temperature temperature = temperatureOf(xyz, observer);
    if (temperature.isOne) {
      entry[std::string("cct_of_") + name] = std::lround(temperature.kelvin);
    }
  }
}

}  // namespace

void addDescription(Json& entry, const std::string& kind, const std::string& name,
                    const spectral::DataLibrary& library) {
  const spectral::NameDescription description = library.description(kind, name);
  entry["description"] = description.text;
  entry["words"] = description.words;
  const spectral::Observer observer = library.observer("CIE 1931 2");
  if (kind == "illuminants") {
    addLight(entry, library.illuminant(name), observer, library);
  } else if (kind == "filters") {
    addFilter(entry, library.filter(name), observer, library);
  }
}

std::string figuresOf(const Json& entry) {
  std::array<char, 120> text{};
  if (entry.contains("cct")) {
    std::snprintf(text.data(), text.size(), "%ld K, Duv %+.4f, SSI %.0f", entry["cct"].get<long>(),
                  entry["duv"].get<double>(), entry["ssi"].get<double>());
    return text.data();
  }
  if (!entry.contains("transmission")) {
    return "-";
  }
  std::snprintf(text.data(), text.size(), "%.0f %%", 100.0 * entry["transmission"].get<double>());
  std::string line = text.data();
  for (const char* const light : {"D65", "A"}) {
    const std::string key = std::string("cct_of_") + light;
    if (entry.contains(key)) {
      line += std::string(", ") + light + " to " + std::to_string(entry[key].get<long>()) + " K";
    }
  }
  return line;
}

}  // namespace metamer::lutgen
