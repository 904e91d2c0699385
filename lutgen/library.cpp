// SPDX-License-Identifier: Apache-2.0
#include "library.h"

#include "exr_channels.h"

namespace metamer::lutgen {

spectral::DataLibrary openLibrary() {
  return spectral::DataLibrary::openDefault(spectral::readExrChannels);
}

}  // namespace metamer::lutgen
