// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace metamer::sip {

/// A file of text/ by its name, "map.body"; it lies in the program. Empty where there is none.
std::string_view deviceTextPart(std::string_view name);

}  // namespace metamer::sip
