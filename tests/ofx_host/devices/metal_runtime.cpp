// SPDX-License-Identifier: Apache-2.0
// An Objective-C library with Metal, whose device is the processor: it runs the plug-in's Metal text, compiled as C++.
#include "metal_runtime.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "device_words.h"
#include "metal_kernels.h"
#include "metal_objects.h"

namespace metal_objects {
namespace {

constexpr unsigned long kCompleted = 4;
constexpr unsigned long kError = 5;

MetalRuntime& runtime();

DeviceLedger& ledger() {
  return ledgerOfLibrary();
}

std::vector<std::vector<Object*>>& pools() {
  thread_local std::vector<std::vector<Object*>> stack;
  return stack;
}

void letGo(Object* object) {
  if (--object->references == 0) {
    delete object;
  }
}

template <typename Kind>
Kind* made(const Class& itsClass) {
  return new Kind(itsClass);
}

/// For methods whose results are not the caller's. Without a pool they would be there for ever.
template <typename Kind>
Kind* inPool(Kind* object) {
  if (!pools().empty()) {
    pools().back().push_back(object);
  }
  return object;
}

struct Size {
  unsigned long width;
  unsigned long height;
  unsigned long depth;
};

template <typename Method>
void* method(Method function) {
  return reinterpret_cast<void*>(+function);
}

void run(const std::string& name, const KeptArguments& kept, const std::vector<unsigned char*>& pointers, Size groups,
         Size group) {
  for (unsigned int y = 0; y < groups.height * group.height; ++y) {
    for (unsigned int x = 0; x < groups.width * group.width; ++x) {
      runMetalThread(name, kept, pointers, x, y);
    }
  }
}

void dispatch(Encoder* encoder, void* /*selector*/, Size groups, Size group) {
  count(ledger().kernels);
  std::copy_n(&groups.width, 3, runtime().grid);
  std::copy_n(&group.width, 3, runtime().group);
  std::vector<unsigned char*> pointers(9);
  std::vector<Kept<Buffer>> kept;
  for (const auto& [index, buffer] : encoder->buffers) {
    kept.emplace_back(buffer);
    pointers[index] = buffer->bytes.data();
  }
  encoder->commands->work.emplace_back(
      [=, held = std::move(kept), name = encoder->pipeline, arguments = encoder->arguments] {
        run(name, arguments, pointers, groups, group);
      });
}

void commit(CommandBuffer* commands, void* /*selector*/) {
  commands->queue->work.put([work = commands->work, status = commands->status] {
    for (const auto& each : work) {
      each();
    }
    *status = runtime().hasFailed ? kError : kCompleted;
  });
}

void copyBuffer(Encoder* encoder, void* /*selector*/, Buffer* from, unsigned long fromByte, Buffer* to,
                unsigned long toByte, unsigned long bytes) {
  // As Metal has it on macOS.
  if (fromByte % 4 != 0 || toByte % 4 != 0 || fromByte + bytes > from->bytes.size() ||
      toByte + bytes > to->bytes.size()) {
    std::abort();
  }
  count(from->isThePlugins ? ledger().writes : ledger().reads);
  encoder->commands->work.emplace_back([from = Kept(from), to = Kept(to), fromByte, toByte, bytes] {
    std::copy_n(from->bytes.begin() + static_cast<std::ptrdiff_t>(fromByte), bytes,
                to->bytes.begin() + static_cast<std::ptrdiff_t>(toByte));
  });
}

const std::map<std::string, void*>& rootMethods() {
  static const std::map<std::string, void*> all = {{"retain", method([](Object* self, void*) {
                                                      ++self->references;
                                                      return self;
                                                    })},
                                                   {"release", method([](Object* self, void*) { letGo(self); })}};
  return all;
}

Class classOf(const std::string& name, std::map<std::string, void*> methods) {
  methods.insert(rootMethods().begin(), rootMethods().end());
  return {name, std::move(methods)};
}

const Class& textClass() {
  static const Class made =
      classOf("NSString", {{"initWithUTF8String:", method([](Text* self, void*, const char* characters) {
                              self->characters = characters;
                              return self;
                            })},
                           {"UTF8String", method([](Text* self, void*) { return self->characters.c_str(); })},
                           // Of errors, which are but their words.
                           {"localizedDescription", method([](Text* self, void*) { return self; })}});
  return made;
}

const Class& optionsClass() {
  static const Class made =
      classOf("MTLCompileOptions",
              {{"setFastMathEnabled:", method([](Options* self, void*, bool isFast) { self->isFast = isFast; })}});
  return made;
}

const Class& bufferClass() {
  static const Class made =
      classOf("Buffer", {{"length", method([](Buffer* self, void*) -> unsigned long { return self->bytes.size(); })},
                         {"contents", method([](Buffer* self, void*) -> void* { return self->bytes.data(); })}});
  return made;
}

const Class& functionClass() {
  static const Class made = classOf("Function", {});
  return made;
}

const Class& programClass() {
  static const Class made =
      classOf("Library", {{"newFunctionWithName:", method([](Program*, void*, Text* name) -> Function* {
                             if (isRefused("newFunctionWithName:")) {
                               return nullptr;
                             }
                             auto* const function = metal_objects::made<Function>(functionClass());
                             function->name = name->characters;
                             return function;
                           })}});
  return made;
}

const Class& encoderClass() {
  static const Class made = classOf(
      "Encoder",
      {{"setComputePipelineState:",
        method([](Encoder* self, void*, Function* pipeline) { self->pipeline = pipeline->name; })},
       {"setBuffer:offset:atIndex:",
        method([](Encoder* self, void*, Buffer* buffer, unsigned long offset, unsigned long index) {
          if (offset != 0) {
            std::abort();
          }
          self->buffers[index] = buffer;
        })},
       {"setBytes:length:atIndex:", method([](Encoder* self, void*, const void* bytes, unsigned long length,
                                              unsigned long index) { self->arguments.keep(index, bytes, length); })},
       {"dispatchThreadgroups:threadsPerThreadgroup:", method(dispatch)},
       {"copyFromBuffer:sourceOffset:toBuffer:destinationOffset:size:", method(copyBuffer)},
       {"endEncoding", method([](Encoder*, void*) {})}});
  return made;
}

Encoder* encoderOf(CommandBuffer* commands, void* /*selector*/) {
  if (isRefused("encoder")) {
    return nullptr;
  }
  auto* const encoder = inPool(made<Encoder>(encoderClass()));
  encoder->commands = commands;
  return encoder;
}

const Class& commandsClass() {
  static const Class made =
      classOf("CommandBuffer", {{"computeCommandEncoder", method(encoderOf)},
                                {"blitCommandEncoder", method(encoderOf)},
                                {"commit", method(commit)},
                                {"status", method([](CommandBuffer* self, void*) -> unsigned long {
                                   return isRefused("status") ? kError : self->status->load();
                                 })},
                                {"waitUntilCompleted", method([](CommandBuffer* self, void*) {
                                   count(ledger().waits);
                                   self->queue->work.wait();
                                 })}});
  return made;
}

const Class& queueClass() {
  static const Class made = classOf(
      "Queue", {{"device", method([](Queue* self, void*) { return isRefused("device") ? nullptr : self->device; })},
                {"commandBuffer", method([](Queue* self, void*) -> CommandBuffer* {
                   if (isRefused("commandBuffer")) {
                     return nullptr;
                   }
                   auto* const commands = inPool(metal_objects::made<CommandBuffer>(commandsClass()));
                   commands->queue = self;
                   return commands;
                 })}});
  return made;
}

Buffer* bufferOf(const char* name, std::size_t bytes) {
  if (isRefused(name)) {
    return nullptr;
  }
  count(ledger().buffers);
  count(ledger().uploads);
  auto* const buffer = made<Buffer>(bufferClass());
  buffer->bytes.resize(bytes);
  return buffer;
}

Program* compiled(Device* /*device*/, void* /*selector*/, Text* source, Options* options, Text** error) {
  std::stringstream text;
  text << std::ifstream(METAMER_METAL_TEXT).rdbuf();
  const bool isText = source->characters == text.str() && !options->isFast;
  if (isRefused("newLibraryWithSource:") || !isText) {
    *error = inPool(made<Text>(textClass()));
    (*error)->characters = isText ? "error: refused\nby the test" : "error: another text, or fast arithmetic";
    return nullptr;
  }
  count(ledger().programs);
  return made<Program>(programClass());
}

const Class& deviceClass() {
  static const Class made = classOf(
      "Device", {{"newLibraryWithSource:options:error:", method(compiled)},
                 {"newComputePipelineStateWithFunction:error:",
                  method([](Device*, void*, Function* function, Text**) -> Function* {
                    if (isRefused("newComputePipelineState")) {
                      return nullptr;
                    }
                    ++function->references;
                    return function;
                  })},
                 {"newBufferWithBytes:length:options:",
                  method([](Device*, void*, const void* bytes, unsigned long length, unsigned long) -> Buffer* {
                    Buffer* const buffer = bufferOf("newBufferWithBytes", length);
                    if (buffer != nullptr) {
                      std::copy_n(static_cast<const unsigned char*>(bytes), length, buffer->bytes.begin());
                    }
                    return buffer;
                  })},
                 {"newBufferWithLength:options:", method([](Device*, void*, unsigned long length, unsigned long) {
                    return bufferOf("newBufferWithLength", length);
                  })}});
  return made;
}

/// Classes as objects: their methods make.
const Class& makerClass(bool isText) {
  static const Class texts =
      classOf("NSString class", {{"alloc", method([](Object*, void*) { return made<Text>(textClass()); })}});
  static const Class options = classOf("MTLCompileOptions class",
                                       {{"new", method([](Object*, void*) { return made<Options>(optionsClass()); })}});
  return isText ? texts : options;
}

Object* classNamed(const std::string& name) {
  static Object texts(makerClass(true));
  static Object options(makerClass(false));
  if (name == "NSString") {
    return &texts;
  }
  return name == "MTLCompileOptions" ? &options : nullptr;
}

MetalRuntime& runtime() {
  static MetalRuntime kept = {
      .makeDevice = [] { return static_cast<void*>(made<Device>(deviceClass())); },
      .makeQueue =
          [](void* device) {
            auto* const queue = made<Queue>(queueClass());
            queue->device = static_cast<Device*>(device);
            return static_cast<void*>(queue);
          },
      .hold = [](void* queue) { static_cast<Queue*>(queue)->work.hold(); },
      .letGo = [](void* queue) { static_cast<Queue*>(queue)->work.letGo(); },
      .wait = [](void* queue) { static_cast<Queue*>(queue)->work.wait(); },
      .makeBuffer =
          [](std::size_t bytes) {
            auto* const buffer = made<Buffer>(bufferClass());
            buffer->bytes.resize(bytes);
            buffer->isThePlugins = false;
            return static_cast<void*>(buffer);
          },
      .contents = [](void* buffer) { return static_cast<void*>(static_cast<Buffer*>(buffer)->bytes.data()); },
      .release = [](void* object) { letGo(static_cast<Object*>(object)); }};
  return kept;
}

}  // namespace

Object::Object(const Class& itsClass) : isa(&itsClass) {
  count(runtime().objects);
}

Object::~Object() {
  count(runtime().objects, -1);
}

Buffer::~Buffer() {
  count(ledger().buffers, isThePlugins ? -1 : 0);
}

Program::~Program() {
  count(ledger().released);
}

}  // namespace metal_objects

using namespace metal_objects;

extern "C" {

DeviceLedger* metamerLedger() {
  return &ledger();
}

MetalRuntime* metamerMetal() {
  return &runtime();
}

void* objc_getClass(const char* name) {
  return classNamed(name);
}

void* sel_registerName(const char* name) {
  static std::mutex mutex;
  static std::set<std::string> names;
  const std::lock_guard lock(mutex);
  return const_cast<std::string*>(&*names.insert(name).first);
}

void* object_getClass(void* object) {
  return const_cast<Class*>(static_cast<Object*>(object)->isa);
}

signed char class_respondsToSelector(void* objectClass, void* selector) {
  return static_cast<Class*>(objectClass)->methods.contains(*static_cast<std::string*>(selector)) ? 1 : 0;
}

void* class_getMethodImplementation(void* objectClass, void* selector) {
  return static_cast<Class*>(objectClass)->methods.at(*static_cast<std::string*>(selector));
}

void* objc_autoreleasePoolPush() {
  pools().emplace_back();
  return &pools();
}

void objc_autoreleasePoolPop(void* /*pool*/) {
  const std::vector<Object*> objects = std::move(pools().back());
  pools().pop_back();
  for (Object* const object : objects) {
    letGo(object);
  }
}

}  // extern "C"
