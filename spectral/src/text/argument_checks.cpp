// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/argument_checks.h"

#include <cmath>
#include <string>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {

void requireWithin(const char* field, double value, double low, double high) {
  if (!(value >= low && value <= high)) {
    throw InputError("", field, numberText(value), "must be from " + numberText(low) + " to " + numberText(high));
  }
}

void requireAbove(const char* field, double value, double bound) {
  if (!(value > bound) || !std::isfinite(value)) {
    throw InputError("", field, numberText(value), "must be above " + numberText(bound));
  }
}

void requireAsMany(const char* field, std::int64_t count, const char* wantedField, std::int64_t wanted) {
  if (count != wanted) {
    throw InputError("", field, std::to_string(count),
                     std::string("must be as many as ") + wantedField + ", " + std::to_string(wanted));
  }
}

void requirePixels(std::int64_t count) {
  if (count % 4 != 0) {
    throw InputError("", "pixels", std::to_string(count), "give four numbers per pixel");
  }
}

}  // namespace metamer::spectral
