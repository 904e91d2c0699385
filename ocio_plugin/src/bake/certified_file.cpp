// SPDX-License-Identifier: Apache-2.0
#include "bake/certified_file.h"

#include "metamer/spectral/path_text.h"

namespace metamer::ocio {

CertifiedFile::CertifiedFile(const std::filesystem::path& file) : m_file(file) {
  if (!m_file.isStream()) {
    m_certificate.emplace(spectral::pathOf(spectral::utf8(file) + ".json"));
  }
}

void CertifiedFile::commit(const Certificate& certificate) {
  if (!m_certificate) {
    m_file.commit();
    return;
  }
  m_certificate->write(certificate.json());
  spectral::commitAll({&m_file, &*m_certificate});
}

}  // namespace metamer::ocio
