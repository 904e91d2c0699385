// SPDX-License-Identifier: Apache-2.0
// What only CUDA's driver knows: contexts of threads, addresses, streams that are not there.
#include "cuda_host.h"
#include "device_fixture.h"

namespace bare_host {
namespace {

constexpr OfxRectI kBounds = {-3, 2, 130, 25};
const std::map<std::string, Properties::Value> kLamp = {{"outputIlluminant", "HP1"}};

class OfxCuda : public OfxDevice {
 protected:
  const CudaHost& cuda() const { return dynamic_cast<const CudaHost&>(m_device); }
  CudaDriver& driver() const { return cuda().driver(); }
  void SetUp() override {
    OfxDevice::SetUp();
    driver().devices = 1;
    driver().hasContextId = true;
    driver().setCurrent(nullptr);
  }

  Case m_case{.source = {kBounds}, .output = {kBounds}, .window = kBounds};
};

TEST_F(OfxCuda, ALaunchCoversTheWindow) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, kLamp);
  expectTheProcessorsBits(*effect, m_case);
  EXPECT_EQ(driver().block[0] * driver().block[1] * driver().block[2], 64U);
  EXPECT_EQ(driver().grid[0], 3U);  // 133 pixels
  EXPECT_EQ(driver().grid[1], 23U);
  EXPECT_EQ(driver().stream, cuda().queue(0));
  EXPECT_EQ(driver().context, cuda().context());
}

TEST_F(OfxCuda, StreamsAreOffered) {
  const Host host(builtLibrary(), features());
  const auto descriptor = host.describe(0, kOfxImageEffectContextFilter);
  EXPECT_EQ(descriptor->properties.text("OfxImageEffectPropCudaStreamSupported"), "true");
  EXPECT_EQ(descriptor->properties.text("OfxImageEffectPropCPURenderSupported"), "true");
  host.act(0, kOfxActionUnload, nullptr, nullptr, nullptr);
}

TEST_F(OfxCuda, WithoutAStreamTheRenderIsDoneWhenItReturns) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, kLamp);
  Frame source({.bounds = kBounds});
  source.fill(testPixel);
  const DeviceFrame there(m_device, source);
  effect->connect("Source", there.image());
  effect->connect("Output", there.image());
  effect->useDevice("Cuda");
  EXPECT_EQ(draft(*effect, kBounds), kOfxStatOK);
  EXPECT_EQ(driver().stream, nullptr);
  EXPECT_EQ(ledger()->kernels, 1);
  EXPECT_EQ(ledger()->waits, 1);
}

TEST_F(OfxCuda, TheThreadsContextIsUsedAndLeft) {
  void* const other = driver().makeContext();
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, kLamp);
  driver().setCurrent(other);
  expectTheProcessorsBits(*effect, m_case);
  EXPECT_EQ(driver().context, other);
  driver().setCurrent(nullptr);
  expectTheProcessorsBits(*effect, m_case);
  EXPECT_EQ(driver().context, cuda().context());
  EXPECT_EQ(ledger()->programs, 2);
  driver().releaseContext(other);
}

TEST_F(OfxCuda, AContextAtTheAddressOfOneThatIsGoneIsAnother) {
  for (const bool hasContextId : {true, false}) {
    driver().hasContextId = hasContextId;
    const Host host(builtLibrary(), features());
    const auto effect = host.create(0, kLamp);
    expectTheProcessorsBits(*effect, m_case);
    const int programs = ledger()->programs;
    const CudaHost second;
    expectTheProcessorsBits(*effect, m_case, second);
    EXPECT_EQ(ledger()->programs, programs + 1);
  }
}

TEST_F(OfxCuda, AddressesOffTheirAlignmentAreReadBack) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, kLamp);
  m_case.begin = 2;
  expectTheProcessorsBits(*effect, m_case);
  EXPECT_EQ(ledger()->kernels, 0);
  m_case.source.depth = m_case.output.depth = kOfxBitDepthHalf;
  expectTheProcessorsBits(*effect, m_case);
  EXPECT_EQ(ledger()->kernels, 1);
  EXPECT_EQ(effect->message(), "");
}

TEST_F(OfxCuda, ADriverWithoutADeviceIsNotOffered) {
  driver().devices = 0;
  const Host host(builtLibrary(), features());
  const auto descriptor = host.describe(0, kOfxImageEffectContextFilter);
  EXPECT_EQ(descriptor->properties.text("OfxImageEffectPropCudaRenderSupported"), "");
  host.act(0, kOfxActionUnload, nullptr, nullptr, nullptr);
}

}  // namespace
}  // namespace bare_host
