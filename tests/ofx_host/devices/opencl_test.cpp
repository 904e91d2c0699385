// SPDX-License-Identifier: Apache-2.0
// What only OpenCL's drivers do.
#include "device_fixture.h"

namespace bare_host {
namespace {

TEST_F(OfxDevice, WithoutDoublesThereAreFewerKernels) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, {{"outputIlluminant", "A"}, {"space", "ACEScct"}});
  ledger()->refused = "clCreateKernel";
  ledger()->status = -46;
  constexpr OfxRectI kBounds = {0, 0, 33, 20};
  expectTheProcessorsBits(*effect, {.source = {kBounds}, .output = {kBounds}, .window = kBounds});
  EXPECT_EQ(ledger()->kernels, 0);
  EXPECT_EQ(effect->effect().messagesShown, 0);
}

}  // namespace
}  // namespace bare_host
