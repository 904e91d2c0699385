// SPDX-License-Identifier: Apache-2.0
#include "effects/spectral_transfer_parameters.h"

#include "effects/effect.h"
#include "host/parameter_makers.h"
#include "metamer/sip/spectral_transform.h"

namespace metamer::ofx {
namespace {

using Names = std::vector<std::string>;

constexpr const char* kSpectrumFiles = "CSV, IES TM-27 .spdx or rawtoaces JSON";

Names withFirst(Names first, const Names& others) {
  first.insert(first.end(), others.begin(), others.end());
  return first;
}

/// The light of one side: what the panel shows first.
void addLight(std::vector<Parameter>& parameters, const std::string& side, const std::string& label,
              const std::string& what, double kelvin, const Catalogue& catalogue) {
  parameters.push_back(makeMenu(side + kIlluminant, label + " light", "",
                                withFirst({kBlackbody, kDaylight, kFromFile}, catalogue.illuminants), "D65",
                                what + " A blackbody or daylight takes its temperature from the slider."));
  parameters.push_back(makeNumber(side + kTemperature, label + " temperature", "", kelvin, {500, 100000}, {1700, 12000},
                                  "Kelvin, of a blackbody (500 to 100000) or of CIE daylight (4000 to 25000)."));
}

/// The rest of one side, folded away.
void addDetails(std::vector<Parameter>& parameters, const std::string& side, const std::string& label,
                const Catalogue& catalogue) {
  const std::string group = side + "Group";
  parameters.push_back(makeGroup(group, label + " details", false));
  parameters.push_back(
      makeFile(side + kIlluminantFile, label + " light file", group,
               std::string("Spectrum of the light, where its menu says From file: ") + kSpectrumFiles + "."));
  parameters.push_back(makeMenu(side + kFilter, label + " filter", group,
                                withFirst({kNoFilter, kFromFile}, catalogue.filters), kNoFilter,
                                "Gel or filter between the light and the " + std::string("observer.")));
  parameters.push_back(makeNumber(side + kDensity, label + " filter density", group, 1.0, {0, 100}, {0, 4},
                                  "1: the filter as measured; 0.5: half its dye; 2: two sheets."));
  parameters.push_back(
      makeFile(side + kFilterFile, label + " filter file", group,
               std::string("Transmittance, where the filter menu says From file: ") + kSpectrumFiles + "."));
  parameters.push_back(makeMenu(side + kObserver, label + " observer", group,
                                withFirst({kFromFile}, catalogue.observers), "CIE 1931 2",
                                "Who looks: an eye, or a camera by its measured sensitivities."));
  parameters.push_back(
      makeFile(side + kObserverFile, label + " observer file", group,
               std::string("Three sensitivities, where the observer menu says From file: ") + kSpectrumFiles + "."));
}

}  // namespace

std::vector<Parameter> spectralTransferParameters(const Catalogue& catalogue) {
  std::vector<Parameter> parameters;
  addLight(parameters, "input", "Input", "The light that the picture was shot under.", 5600, catalogue);
  addLight(parameters, "output", "Output", "The light that it should appear under.", 3200, catalogue);
  parameters.push_back(makeNumber("adaptation", "Adaptation", "", 0.0, {0, 1}, {0, 1},
                                  "How far the viewer's eye follows the new light. 0: the whole cast of the new light "
                                  "shows; 1: neutrals stay neutral."));
  parameters.push_back(makeNumber(kMixName, "Mix", "", 1.0, {0, 1}, {0, 1},
                                  "0: the picture as it came; 1: the result. The mask scales it."));

  addDetails(parameters, "input", "Input", catalogue);
  addDetails(parameters, "output", "Output", catalogue);

  const std::string scene = "sceneGroup";
  parameters.push_back(makeGroup(scene, "Objects in the picture", false));
  parameters.push_back(
      makeMenu("scene", "Reference scene", scene, {kSmooth, kDataset, kNatural, kSkin, kPairs}, kNatural,
               "Which reflectance a colour is taken to have. Natural: smooth, and beyond that as "
               "measured surfaces and skins of the colour are. Skin: among skins' colours, as skins are. Smooth: the "
               "smoothest that has it. Data set: measured ones, interpolated. Pairs: Natural, and exactly the "
               "spectra of a file at their colours."));
  parameters.push_back(makeMenu("sceneSet", "Reflectances", scene, withFirst({kFromFile}, catalogue.reflectanceSets),
                                "colorchecker", "Measured reflectances, for Data set."));
  parameters.push_back(
      makeFile("sceneFile", "Reflectance file", scene, "CSV of reflectances, where the menu says From file."));
  // Projects hold the strength under the name that it had first.
  parameters.push_back(makeNumber("priorStrength", "Skin strength", scene, 1.0, {0, 1}, {0, 1},
                                  "Of Skin. 0: as Natural; 1: as near to skins as can be."));
  parameters.push_back(makeNumber("skinFade", "Skin fade", scene, sip::kDefaultSkinFade,
                                  {sip::kLeastSkinFade, sip::kLargestSkinFade},
                                  {sip::kLeastSkinFade, sip::kLargestSkinFade},
                                  "Of Skin. How far beside skin's mean colour it reaches, in standard deviations of "
                                  "skins. More finds odder skins, and takes more of what is none for skin."));
  parameters.push_back(makeFile("pairsFile", "Pairs file", scene,
                                "For Pairs: CSV of colours whose spectra are known, as lutgen pairs add makes."));
  parameters.push_back(
      makeNumber("pairsRadius", "Pairs radius", scene, sip::kDefaultPairRadius,
                 {sip::kLeastPairRadius, sip::kLargestPairRadius}, {sip::kLeastPairRadius, 4},
                 "Of Pairs. How far one is felt, in standard deviations of surfaces' chromaticities."));

  const std::string colour = "colourGroup";
  parameters.push_back(makeGroup(colour, "Colour", false));
  parameters.push_back(makeFlag(kHostSpaceName, "Follow the host's colour space", colour, true, false,
                                "Take the picture's colour space from the host, where it tells (OFX 1.5). The menu "
                                "holds otherwise."));
  parameters.push_back(makeMenu("space", "Working space", colour, catalogue.spaces, "ACEScg",
                                "Colour space of the picture, in and out; linear or log."));
  parameters.push_back(makeMenu("cat", "Chromatic adaptation", colour, {"vonkries", "bradford", "cat02", "cat16"},
                                "vonkries", "The cone space in which white is adapted to white."));
  parameters.push_back(makeMenu(
      "balanced", "Shot balanced by", colour,
      {kAsAdaptation, "camera", "rgb", "none", "vonkries", "bradford", "cat02", "cat16"}, kAsAdaptation,
      "How the light's colour was taken out of the shot. camera: gains on the channels of the input observer, and its "
      "matrix for daylight; rgb: gains on the working space, as by a grey card; none: it is still there."));
  parameters.push_back(makeFlag("keepExposure", "Keep exposure", colour, false, true,
                                "On: the light that filters cost is lost in the result too. Off: made up for."));
  parameters.push_back(makeMenu("quality", "Quality", colour, {kMapQuality, kExactQuality}, kMapQuality,
                                "Map: a table within about a tenth of a CIEDE2000, at playback speed. Exact: every "
                                "pixel solved, slow."));

  const std::string recipe = "recipeGroup";
  parameters.push_back(makeGroup(recipe, "Recipe", false));
  parameters.push_back(makeFile("recipeFile", "Recipe file", recipe,
                                "A metamer recipe (.yaml). Where one is given it overrides lights, filters, observers, "
                                "adaptation, objects, working space, chromatic adaptation and exposure above."));
  return parameters;
}

}  // namespace metamer::ofx
