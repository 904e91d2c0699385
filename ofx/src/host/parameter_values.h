// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "host/host.h"
#include "host/parameter.h"

namespace metamer::ofx {

/// The parameters of one instance: values as the host holds them.
class ParameterValues {
 public:
  /// @throws HostError where the host does not know a parameter
  ParameterValues(const HostSuites& host, OfxImageEffectHandle instance, std::vector<Parameter> parameters);

  /// Values at a time, in the host's frames. @throws HostError
  double number(const std::string& name, double time) const;
  bool flag(const std::string& name, double time) const;
  std::string text(const std::string& name, double time) const;
  /// What a menu has chosen, by name: what its memory holds, else the option at its position.
  std::string menu(const std::string& name, double time) const;

  /// Brings menus and memories together. At creation the memory decides (a project may come from a release with other
  /// lists); after a user's edit, what was edited.
  void restoreMenus() const;
  void followEdit(const std::string& edited) const;

  /// Greys a parameter out, or not.
  void enable(const std::string& name, bool isEnabled) const;

 private:
  OfxParamHandle handle(const std::string& name) const;
  const Parameter* findMenu(const std::string& name) const;
  int menuPosition(const Parameter& menu) const;
  void remember(const Parameter& menu) const;
  void choose(const Parameter& menu) const;

  const HostSuites* m_host;
  std::vector<Parameter> m_parameters;
  std::map<std::string, OfxParamHandle> m_handles;
};

}  // namespace metamer::ofx
