// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/host.h"

namespace metamer::ofx {

/// One parameter of an effect, as it is declared to hosts and printed in docs/ofx.md. Names are part of users'
/// projects: they are never changed or given another meaning.
struct Parameter {
  enum class Kind {
    Group,   ///< folds the parameters that name it as their group
    Number,  ///< double
    Flag,    ///< boolean
    Text,    ///< one line
    File,    ///< path of a file
    Menu,    ///< choice; a hidden text parameter (menuMemory) holds the chosen name
  };
  Kind kind = Kind::Number;
  std::string name;
  std::string label;
  std::string hint;
  std::string group;  ///< empty: at the top
  bool animates = false;
  bool isSecret = false;
  bool isOpen = true;  ///< of a Group
  double value = 0;    ///< default of a Number or Flag
  double least = 0;    ///< range of a Number
  double most = 1;
  double leastShown = 0;  ///< range of its slider
  double mostShown = 1;
  std::vector<std::string> options;  ///< of a Menu
  std::string chosen;                ///< default of a Menu, one of its options
};

/// Name of the hidden text parameter beside a menu. Menus hold a number, and lists grow: what counts is the name.
std::string menuMemory(const std::string& menu);

/// Position of a name in a menu, -1 where it is not there.
int optionIndex(const Parameter& menu, const std::string& option);

/// Declares them in this order to a descriptor, each menu with its memory.
/// @throws HostError
void declare(const HostSuites& host, OfxImageEffectHandle descriptor, const std::vector<Parameter>& parameters);

}  // namespace metamer::ofx
