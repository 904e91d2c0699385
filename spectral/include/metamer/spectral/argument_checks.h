// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace metamer::spectral {

// What public functions ask of their arguments. Each check is once a call, never once a pixel.

/// A number from `low` to `high`, both included; a NaN is outside.
/// @throws InputError "FIELD 'VALUE': must be from LOW to HIGH"
void requireWithin(const char* field, double value, double low, double high);

/// A finite number above `bound`.
/// @throws InputError "FIELD 'VALUE': must be above BOUND"
void requireAbove(const char* field, double value, double bound);

/// As many of one as of another.
/// @throws InputError "FIELD 'COUNT': must be as many as WANTED_FIELD, WANTED"
void requireAsMany(const char* field, std::int64_t count, const char* wantedField, std::int64_t wanted);

/// Values of whole RGBA pixels.
/// @throws InputError "pixels 'COUNT': give four numbers per pixel"
void requirePixels(std::int64_t count);

}  // namespace metamer::spectral
