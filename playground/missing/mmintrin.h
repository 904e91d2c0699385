// SPDX-License-Identifier: Apache-2.0
// <mmintrin.h> for emscripten, whose SSE2 comes without MMX. Eigen asks for the header and takes nothing from it.
#pragma once
