// SPDX-License-Identifier: Apache-2.0
// A CUDA driver whose device is the processor: it runs the plug-in's CUDA text, compiled as C++.
#include "cuda_driver.h"

#include <cuda_words.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "device_words.h"
#include "held_queue.h"
#include "window_forms.h"

// As the plug-in embeds it, before it becomes PTX.
#include "window.cu"

namespace {

using Status = std::int32_t;
using Address = std::uint64_t;
constexpr Status kNoDevice = 100;
constexpr Status kInvalidContext = 201;
constexpr Status kInvalidValue = 1;
constexpr Status kNotFound = 500;
constexpr Status kNotReady = 600;

struct Context {
  std::uint64_t id;
  int modules;  ///< that are loaded
};

struct Stream {
  HeldQueue work;
};

struct Block {
  std::unique_ptr<unsigned char[]> bytes;
  std::size_t size = 0;
  void* context = nullptr;
  bool isThePlugins = false;
};

struct State {
  std::mutex mutex;
  std::map<Address, Block> blocks;  ///< by their beginning
  std::set<void*> contexts;
  std::uint64_t lastContext = 0;
  Stream defaultStream;
};

State& state() {
  static State kept;
  return kept;
}

std::vector<void*>& contextsOfThread() {
  thread_local std::vector<void*> stack;
  return stack;
}

void* current() {
  return contextsOfThread().empty() ? nullptr : contextsOfThread().back();
}

DeviceLedger& ledger() {
  return ledgerOfLibrary();
}

Stream& streamOf(void* stream) {
  return stream == nullptr ? state().defaultStream : *static_cast<Stream*>(stream);
}

void* allocate(void* context, std::size_t bytes, bool isThePlugins) {
  const std::lock_guard lock(state().mutex);
  // Of the bytes that were asked for, so that a sanitizer sees what lies beyond.
  auto memory = std::unique_ptr<unsigned char[]>(new unsigned char[std::max<std::size_t>(bytes, 1)]);
  void* const made = memory.get();
  state().blocks[reinterpret_cast<Address>(made)] = {std::move(memory), bytes, context, isThePlugins};
  return made;
}

Block* blockOf(Address address) {
  const auto after = state().blocks.upper_bound(address);
  if (after == state().blocks.begin()) {
    return nullptr;
  }
  auto& [begin, block] = *std::prev(after);
  return address < begin + block.size ? &block : nullptr;
}

template <typename Function>
struct Kernel;

template <typename... Parameters>
struct Kernel<void(Parameters...)> {
  template <std::size_t... kIndex>
  static void run(void (*kernel)(Parameters...), const KeptArguments& arguments, std::index_sequence<kIndex...>) {
    kernel(arguments.get<Parameters>(kIndex)...);
  }
  template <std::size_t... kIndex>
  static void keep(void** given, KeptArguments& arguments, std::index_sequence<kIndex...>) {
    (arguments.keep(kIndex, given[kIndex], sizeof(Parameters)), ...);
  }
  using Indices = std::index_sequence_for<Parameters...>;
};

struct Function {
  std::string name;
  void (*keep)(void** given, KeptArguments& arguments);
  void (*run)(const KeptArguments& arguments);
};

template <auto* kKernel>
Function functionOf(const char* name) {
  using Form = Kernel<std::remove_pointer_t<decltype(kKernel)>>;
  return {name, [](void** given, KeptArguments& arguments) { Form::keep(given, arguments, typename Form::Indices()); },
          [](const KeptArguments& arguments) { Form::run(kKernel, arguments, typename Form::Indices()); }};
}

std::vector<Function>& functions() {
  static std::vector<Function> all = {functionOf<&metamerCopyWindow>("metamerCopyWindow"),
                                      functionOf<&metamerMapWindow>("metamerMapWindow"),
                                      functionOf<&metamerSkinWindow>("metamerSkinWindow"),
                                      functionOf<&metamerAffineWindow>("metamerAffineWindow"),
                                      functionOf<&metamerMapCurveWindow>("metamerMapCurveWindow"),
                                      functionOf<&metamerSkinCurveWindow>("metamerSkinCurveWindow")};
  return all;
}

CudaDriver& driver() {
  static CudaDriver kept = {
      .makeContext =
          [] {
            const std::lock_guard lock(state().mutex);
            auto* const made = new Context{++state().lastContext, 0};
            state().contexts.insert(made);
            return static_cast<void*>(made);
          },
      .releaseContext =
          [](void* context) {
            const std::lock_guard lock(state().mutex);
            // With all that the plug-in has in it.
            count(ledger().released, static_cast<Context*>(context)->modules);
            for (auto block = state().blocks.begin(); block != state().blocks.end();) {
              const bool isGone = block->second.isThePlugins && block->second.context == context;
              count(ledger().buffers, isGone ? -1 : 0);
              block = isGone ? state().blocks.erase(block) : std::next(block);
            }
            state().contexts.erase(context);
            delete static_cast<Context*>(context);
          },
      .makeStream = [](void* /*context*/) { return static_cast<void*>(new Stream); },
      .releaseStream = [](void* stream) { delete static_cast<Stream*>(stream); },
      .hold = [](void* stream) { streamOf(stream).work.hold(); },
      .letGo = [](void* stream) { streamOf(stream).work.letGo(); },
      .wait = [](void* stream) { streamOf(stream).work.wait(); },
      .allocate = [](void* context, std::size_t bytes) { return allocate(context, bytes, false); },
      .release =
          [](void* memory) {
            const std::lock_guard lock(state().mutex);
            state().blocks.erase(reinterpret_cast<Address>(memory));
          },
      .setCurrent =
          [](void* context) {
            contextsOfThread().clear();
            if (context != nullptr) {
              contextsOfThread().push_back(context);
            }
          },
      .devices = 1,
      .hasContextId = true};
  return kept;
}

}  // namespace

extern "C" {

DeviceLedger* metamerLedger() {
  return &ledger();
}

CudaDriver* metamerCuda() {
  return &driver();
}

// A call that fails where a test says so, or where it needs a context and the thread has none.
#define REFUSE(name)        \
  if (isRefused(name)) {    \
    return ledger().status; \
  }
#define NEEDS_CONTEXT         \
  if (current() == nullptr) { \
    return kInvalidContext;   \
  }

Status cuInit(unsigned int) {
  return driver().devices > 0 ? 0 : kNoDevice;
}

Status cuDeviceGetCount(int* devices) {
  *devices = driver().devices;
  return 0;
}

Status cuCtxGetCurrent(void** context) {
  REFUSE("cuCtxGetCurrent")
  *context = current();
  return 0;
}

Status cuCtxPushCurrent_v2(void* context) {
  REFUSE("cuCtxPushCurrent")
  const std::lock_guard lock(state().mutex);
  if (!state().contexts.contains(context)) {
    return kInvalidContext;
  }
  contextsOfThread().push_back(context);
  return 0;
}

Status cuCtxPopCurrent_v2(void** context) {
  NEEDS_CONTEXT
  *context = current();
  contextsOfThread().pop_back();
  return 0;
}

Status cuCtxGetId(void* context, std::uint64_t* id) {
  *id = static_cast<Context*>(context)->id;
  return driver().hasContextId ? 0 : kInvalidContext;
}

Status cuPointerGetAttribute(void* value, unsigned int what, Address pointer) {
  REFUSE("cuPointerGetAttribute")
  const std::lock_guard lock(state().mutex);
  const Block* const block = blockOf(pointer);
  if (what != 1 || block == nullptr) {
    return kInvalidValue;
  }
  std::memcpy(value, &block->context, sizeof block->context);
  return 0;
}

Status cuMemGetAddressRange_v2(Address* base, std::size_t* bytes, Address pointer) {
  REFUSE("cuMemGetAddressRange")
  NEEDS_CONTEXT
  const std::lock_guard lock(state().mutex);
  const Block* const block = blockOf(pointer);
  if (block == nullptr) {
    return kInvalidValue;
  }
  *base = reinterpret_cast<Address>(block->bytes.get());
  *bytes = block->size;
  return 0;
}

// What a host asks of it, in the primary context.
Status cuDeviceGet(std::int32_t* device, int index) {
  *device = index;
  return 0;
}

Status cuDeviceGetName(char* name, int size, std::int32_t /*device*/) {
  std::snprintf(name, static_cast<std::size_t>(size), "the processor in a card's place");
  return 0;
}

Status cuDevicePrimaryCtxRetain(void** context, std::int32_t /*device*/) {
  static void* const primary = driver().makeContext();
  *context = primary;
  return 0;
}

Status cuDevicePrimaryCtxRelease_v2(std::int32_t /*device*/) {
  return 0;
}

Status cuCtxSetCurrent(void* context) {
  driver().setCurrent(context);
  return 0;
}

Status cuModuleLoadData(void** module, const void* text) {
  REFUSE("cuModuleLoadData")
  NEEDS_CONTEXT
  // It is PTX, and has every kernel.
  const std::string given(static_cast<const char*>(text));
  for (const Function& function : functions()) {
    if (given.find(".visible .entry " + function.name + "(") == std::string::npos) {
      return kInvalidValue;
    }
  }
  count(ledger().programs);
  ++static_cast<Context*>(current())->modules;
  *module = current();
  return 0;
}

Status cuModuleUnload(void* module) {
  NEEDS_CONTEXT
  count(ledger().released);
  --static_cast<Context*>(current())->modules;
  return module == current() ? 0 : kInvalidContext;
}

Status cuModuleGetFunction(void** found, void* module, const char* name) {
  REFUSE("cuModuleGetFunction")
  NEEDS_CONTEXT
  for (Function& function : functions()) {
    if (function.name == name && module == current()) {
      *found = &function;
      return 0;
    }
  }
  return kNotFound;
}

Status cuMemAlloc_v2(Address* made, std::size_t bytes) {
  REFUSE("cuMemAlloc")
  NEEDS_CONTEXT
  *made = reinterpret_cast<Address>(allocate(current(), bytes, true));
  count(ledger().buffers);
  count(ledger().uploads);
  return 0;
}

Status cuMemFree_v2(Address address) {
  NEEDS_CONTEXT
  const std::lock_guard lock(state().mutex);
  if (state().blocks.erase(address) == 0) {
    return kInvalidValue;
  }
  count(ledger().buffers, -1);
  return 0;
}

Status cuStreamCreate(void** stream, unsigned int flags) {
  REFUSE("cuStreamCreate")
  NEEDS_CONTEXT
  *stream = new Stream;
  return flags == 1 ? 0 : kInvalidValue;
}

Status cuStreamDestroy_v2(void* stream) {
  NEEDS_CONTEXT
  delete static_cast<Stream*>(stream);
  return 0;
}

Status cuStreamQuery(void* stream) {
  REFUSE("cuStreamQuery")
  NEEDS_CONTEXT
  return streamOf(stream).work.isEmpty() ? 0 : kNotReady;
}

Status cuStreamSynchronize(void* stream) {
  REFUSE("cuStreamSynchronize")
  NEEDS_CONTEXT
  // Of the host's streams; the plug-in's own hold a copy alone.
  count(ledger().waits, stream == nullptr || stream == driver().stream ? 1 : 0);
  streamOf(stream).work.wait();
  return 0;
}

Status cuMemcpyHtoDAsync_v2(Address to, const void* from, std::size_t bytes, void* stream) {
  REFUSE("cuMemcpyHtoD")
  NEEDS_CONTEXT {
    const std::lock_guard lock(state().mutex);
    const Block* const block = blockOf(to);
    if (block == nullptr || blockOf(to + bytes - 1) != block) {
      return kInvalidValue;
    }
    count(ledger().writes, block->isThePlugins ? 0 : 1);
  }
  streamOf(stream).work.put([=] { std::memcpy(reinterpret_cast<void*>(to), from, bytes); });
  return 0;
}

Status cuMemcpyDtoDAsync_v2(Address to, Address from, std::size_t bytes, void* stream) {
  NEEDS_CONTEXT
  streamOf(stream).work.put(
      [=] { std::memcpy(reinterpret_cast<void*>(to), reinterpret_cast<const void*>(from), bytes); });
  return 0;
}

Status cuMemcpyDtoHAsync_v2(void* to, Address from, std::size_t bytes, void* stream) {
  REFUSE("cuMemcpyDtoH")
  NEEDS_CONTEXT {
    const std::lock_guard lock(state().mutex);
    const Block* const block = blockOf(from);
    if (block == nullptr || blockOf(from + bytes - 1) != block) {
      return kInvalidValue;
    }
  }
  count(ledger().reads);
  // For a test of who compares bits.
  const bool flipsABit = std::getenv("METAMER_FLIP_A_BIT") != nullptr;  // NOLINT(concurrency-mt-unsafe)
  streamOf(stream).work.put([=] {
    std::memcpy(to, reinterpret_cast<const void*>(from), bytes);
    static_cast<unsigned char*>(to)[bytes / 2] ^= flipsABit ? 1 : 0;
  });
  return 0;
}

Status cuLaunchKernel(void* function, unsigned int gridX, unsigned int gridY, unsigned int gridZ, unsigned int blockX,
                      unsigned int blockY, unsigned int blockZ, unsigned int sharedBytes, void* stream, void** given,
                      void** more) {
  REFUSE("cuLaunchKernel")
  NEEDS_CONTEXT
  if (gridX == 0 || gridY == 0 || gridY > 65535 || gridZ != 1 || blockX * blockY * blockZ > 1024 || more != nullptr ||
      sharedBytes != 0) {
    return kInvalidValue;
  }
  count(ledger().kernels);
  CudaDriver& seen = driver();
  std::copy_n(std::begin({gridX, gridY, gridZ}), 3, seen.grid);
  std::copy_n(std::begin({blockX, blockY, blockZ}), 3, seen.block);
  seen.stream = stream;
  seen.context = current();
  const auto& kernel = *static_cast<const Function*>(function);
  KeptArguments arguments;
  kernel.keep(given, arguments);
  streamOf(stream).work.put([=, run = kernel.run] {
    blockDim = {blockX, blockY};
    for (unsigned int y = 0; y < gridY; ++y) {
      for (unsigned int x = 0; x < gridX * blockX; ++x) {
        blockIdx = {x / blockX, y};
        threadIdx = {x % blockX, 0};
        run(arguments);
      }
    }
  });
  return 0;
}

}  // extern "C"
