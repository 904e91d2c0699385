// SPDX-License-Identifier: Apache-2.0
#include "vector/instruction_sets.h"

#include <hwy/detect_targets.h>

#include <atomic>
#if HWY_ARCH_X86 && defined(__APPLE__)
#include <sys/sysctl.h>

#include <algorithm>
#include <initializer_list>
#endif

namespace metamer::sip {
namespace {

/// What a processor of Intel's kind has, and the system keeps the registers of; each comes with all that stands before
/// it.
struct Features {
  bool ssse3 = false;
  bool sse4 = false;
  bool avx2 = false;
  bool avx512 = false;
};

#if HWY_ARCH_X86 && defined(__APPLE__)
/// By the system's word: the compiler's test would bring a library that takes the place of the system's own functions.
Features features() {
  const auto all = [](std::initializer_list<const char*> names) {
    return std::all_of(names.begin(), names.end(), [](const char* name) {
      int value = 0;
      std::size_t bytes = sizeof value;
      return sysctlbyname(name, &value, &bytes, nullptr, 0) == 0 && value != 0;
    });
  };
  Features found;
  found.ssse3 = all({"hw.optional.supplementalsse3"});
  // Every processor with AES has carry-less products, of which the system says nothing.
  found.sse4 = found.ssse3 && all({"hw.optional.sse4_1", "hw.optional.sse4_2", "hw.optional.aes"});
  found.avx2 = found.sse4 && all({"hw.optional.avx2_0", "hw.optional.fma", "hw.optional.bmi1", "hw.optional.bmi2"});
  found.avx512 = found.avx2 && all({"hw.optional.avx512f", "hw.optional.avx512cd", "hw.optional.avx512dq",
                                    "hw.optional.avx512bw", "hw.optional.avx512vl"});
  return found;
}
#elif HWY_ARCH_X86 && (defined(__GNUC__) || defined(__clang__))
/// By the compiler's own test.
Features features() {
  __builtin_cpu_init();
  Features found;
  found.ssse3 = __builtin_cpu_supports("ssse3");
  found.sse4 = __builtin_cpu_supports("sse4.1") && __builtin_cpu_supports("sse4.2") &&
               __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("aes");
  // Highway compiles its AVX2 code with F16C too; every processor with AVX2 has it.
  found.avx2 = found.sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
               __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  found.avx512 = found.avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
                 __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                 __builtin_cpu_supports("avx512vl");
  return found;
}
#else
/// Nothing beyond what every program of this build relies on anyway.
Features features() {
  return {};
}
#endif

std::int64_t detected() {
  std::int64_t sets = HWY_SCALAR | HWY_EMU128 | HWY_STATIC_TARGET;
  const Features has = features();
  sets |= has.ssse3 ? HWY_SSSE3 : 0;
  sets |= has.sse4 ? HWY_SSE4 : 0;
  sets |= has.avx2 ? HWY_AVX2 : 0;
  sets |= has.avx512 ? HWY_AVX3 : 0;
#if HWY_ARCH_ARM_A64
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
