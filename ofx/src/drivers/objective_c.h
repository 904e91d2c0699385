// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "device/device_interface.h"

namespace metamer::ofx {

/// Objects of another language's, asked through its run-time library: neither headers nor a compiler of Apple's are
/// needed.
class ObjectiveC {
 public:
  using Object = void*;

  /// Of the system's library, or what the environment's variable says. Null where there is none or it lacks a function.
  static std::shared_ptr<const ObjectiveC> load(const char* variable);

  /// A class, as an object. @throws DeviceError where there is none of that name
  Object classNamed(const char* name) const {
    Object const found = m_getClass(name);
    return found != nullptr ? found : throw DeviceError(std::string("Metal: no class ") + name);
  }

  /// Sends a message. The types are those that the method has.
  /// @throws DeviceError where there is no object, or it does not understand: the language itself would end the program
  template <typename Result = Object, typename... Arguments>
  Result send(Object object, const char* message, Arguments... arguments) const {
    void* const selector = m_selector(message);
    void* const objectClass = object == nullptr ? nullptr : m_classOf(object);
    if (objectClass == nullptr || m_responds(objectClass, selector) == 0) {
      throw DeviceError(std::string("Metal: nothing that understands ") + message);
    }
    using Method = Result(Object, void*, Arguments...);
    return reinterpret_cast<Method*>(m_method(objectClass, selector))(object, selector, arguments...);
  }

  /// Keeps an object that is already the caller's (of new..., alloc, retain) until the last holder goes.
  static std::shared_ptr<void> owned(const std::shared_ptr<const ObjectiveC>& library, Object object) {
    return {object, [library](Object kept) {
              if (kept != nullptr) {
                library->send<void>(kept, "release");
              }
            }};
  }
  static std::shared_ptr<void> retained(const std::shared_ptr<const ObjectiveC>& library, Object object) {
    return owned(library, library->send(object, "retain"));
  }

  /// Objects that methods hand out are let go when this goes.
  class Pool {
   public:
    explicit Pool(std::shared_ptr<const ObjectiveC> library)
        : m_library(std::move(library)), m_pool(m_library->m_pushPool()) {}
    ~Pool() { m_library->m_popPool(m_pool); }
    Pool(const Pool&) = delete;
    Pool& operator=(const Pool&) = delete;

   private:
    std::shared_ptr<const ObjectiveC> m_library;
    void* m_pool;
  };

 private:
  Object (*m_getClass)(const char* name) = nullptr;
  void* (*m_selector)(const char* name) = nullptr;
  Object (*m_classOf)(Object object) = nullptr;
  signed char (*m_responds)(Object objectClass, void* selector) = nullptr;
  void* (*m_method)(Object objectClass, void* selector) = nullptr;
  void* (*m_pushPool)() = nullptr;
  void (*m_popPool)(void* pool) = nullptr;
};

}  // namespace metamer::ofx
