// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace metamer::ocio {

/// A CTF file with the numbers of its tables (LUT1D, LUT3D) rounded to five digits behind the point and one space
/// between them: half the file. Chromaticities move by 5e-6 and amounts by 3e-4 of a stop at most, a hundredth of a
/// CIEDE2000. Everything else stays as it is.
std::string shortTables(const std::string& ctf);

}  // namespace metamer::ocio
