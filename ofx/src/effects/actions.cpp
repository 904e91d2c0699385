// SPDX-License-Identifier: Apache-2.0
#include "effects/actions.h"

#include <memory>
#include <new>
#include <string_view>

#include "effects/describe.h"
#include "effects/instance.h"
#include "host/colour_management.h"
#include "host/property_set.h"

namespace metamer::ofx {
namespace {

PropertySet instanceProperties(const HostSuites& host, OfxImageEffectHandle handle) {
  OfxPropertySetHandle properties = nullptr;
  check(host.effect->getPropertySet(handle, &properties), "getPropertySet");
  return {host, properties};
}

Instance& instanceOf(const HostSuites& host, OfxImageEffectHandle handle) {
  void* data = instanceProperties(host, handle).getPointer(kOfxPropInstanceData);
  if (data == nullptr) {
    throw HostError(kOfxStatErrBadHandle, "an instance that was not created");
  }
  return *static_cast<Instance*>(data);
}

/// Runs an action; what goes wrong is told to the user as well as to the host.
template <typename Action>
auto onInstance(const HostSuites& host, OfxImageEffectHandle handle, Action action) {
  Instance& instance = instanceOf(host, handle);
  try {
    return action(instance);
  } catch (const HostError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    instance.messages().show(error.what());
    throw;
  }
}

OfxStatus createInstance(const Plugin& plugin, const Effect& effect, OfxImageEffectHandle handle) {
  auto instance = std::make_unique<Instance>(plugin.host(), effect, handle, plugin.devices());
  instanceProperties(plugin.host(), handle).setPointer(kOfxPropInstanceData, instance.get());
  instance.release();  // until destroyInstance
  return kOfxStatOK;
}

OfxStatus destroyInstance(const HostSuites& host, OfxImageEffectHandle handle) {
  const PropertySet properties = instanceProperties(host, handle);
  const std::unique_ptr<Instance> instance(static_cast<Instance*>(properties.getPointer(kOfxPropInstanceData)));
  properties.setPointer(kOfxPropInstanceData, nullptr);
  return kOfxStatOK;
}

OfxStatus isIdentity(const HostSuites& host, OfxImageEffectHandle handle, const PropertySet& in,
                     const PropertySet& out) {
  if (!onInstance(host, handle, [&](Instance& instance) { return instance.isIdentity(in); })) {
    return kOfxStatReplyDefault;
  }
  out.set(kOfxPropName, kOfxImageEffectSimpleSourceClipName);
  out.set(kOfxPropTime, in.getDouble(kOfxPropTime));
  return kOfxStatOK;
}

}  // namespace

OfxStatus perform(const Plugin& plugin, std::size_t index, const char* action, OfxImageEffectHandle handle,
                  OfxPropertySetHandle inArguments, OfxPropertySetHandle outArguments) {
  const HostSuites& host = plugin.host();
  const Effect& effect = plugin.effect(index);
  const std::string_view name(action);
  const PropertySet in(host, inArguments);
  const PropertySet out(host, outArguments);
  if (name == kOfxActionDescribe) {
    describe(host, effect, handle, plugin.devices());
  } else if (name == kOfxImageEffectActionDescribeInContext) {
    describeInContext(host, effect, handle);
  } else if (name == kOfxActionCreateInstance) {
    return createInstance(plugin, effect, handle);
  } else if (name == kOfxActionDestroyInstance) {
    return destroyInstance(host, handle);
  } else if (name == kOfxActionInstanceChanged) {
    onInstance(host, handle, [&](Instance& instance) { instance.instanceChanged(in); });
  } else if (name == kOfxImageEffectActionGetClipPreferences) {
    onInstance(host, handle, [&](Instance& instance) { instance.clipPreferences(out); });
  } else if (name == kOfxImageEffectActionIsIdentity) {
    return isIdentity(host, handle, in, out);
  } else if (name == kOfxImageEffectActionRender) {
    onInstance(host, handle, [&](Instance& instance) { instance.render(in); });
  } else if (name == kOfxImageEffectActionGetOutputColourspace) {
    out.set(kOfxImageClipPropColourspace, std::string("OfxColourspace_") + kOfxImageEffectSimpleSourceClipName);
  } else {
    return kOfxStatReplyDefault;
  }
  return kOfxStatOK;
}

}  // namespace metamer::ofx
