// SPDX-License-Identifier: Apache-2.0
#include "drivers/objective_c.h"

#include "drivers/system_library.h"

namespace metamer::ofx {
namespace {

#if defined(__APPLE__)
constexpr const char* kSystemName = "/usr/lib/libobjc.A.dylib";
#else
constexpr const char* kSystemName = "";
#endif

}  // namespace

std::shared_ptr<const ObjectiveC> ObjectiveC::load(const char* variable) {
  const auto library = SystemLibrary::loadOr(variable, kSystemName);
  if (!library) {
    return nullptr;
  }
  auto functions = std::make_shared<ObjectiveC>();
  bool hasAll = true;
  const auto find = [&](auto& function, const char* symbol) { hasAll = library->find(function, symbol) && hasAll; };
  find(functions->m_getClass, "objc_getClass");
  find(functions->m_selector, "sel_registerName");
  find(functions->m_classOf, "object_getClass");
  find(functions->m_responds, "class_respondsToSelector");
  find(functions->m_method, "class_getMethodImplementation");
  find(functions->m_pushPool, "objc_autoreleasePoolPush");
  find(functions->m_popPool, "objc_autoreleasePoolPop");
  return hasAll ? functions : nullptr;
}

}  // namespace metamer::ofx
