// SPDX-License-Identifier: Apache-2.0
// CUDA's words as far as the kernels use them, for a C++ compiler.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#define __device__
#define __global__
#define __forceinline__ inline

struct alignas(16) float4 {
  float x;
  float y;
  float z;
  float w;
};

inline float4 make_float4(float x, float y, float z, float w) {
  return {x, y, z, w};
}

struct CudaPlace {
  unsigned int x;
  unsigned int y;
};

// Of the thread that runs.
inline thread_local CudaPlace blockIdx;
inline thread_local CudaPlace blockDim;
inline thread_local CudaPlace threadIdx;

inline unsigned int __float_as_uint(float x) {
  return std::bit_cast<unsigned int>(x);
}
inline float __uint_as_float(unsigned int x) {
  return std::bit_cast<float>(x);
}
inline long long __double_as_longlong(double x) {
  return std::bit_cast<long long>(x);
}
inline double __longlong_as_double(unsigned long long x) {
  return std::bit_cast<double>(x);
}
inline float __fmaf_rn(float a, float b, float c) {
  return std::fma(a, b, c);
}
inline double __fma_rn(double a, double b, double c) {
  return std::fma(a, b, c);
}
inline float __fmul_rn(float a, float b) {
  return a * b;
}
inline float __fadd_rn(float a, float b) {
  return a + b;
}
inline float __fdiv_rn(float a, float b) {
  return a / b;
}
