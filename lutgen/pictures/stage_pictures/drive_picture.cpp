// SPDX-License-Identifier: Apache-2.0
#include "stage_pictures/drive_picture.h"

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"

namespace metamer::lutgen {

using spectral::InputError;

DrivePicture::DrivePicture(const std::filesystem::path& file, const stage::LatLong& layout,
                           const std::vector<std::string>& channels)
    : m_pending(file), m_output(OIIO::ImageOutput::create(spectral::utf8(m_pending.path()))) {
  if (!m_output) {
    throw InputError(spectral::utf8(file), "output", "", "cannot be written: " + OIIO::geterror());
  }
  OIIO::ImageSpec spec(layout.width, layout.height, static_cast<int>(channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = channels;
  spec.attribute("compression", "zips");
  spec.attribute("ImageDescription", "drives of emitters, one channel each, for a lat-long environment");
  if (!m_output->open(spectral::utf8(m_pending.path()), spec)) {
    throw InputError(spectral::utf8(file), "output", "", "cannot be written: " + m_output->geterror());
  }
}

void DrivePicture::write(int first, int count, const std::vector<float>& drives) {
  if (!m_output->write_scanlines(first, first + count, 0, OIIO::TypeDesc::FLOAT, drives.data())) {
    throw InputError(spectral::utf8(m_pending.target()), "output", "", "cannot be written: " + m_output->geterror());
  }
}

void DrivePicture::close() {
  if (!m_output->close()) {
    throw InputError(spectral::utf8(m_pending.target()), "output", "", "cannot be written: " + m_output->geterror());
  }
  m_pending.commit();
}

}  // namespace metamer::lutgen
