// SPDX-License-Identifier: Apache-2.0
#include "host/parameter.h"

#include <algorithm>

#include "host/property_set.h"

namespace metamer::ofx {
namespace {

const char* typeOf(Parameter::Kind kind) {
  switch (kind) {
    case Parameter::Kind::Group:
      return kOfxParamTypeGroup;
    case Parameter::Kind::Number:
      return kOfxParamTypeDouble;
    case Parameter::Kind::Flag:
      return kOfxParamTypeBoolean;
    case Parameter::Kind::Menu:
      return kOfxParamTypeChoice;
    case Parameter::Kind::Text:
    case Parameter::Kind::File:
      return kOfxParamTypeString;
  }
  return kOfxParamTypeString;
}

void setValues(const PropertySet& properties, const Parameter& parameter) {
  switch (parameter.kind) {
    case Parameter::Kind::Group:
      properties.trySet(kOfxParamPropGroupOpen, parameter.isOpen ? 1 : 0);
      return;
    case Parameter::Kind::Number:
      properties.set(kOfxParamPropDoubleType, kOfxParamDoubleTypePlain);
      properties.set(kOfxParamPropDefault, parameter.value);
      properties.set(kOfxParamPropMin, parameter.least);
      properties.set(kOfxParamPropMax, parameter.most);
      properties.set(kOfxParamPropDisplayMin, parameter.leastShown);
      properties.set(kOfxParamPropDisplayMax, parameter.mostShown);
      return;
    case Parameter::Kind::Flag:
      properties.set(kOfxParamPropDefault, parameter.value != 0 ? 1 : 0);
      return;
    case Parameter::Kind::Menu:
      properties.setAll(kOfxParamPropChoiceOption, parameter.options);
      properties.set(kOfxParamPropDefault, std::max(0, optionIndex(parameter, parameter.chosen)));
      return;
    case Parameter::Kind::Text:
      properties.set(kOfxParamPropStringMode, kOfxParamStringIsSingleLine);
      return;
    case Parameter::Kind::File:
      properties.set(kOfxParamPropStringMode, kOfxParamStringIsFilePath);
      properties.trySet(kOfxParamPropStringFilePathExists, 1);
      return;
  }
}

void declareOne(const HostSuites& host, OfxParamSetHandle set, const Parameter& parameter) {
  OfxPropertySetHandle handle = nullptr;
  check(host.parameter->paramDefine(set, typeOf(parameter.kind), parameter.name.c_str(), &handle),
        parameter.name.c_str());
  const PropertySet properties(host, handle);
  properties.set(kOfxPropLabel, parameter.label);
  properties.trySet(kOfxParamPropScriptName, parameter.name);
  properties.trySet(kOfxParamPropHint, parameter.hint);
  properties.trySet(kOfxParamPropSecret, parameter.isSecret ? 1 : 0);
  if (!parameter.group.empty()) {
    properties.trySet(kOfxParamPropParent, parameter.group);
  }
  if (parameter.kind != Parameter::Kind::Group) {
    properties.trySet(kOfxParamPropAnimates, parameter.animates ? 1 : 0);
  }
  setValues(properties, parameter);
}

}  // namespace

std::string menuMemory(const std::string& menu) {
  return menu + "Name";
}

int optionIndex(const Parameter& menu, const std::string& option) {
  const auto place = std::find(menu.options.begin(), menu.options.end(), option);
  return place == menu.options.end() ? -1 : static_cast<int>(place - menu.options.begin());
}

void declare(const HostSuites& host, OfxImageEffectHandle descriptor, const std::vector<Parameter>& parameters) {
  OfxParamSetHandle set = nullptr;
  check(host.effect->getParamSet(descriptor, &set), "getParamSet");
  for (const Parameter& parameter : parameters) {
    declareOne(host, set, parameter);
    if (parameter.kind == Parameter::Kind::Menu) {
      Parameter memory;
      memory.kind = Parameter::Kind::Text;
      memory.name = menuMemory(parameter.name);
      memory.label = parameter.label + ", name";
      memory.hint = "The menu's choice by name.";
      memory.group = parameter.group;
      memory.isSecret = true;
      declareOne(host, set, memory);
    }
  }
}

}  // namespace metamer::ofx
