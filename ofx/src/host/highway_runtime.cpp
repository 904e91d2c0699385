// SPDX-License-Identifier: Apache-2.0
// The two functions of Highway that are not in its headers, for systems that have Highway as a shared library alone
// (Debian 12): a plug-in must not ask its host for one. What the processor can do is told by the compiler's own test,
// which also asks whether the operating system keeps the wide registers.
#include <hwy/highway.h>
#include <hwy/targets.h>

namespace hwy {

int64_t SupportedTargets() {
  int64_t targets = HWY_SCALAR | HWY_EMU128;
#if HWY_ARCH_X86_64 && (defined(__GNUC__) || defined(__clang__))
  __builtin_cpu_init();
  if (__builtin_cpu_supports("ssse3")) {
    targets |= HWY_SSSE3;
  }
  const bool sse4 = __builtin_cpu_supports("sse4.1") && __builtin_cpu_supports("sse4.2") &&
                    __builtin_cpu_supports("pclmul") && __builtin_cpu_supports("aes");
  if (sse4) {
    targets |= HWY_SSE4;
  }
  // Highway compiles its AVX2 code with F16C too; every processor with AVX2 has it.
  const bool avx2 = sse4 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  if (avx2) {
    targets |= HWY_AVX2;
  }
  if (avx2 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl")) {
    targets |= HWY_AVX3;
  }
#elif HWY_ARCH_ARM_A64
  targets |= HWY_NEON;
#endif
  return targets;
}

ChosenTarget& GetChosenTarget() {
  static ChosenTarget chosen;
  return chosen;
}

}  // namespace hwy
