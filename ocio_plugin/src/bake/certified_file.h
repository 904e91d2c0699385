// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "metamer/ocio/certificate.h"
#include "metamer/spectral/pending_file.h"

namespace metamer::ocio {

/// A file and its certificate beside it, FILE.json, which appear together or not at all; a stream has none beside it.
class CertifiedFile {
 public:
  /// Before the work: what cannot be written is not worth it. @throws spectral::InputError as spectral::PendingFile
  explicit CertifiedFile(const std::filesystem::path& file);

  spectral::PendingFile& file() { return m_file; }
  /// @throws spectral::InputError as spectral::PendingFile
  void commit(const Certificate& certificate);

 private:
  spectral::PendingFile m_file;
  std::optional<spectral::PendingFile> m_certificate;
};

}  // namespace metamer::ocio
