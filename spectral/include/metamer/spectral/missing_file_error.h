// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/spectral/input_error.h"

namespace metamer::spectral {

/// A file that is asked for and is not there.
class MissingFileError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace metamer::spectral
