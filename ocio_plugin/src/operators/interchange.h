// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace metamer::ocio {

/// The role by which configs say which of their spaces is ACES2065-1, and that space's name in metamer.
inline constexpr const char* kInterchangeRole = "aces_interchange";
inline constexpr const char* kInterchangeSpace = "ACES2065-1";

}  // namespace metamer::ocio
