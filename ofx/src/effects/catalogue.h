// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral/data_library.h"

namespace metamer::ofx {

/// The measured tables of the bundle, and the names for the menus. Safe to share between threads.
class Catalogue {
 public:
  /// Opens Contents/Resources/data of the bundle that holds this library. Where it is missing or damaged the menus
  /// have their defaults alone, and library() says why.
  static Catalogue ofThisBundle();

  /// @throws spectral::InputError where the bundle's tables cannot be read
  const spectral::DataLibrary& library() const;
  /// A working space by name, without regard to case. @throws spectral::InputError (near names listed)
  spectral::ColourSpace space(const std::string& name) const;

  std::vector<std::string> illuminants;
  std::vector<std::string> observers;
  std::vector<std::string> filters;
  std::vector<std::string> reflectanceSets;
  std::vector<std::string> spaces;

 private:
  std::optional<spectral::DataLibrary> m_library;
  std::vector<spectral::ColourSpace> m_spaces;
  std::string m_problem;
};

}  // namespace metamer::ofx
