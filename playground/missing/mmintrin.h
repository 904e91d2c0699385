// SPDX-License-Identifier: Apache-2.0
// Eigen asks for it beside the headers of SSE, and uses nothing of it; emscripten has those of SSE alone.
#pragma once
