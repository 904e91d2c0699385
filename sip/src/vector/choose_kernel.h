// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "vector/instruction_sets.h"

namespace metamer::sip {

/// A kernel as compiled for one instruction set; null where Highway did not compile it for that.
template <typename Kernel>
struct CompiledKernel {
  std::int64_t set;
  Kernel* kernel;
};

/// The first of the kernels, best first, that this machine can run; `fallback` where it can run none.
template <typename Kernel, std::size_t count>
Kernel* chooseKernel(const std::array<CompiledKernel<Kernel>, count>& compiled, Kernel* fallback) {
  const std::int64_t sets = instructionSets();
  for (const auto& one : compiled) {
    if (one.kernel != nullptr && (sets & one.set) != 0) {
      return one.kernel;
    }
  }
  return fallback;
}

}  // namespace metamer::sip

/// The kernel FUNCTION, of type TYPE, for the best instruction set of this machine. Highway's names for it exist only
/// in the file that it compiles again and again, hence a macro.
#define METAMER_CHOOSE_KERNEL(TYPE, FUNCTION)                                                       \
  ::metamer::sip::chooseKernel<TYPE>(                                                               \
      std::array<::metamer::sip::CompiledKernel<TYPE>, 5>{{{HWY_AVX3, HWY_CHOOSE_AVX3(FUNCTION)},   \
                                                           {HWY_AVX2, HWY_CHOOSE_AVX2(FUNCTION)},   \
                                                           {HWY_SSE4, HWY_CHOOSE_SSE4(FUNCTION)},   \
                                                           {HWY_SSSE3, HWY_CHOOSE_SSSE3(FUNCTION)}, \
                                                           {HWY_NEON, HWY_CHOOSE_NEON(FUNCTION)}}}, \
      HWY_CHOOSE_FALLBACK(FUNCTION))
