// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "held_queue.h"
#include "window_forms.h"

// Objects of the tests' own Objective-C library.
namespace metal_objects {

struct Class;

struct Object {
  explicit Object(const Class& itsClass);
  virtual ~Object();
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  const Class* isa;
  std::atomic<int> references = 1;
};

/// Methods by their selectors' names.
struct Class {
  std::string name;
  std::map<std::string, void*> methods;
};

/// Holds a reference.
template <typename Kind>
class Kept {
 public:
  explicit Kept(Kind* object) : m_object(object) { ++m_object->references; }
  Kept(const Kept& other) : Kept(other.m_object) {}
  Kept& operator=(const Kept&) = delete;
  ~Kept() {
    if (--m_object->references == 0) {
      delete m_object;
    }
  }
  Kind* operator->() const { return m_object; }

 private:
  Kind* m_object;
};

struct Device : Object {
  using Object::Object;
};

struct Queue : Object {
  using Object::Object;
  Device* device = nullptr;
  HeldQueue work;
};

struct Buffer : Object {
  using Object::Object;
  ~Buffer() override;
  std::vector<unsigned char> bytes;
  bool isThePlugins = true;
};

struct Text : Object {
  using Object::Object;
  std::string characters;
};

struct Options : Object {
  using Object::Object;
  bool isFast = true;  // as Metal's are
};

struct Program : Object {
  using Object::Object;
  ~Program() override;
};

/// A function of the program, and what is built of it.
struct Function : Object {
  using Object::Object;
  std::string name;
};

struct CommandBuffer : Object {
  using Object::Object;
  Queue* queue = nullptr;
  std::vector<std::function<void()>> work;
  std::shared_ptr<std::atomic<unsigned long>> status = std::make_shared<std::atomic<unsigned long>>(0);
};

struct Encoder : Object {
  using Object::Object;
  CommandBuffer* commands = nullptr;
  std::string pipeline;
  KeptArguments arguments;
  std::map<unsigned long, Buffer*> buffers;
};

}  // namespace metal_objects
