// SPDX-License-Identifier: Apache-2.0
#include "drivers/devices.h"

#include <array>

#include "drivers/cuda_interface.h"
#include "drivers/metal_interface.h"
#include "drivers/opencl_interface.h"
#include "host/device_properties.h"

namespace metamer::ofx {
namespace {

/// What hosts and the environment call an interface.
struct Door {
  const char* supported;  ///< of hosts and effects: "true"
  const char* enabled;    ///< of a render: 1 where images lie there
  const char* queue;      ///< of a render
  bool hasQueueAlways;
  const char* alsoSupported;  ///< of effects; null: nothing more
  const char* variable;       ///< METAMER_OFX_...
  std::unique_ptr<DeviceInterface> (*load)(const char* variable);
};

constexpr std::array kDoors = {
    Door{kOfxImageEffectPropOpenCLRenderSupported, kOfxImageEffectPropOpenCLEnabled,
         kOfxImageEffectPropOpenCLCommandQueue, true, nullptr, "METAMER_OFX_OPENCL", loadOpenCl},
    // Hosts without streams give none: the default one is theirs.
    Door{kOfxImageEffectPropCudaRenderSupported, kOfxImageEffectPropCudaEnabled, kOfxImageEffectPropCudaStream, false,
         kOfxImageEffectPropCudaStreamSupported, "METAMER_OFX_CUDA", loadCuda},
    Door{kOfxImageEffectPropMetalRenderSupported, kOfxImageEffectPropMetalEnabled, kOfxImageEffectPropMetalCommandQueue,
         true, nullptr, "METAMER_OFX_METAL", loadMetal}};

}  // namespace

struct Devices::Opened {
  const Door* door;
  std::unique_ptr<DeviceRenderer> renderer;
};

Devices::Devices(const HostSuites& host) {
  const PropertySet properties(host, host.hostProperties);
  for (const Door& door : kDoors) {
    if (properties.findString(door.supported).value_or("false") == "false") {
      continue;
    }
    if (auto interface = door.load(door.variable)) {
      m_opened.push_back({&door, std::make_unique<DeviceRenderer>(std::move(interface))});
    }
  }
}

Devices::~Devices() = default;

void Devices::describe(const PropertySet& descriptor) const {
  for (const Opened& opened : m_opened) {
    descriptor.trySet(opened.door->supported, "true");
    if (opened.door->alsoSupported != nullptr) {
      descriptor.trySet(opened.door->alsoSupported, "true");
    }
    descriptor.trySet(kOfxImageEffectPropCPURenderSupported, "true");
  }
}

std::string Devices::render(const HostSuites& host, const PropertySet& arguments, const RenderJob& job,
                            const std::function<bool()>& isAborted) const {
  for (const Door& door : kDoors) {
    if (arguments.findInt(door.enabled).value_or(0) == 0) {
      continue;
    }
    for (const Opened& opened : m_opened) {
      if (opened.door != &door) {
        continue;
      }
      void* const queue =
          door.hasQueueAlways ? arguments.getPointer(door.queue) : arguments.findPointer(door.queue).value_or(nullptr);
      const std::string refused = opened.renderer->render(host, queue, job, isAborted);
      return refused.empty()
                 ? refused
                 : refused + "; the processor renders, more slowly. " + door.variable + "=off switches the device off";
    }
    throw HostError(kOfxStatGPURenderFailed, "images on a device that was not offered to be taken");
  }
  ofx::render(host, job, isAborted);
  return {};
}

}  // namespace metamer::ofx
