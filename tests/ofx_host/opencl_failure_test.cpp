// SPDX-License-Identifier: Apache-2.0
// Where there is no OpenCL, or what there is fails: the processor's picture, and one message at most.
#include "opencl_fixture.h"

namespace bare_host {
namespace {

constexpr OfxRectI kBounds = {0, 0, 33, 20};
constexpr const char* kSupported = "OfxImageEffectPropOpenCLRenderSupported";
constexpr OfxStatus kDeviceRenderFailed = 1002;

std::string offered(const Features& features) {
  const Host host(builtLibrary(), features);
  const std::string supported = host.describe(0, kOfxImageEffectContextFilter)->properties.text(kSupported);
  host.act(0, kOfxActionUnload, nullptr, nullptr, nullptr);
  return supported;
}

class OfxOpenClFailure : public OfxOpenCl {
 protected:
  std::map<std::string, Properties::Value> m_settings = {{"outputIlluminant", "A"}};
  Case m_case{.source = {kBounds}, .output = {kBounds}, .window = kBounds};
};

TEST_F(OfxOpenClFailure, ItIsOfferedWhereHostAndLibraryHaveIt) {
  EXPECT_EQ(offered({.openCl = true}), "true");
  EXPECT_EQ(offered({}), "");
  for (const char* const elsewhere : {"off", "no-such-library.so", "libm.so.6"}) {
    setenv("METAMER_OFX_OPENCL", elsewhere, 1);
    EXPECT_EQ(offered({.openCl = true}), "") << elsewhere;
  }
}

TEST_F(OfxOpenClFailure, WithoutItTheProcessorRendersAsEver) {
  setenv("METAMER_OFX_OPENCL", "no-such-library.so", 1);
  const Host host(builtLibrary(), {.openCl = true});
  const auto effect = host.create(0, m_settings);
  Frame source({.bounds = kBounds});
  source.fill(testPixel);
  Frame output({.bounds = kBounds});
  effect->connect("Source", source.image());
  effect->connect("Output", output.image());
  EXPECT_EQ(draft(*effect, kBounds), kOfxStatOK);
  EXPECT_NE(output.at(3, 3), source.at(3, 3));
  EXPECT_EQ(effect->effect().messagesShown, 0);
  // A host that does not ask first is told to do without.
  effect->useOpenCl(m_device.queue());
  EXPECT_EQ(draft(*effect, kBounds), kDeviceRenderFailed);
  EXPECT_EQ(effect->effect().imagesOut, 0);
}

TEST_F(OfxOpenClFailure, WhereTheDriverRefusesTheProcessorAnswers) {
  for (const char* const refused : {"clBuildProgram", "clCreateProgramWithSource", "clCreateKernel", "clCreateBuffer",
                                    "clSetKernelArg", "clGetKernelWorkGroupInfo", "clEnqueueNDRangeKernel"}) {
    SCOPED_TRACE(refused);
    const Host host(builtLibrary(), {.openCl = true});
    const auto effect = host.create(0, m_settings);
    ledger()->refused = refused;
    ledger()->status = -6;
    for (int frame = 0; frame < 3; ++frame) {
      expectTheProcessorsBits(*effect, m_case);
    }
    EXPECT_EQ(effect->effect().messagesShown, 1);
    EXPECT_NE(effect->message().find("the processor renders"), std::string::npos) << effect->message();
    EXPECT_EQ(ledger()->kernels, 0);
  }
}

TEST_F(OfxOpenClFailure, ADeviceWithoutDoublesHasFewerKernels) {
  const Host host(builtLibrary(), {.openCl = true});
  m_settings["space"] = "ACEScct";
  const auto effect = host.create(0, m_settings);
  ledger()->refused = "clCreateKernel";
  ledger()->status = -46;
  expectTheProcessorsBits(*effect, m_case);
  EXPECT_EQ(ledger()->kernels, 0);
  EXPECT_EQ(effect->effect().messagesShown, 0);
}

TEST_F(OfxOpenClFailure, ADriverThatCannotCompileIsAskedOnce) {
  const Host host(builtLibrary(), {.openCl = true});
  const auto effect = host.create(0, m_settings);
  ledger()->refused = "clBuildProgram";
  ledger()->status = -11;
  expectTheProcessorsBits(*effect, m_case);
  ledger()->refused = nullptr;
  expectTheProcessorsBits(*effect, m_case);
  EXPECT_EQ(ledger()->programs, 0);
  EXPECT_NE(effect->message().find("does not compile"), std::string::npos) << effect->message();
}

TEST_F(OfxOpenClFailure, ALostContextIsForTheHostToDoWithout) {
  const Host host(builtLibrary(), {.openCl = true});
  const auto effect = host.create(0, m_settings);
  expectTheProcessorsBits(*effect, m_case);
  Frame source({.bounds = kBounds});
  const OpenClFrame there(m_device, source);
  effect->connect("Source", there.image());
  effect->connect("Output", there.image());
  effect->useOpenCl(m_device.queue());
  // Nothing can be read back either.
  for (const char* const refused : {"clEnqueue", "clGet"}) {
    ledger()->refused = refused;
    ledger()->status = -36;
    EXPECT_EQ(draft(*effect, kBounds), kDeviceRenderFailed);
    EXPECT_EQ(effect->effect().imagesOut, 0);
  }
  EXPECT_LE(effect->effect().messagesShown, 1);
  ledger()->refused = nullptr;
  expectTheProcessorsBits(*effect, m_case);
}

TEST_F(OfxOpenClFailure, RowsBeyondTheirBufferAreRefused) {
  const Host host(builtLibrary(), {.openCl = true});
  const auto effect = host.create(0, m_settings);
  Frame source({.bounds = kBounds});
  Frame output({.bounds = kBounds});
  const OpenClFrame sourceThere(m_device, source);
  const OpenClFrame outputThere(m_device, output);
  Image longer = sourceThere.image();
  longer.bounds.y2 += 1;
  effect->connect("Source", longer);
  effect->connect("Output", outputThere.image());
  effect->useOpenCl(m_device.queue());
  EXPECT_EQ(draft(*effect, kBounds), kOfxStatErrImageFormat);
  EXPECT_EQ(effect->effect().imagesOut, 0);
  EXPECT_EQ(ledger()->kernels, 0);
}

}  // namespace
}  // namespace bare_host
