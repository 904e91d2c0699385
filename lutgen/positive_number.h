// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace metamer::lutgen {

/// An option's number above 0. CLI11's own check prints the ends of its range in full: the largest has 309 digits.
CLI::Validator positiveNumber();

}  // namespace metamer::lutgen
