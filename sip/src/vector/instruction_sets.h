// SPDX-License-Identifier: Apache-2.0
// Which of the instruction sets that a kernel was compiled for it runs on. Highway compiles it for each; choosing is
// done here, so that nothing of Highway's own library is needed: what links the engine as an archive (the OFX plug-in,
// other programs) needs no shared library beside it.
#pragma once

#include <cstdint>

namespace metamer::sip {

/// Instruction sets of this processor, as Highway's bits (HWY_AVX2 and so on); a lower bit is the better one. Always
/// has the bits of the portable fallbacks. Thread-safe.
std::int64_t instructionSets();

/// Lets instructionSets() tell only those of `allowed` from now on, beside the portable fallbacks; 0: all again. For
/// tests and measurements of one set against another; not for while kernels run.
void allowInstructionSets(std::int64_t allowed);

}  // namespace metamer::sip
