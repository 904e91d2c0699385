// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "host/parameter.h"

// Short spellings for the tables of parameters.
namespace metamer::ofx {

inline Parameter makeGroup(std::string name, std::string label, bool isOpen) {
  Parameter parameter;
  parameter.kind = Parameter::Kind::Group;
  parameter.name = std::move(name);
  parameter.label = std::move(label);
  parameter.isOpen = isOpen;
  return parameter;
}

/// A number that animates.
inline Parameter makeNumber(std::string name, std::string label, std::string group, double value,
                            std::pair<double, double> range, std::pair<double, double> shown, std::string hint) {
  Parameter parameter;
  parameter.kind = Parameter::Kind::Number;
  parameter.name = std::move(name);
  parameter.label = std::move(label);
  parameter.group = std::move(group);
  parameter.hint = std::move(hint);
  parameter.animates = true;
  parameter.value = value;
  parameter.least = range.first;
  parameter.most = range.second;
  parameter.leastShown = shown.first;
  parameter.mostShown = shown.second;
  return parameter;
}

inline Parameter makeFlag(std::string name, std::string label, std::string group, bool value, bool animates,
                          std::string hint) {
  Parameter parameter;
  parameter.kind = Parameter::Kind::Flag;
  parameter.name = std::move(name);
  parameter.label = std::move(label);
  parameter.group = std::move(group);
  parameter.hint = std::move(hint);
  parameter.animates = animates;
  parameter.value = value ? 1 : 0;
  return parameter;
}

inline Parameter makeMenu(std::string name, std::string label, std::string group, std::vector<std::string> options,
                          std::string chosen, std::string hint) {
  Parameter parameter;
  parameter.kind = Parameter::Kind::Menu;
  parameter.name = std::move(name);
  parameter.label = std::move(label);
  parameter.group = std::move(group);
  parameter.hint = std::move(hint);
  parameter.options = std::move(options);
  parameter.chosen = std::move(chosen);
  return parameter;
}

inline Parameter makeFile(std::string name, std::string label, std::string group, std::string hint) {
  Parameter parameter;
  parameter.kind = Parameter::Kind::File;
  parameter.name = std::move(name);
  parameter.label = std::move(label);
  parameter.group = std::move(group);
  parameter.hint = std::move(hint);
  return parameter;
}

}  // namespace metamer::ofx
