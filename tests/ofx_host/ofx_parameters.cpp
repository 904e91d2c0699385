// SPDX-License-Identifier: Apache-2.0
// Prints what the bundle declares to a host, as JSON: script/ofx_parameters.py makes the manual's table of it.
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>

#include "bare_host.h"

namespace {

using bare_host::Effect;
using bare_host::Parameter;
using nlohmann::ordered_json;

ordered_json described(const Parameter& parameter) {
  const auto& properties = parameter.properties;
  ordered_json json = {{"name", parameter.name},
                       {"type", parameter.type},
                       {"label", properties.text(kOfxPropLabel)},
                       {"hint", properties.text(kOfxParamPropHint)},
                       {"group", properties.text(kOfxParamPropParent)},
                       {"secret", properties.integer(kOfxParamPropSecret) != 0},
                       {"animates", properties.integer(kOfxParamPropAnimates) != 0}};
  if (parameter.type == kOfxParamTypeDouble) {
    json["default"] = properties.number(kOfxParamPropDefault);
    json["range"] = {properties.number(kOfxParamPropMin), properties.number(kOfxParamPropMax)};
    json["shown"] = {properties.number(kOfxParamPropDisplayMin), properties.number(kOfxParamPropDisplayMax)};
  } else if (parameter.type == kOfxParamTypeBoolean) {
    json["default"] = properties.integer(kOfxParamPropDefault) != 0;
  } else if (parameter.type == kOfxParamTypeChoice) {
    json["options"] = properties.texts(kOfxParamPropChoiceOption);
    json["default"] = properties.text(kOfxParamPropChoiceOption, properties.integer(kOfxParamPropDefault));
  }
  return json;
}

}  // namespace

int main() {
  try {
    const bare_host::Host host(bare_host::builtLibrary());
    ordered_json effects = ordered_json::array();
    for (int i = 0; i < host.pluginCount(); ++i) {
      const auto descriptor = host.describe(i, kOfxImageEffectContextFilter);
      ordered_json parameters = ordered_json::array();
      for (const std::string& name : descriptor->parameterOrder) {
        parameters.push_back(described(*descriptor->parameters.at(name)));
      }
      effects.push_back({{"identifier", host.plugin(i).pluginIdentifier},
                         {"label", descriptor->properties.text(kOfxPropLabel)},
                         {"description", descriptor->properties.text(kOfxPropPluginDescription)},
                         {"parameters", parameters}});
      host.act(i, kOfxActionUnload, nullptr, nullptr, nullptr);
    }
    std::cout << effects.dump(1) << "\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
