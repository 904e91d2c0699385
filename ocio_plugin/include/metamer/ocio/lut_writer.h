// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <filesystem>
#include <string>
#include <vector>

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// A LUT file format that can be written.
struct LutFormat {
  enum class Content {
    Operators,  ///< a group of operators, as it is: linear pixels keep their range
    Cube,       ///< a 3-D table over 0 ... 1: log signal in and out
    Curves,     ///< a curve a channel over 0 ... 1: only what leaves channels apart
  };
  std::string name;       ///< OCIO's
  std::string extension;  ///< with its dot
  std::string use;        ///< one line for a list
  Content content = Content::Cube;
  bool holdsNegatives = true;     ///< false: whole numbers, which clip at 0
  bool holdsShaperCurve = false;  ///< whether a curve may stand in front of a log cube's table
};

/// All that OCIO's group writer and baker know, the one that an extension picks first among those that share it.
const std::vector<LutFormat>& lutFormats();

/// The format of a file by `formatName` (OCIO's name, or an extension without its dot), or by the file's extension
/// where that is empty.
/// @throws spectral::InputError: unknown (all listed), or a name whose extension is not the file's
const LutFormat& lutFormat(const std::filesystem::path& file, const std::string& formatName);

/// The format of a name alone. @throws spectral::InputError: unknown (all listed)
const LutFormat& lutFormatNamed(const std::string& formatName);

/// What a file says about itself, where the format has a place for it.
struct LutDescription {
  std::string name;                ///< one line
  std::string id;                  ///< the same for the same contents
  std::vector<std::string> lines;  ///< comments or descriptions, one line each
};

inline constexpr int kFewestCurveEntries = 2;
inline constexpr int kMostCurveEntries = 65536;

/// A group of operators as the text of a file.
/// @param size        nodes along a side where the format holds a table, kSmallestTable ... kLargestTable (log_cube.h)
/// @param shaperSize  entries of a curve in front of the table that the format itself asks for, or of Content::Curves;
///                    kFewestCurveEntries ... kMostCurveEntries, or 0: its usual number
/// @throws spectral::InputError outside these, and where the group cannot be written in this format
std::string lutText(const LutFormat& format, const OCIO::ConstGroupTransformRcPtr& group, int size,
                    const LutDescription& description, int shaperSize = 0);

}  // namespace metamer::ocio
