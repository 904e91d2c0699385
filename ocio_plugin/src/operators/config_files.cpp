// SPDX-License-Identifier: Apache-2.0
#include "operators/config_files.h"

#include <filesystem>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "operators/lut_file.h"

namespace metamer::ocio {
namespace {

/// References stand in place of tables: a file that has them is small.
constexpr std::uintmax_t kMostReferring = 1U << 20U;

class FileCheck {
 public:
  FileCheck(const OCIO::Config& config, const std::string& where) : m_config(config), m_where(where) {}

  void visit(const OCIO::ConstTransformRcPtr& transform) const {
    if (!transform) {
      return;
    }
    if (const auto group = OCIO::DynamicPtrCast<const OCIO::GroupTransform>(transform)) {
      for (int k = 0; k < group->getNumTransforms(); ++k) {
        visit(group->getTransform(k));
      }
    } else if (const auto file = OCIO::DynamicPtrCast<const OCIO::FileTransform>(transform)) {
      check(file->getSrc());
    }
  }

 private:
  void check(const std::string& source) const {
    std::filesystem::path file;
    try {
      file = spectral::pathOf(m_config.getCurrentContext()->resolveFileLocation(source.c_str()));
    } catch (const OCIO::Exception&) {
      return;  // it is not there: whoever needs it says so
    }
    std::error_code none;
    if (!std::filesystem::exists(file, none)) {
      return;  // within an archive
    }
    if (!std::filesystem::is_regular_file(file, none)) {
      throw spectral::InputError(m_where, "src", source, "is a device, pipe or folder; name a LUT file");
    }
    if (std::filesystem::file_size(file, none) <= kMostReferring) {
      refuseOddLut(file);
    }
  }

  const OCIO::Config& m_config;
  const std::string& m_where;
};

}  // namespace

void refuseEndlessFiles(const OCIO::Config& config, const std::string& where) {
  const FileCheck files(config, where);
  const int spaces = config.getNumColorSpaces(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL);
  for (int k = 0; k < spaces; ++k) {
    const auto space = config.getColorSpace(
        config.getColorSpaceNameByIndex(OCIO::SEARCH_REFERENCE_SPACE_ALL, OCIO::COLORSPACE_ALL, k));
    files.visit(space->getTransform(OCIO::COLORSPACE_DIR_TO_REFERENCE));
    files.visit(space->getTransform(OCIO::COLORSPACE_DIR_FROM_REFERENCE));
  }
  for (int k = 0; k < config.getNumLooks(); ++k) {
    const auto look = config.getLook(config.getLookNameByIndex(k));
    files.visit(look->getTransform());
    files.visit(look->getInverseTransform());
  }
  for (int k = 0; k < config.getNumViewTransforms(); ++k) {
    const auto view = config.getViewTransform(config.getViewTransformNameByIndex(k));
    files.visit(view->getTransform(OCIO::VIEWTRANSFORM_DIR_TO_REFERENCE));
    files.visit(view->getTransform(OCIO::VIEWTRANSFORM_DIR_FROM_REFERENCE));
  }
  const int named = config.getNumNamedTransforms(OCIO::NAMEDTRANSFORM_ALL);
  for (int k = 0; k < named; ++k) {
    const auto transform = config.getNamedTransform(config.getNamedTransformNameByIndex(OCIO::NAMEDTRANSFORM_ALL, k));
    files.visit(transform->getTransform(OCIO::TRANSFORM_DIR_FORWARD));
    files.visit(transform->getTransform(OCIO::TRANSFORM_DIR_INVERSE));
  }
}

}  // namespace metamer::ocio
