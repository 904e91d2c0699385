// SPDX-License-Identifier: Apache-2.0
#include "vector/instruction_sets.h"

#include <hwy/detect_targets.h>

#include <atomic>

namespace metamer::sip {
namespace {

/// What the processor has, by the compiler's own test, which also asks whether the operating system keeps the wide
/// registers. Where the compiler has none: what every program of this build relies on anyway.
std::int64_t detected() {
  std::int64_t sets = HWY_SCALAR | HWY_EMU128 | HWY_STATIC_TARGET;
#if HWY_ARCH_X86 && (defined(__GNUC__) || defined(__clang__))
  __builtin_cpu_init();
  if (__builtin_cpu_supports("ssse3")) {
    sets |= HWY_SSSE3;
  }
  const bool sse4 = __builtin_cpu_supports("sse4.1") && __builtin_cpu_supports("sse4.2") &&
                    __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("aes");
  if (sse4) {
    sets |= HWY_SSE4;
  }
  // Highway compiles its AVX2 code with F16C too; every processor with AVX2 has it.
  const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  if (avx2) {
    sets |= HWY_AVX2;
  }
  if (avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl")) {
    sets |= HWY_AVX3;
  }
#elif HWY_ARCH_ARM_A64
  sets |= HWY_NEON;
#endif
  return sets;
}

std::atomic<std::int64_t> allowedSets{0};

}  // namespace

std::int64_t instructionSets() {
  static const std::int64_t sets = detected();
  const std::int64_t allowed = allowedSets.load(std::memory_order_relaxed);
  return allowed == 0 ? sets : sets & (allowed | HWY_SCALAR | HWY_EMU128 | HWY_STATIC_TARGET);
}

void allowInstructionSets(std::int64_t allowed) {
  allowedSets.store(allowed, std::memory_order_relaxed);
}

}  // namespace metamer::sip
