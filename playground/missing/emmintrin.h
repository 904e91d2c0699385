// SPDX-License-Identifier: Apache-2.0
// <emmintrin.h> with numbers spread over a vector such that clang 14 keeps the order of loads and stores. What it makes
// of a number in memory, v128.load64_splat, it moves past later stores to the same place: v = M v came out wrong.
#pragma once

#include_next <emmintrin.h>

/// Both lanes. Through a register: the number is loaded before what follows.
static inline __attribute__((always_inline)) __m128d metamerBothLanes(double value) {
  __asm__("" : "+r"(value));
  return (__m128d)wasm_f64x2_splat(value);
}

/// All four.
static inline __attribute__((always_inline)) __m128 metamerAllLanes(float value) {
  __asm__("" : "+r"(value));
  return (__m128)wasm_f32x4_splat(value);
}

#undef _mm_set1_ps
#define _mm_set1_pd metamerBothLanes
#define _mm_set1_ps metamerAllLanes
#define _mm_set_ps1 metamerAllLanes
