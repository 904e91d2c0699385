// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/certificate.h"

#include <openssl/evp.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "metamer/ocio/exposure_invariant_chain.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"

namespace metamer::ocio {
namespace {

using Json = nlohmann::ordered_json;

/// Numbers to as many digits as mean something, so that they are the same wherever they are computed.
double rounded(double value, int digits = 4) {
  const double scale = std::pow(10.0, digits);
  return std::isfinite(value) ? std::round(value * scale) / scale : value;
}

double significant(double value) {
  if (!std::isfinite(value) || value == 0.0) {
    return value;
  }
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.5g", value);
  return std::strtod(text.data(), nullptr);
}

/// A path as the user gave it, but for a folder of this machine.
std::string portable(const std::string& name) {
  const std::filesystem::path path = spectral::pathOf(name);
  return path.is_absolute() ? spectral::utf8(path.filename()) : name;
}

Json pipelineJson(const sip::RecipePipeline& pipeline) {
  Json filters = Json::array();
  for (const auto& filter : pipeline.filters) {
    filters.push_back({{"name", portable(filter.name)}, {"density", filter.density}});
  }
  return {
      {"illuminant", portable(pipeline.illuminant)}, {"filters", filters}, {"observer", portable(pipeline.observer)}};
}

/// The kind of scene: where it is of pairs, the one below them.
sip::ReferenceScene::Kind kindBelowPairs(const sip::RecipeScene& scene) {
  return scene.kind == sip::ReferenceScene::Kind::Pairs ? scene.over : scene.kind;
}

Json recipeJson(const sip::Recipe& recipe) {
  Json output = pipelineJson(recipe.output);
  output["adaptation"] = recipe.adaptation;
  Json scene = {{"kind", sip::nameOf(recipe.scene.kind)}};
  const bool hasPairs = recipe.scene.kind == sip::ReferenceScene::Kind::Pairs;
  if (hasPairs || recipe.scene.kind == sip::ReferenceScene::Kind::Dataset) {
    scene["set"] = portable(recipe.scene.set);
  }
  if (hasPairs) {
    scene["over"] = sip::nameOf(recipe.scene.over);
    scene["radius"] = recipe.scene.radius;
  }
  if (kindBelowPairs(recipe.scene) == sip::ReferenceScene::Kind::Skin) {
    scene["strength"] = recipe.scene.strength;
    scene["fade"] = recipe.scene.fade;
  }
  return {{"metamer", 1},
          {"name", recipe.name},
          {"space", recipe.space},
          {"input", pipelineJson(recipe.input)},
          {"output", output},
          {"scene", scene},
          {"cat", spectral::nameOf(recipe.cat)},
          {"balanced", nameOf(recipe.balanced.value_or(sip::Balance{.cat = recipe.cat}))},
          {"keep_exposure", recipe.keepExposure}};
}

struct Policy {
  std::string negatives;
  std::string outOfRange;
  std::string notANumber;
};

Policy policyOf(const Certificate& certificate) {
  switch (certificate.representation) {
    case Representation::Identity:
      return {"kept", "kept", "kept"};
    case Representation::Matrix:
      return {"kept, linear", "kept, linear", "NaN in, NaN out, in that pixel alone"};
    case Representation::LogCube:
      return {std::string("in: clipped below the shaper's signal 0; out: ") +
                  (certificate.negativesKept ? "kept as signals below 0, which stand for what leaves the gamut"
                                             : "clipped at signal 0, as the format holds whole numbers"),
              "clipped above the shaper's signal 1", "a colour of the table, in that pixel alone"};
    case Representation::ExposureInvariantChain:
      return {
          "kept, as the engine has them: no colour is clipped",
          std::to_string(kChainStops) + " stops below 0.18 and darker: to black in proportion; as far above: clipped",
          "a finite colour or NaN, in that pixel alone"};
    case Representation::HomogeneousMap:
      return {"kept, as the engine has them: no colour is clipped", "none: any exposure", "kept, in that pixel alone"};
  }
  return {};
}

Json pixelsJson(const PixelProtocol::Report& pixels) {
  if (pixels.count == 0) {
    return nullptr;
  }
  return {{"count", pixels.count},
          {"off_by",
           {{"of", "the pixel's largest channel"},
            {"p999", rounded(pixels.p999)},
            {"largest", rounded(pixels.largest)},
            {"worst",
             {{"kind", pixels.worstKind},
              {"rgb",
               {significant(pixels.worstRgb[0]), significant(pixels.worstRgb[1]), significant(pixels.worstRgb[2])}}}}}},
          {"display_codes",
           {{"photograph_p99", rounded(pixels.photographCodes)}, {"noisy_p99", rounded(pixels.noisyCodes)}}}};
}

Json cardsJson(const Certificate::OnCards& onCards) {
  const auto figures = [](const sip::ErrorProtocol::Report& error) {
    return Json{{"mean", rounded(error.mean)}, {"p99", rounded(error.p99)}, {"max", rounded(error.max)}};
  };
  return {{"through", "OpenColorIO's shader, its tables as textures"},
          {"float_textures", figures(onCards.floats)},
          {"half_textures", figures(onCards.halves)}};
}

/// Beyond these a certificate says so in a sentence: luminance, over white's; distance, of a pixel's own size.
constexpr double kBright = 3.0;
constexpr double kFar = 2.0;

}  // namespace

std::vector<std::string> Certificate::warnings() const {
  std::vector<std::string> result;
  std::array<char, 200> text{};
  if (brightening > kBright) {
    std::snprintf(text.data(), text.size(), "saturated lights grow up to %.1f times as bright against white",
                  brightening);
    result.emplace_back(text.data());
  }
  if (pixels.count > 0 && pixels.largest > kFar) {
    std::snprintf(
        text.data(), text.size(),
        "a pixel of the kind '%s' ends %.1f times its own size from the engine; more nodes (--size) or .ctf keep it",
        pixels.worstKind.c_str(), pixels.largest);
    result.emplace_back(text.data());
  }
  return result;
}

std::string Certificate::json() const {
  Json inputList = Json::array();
  for (const auto& input : inputs) {
    Json entry = {{"role", input.role}, {"name", portable(input.provenance.name)}};
    const auto put = [&](const char* key, const std::string& value) {
      if (!value.empty()) {
        entry[key] = value;
      }
    };
    put("file", portable(input.provenance.file));
    put("sha256", input.provenance.sha256);
    put("source", input.provenance.source);
    put("licence", input.provenance.licence);
    inputList.push_back(entry);
  }
  Json transform = {{"representation", nameOf(representation)}};
  if (!format.empty()) {
    transform["format"] = format;
  }
  if (size > 0) {
    transform["size"] = size;
    transform["nodes"] = fitted ? "fitted" : "sampled";
  }
  if (!shaper.empty()) {
    transform["shaper"] = shaper;
  }
  if (shaperEntries > 0) {
    transform["shaper_entries"] = shaperEntries;
  }
  transform["engine_bands"] = bandCount;
  if (!sha256.empty()) {
    transform["sha256"] = sha256;
  }
  if (choice) {
    Json tried = Json::array();
    for (const auto& each : choice->tried) {
      Json entry = {{"representation", nameOf(each.representation)}};
      if (each.size > 0) {
        entry["size"] = each.size;
      }
      entry["p99"] = rounded(each.p99);
      entry["max"] = rounded(each.max);
      tried.push_back(entry);
    }
    transform["choice"] = {{"tolerance", choice->tolerance}, {"on", "p99"}, {"tried", tried}};
  }
  Json range = {{"gamut", gamut},
                {"inside_gamut_only", probes.insideGamutOnly},
                {"lowest_stop", probes.lowestStop},
                {"highest_stop", probes.highestStop}};
  if (std::isfinite(probes.largestComponent)) {
    range["largest_component"] = probes.largestComponent;
  }
  const Policy policy = policyOf(*this);
  Json document = {
      {"metamer_certificate", 1},
      {"tool", {{"name", "metamer"}, {"version", toolVersion()}}},
      {"recipe", recipeJson(recipe)},
      {"inputs", inputList},
      {"transform", transform},
      {"range", range},
      {"error",
       {{"metric", "CIEDE2000"},
        {"against", "spectral engine, 401 bands"},
        {"mean", rounded(error.mean)},
        {"p99", rounded(error.p99)},
        {"max", rounded(error.max)},
        {"count", error.count},
        {"worst",
         {{"name", error.worstProbe},
          {"rgb", {significant(error.worstRgb[0]), significant(error.worstRgb[1]), significant(error.worstRgb[2])}}}}}},
      {"pixels", pixelsJson(pixels)},
      {"diagnostics",
       {{"brightening", significant(brightening)},
        {"condition_number", significant(diagnostics.conditionNumber)},
        {"surface_gain", significant(diagnostics.gain)},
        {"relaxation", significant(diagnostics.relaxation)},
        {"reach",
         {{"up", significant(diagnostics.reachUp)},
          {"down", significant(diagnostics.reachDown)},
          {"aside", significant(diagnostics.reachAside)}}},
        {"limited_surfaces", rounded(diagnostics.limitedShare)},
        {"gain", significant(gain)},
        {"folds", rounded(folds)}}},
      {"policy",
       {{"negatives", policy.negatives}, {"out_of_range", policy.outOfRange}, {"not_a_number", policy.notANumber}}}};
  if (onCards) {
    document["graphics_cards"] = cardsJson(*onCards);
  }
  if (!surfaces.empty()) {
    Json sets = Json::array();
    for (const sip::HeldOutSet& set : surfaces) {
      sets.push_back({{"set", set.name},
                      {"count", set.count},
                      {"engine", rounded(set.engine, 3)},
                      {"plain_adaptation", rounded(set.adaptation, 3)},
                      {"root_polynomial", rounded(set.rootPolynomial, 3)}});
    }
    document["surfaces"] = {{"metric", "mean CIEDE2000"},
                            {"against", "the spectra themselves, each set left out of the scene"},
                            {"sets", sets}};
  }
  if (!notes.empty()) {
    document["notes"] = notes;
  }
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<std::string> Certificate::lines() const {
  const auto side = [](const sip::RecipePipeline& pipeline) {
    std::string text = portable(pipeline.illuminant);
    for (const auto& filter : pipeline.filters) {
      std::array<char, 32> density{};
      std::snprintf(density.data(), density.size(), ":%g", filter.density);
      text += " + " + portable(filter.name) + density.data();
    }
    return text + " seen by " + portable(pipeline.observer);
  };
  std::array<char, 160> figures{};
  std::snprintf(figures.data(), figures.size(),
                "CIEDE2000 against the spectral engine: mean %.3f, p99 %.3f, max %.3f, stops %+d to %+d", error.mean,
                error.p99, error.max, probes.lowestStop, probes.highestStop);
  std::array<char, 48> scene{};
  if (kindBelowPairs(recipe.scene) == sip::ReferenceScene::Kind::Skin) {
    std::snprintf(scene.data(), scene.size(), " %.4g, fade %.4g", recipe.scene.strength, recipe.scene.fade);
  }
  std::vector<std::string> result = {
      "metamer " + toolVersion() + ": " + side(recipe.input) + " -> " + side(recipe.output) + ", scene " +
          (recipe.scene.kind == sip::ReferenceScene::Kind::Pairs
               ? "pairs " + portable(recipe.scene.set) + " over " + sip::nameOf(recipe.scene.over)
               : sip::nameOf(recipe.scene.kind)) +
          scene.data(),
      "space " + recipe.space + ", " + nameOf(representation) +
          (size > 0 ? ", " + std::to_string(size) + " nodes a side, " + (fitted ? "fitted" : "sampled") : "") +
          (shaper.empty() ? "" : ", shaper " + shaper) +
          (shaperEntries > 0 ? ", 1-D shaper of " + std::to_string(shaperEntries) + " entries" : ""),
      figures.data(), "worst: " + error.worstProbe};
  std::array<char, 160> range{};
  std::snprintf(range.data(), range.size(), "gamut %s%s; condition %.4g, relaxation %.3g, gain %.4g, folds %.2f %%",
                gamut.c_str(), probes.insideGamutOnly ? ", inside only" : "", diagnostics.conditionNumber,
                diagnostics.relaxation, gain, 100.0 * folds);
  result.emplace_back(range.data());
  if (pixels.count > 0) {
    std::array<char, 200> text{};
    std::snprintf(text.data(), text.size(),
                  "pixels of noisy photographs, lights and beyond: off by %.3f of their size at p99.9, %.3f at most; "
                  "photographs by %.2f display codes at p99, noisy ones by %.2f",
                  pixels.p999, pixels.largest, pixels.photographCodes, pixels.noisyCodes);
    result.emplace_back(text.data());
  }
  if (!surfaces.empty()) {
    double engine = 0.0;
    double adaptation = 0.0;
    double polynomial = 0.0;
    const double share = 1.0 / static_cast<double>(surfaces.size());
    for (const sip::HeldOutSet& set : surfaces) {
      engine += share * set.engine;
      adaptation += share * set.adaptation;
      polynomial += share * set.rootPolynomial;
    }
    std::array<char, 200> text{};
    std::snprintf(text.data(), text.size(),
                  "measured surfaces that it does not know: off the truth by %.2f, plain adaptation by %.2f, a root "
                  "polynomial by %.2f",
                  engine, adaptation, polynomial);
    result.emplace_back(text.data());
  }
  if (choice) {
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), "chosen as the cheapest with p99 within %g", choice->tolerance);
    result.emplace_back(text.data());
    if (choice->tried.size() > 1) {
      const auto& cheaper = choice->tried[choice->tried.size() - 2];
      std::snprintf(text.data(), text.size(), "the next cheaper, %s%s, would be at p99 %.3f, max %.3f",
                    nameOf(cheaper.representation).c_str(),
                    cheaper.size > 0 ? (" of " + std::to_string(cheaper.size) + " nodes").c_str() : "", cheaper.p99,
                    cheaper.max);
      result.emplace_back(text.data());
    }
  }
  for (const auto& input : inputs) {
    result.push_back(input.role + ": " + portable(input.provenance.name) + " sha256 " + input.provenance.sha256);
  }
  const Policy policy = policyOf(*this);
  result.push_back("negatives: " + policy.negatives);
  result.push_back("out of range: " + policy.outOfRange);
  result.push_back("not a number: " + policy.notANumber);
  return result;
}

std::vector<CertifiedInput> certifiedInputs(const sip::Recipe& recipe, const spectral::DataLibrary& library) {
  std::vector<CertifiedInput> inputs;
  const auto add = [&](std::string role, const std::string& group, const std::string& name) {
    spectral::Provenance provenance = library.provenance(group, name);
    if (!provenance.file.empty() && provenance.sha256.empty()) {
      provenance.sha256 = sha256(spectral::readTextFile(recipe.folder / spectral::pathOf(provenance.file)));
    }
    inputs.push_back({std::move(role), std::move(provenance)});
  };
  const auto addPipeline = [&](const std::string& side, const sip::RecipePipeline& pipeline) {
    add(side + ".illuminant", "illuminants", pipeline.illuminant);
    for (std::size_t k = 0; k < pipeline.filters.size(); ++k) {
      add(side + ".filters[" + std::to_string(k) + "]", "filters", pipeline.filters[k].name);
    }
    add(side + ".observer", "observers", pipeline.observer);
  };
  addPipeline("input", recipe.input);
  addPipeline("output", recipe.output);
  if (recipe.scene.kind == sip::ReferenceScene::Kind::Pairs) {
    add("scene.set", "reflectances", recipe.scene.set);
  }
  switch (kindBelowPairs(recipe.scene)) {
    case sip::ReferenceScene::Kind::Smooth:
    case sip::ReferenceScene::Kind::Pairs:
      break;
    case sip::ReferenceScene::Kind::Dataset:
      add("scene.set", "reflectances", recipe.scene.set);
      break;
    case sip::ReferenceScene::Kind::Smits:
    case sip::ReferenceScene::Kind::Mallett:
    case sip::ReferenceScene::Kind::Jakob:
    case sip::ReferenceScene::Kind::Meng:
    case sip::ReferenceScene::Kind::Natural:
    case sip::ReferenceScene::Kind::Skin: {
      // All sets of the library, by one hash of theirs.
      const bool isSkin = kindBelowPairs(recipe.scene) == sip::ReferenceScene::Kind::Skin;
      std::string hashes;
      for (const std::string& name : library.reflectanceSetNames()) {
        if (!isSkin && name == "virtual skins") {
          continue;
        }
        hashes += library.provenance("reflectances", name).sha256 + " " + name + "\n";
      }
      spectral::Provenance provenance;
      provenance.name = isSkin ? "all measured reflectances, model skins and virtual skins"
                               : "all measured reflectances and model skins";
      if (sip::upliftOf(recipe.scene.kind)) {
        provenance.name = "the uplift " + sip::nameOf(recipe.scene.kind) + ", limited by all measured reflectances";
      }
      provenance.sha256 = sha256(hashes);
      inputs.push_back(
          {recipe.scene.kind == sip::ReferenceScene::Kind::Pairs ? "scene.over" : "scene.set", std::move(provenance)});
      break;
    }
  }
  return inputs;
}

std::string sha256(const std::string& bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1) {
    throw std::runtime_error("libcrypto has no SHA-256");
  }
  std::string text;
  for (unsigned int k = 0; k < length; ++k) {
    std::array<char, 3> pair{};
    std::snprintf(pair.data(), pair.size(), "%02x", digest[k]);
    text += pair.data();
  }
  return text;
}

std::string toolVersion() {
  return METAMER_VERSION;
}

}  // namespace metamer::ocio
