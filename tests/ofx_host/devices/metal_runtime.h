// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

/// What a test's host asks of the test's own Objective-C library, under the name "metamerMetal".
struct MetalRuntime {
  void* (*makeDevice)();
  void* (*makeQueue)(void* device);
  void (*hold)(void* queue);
  void (*letGo)(void* queue);
  void (*wait)(void* queue);
  void* (*makeBuffer)(std::size_t bytes);
  void* (*contents)(void* buffer);
  void (*release)(void* object);
  int objects = 0;         ///< that are alive
  bool hasFailed = false;  ///< what is committed ends in an error
  unsigned long grid[3] = {};
  unsigned long group[3] = {};
};

using MetalRuntimeFunction = MetalRuntime*();
