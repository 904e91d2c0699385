// SPDX-License-Identifier: Apache-2.0
#include "effects/spectral_transfer.h"

#include "effects/file_stamp.h"
#include "effects/shared_cache.h"
#include "effects/signal_tables.h"
#include "effects/spectral_transfer_parameters.h"
#include "metamer/sip/recipe.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/text.h"
#include "pixels/spectral_pixels.h"

namespace metamer::ofx {
namespace {

using spectral::InputError;

/// Engines kept beyond those in use: enough to go back and forth between settings, and to scrub an animated light.
constexpr std::size_t kKeptEngines = 24;

/// Reads one instance's parameters at one time as a recipe.
class RecipeReader {
 public:
  RecipeReader(const ParameterValues& values, double time) : m_values(values), m_time(time) {}

  sip::Recipe read() const {
    const std::string file = m_values.text("recipeFile", m_time);
    if (!file.empty()) {
      requireFile(spectral::pathOf(file), "recipeFile",
                  "choose the recipe anew, or clear the field to go by the menus");
      return sip::readRecipe(spectral::pathOf(file));
    }
    sip::Recipe recipe;
    recipe.space = m_values.menu("space", m_time);
    recipe.input = readSide("input");
    recipe.output = readSide("output");
    recipe.adaptation = m_values.number("adaptation", m_time);
    recipe.scene = readScene();
    recipe.cat = spectral::chromaticAdaptationFromName(m_values.menu("cat", m_time));
    const std::string balanced = m_values.menu("balanced", m_time);
    if (balanced != kAsAdaptation) {
      recipe.balanced = sip::balanceFromName(balanced);
    }
    recipe.keepExposure = m_values.flag("keepExposure", m_time);
    return recipe;
  }

 private:
  /// The path of a file parameter in a form that is never taken for a name.
  std::string file(const std::string& name, const std::string& menu) const {
    const std::string path = m_values.text(name, m_time);
    if (path.empty()) {
      throw InputError("", name, "", "no file is chosen; choose one, or another entry in " + menu);
    }
    requireFile(spectral::pathOf(path), name, "choose the file anew, or another entry in " + menu);
    return path.find_first_of("/\\") == std::string::npos ? "./" + path : path;
  }

  sip::RecipePipeline readSide(const std::string& side) const {
    sip::RecipePipeline pipeline;
    pipeline.illuminant = m_values.menu(side + kIlluminant, m_time);
    if (pipeline.illuminant == kBlackbody || pipeline.illuminant == kDaylight) {
      const std::string kelvin = spectral::shortestNumber(m_values.number(side + kTemperature, m_time)) + " K";
      pipeline.illuminant = pipeline.illuminant == kBlackbody ? kelvin : "daylight " + kelvin;
    } else if (pipeline.illuminant == kFromFile) {
      pipeline.illuminant = file(side + kIlluminantFile, side + kIlluminant);
    }
    std::string filter = m_values.menu(side + kFilter, m_time);
    if (filter != kNoFilter) {
      if (filter == kFromFile) {
        filter = file(side + kFilterFile, side + kFilter);
      }
      pipeline.filters.push_back({filter, m_values.number(side + kDensity, m_time)});
    }
    pipeline.observer = m_values.menu(side + kObserver, m_time);
    if (pipeline.observer == kFromFile) {
      pipeline.observer = file(side + kObserverFile, side + kObserver);
    }
    return pipeline;
  }

  sip::RecipeScene readScene() const {
    sip::RecipeScene scene;
    const std::string kind = m_values.menu("scene", m_time);
    if (kind == kDataset) {
      scene.kind = sip::ReferenceScene::Kind::Dataset;
      scene.set = m_values.menu("sceneSet", m_time);
      if (scene.set == kFromFile) {
        scene.set = file("sceneFile", "sceneSet");
      }
    } else if (kind == kSkin) {
      scene.kind = sip::ReferenceScene::Kind::Skin;
      scene.strength = m_values.number("priorStrength", m_time);
      scene.fade = m_values.number("skinFade", m_time);
    } else if (kind == kPairs) {
      scene.kind = sip::ReferenceScene::Kind::Pairs;
      scene.set = file("pairsFile", "scene");
      scene.radius = m_values.number("pairsRadius", m_time);
    } else if (kind == kNatural || kind == kSmooth) {
      scene.kind = kind == kSmooth ? sip::ReferenceScene::Kind::Smooth : sip::ReferenceScene::Kind::Natural;
    } else {
      throw InputError("", "scene", kind,
                       "is no reference scene any more; choose Natural, Skin, Pairs, Smooth or Data set");
    }
    return scene;
  }

  const ParameterValues& m_values;
  double m_time;
};

/// Every file that a recipe could have been read from; names of tables are files that are not there.
FileStamps filesOf(const sip::Recipe& recipe) {
  FileStamps files;
  for (const sip::RecipePipeline* side : {&recipe.input, &recipe.output}) {
    files.add(recipe.folder / spectral::pathOf(side->illuminant));
    files.add(recipe.folder / spectral::pathOf(side->observer));
    for (const sip::RecipeFilter& filter : side->filters) {
      files.add(recipe.folder / spectral::pathOf(filter.name));
    }
  }
  if (!recipe.scene.set.empty()) {
    files.add(recipe.folder / spectral::pathOf(recipe.scene.set));
  }
  return files;
}

class SpectralTransfer final : public Effect {
 public:
  explicit SpectralTransfer(const Catalogue& catalogue)
      : Effect({"org.metamer.SpectralTransfer", "Spectral Transfer",
                "Shows a picture as it would look under another light, behind another filter, or to another observer. "
                "Each colour is given a likely reflectance that explains it under the input light; that "
                "reflectance is put under the output light. Exact at any exposure. Pixels in and out are in the "
                "working space."},
               spectralTransferParameters(catalogue)),
        m_catalogue(catalogue) {}

  std::shared_ptr<const PixelTransform> transform(const ParameterValues& values, double time,
                                                  const std::optional<std::string>& hostSpace) const override {
    sip::Recipe recipe = RecipeReader(values, time).read();
    recipe.space = hostSpace.value_or(recipe.space);
    recipe.name.clear();
    const spectral::DataLibrary& library = m_catalogue.library();
    const spectral::ColourSpace space = m_catalogue.space(recipe.space);
    // Log spaces and their linear ones share an engine.
    recipe.space = space.linear.name;
    const auto engine = m_engines.get(toYaml(recipe) + spectral::utf8(recipe.folder), [&] {
      FileStamps files = filesOf(recipe);
      return SharedCache<SpectralEngine>::Built{
          std::make_shared<SpectralEngine>(sip::resolve(recipe, library, space.linear), m_memory, m_draftMemory),
          std::move(files)};
    });
    const Quality quality = values.menu("quality", time) == kExactQuality ? Quality::Exact : Quality::Map;
    return makeSpectralPixels(engine, space.encoding, m_tables.get(space, quality), quality);
  }

  std::string wantedSpace(const ParameterValues& values) const override { return values.menu("space", 0); }

  void enableParameters(const ParameterValues& values) const override {
    const bool byMenus = values.text("recipeFile", 0).empty();
    const std::string scene = values.menu("scene", 0);
    for (const std::string side : {"input", "output"}) {
      const std::string light = values.menu(side + kIlluminant, 0);
      const std::string filter = values.menu(side + kFilter, 0);
      values.enable(side + kIlluminant, byMenus);
      values.enable(side + kTemperature, byMenus && (light == kBlackbody || light == kDaylight));
      values.enable(side + kIlluminantFile, byMenus && light == kFromFile);
      values.enable(side + kFilter, byMenus);
      values.enable(side + kDensity, byMenus && filter != kNoFilter);
      values.enable(side + kFilterFile, byMenus && filter == kFromFile);
      values.enable(side + kObserver, byMenus);
      values.enable(side + kObserverFile, byMenus && values.menu(side + kObserver, 0) == kFromFile);
    }
    for (const char* name : {"adaptation", "scene", "space", "cat", "balanced", "keepExposure"}) {
      values.enable(name, byMenus);
    }
    values.enable("sceneSet", byMenus && scene == kDataset);
    values.enable("sceneFile", byMenus && scene == kDataset && values.menu("sceneSet", 0) == kFromFile);
    values.enable("priorStrength", byMenus && scene == kSkin);
    values.enable("skinFade", byMenus && scene == kSkin);
    values.enable("pairsFile", byMenus && scene == kPairs);
    values.enable("pairsRadius", byMenus && scene == kPairs);
  }

 private:
  const Catalogue& m_catalogue;
  SignalTables m_tables;
  mutable SharedCache<SpectralEngine> m_engines{kKeptEngines};
  mutable EngineMemory m_memory;
  mutable EngineMemory m_draftMemory;
};

}  // namespace

std::unique_ptr<Effect> makeSpectralTransfer(const Catalogue& catalogue) {
  return std::make_unique<SpectralTransfer>(catalogue);
}

}  // namespace metamer::ofx
