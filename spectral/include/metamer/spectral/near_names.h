// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace metamer::spectral {

/// The names most like `given` (edit distance without regard to case, then containment), nearest first, at most `most`.
std::vector<std::string> nearNames(const std::string& given, const std::vector<std::string>& known,
                                   std::size_t most = 4);

/// "unknown; near names: FL11, FL1, FL12" as the remedy of an InputError.
std::string unknownNameRemedy(const std::string& given, const std::vector<std::string>& known,
                              const std::string& listCommand);

}  // namespace metamer::spectral
