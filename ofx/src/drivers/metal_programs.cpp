// SPDX-License-Identifier: Apache-2.0
#include "drivers/metal_programs.h"

#include <algorithm>

#include "device/window_text.h"

namespace metamer::ofx {

std::shared_ptr<void> MetalPrograms::pipeline(ObjectiveC::Object device, const std::string& name) {
  const Entry entry =
      m_entries.get([&](const Entry& each) { return each.device.get() == device; }, [&] { return build(device); });
  if (!entry.problem.empty()) {
    throw DeviceError(entry.problem);
  }
  const auto found = entry.pipelines.find(name);
  return found == entry.pipelines.end() ? nullptr : found->second;
}

MetalPrograms::Entry MetalPrograms::build(ObjectiveC::Object device) const {
  using Object = ObjectiveC::Object;
  const auto own = [this](Object object) { return ObjectiveC::owned(m_library, object); };
  Entry entry{ObjectiveC::retained(m_library, device), {}, {}};
  const auto options = own(m_library->send(m_library->classNamed("MTLCompileOptions"), "new"));
  m_library->send<void>(options.get(), "setFastMathEnabled:", false);
  const auto source = text(windowText("window.metal").data());
  Object error = nullptr;
  const auto program = own(m_library->send<Object, Object, Object, Object*>(
      device, "newLibraryWithSource:options:error:", source.get(), options.get(), &error));
  if (program == nullptr) {
    entry.problem = "the device does not compile the kernel: " + wordsOf(error);
    return entry;
  }
  for (const char* const name : {kCopyWindow, kMapWindow, kSkinWindow}) {
    const auto function = own(m_library->send(program.get(), "newFunctionWithName:", text(name).get()));
    auto pipeline = function == nullptr
                        ? nullptr
                        : own(m_library->send<Object, Object, Object*>(
                              device, "newComputePipelineStateWithFunction:error:", function.get(), &error));
    if (pipeline == nullptr) {
      entry.problem = std::string("the device does not build ") + name + ": " + wordsOf(error);
      return entry;
    }
    entry.pipelines.emplace(name, std::move(pipeline));
  }
  return entry;
}

std::shared_ptr<void> MetalPrograms::text(const char* characters) const {
  ObjectiveC::Object const made = m_library->send(m_library->classNamed("NSString"), "alloc");
  return ObjectiveC::owned(m_library, m_library->send(made, "initWithUTF8String:", characters));
}

std::string MetalPrograms::wordsOf(ObjectiveC::Object error) const {
  if (error == nullptr) {
    return "it does not say why";
  }
  const std::string words = m_library->send<const char*>(m_library->send(error, "localizedDescription"), "UTF8String");
  return words.substr(0, std::min<std::size_t>(words.find('\n'), 200));
}

}  // namespace metamer::ofx
