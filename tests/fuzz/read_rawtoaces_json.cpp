// SPDX-License-Identifier: Apache-2.0
#include "fuzz_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  metamer::spectral::fuzzReader(metamer::spectral::readRawtoacesJson, data, size);
  return 0;
}
