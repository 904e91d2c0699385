// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

/// What a test's host asks of the test's own CUDA driver, under the name "metamerCuda".
struct CudaDriver {
  void* (*makeContext)();
  void (*releaseContext)(void* context);
  void* (*makeStream)(void* context);
  void (*releaseStream)(void* stream);
  void (*hold)(void* stream);
  void (*letGo)(void* stream);
  void (*wait)(void* stream);
  void* (*allocate)(void* context, std::size_t bytes);
  void (*release)(void* memory);
  void (*setCurrent)(void* context);  ///< of this thread
  int devices;                        ///< that it has
  bool hasContextId;                  ///< as drivers since CUDA 12
  /// Of the last launch.
  std::uint32_t grid[3] = {};
  std::uint32_t block[3] = {};
  void* stream = nullptr;
  void* context = nullptr;
};

using CudaDriverFunction = CudaDriver*();
