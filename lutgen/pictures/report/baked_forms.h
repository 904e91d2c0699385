// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apply/picture_space.h"
#include "metamer/ocio/certificate.h"
#include "metamer/ocio/config_source.h"
#include "metamer/sip/comparison.h"
#include "metamer/spectral/interruption.h"

namespace metamer::lutgen {

/// A folder for files that a command needs for a while: it and they go with this, and with a signal too.
class WorkFolder {
 public:
  /// @throws std::filesystem::filesystem_error
  WorkFolder();
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  /// Where a file of this name may be written.
  std::filesystem::path place(const std::string& name) const;
  /// Writes a file. @throws spectral::InputError (full disk)
  std::filesystem::path write(const std::string& name, std::string_view contents) const;

 private:
  std::filesystem::path m_path;
  std::optional<spectral::Unfinished> m_unfinished;
  mutable std::map<std::string, spectral::Unfinished> m_files;
};

/// A recipe as a file that other programs load.
struct BakedForm {
  std::string label;    ///< ".ctf (OpenColorIO)"
  std::string command;  ///< that makes the same file
  ocio::Certificate certificate;
  sip::Comparison comparison;  ///< against the recipe, as `lutgen compare` has it
  PixelFunction apply;         ///< on linear pixels of the recipe's space
};

/// The recipe as .ctf, certified in full, and as .cube.
/// @param progress  told the share of the work that is done, 0 ... 1
/// @throws spectral::InputError as ocio::bakeFile
std::vector<BakedForm> bakedForms(const sip::Recipe& recipe, const spectral::DataLibrary& library,
                                  const ocio::ConfigSource& config, const WorkFolder& folder,
                                  const std::function<void(double)>& progress);

}  // namespace metamer::lutgen
