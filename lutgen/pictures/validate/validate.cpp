// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "library.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/validation/validation.h"
#include "picture_commands.h"

namespace metamer::lutgen {
namespace {

struct ValidateArguments {
  std::string recipe;
  std::string json;
  double tolerance = 0.1;
  validation::ValidationOptions options;
};

template <typename Patches, typename Member>
double meanOf(const Patches& patches, Member member) {
  double sum = 0;
  for (const auto& patch : patches) {
    sum += std::invoke(member, patch);
  }
  return sum / static_cast<double>(patches.size());
}

double beyondNoise(const validation::PatchValidation& patch) {
  return std::max(0.0, patch.total - patch.noise);
}

nlohmann::ordered_json summary(const validation::SceneValidation& scene) {
  nlohmann::ordered_json json;
  json["name"] = scene.name;
  json["about"] = scene.about;
  json["total"] = meanOf(scene.patches, &validation::PatchValidation::total);
  json["beyond_noise"] = meanOf(scene.patches, beyondNoise);
  json["engine"] = meanOf(scene.patches, &validation::PatchValidation::engine);
  json["metamerism"] = meanOf(scene.patches, &validation::PatchValidation::metamerism);
  if (scene.isInterreflecting) {
    json["interreflection"] = json["engine"].get<double>() - json["metamerism"].get<double>();
  }
  json["representation"] = meanOf(scene.patches, &validation::PatchValidation::representation);
  json["noise"] = meanOf(scene.patches, &validation::PatchValidation::noise);
  for (const validation::PatchValidation& patch : scene.patches) {
    json["patches"].push_back({{"name", patch.name},
                               {"total", patch.total},
                               {"engine", patch.engine},
                               {"metamerism", patch.metamerism},
                               {"representation", patch.representation},
                               {"noise", patch.noise}});
  }
  return json;
}

nlohmann::ordered_json summary(const validation::WallValidation& wall) {
  nlohmann::ordered_json json;
  json["driven_only"] = meanOf(wall.patches, &validation::WallValidation::Patch::drivenOnly);
  json["corrected"] = meanOf(wall.patches, &validation::WallValidation::Patch::corrected);
  json["noise"] = meanOf(wall.patches, &validation::WallValidation::Patch::noise);
  json["prediction_error"] = wall.predictionError;
  json["frustum_error"] = wall.frustumError;
  for (const validation::WallValidation::Patch& patch : wall.patches) {
    json["patches"].push_back({{"name", patch.name},
                               {"driven_only", patch.drivenOnly},
                               {"corrected", patch.corrected},
                               {"noise", patch.noise}});
  }
  return json;
}

void print(const nlohmann::ordered_json& json) {
  std::printf("%-16s %8s %8s %8s %11s %8s %8s %8s   mean CIEDE2000\n", "scene", "total", "beyond", "engine",
              "metamerism", "inter-", "represen-", "noise");
  std::printf("%-16s %8s %8s %8s %11s %8s %8s %8s\n", "", "", "noise", "", "", "refl.", "tation", "95 %");
  for (const auto& scene : json["scenes"]) {
    const auto value = [&](const char* key) { return scene.contains(key) ? scene[key].get<double>() : 0.0; };
    std::printf("%-16s %8.3f %8.3f %8.3f %11.3f %8.3f %9.3f %8.3f\n", scene["name"].get<std::string>().c_str(),
                value("total"), value("beyond_noise"), value("engine"), value("metamerism"), value("interreflection"),
                value("representation"), value("noise"));
  }
  const auto& wall = json["led_wall"];
  std::printf(
      "LED wall against daylight: M alone %.3f, with Q %.3f, noise %.3f; chart predicted within %.3f; "
      "background kept within %.1e\n",
      wall["driven_only"].get<double>(), wall["corrected"].get<double>(), wall["noise"].get<double>(),
      wall["prediction_error"].get<double>(), wall["frustum_error"].get<double>());
}

void run(const ValidateArguments& arguments) {
  const auto library = openLibrary();
  const sip::Recipe recipe = sip::readRecipe(spectral::pathOf(arguments.recipe));
  // The place first: what cannot be written is not worth the renders.
  std::optional<spectral::PendingFile> file;
  if (!arguments.json.empty()) {
    file.emplace(spectral::pathOf(arguments.json));
  }
  const validation::Validation result = validation::validate(recipe, library, arguments.options);
  nlohmann::ordered_json json;
  json["metamer_validation"] = 1;
  json["recipe"] = sip::toYaml(recipe);
  json["replicates"] = arguments.options.replicates;
  json["samples"] = arguments.options.samples;
  json["seed"] = arguments.options.seed;
  for (const validation::SceneValidation& scene : result.scenes) {
    json["scenes"].push_back(summary(scene));
  }
  json["led_wall"] = summary(result.wall);
  print(json);
  if (file) {
    file->write(json.dump(1) + "\n");
    file->commit();
  }
  const double beyond = json["scenes"][0]["beyond_noise"].get<double>();
  if (beyond > arguments.tolerance) {
    std::cout << "smooth objects: " << beyond << " beyond the noise, more than the tolerance " << arguments.tolerance
              << std::endl;
    throw CLI::RuntimeError(kExceeded);
  }
}

}  // namespace

void addValidate(CLI::App& application) {
  CLI::App* command = kValidate.addTo(application);
  const auto arguments = std::make_shared<ValidateArguments>();
  command->add_option("RECIPE", arguments->recipe, "Recipe file")->required();
  command->add_option("--json", arguments->json, "Write all figures, patch by patch");
  command
      ->add_option("--tolerance", arguments->tolerance,
                   "Mean CIEDE2000 beyond the noise that smooth objects may have; exit code 3 above it")
      ->check(CLI::Range(0.0, 100.0));
  command->add_option("--replicates", arguments->options.replicates, "Renders with seeds of their own; 8 by default")
      ->check(CLI::Range(3, 1000));
  command->add_option("--samples", arguments->options.samples, "Paths a pixel in each; 64 by default")
      ->check(CLI::Range(1, 1 << 20));
  command->add_option("--seed", arguments->options.seed, "Of the first replicate; 1 by default");
  command->add_option("--threads", arguments->options.threads, "All by default")->check(CLI::Range(1, 1024));
  command->callback([arguments] { run(*arguments); });
}

}  // namespace metamer::lutgen
