// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "engines.h"
#include "metamer/spectral/path_text.h"

namespace metamer::farm {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kProgram = "Program";

std::string textOf(const Word& word) {
  std::string text;
  for (const Piece& piece : word) {
    switch (piece.kind) {
      case Piece::Kind::Text:
        text += piece.text;
        break;
      case Piece::Kind::File:
        text += "{{Param." + piece.text + "}}";
        break;
      case Piece::Kind::Value:
        text += "{{Task.Param." + piece.text + "}}";
        break;
    }
  }
  return text;
}

Json parameterOf(const JobFile& file) {
  constexpr const char* kFlows[] = {"IN", "OUT", "INOUT"};
  return {{"name", file.name},
          {"type", "PATH"},
          {"objectType", file.isFolder ? "DIRECTORY" : "FILE"},
          {"dataFlow", kFlows[static_cast<int>(file.flow)]}};
}

/// The step's tasks: the k-th has the k-th of each value.
Json parameterSpaceOf(const JobStep& step) {
  Json definitions = Json::array();
  std::string together;
  for (const TaskValue& value : step.values) {
    definitions.push_back({{"name", value.name}, {"type", value.isPath ? "PATH" : "STRING"}, {"range", value.values}});
    together += (together.empty() ? "(" : ", ") + value.name;
  }
  Json space = {{"taskParameterDefinitions", definitions}};
  if (step.values.size() > 1) {
    space["combination"] = together + ")";
  }
  return space;
}

Json stepOf(const JobStep& step) {
  Json words = Json::array();
  for (const Word& word : step.words) {
    words.push_back(textOf(word));
  }
  Json result = {{"name", step.name}};
  if (!step.after.empty()) {
    result["dependencies"] = Json::array({{{"dependsOn", step.after}}});
  }
  if (!step.values.empty()) {
    result["parameterSpace"] = parameterSpaceOf(step);
  }
  const Json run = {{"command", "{{Param." + std::string(kProgram) + "}}"}, {"args", words}};
  result["script"] = {{"actions", {{"onRun", run}}}};
  return result;
}

}  // namespace

std::vector<JobText> openJobDescription(const FarmJob& job) {
  Json definitions = Json::array({{{"name", kProgram},
                                   {"type", "STRING"},
                                   {"default", spectral::utf8(job.program.filename())},
                                   {"description", "The program, where a worker finds it"}}});
  Json values = {{kProgram, spectral::utf8(job.program)}};
  for (const JobFile& file : job.files) {
    definitions.push_back(parameterOf(file));
    values[file.name] = spectral::utf8(std::filesystem::absolute(file.path).lexically_normal());
  }
  Json steps = Json::array();
  for (const JobStep& step : job.steps) {
    steps.push_back(stepOf(step));
  }
  const Json document = {{"specificationVersion", "jobtemplate-2023-09"},
                         {"name", job.name},
                         {"description", job.description},
                         {"parameterDefinitions", definitions},
                         {"steps", steps}};
  Json bundle = Json::array();
  for (const auto& [name, value] : values.items()) {
    bundle.push_back({{"name", name}, {"value", value}});
  }
  return {{"template.json", document.dump(2) + "\n"},
          {"parameters.json", values.dump(2) + "\n"},
          {"parameter_values.json", Json{{"parameterValues", bundle}}.dump(2) + "\n"}};
}

}  // namespace metamer::farm
