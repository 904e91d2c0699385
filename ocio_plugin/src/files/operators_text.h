// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <string>

namespace metamer::ocio {

namespace OCIO = OCIO_NAMESPACE;

/// A group as text of a format for operators ("Color Transform Format", "Academy/ASC Common LUT Format"), as
/// OpenColorIO writes it, byte for byte. The entries of 3-D tables are set here: OpenColorIO takes ten times as long
/// over them, nearly half of what a bake of the widest table takes in all.
/// @throws OCIO::Exception where the format cannot hold the group
std::string operatorsText(const OCIO::ConstGroupTransformRcPtr& group, const std::string& formatName);

}  // namespace metamer::ocio
