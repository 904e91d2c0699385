// SPDX-License-Identifier: Apache-2.0
#include "drivers/cuda_programs.h"

#include "device/window_text.h"

namespace metamer::ofx {

Cuda::Function CudaPrograms::kernel(Cuda::Context context, const void* place, const char* name) {
  const Entry entry =
      m_entries.get([&](const Entry& each) { return each.place == place; }, [&] { return load(context, place); });
  if (entry.module == nullptr) {
    throw DeviceError(entry.problem);
  }
  Cuda::Function found = nullptr;
  checkCuda(m_library->function(&found, entry.module.get(), name), "a kernel");
  return found;
}

CudaPrograms::Entry CudaPrograms::load(Cuda::Context context, const void* place) const {
  Cuda::Module module = nullptr;
  const Cuda::Status status = m_library->loadModule(&module, windowText("window.ptx").data());
  if (status != Cuda::kSuccess) {
    return {place, nullptr, "the driver does not compile the kernel (" + std::to_string(status) + ")"};
  }
  // A context that is gone took its modules with it: there is nothing to unload then.
  const auto unload = [library = m_library, context](Cuda::Module made) {
    if (library->pushContext(context) == Cuda::kSuccess) {
      library->unloadModule(made);
      Cuda::Context popped = nullptr;
      library->popContext(&popped);
    }
  };
  return {place, {module, unload}, {}};
}

}  // namespace metamer::ofx
