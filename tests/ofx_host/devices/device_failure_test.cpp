// SPDX-License-Identifier: Apache-2.0
// Where there is no library for a device, or what there is fails: the processor's picture, and one message at most.
#include <chrono>
#include <future>

#include "device_fixture.h"

namespace bare_host {
namespace {

constexpr OfxRectI kBounds = {0, 0, 33, 20};
constexpr OfxStatus kDeviceRenderFailed = 1002;

class OfxDeviceFailure : public OfxDevice {
 protected:
  /// What a descriptor says of the device.
  std::string offered(const Features& features) const {
    const Host host(builtLibrary(), features);
    const auto descriptor = host.describe(0, kOfxImageEffectContextFilter);
    host.act(0, kOfxActionUnload, nullptr, nullptr, nullptr);
    return descriptor->properties.text("OfxImageEffectProp" + m_words.kind + "RenderSupported");
  }

  std::map<std::string, Properties::Value> m_settings = {{"outputIlluminant", "A"}};
  Case m_case{.source = {kBounds}, .output = {kBounds}, .window = kBounds};
};

TEST_F(OfxDeviceFailure, ItIsOfferedWhereHostAndLibraryHaveIt) {
  EXPECT_EQ(offered(features()), "true");
  EXPECT_EQ(offered({}), "");
  for (const char* const elsewhere : {"off", "no-such-library.so", "libm.so.6"}) {
    useLibrary(elsewhere);
    EXPECT_EQ(offered(features()), "") << elsewhere;
  }
}

TEST_F(OfxDeviceFailure, WithoutItTheProcessorRendersAsEver) {
  useLibrary("no-such-library.so");
  const Host host(builtLibrary(), features());
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
  onDevice(*effect);
  EXPECT_EQ(draft(*effect, kBounds), kDeviceRenderFailed);
  EXPECT_EQ(effect->effect().imagesOut, 0);
}

TEST_F(OfxDeviceFailure, WhereTheDriverRefusesTheProcessorAnswers) {
  for (const char* const refused : m_words.needless) {
    SCOPED_TRACE(refused);
    const Host host(builtLibrary(), features());
    const auto effect = host.create(0, m_settings);
    ledger()->refused = refused;
    ledger()->status = m_words.failure;
    for (int frame = 0; frame < 3; ++frame) {
      expectTheProcessorsBits(*effect, m_case);
    }
    EXPECT_EQ(effect->effect().messagesShown, 1);
    EXPECT_NE(effect->message().find("the processor renders"), std::string::npos) << effect->message();
    EXPECT_EQ(ledger()->kernels, 0);
  }
}

TEST_F(OfxDeviceFailure, EachCallFailingOnceIsLivedThrough) {
  int haveAnswered = 0;
  for (const char* const quality : {"Map", "Exact"}) {
    int answered = 0;
    for (int failing = 1;; ++failing) {
      SCOPED_TRACE(std::string(quality) + ", call " + std::to_string(failing));
      const Host host(builtLibrary(), features());
      const auto effect = host.create(0, m_settings);
      effect->set("quality", quality);
      Frame expected({.bounds = kBounds});
      drawExpected(*effect, expected);
      const Pictures pictures(*this, *effect, kBounds);
      ledger()->calls = 0;
      ledger()->failing = failing;
      ledger()->status = m_words.failure;
      const OfxStatus status = draft(*effect, kBounds);
      const bool hasFailed = ledger()->calls >= failing;
      ledger()->failing = 0;
      EXPECT_EQ(effect->effect().imagesOut, 0);
      EXPECT_LE(effect->effect().messagesShown, 1);
      EXPECT_TRUE(pictures.outputThere.bring());
      if (status == kOfxStatOK) {
        expectEqual(pictures.output, expected);
        ++answered;
      } else {
        EXPECT_EQ(status, kDeviceRenderFailed);
      }
      if (!hasFailed) {
        EXPECT_GT(failing, 5);
        EXPECT_EQ(status, kOfxStatOK);
        break;
      }
    }
    EXPECT_GE(answered, 1);
    haveAnswered += answered;
  }
  EXPECT_GT(haveAnswered, 4);
  EXPECT_EQ(ledger()->buffers, 0);
}

TEST_F(OfxDeviceFailure, AQueueThatTheHostHoldsForEverEndsTheReadBack) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, m_settings);
  effect->set("quality", "Exact");
  Frame source({.bounds = kBounds});
  source.fill(testPixel);
  Frame output({.bounds = kBounds});
  output.fill(testPixel);
  const Frame before = output;
  const DeviceFrame sourceThere(m_device, source);
  const DeviceFrame outputThere(m_device, output);
  effect->connect("Source", sourceThere.image());
  effect->connect("Output", outputThere.image());
  onDevice(*effect);
  void* const event = m_device.hold();
  auto rendered = std::async(std::launch::async, [&] { return draft(*effect, kBounds); });
  EXPECT_EQ(rendered.wait_for(std::chrono::seconds(40)), std::future_status::ready);
  // A host that aborts is answered at once.
  effect->effect().pollsToAbort = effect->effect().polls + 1;
  auto aborted = std::async(std::launch::async, [&] { return draft(*effect, kBounds); });
  EXPECT_EQ(aborted.wait_for(std::chrono::seconds(30)), std::future_status::ready);
  m_device.signal(event);
  EXPECT_EQ(rendered.get(), kDeviceRenderFailed);
  EXPECT_EQ(aborted.get(), kOfxStatOK);
  EXPECT_TRUE(outputThere.bring());
  expectEqual(output, before);
}

TEST_F(OfxDeviceFailure, ADriverThatCannotCompileIsAskedOnce) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, m_settings);
  ledger()->refused = m_words.compiling;
  ledger()->status = m_words.failure;
  expectTheProcessorsBits(*effect, m_case);
  ledger()->refused = nullptr;
  expectTheProcessorsBits(*effect, m_case);
  EXPECT_EQ(ledger()->programs, 0);
  EXPECT_NE(effect->message().find("does not compile"), std::string::npos) << effect->message();
}

TEST_F(OfxDeviceFailure, ALostContextIsForTheHostToDoWithout) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, m_settings);
  expectTheProcessorsBits(*effect, m_case);
  Frame source({.bounds = kBounds});
  const DeviceFrame there(m_device, source);
  effect->connect("Source", there.image());
  effect->connect("Output", there.image());
  onDevice(*effect);
  // Nothing can be read back either.
  for (const char* const refused : m_words.needed) {
    ledger()->refused = refused;
    ledger()->status = m_words.failure;
    EXPECT_EQ(draft(*effect, kBounds), kDeviceRenderFailed);
    EXPECT_EQ(effect->effect().imagesOut, 0);
  }
  EXPECT_LE(effect->effect().messagesShown, 1);
  ledger()->refused = nullptr;
  expectTheProcessorsBits(*effect, m_case);
}

TEST_F(OfxDeviceFailure, RowsBeyondTheirBufferAreRefused) {
  const Host host(builtLibrary(), features());
  const auto effect = host.create(0, m_settings);
  Frame source({.bounds = kBounds});
  Frame output({.bounds = kBounds});
  const DeviceFrame sourceThere(m_device, source);
  const DeviceFrame outputThere(m_device, output);
  Image longer = sourceThere.image();
  longer.bounds.y2 += 1;
  effect->connect("Source", longer);
  effect->connect("Output", outputThere.image());
  onDevice(*effect);
  EXPECT_EQ(draft(*effect, kBounds), kOfxStatErrImageFormat);
  EXPECT_EQ(effect->effect().imagesOut, 0);
  EXPECT_EQ(ledger()->kernels, 0);
}

}  // namespace
}  // namespace bare_host
