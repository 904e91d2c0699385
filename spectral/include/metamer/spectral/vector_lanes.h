// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Before a function of no other file: it is compiled once more for wider vector lanes (AVX2), and the processor at
/// hand decides which one is called. For whole numbers, and for floats whose sums have a fixed order: without fused
/// products the lanes change no bit.
#if defined(__x86_64__) && defined(__linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define METAMER_VECTOR_LANES __attribute__((target_clones("default", "avx2")))
#else
#define METAMER_VECTOR_LANES
#endif

/// Of what such functions call, so that it is compiled for their lanes.
#ifdef __GNUC__
#define METAMER_ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define METAMER_ALWAYS_INLINE inline
#endif
