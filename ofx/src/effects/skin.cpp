// SPDX-License-Identifier: Apache-2.0
#include "effects/skin.h"

#include "effects/shared_cache.h"
#include "effects/signal_tables.h"
#include "host/parameter_makers.h"
#include "metamer/skin/skin_look.h"
#include "metamer/spectral/text.h"
#include "pixels/affine_pixels.h"
#include "pixels/skin_pixels.h"

namespace metamer::ofx {
namespace {

constexpr const char* kMapQuality = "Map";
constexpr const char* kExactQuality = "Exact";
constexpr const char* kObserver = "CIE 1931 2";
/// Estimators take a second and a third of a megabyte, looks some milliseconds and 0.15.
constexpr std::size_t kKeptEstimators = 8;
constexpr std::size_t kKeptLooks = 32;

std::vector<Parameter> skinParameters(const Catalogue& catalogue) {
  std::vector<Parameter> parameters;
  const auto number = [&](const char* name, const char* label, double value, std::pair<double, double> range,
                          std::pair<double, double> shown, const char* hint) {
    parameters.push_back(makeNumber(name, label, "", value, range, shown, hint));
  };
  number("melanin", "Melanin", 1, {0, 100}, {0, 3}, "Times as much: below 1 paler, above 1 darker.");
  number("blood", "Blood", 1, {0, 100}, {0, 3}, "Times as much: below 1 paler, above 1 redder.");
  number("oxygenation", "Oxygenation", 0, {-1, 1}, {-1, 1}, "Above 0 rosier, below 0 bluer: cold, or out of breath.");
  number("tan", "Tan", 0, {0, 4}, {0, 2}, "More melanin, more of it brown, in a thicker skin.");
  number("flush", "Flush", 0, {-0.9, 4}, {-0.9, 2}, "More blood with more oxygen; below 0 pallor.");
  number("strength", "Strength", 1, {0, 1}, {0, 1}, "How far all of the above go.");
  parameters.push_back(makeFlag("matte", "Skin only", "", true, true,
                                "Colours that are no skin's stay: a matte by chromaticity. Off: every colour is taken "
                                "for the nearest skin; limit it with the mask."));
  number("reach", "Matte's reach", 2.5, {0.5, 10}, {1, 6},
         "How far from skins' mean colour the matte reaches, in standard deviations of skins.");
  number(kMixName, "Mix", 1, {0, 1}, {0, 1}, "0: the picture as it came; 1: the result. The mask scales it.");

  const std::string colour = "colourGroup";
  parameters.push_back(makeGroup(colour, "Colour", false));
  parameters.push_back(makeMenu("illuminant", "Light", colour, catalogue.illuminants, "D65",
                                "The light that skin was shot under; white is taken for balanced."));
  parameters.push_back(makeFlag(kHostSpaceName, "Follow the host's colour space", colour, true, false,
                                "Take the picture's colour space from the host, where it tells (OFX 1.5). The menu "
                                "holds otherwise."));
  parameters.push_back(makeMenu("space", "Working space", colour, catalogue.spaces, "ACEScg",
                                "Colour space of the picture, in and out; linear or log."));
  parameters.push_back(
      makeMenu("quality", "Quality", colour, {kMapQuality, kExactQuality}, kMapQuality,
               "Map: a table over chromaticity, at playback speed. Exact: every pixel by itself, slow."));
  return parameters;
}

skin::SkinLookSettings settingsOf(const ParameterValues& values, double time) {
  skin::SkinLookSettings settings;
  settings.melanin = values.number("melanin", time);
  settings.blood = values.number("blood", time);
  settings.tan = values.number("tan", time);
  settings.flush = values.number("flush", time);
  settings.oxygenation = values.number("oxygenation", time);
  settings.strength = values.number("strength", time);
  if (values.flag("matte", time)) {
    settings.reach = values.number("reach", time);
  }
  return settings;
}

class Skin final : public Effect {
 public:
  explicit Skin(const Catalogue& catalogue)
      : Effect({"org.metamer.Skin", "Skin",
                "Edits skin by what it is made of: melanin, blood and its oxygen. Each colour is given a likely skin, "
                "which is changed; what the skin lacks of the colour is kept, so that without a change nothing "
                "changes. The same at any exposure. Pixels in and out are in the working space."},
               skinParameters(catalogue)),
        m_catalogue(catalogue) {}

  std::shared_ptr<const PixelTransform> transform(const ParameterValues& values, double time,
                                                  const std::optional<std::string>& hostSpace) const override {
    const skin::SkinLookSettings settings = settingsOf(values, time);
    const spectral::DataLibrary& library = m_catalogue.library();
    const spectral::ColourSpace space = m_catalogue.space(hostSpace.value_or(values.menu("space", time)));
    const std::string light = values.menu("illuminant", time);
    const spectral::Spectrum illuminant = library.illuminant(light);
    if (skin::isNeutral(settings)) {
      return std::make_shared<AffinePixels>(AffinePixels::Form{});
    }
    const auto estimator = m_estimators.get(light + "\n" + space.linear.name, [&] {
      const skin::SkinView view(illuminant, library.observer(kObserver), space.linear);
      return SharedCache<skin::SkinEstimator>::Built{std::make_shared<const skin::SkinEstimator>(library, view), {}};
    });
    const Quality quality = values.menu("quality", time) == kExactQuality ? Quality::Exact : Quality::Map;
    const std::string key = keyOf(settings) + light + "\n" + space.name + (quality == Quality::Map ? "\nmap" : "");
    return m_looks.get(key, [&] {
      return SharedCache<SkinPixels>::Built{
          std::make_shared<const SkinPixels>(skin::SkinLook(*estimator, settings), space.encoding,
                                             m_tables.get(space, quality), quality),
          {}};
    });
  }

  std::string wantedSpace(const ParameterValues& values) const override { return values.menu("space", 0); }

  void enableParameters(const ParameterValues& values) const override {
    values.enable("reach", values.flag("matte", 0));
  }

 private:
  static std::string keyOf(const skin::SkinLookSettings& settings) {
    std::string key;
    for (const double number : {settings.melanin, settings.blood, settings.tan, settings.flush, settings.oxygenation,
                                settings.strength, settings.reach}) {
      key += spectral::shortestNumber(number) + "\n";
    }
    return key;
  }

  const Catalogue& m_catalogue;
  SignalTables m_tables;
  mutable SharedCache<skin::SkinEstimator> m_estimators{kKeptEstimators};
  mutable SharedCache<SkinPixels> m_looks{kKeptLooks};
};

}  // namespace

std::unique_ptr<Effect> makeSkin(const Catalogue& catalogue) {
  return std::make_unique<Skin>(catalogue);
}

}  // namespace metamer::ofx
