// SPDX-License-Identifier: Apache-2.0
#include "effects/describe.h"

#include "effects/instance.h"
#include "host/colour_management.h"
#include "host/property_set.h"

namespace metamer::ofx {
namespace {

PropertySet propertiesOf(const HostSuites& host, OfxImageEffectHandle descriptor) {
  OfxPropertySetHandle handle = nullptr;
  check(host.effect->getPropertySet(descriptor, &handle), "getPropertySet");
  return {host, handle};
}

PropertySet defineClip(const HostSuites& host, OfxImageEffectHandle descriptor, const char* name,
                       const std::vector<std::string>& components) {
  OfxPropertySetHandle handle = nullptr;
  check(host.effect->clipDefine(descriptor, name, &handle), name);
  const PropertySet clip(host, handle);
  clip.setAll(kOfxImageEffectPropSupportedComponents, components);
  clip.trySet(kOfxImageEffectPropSupportsTiles, 1);
  clip.trySet(kOfxImageEffectPropTemporalClipAccess, 0);
  // Every pixel stands alone: fielded pictures are taken and given whole.
  clip.trySet(kOfxImageClipPropFieldExtraction, kOfxImageFieldBoth);
  return clip;
}

}  // namespace

void describe(const HostSuites& host, const Effect& effect, OfxImageEffectHandle descriptor, const Devices& devices) {
  const PropertySet properties = propertiesOf(host, descriptor);
  const Effect::Names& names = effect.names();
  properties.set(kOfxPropLabel, names.label);
  properties.trySet(kOfxPropShortLabel, names.label);
  properties.trySet(kOfxPropLongLabel, "metamer " + names.label);
  properties.set(kOfxImageEffectPluginPropGrouping, "metamer");
  properties.trySet(kOfxPropPluginDescription, names.description);
  properties.trySet(kOfxPropVersion, METAMER_VERSION_MAJOR, 0);
  properties.trySet(kOfxPropVersion, METAMER_VERSION_MINOR, 1);
  properties.trySet(kOfxPropVersionLabel, METAMER_VERSION);
  properties.setAll(kOfxImageEffectPropSupportedContexts,
                    {kOfxImageEffectContextFilter, kOfxImageEffectContextGeneral});
  // The best first: hosts may take the first that they have.
  std::vector<std::string> depths = {kOfxBitDepthFloat, kOfxBitDepthHalf, kOfxBitDepthShort, kOfxBitDepthByte};
  int index = 0;
  for (const std::string& depth : depths) {
    // Hosts from before OFX 1.4 may refuse to hear of half.
    index += properties.trySet(kOfxImageEffectPropSupportedPixelDepths, depth, index) ? 1 : 0;
  }
  properties.set(kOfxImageEffectPluginRenderThreadSafety, kOfxImageEffectRenderFullySafe);
  properties.trySet(kOfxImageEffectPluginPropHostFrameThreading, 0);
  properties.trySet(kOfxImageEffectPluginPropSingleInstance, 0);
  properties.trySet(kOfxImageEffectPropSupportsMultiResolution, 1);
  properties.trySet(kOfxImageEffectPropSupportsTiles, 1);
  properties.trySet(kOfxImageEffectPropTemporalClipAccess, 0);
  properties.trySet(kOfxImageEffectPluginPropFieldRenderTwiceAlways, 0);
  properties.trySet(kOfxImageEffectPropSupportsMultipleClipDepths, 1);
  properties.trySet(kOfxImageEffectPropSupportsMultipleClipPARs, 0);
  devices.describe(properties);
  declareColourManagement(host, descriptor);
}

void describeInContext(const HostSuites& host, const Effect& effect, OfxImageEffectHandle descriptor) {
  const std::vector<std::string> pictures = {kOfxImageComponentRGBA, kOfxImageComponentRGB, kOfxImageComponentAlpha};
  defineClip(host, descriptor, kOfxImageEffectSimpleSourceClipName, pictures);
  defineClip(host, descriptor, kOfxImageEffectOutputClipName, pictures);
  const PropertySet mask = defineClip(host, descriptor, kMaskClipName, {kOfxImageComponentAlpha});
  mask.set(kOfxImageClipPropOptional, 1);
  mask.trySet(kOfxImageClipPropIsMask, 1);
  declare(host, descriptor, effect.parameters());
}

}  // namespace metamer::ofx
