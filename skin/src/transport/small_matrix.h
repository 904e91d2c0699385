// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

// Everything here becomes part of the solver, which is compiled for several instruction sets: nothing may stay a
// function of its own.
#if defined(__GNUC__)
#define METAMER_INLINE [[gnu::always_inline]] inline
#else
#include <Eigen/Core>
#define METAMER_INLINE inline
#endif

namespace metamer::skin {

/// Numbers of several wavelengths that go through one computation side by side.
inline constexpr std::size_t kLanes = 4;
#if defined(__GNUC__)
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
#else
using Lanes = Eigen::Array<double, kLanes, 1>;
#endif

/// A 4 x 4 matrix, a lane each. Aligned by hand: lanes ask for that only where the instruction set has such vectors,
/// and one of several sets reads what a function for none of them laid out.
struct alignas(kLanes * sizeof(double)) Matrix4 {
  std::array<Lanes, 16> m;

  METAMER_INLINE Lanes& operator()(std::size_t i, std::size_t j) { return m[4 * i + j]; }
  METAMER_INLINE const Lanes& operator()(std::size_t i, std::size_t j) const { return m[4 * i + j]; }
};

using Vector4 = std::array<Lanes, 4>;

METAMER_INLINE void multiply(const Matrix4& a, const Matrix4& b, Matrix4& result) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      result(i, j) = (a(i, 0) * b(0, j) + a(i, 1) * b(1, j)) + (a(i, 2) * b(2, j) + a(i, 3) * b(3, j));
    }
  }
}

/// A product that is known to be symmetric.
METAMER_INLINE void multiplySymmetric(const Matrix4& a, const Matrix4& b, Matrix4& result) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i; j < 4; ++j) {
      result(i, j) = (a(i, 0) * b(0, j) + a(i, 1) * b(1, j)) + (a(i, 2) * b(2, j) + a(i, 3) * b(3, j));
      result(j, i) = result(i, j);
    }
  }
}

METAMER_INLINE void multiply(const Matrix4& a, const Vector4& b, Vector4& result) {
  for (std::size_t i = 0; i < 4; ++i) {
    result[i] = (a(i, 0) * b[0] + a(i, 1) * b[1]) + (a(i, 2) * b[2] + a(i, 3) * b[3]);
  }
}

/// scale * a + shift * identity.
METAMER_INLINE void scaleAndShift(const Matrix4& a, double scale, double shift, Matrix4& result) {
  for (std::size_t i = 0; i < 16; ++i) {
    result.m[i] = scale * a.m[i];
  }
  for (std::size_t i = 0; i < 4; ++i) {
    result(i, i) = result(i, i) + shift;
  }
}

/// Inverse by cofactors, from the minors of the upper and the lower two rows.
METAMER_INLINE void invert(const Matrix4& a, Matrix4& result) {
  const Lanes s0 = a(0, 0) * a(1, 1) - a(1, 0) * a(0, 1);
  const Lanes s1 = a(0, 0) * a(1, 2) - a(1, 0) * a(0, 2);
  const Lanes s2 = a(0, 0) * a(1, 3) - a(1, 0) * a(0, 3);
  const Lanes s3 = a(0, 1) * a(1, 2) - a(1, 1) * a(0, 2);
  const Lanes s4 = a(0, 1) * a(1, 3) - a(1, 1) * a(0, 3);
  const Lanes s5 = a(0, 2) * a(1, 3) - a(1, 2) * a(0, 3);
  const Lanes c5 = a(2, 2) * a(3, 3) - a(3, 2) * a(2, 3);
  const Lanes c4 = a(2, 1) * a(3, 3) - a(3, 1) * a(2, 3);
  const Lanes c3 = a(2, 1) * a(3, 2) - a(3, 1) * a(2, 2);
  const Lanes c2 = a(2, 0) * a(3, 3) - a(3, 0) * a(2, 3);
  const Lanes c1 = a(2, 0) * a(3, 2) - a(3, 0) * a(2, 2);
  const Lanes c0 = a(2, 0) * a(3, 1) - a(3, 0) * a(2, 1);
  const Lanes scale = 1.0 / ((s0 * c5 - s1 * c4) + (s2 * c3 + s3 * c2) + (s5 * c0 - s4 * c1));
  result(0, 0) = (a(1, 1) * c5 - a(1, 2) * c4 + a(1, 3) * c3) * scale;
  result(0, 1) = (a(0, 2) * c4 - a(0, 1) * c5 - a(0, 3) * c3) * scale;
  result(0, 2) = (a(3, 1) * s5 - a(3, 2) * s4 + a(3, 3) * s3) * scale;
  result(0, 3) = (a(2, 2) * s4 - a(2, 1) * s5 - a(2, 3) * s3) * scale;
  result(1, 0) = (a(1, 2) * c2 - a(1, 0) * c5 - a(1, 3) * c1) * scale;
  result(1, 1) = (a(0, 0) * c5 - a(0, 2) * c2 + a(0, 3) * c1) * scale;
  result(1, 2) = (a(3, 2) * s2 - a(3, 0) * s5 - a(3, 3) * s1) * scale;
  result(1, 3) = (a(2, 0) * s5 - a(2, 2) * s2 + a(2, 3) * s1) * scale;
  result(2, 0) = (a(1, 0) * c4 - a(1, 1) * c2 + a(1, 3) * c0) * scale;
  result(2, 1) = (a(0, 1) * c2 - a(0, 0) * c4 - a(0, 3) * c0) * scale;
  result(2, 2) = (a(3, 0) * s4 - a(3, 1) * s2 + a(3, 3) * s0) * scale;
  result(2, 3) = (a(2, 1) * s2 - a(2, 0) * s4 - a(2, 3) * s0) * scale;
  result(3, 0) = (a(1, 1) * c1 - a(1, 0) * c3 - a(1, 2) * c0) * scale;
  result(3, 1) = (a(0, 0) * c3 - a(0, 1) * c1 + a(0, 2) * c0) * scale;
  result(3, 2) = (a(3, 1) * s1 - a(3, 0) * s3 - a(3, 2) * s0) * scale;
  result(3, 3) = (a(2, 0) * s3 - a(2, 1) * s1 + a(2, 2) * s0) * scale;
}

}  // namespace metamer::skin
