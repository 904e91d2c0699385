// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace metamer::lutgen {

/// A file of lutgen/pictures/report/page, built into the program: "page.html", "coffee.jpg". Empty for other names.
std::string_view pagePart(std::string_view name);

}  // namespace metamer::lutgen
