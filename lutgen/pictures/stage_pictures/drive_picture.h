// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "metamer/spectral/pending_file.h"
#include "metamer/stage/stage_geometry.h"

namespace metamer::lutgen {

/// A picture of drives, one channel an emitter, written row by row; it appears whole or not at all.
class DrivePicture {
 public:
  /// @throws spectral::InputError where it cannot be written
  DrivePicture(const std::filesystem::path& file, const stage::LatLong& layout,
               const std::vector<std::string>& channels);

  /// @param drives  interleaved, rows first ... first + count - 1, in order
  void write(int first, int count, const std::vector<float>& drives);
  void close();

 private:
  spectral::PendingFile m_pending;
  std::unique_ptr<OIIO::ImageOutput> m_output;
};

}  // namespace metamer::lutgen
