// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/spectral/pending_file.h"

namespace metamer::ocio {

using spectral::PendingFile;

}  // namespace metamer::ocio
