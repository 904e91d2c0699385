// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host/host.h"
#include "host/property_set.h"

// OFX 1.5's colour management, which the 1.4 headers do not declare (ofxColour.h of OpenFX 1.5).
#ifndef kOfxImageEffectPropColourManagementStyle
#define kOfxImageEffectPropColourManagementStyle "OfxImageEffectPropColourManagementStyle"
#define kOfxImageEffectColourManagementNone "OfxImageEffectColourManagementNone"
#define kOfxImageEffectColourManagementFull "OfxImageEffectColourManagementFull"
#define kOfxImageEffectPropColourManagementAvailableConfigs "OfxImageEffectPropColourManagementAvailableConfigs"
#define kOfxImageClipPropColourspace "OfxImageClipPropColourspace"
#define kOfxImageClipPropPreferredColourspaces "OfxImageClipPropPreferredColourspaces"
#define kOfxImageEffectActionGetOutputColourspace "OfxImageEffectActionGetOutputColourspace"
#endif

namespace metamer::ofx {

/// Whether the host says which colour space its clips have.
bool offersColourManagement(const HostSuites& host);

/// To the descriptor of an effect: native colour spaces are understood.
void declareColourManagement(const HostSuites& host, OfxImageEffectHandle descriptor);

/// Our name of the colour space that the host gives a clip; nothing where it gives none, or one that is not a scene
/// space of ours.
std::optional<std::string> negotiatedSpace(const HostSuites& host, OfxImageClipHandle clip);

/// The spaces to ask for, in OFX's names: `preferred` (one of ours) first, then the others, the generic one last.
std::vector<std::string> preferredSpaces(const std::string& preferred);

}  // namespace metamer::ofx
