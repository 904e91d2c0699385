// SPDX-License-Identifier: Apache-2.0
// The bundle's C door: three functions, and one action entry for each effect. Nothing is thrown through it.
#if defined(__GNUC__)
#pragma GCC visibility push(default)  // for the three functions that it declares
#endif
#include <ofxCore.h>
#if defined(__GNUC__)
#pragma GCC visibility pop
#endif
#include <ofxImageEffect.h>

#include <array>
#include <memory>
#include <mutex>
#include <new>
#include <string_view>

#include "effects/actions.h"

namespace {

using namespace metamer::ofx;

/// The C interface has no place for state but this: the host, and what is loaded while effects are.
struct Loaded {
  std::mutex mutex;
  const OfxHost* host = nullptr;
  int effects = 0;  ///< loaded
  std::shared_ptr<Plugin> plugin;
};

Loaded& loaded() {
  static Loaded instance;
  return instance;
}

/// Hosts differ in whether they describe before or after they load: whatever comes first makes it.
std::shared_ptr<Plugin> plugin() {
  Loaded& state = loaded();
  const std::lock_guard lock(state.mutex);
  if (!state.plugin) {
    state.plugin = std::make_shared<Plugin>(state.host);
  }
  return state.plugin;
}

OfxStatus load() {
  plugin();
  const std::lock_guard lock(loaded().mutex);
  ++loaded().effects;
  return kOfxStatOK;
}

OfxStatus unload() {
  Loaded& state = loaded();
  const std::lock_guard lock(state.mutex);
  if (state.effects > 0 && --state.effects == 0) {
    state.plugin.reset();
  }
  return kOfxStatOK;
}

OfxStatus enter(std::size_t index, const char* action, const void* handle, OfxPropertySetHandle inArguments,
                OfxPropertySetHandle outArguments) noexcept {
  try {
    if (action == nullptr) {
      return kOfxStatErrBadHandle;
    }
    if (std::string_view(action) == kOfxActionLoad) {
      return load();
    }
    if (std::string_view(action) == kOfxActionUnload) {
      return unload();
    }
    const std::shared_ptr<Plugin> current = plugin();
    // The interface hands effects out as constant; they are the host's own.
    auto* effect = static_cast<OfxImageEffectHandle>(const_cast<void*>(handle));
    return perform(*current, index, action, effect, inArguments, outArguments);
  } catch (const HostError& error) {
    return error.status();
  } catch (const std::bad_alloc&) {
    return kOfxStatErrMemory;
  } catch (...) {
    return kOfxStatFailed;
  }
}

void setHost(OfxHost* host) {
  const std::lock_guard lock(loaded().mutex);
  loaded().host = host;
}

template <std::size_t kIndex>
OfxStatus enterEffect(const char* action, const void* handle, OfxPropertySetHandle inArguments,
                      OfxPropertySetHandle outArguments) {
  return enter(kIndex, action, handle, inArguments, outArguments);
}

constexpr int kEffectMajorVersion = 1;
constexpr int kEffectMinorVersion = 0;

template <std::size_t kIndex>
OfxPlugin describedAs(const char* identifier) {
  return {kOfxImageEffectPluginApi,
          kOfxImageEffectPluginApiVersion,
          identifier,
          kEffectMajorVersion,
          kEffectMinorVersion,
          setHost,
          enterEffect<kIndex>};
}

}  // namespace

int OfxGetNumberOfPlugins() {
  return kEffectCount;
}

OfxPlugin* OfxGetPlugin(int index) {
  static std::array<OfxPlugin, kEffectCount> plugins = {describedAs<0>("org.metamer.SpectralTransfer"),
                                                        describedAs<1>("org.metamer.LEDStage"),
                                                        describedAs<2>("org.metamer.Skin")};
  return index >= 0 && index < kEffectCount ? &plugins[static_cast<std::size_t>(index)] : nullptr;
}

/// OFX 1.4's early way to hand over the host; older hosts use each plug-in's setHost.
OfxStatus OfxSetHost(const OfxHost* host) {
  const std::lock_guard lock(loaded().mutex);
  loaded().host = host;
  return kOfxStatOK;
}
