// SPDX-License-Identifier: Apache-2.0
#include "host/parameter_values.h"

#include <utility>

#include "host/property_set.h"

namespace metamer::ofx {

ParameterValues::ParameterValues(const HostSuites& host, OfxImageEffectHandle instance,
                                 std::vector<Parameter> parameters)
    : m_host(&host), m_parameters(std::move(parameters)) {
  OfxParamSetHandle set = nullptr;
  check(host.effect->getParamSet(instance, &set), "getParamSet");
  const auto find = [&](const std::string& name) {
    OfxParamHandle found = nullptr;
    check(host.parameter->paramGetHandle(set, name.c_str(), &found, nullptr), name.c_str());
    m_handles[name] = found;
  };
  for (const Parameter& parameter : m_parameters) {
    if (parameter.kind != Parameter::Kind::Group) {
      find(parameter.name);
    }
    if (parameter.kind == Parameter::Kind::Menu) {
      find(menuMemory(parameter.name));
    }
  }
}

OfxParamHandle ParameterValues::handle(const std::string& name) const {
  return m_handles.at(name);
}

double ParameterValues::number(const std::string& name, double time) const {
  double value = 0;
  check(m_host->parameter->paramGetValueAtTime(handle(name), time, &value), name.c_str());
  return value;
}

bool ParameterValues::flag(const std::string& name, double time) const {
  int value = 0;
  check(m_host->parameter->paramGetValueAtTime(handle(name), time, &value), name.c_str());
  return value != 0;
}

std::string ParameterValues::text(const std::string& name, double time) const {
  char* value = nullptr;
  check(m_host->parameter->paramGetValueAtTime(handle(name), time, &value), name.c_str());
  return value == nullptr ? std::string() : std::string(value);
}

std::string ParameterValues::menu(const std::string& name, double time) const {
  std::string remembered = text(menuMemory(name), time);
  if (!remembered.empty()) {
    return remembered;
  }
  const Parameter& menu = *findMenu(name);
  const auto position = static_cast<std::size_t>(menuPosition(menu));
  return position < menu.options.size() ? menu.options[position] : menu.chosen;
}

void ParameterValues::restoreMenus() const {
  for (const Parameter& parameter : m_parameters) {
    if (parameter.kind == Parameter::Kind::Menu) {
      if (text(menuMemory(parameter.name), 0).empty()) {
        remember(parameter);
      } else {
        choose(parameter);
      }
    }
  }
}

void ParameterValues::followEdit(const std::string& edited) const {
  for (const Parameter& parameter : m_parameters) {
    if (parameter.kind == Parameter::Kind::Menu && parameter.name == edited) {
      remember(parameter);
    } else if (parameter.kind == Parameter::Kind::Menu && menuMemory(parameter.name) == edited) {
      choose(parameter);
    }
  }
}

void ParameterValues::enable(const std::string& name, bool isEnabled) const {
  OfxPropertySetHandle properties = nullptr;
  check(m_host->parameter->paramGetPropertySet(handle(name), &properties), name.c_str());
  PropertySet(*m_host, properties).trySet(kOfxParamPropEnabled, isEnabled ? 1 : 0);
}

const Parameter* ParameterValues::findMenu(const std::string& name) const {
  for (const Parameter& parameter : m_parameters) {
    if (parameter.kind == Parameter::Kind::Menu && parameter.name == name) {
      return &parameter;
    }
  }
  return nullptr;
}

int ParameterValues::menuPosition(const Parameter& menu) const {
  int position = 0;
  check(m_host->parameter->paramGetValue(handle(menu.name), &position), menu.name.c_str());
  return position;
}

/// Menu to memory.
void ParameterValues::remember(const Parameter& menu) const {
  const auto position = static_cast<std::size_t>(menuPosition(menu));
  if (position < menu.options.size()) {
    const std::string& option = menu.options[position];
    if (option != text(menuMemory(menu.name), 0)) {
      m_host->parameter->paramSetValue(handle(menuMemory(menu.name)), option.c_str());
    }
  }
}

/// Memory to menu; a name that is not in the list leaves the menu as it is, and is reported when it is looked up.
void ParameterValues::choose(const Parameter& menu) const {
  const int position = optionIndex(menu, text(menuMemory(menu.name), 0));
  if (position >= 0 && position != menuPosition(menu)) {
    m_host->parameter->paramSetValue(handle(menu.name), position);
  }
}

}  // namespace metamer::ofx
