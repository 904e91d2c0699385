// SPDX-License-Identifier: Apache-2.0
// A C door to the OFX plug-in in the bare test host: one Python process can time it beside its peers.
#include <memory>
#include <string>

#include "bare_host.h"
#include "devices/device_host.h"

namespace {

struct Session {
  Session(int threads, int plugin)
      : host(bare_host::builtLibrary(), {.threads = threads}), effect(host.create(plugin)) {}
  bare_host::Host host;
  std::unique_ptr<bare_host::Instance> effect;
  OfxRectI bounds{};
};

bare_host::Instance& effectOf(void* session) {
  return *static_cast<Session*>(session)->effect;
}

}  // namespace

/// An effect of the bundle by its index, in a host whose multi-thread suite runs this many threads. Free with ofxClose.
extern "C" void* ofxOpenEffect(int threads, int plugin) {
  return new Session(threads, plugin);
}

/// Spectral Transfer in a host whose multi-thread suite runs this many threads. Free with ofxClose.
extern "C" void* ofxOpen(int threads) {
  return new Session(threads, 0);
}

extern "C" void ofxClose(void* session) {
  delete static_cast<Session*>(session);
}

/// Float RGBA pictures of the same window, x1 ... x2 - 1 by y1 ... y2 - 1, each from its first pixel on with as many
/// bytes from row to row, which may be negative.
extern "C" void ofxConnectStrided(void* session, void* source, int sourceRowBytes, void* destination,
                                  int destinationRowBytes, int x1, int y1, int x2, int y2) {
  OfxRectI& bounds = static_cast<Session*>(session)->bounds;
  bounds = {x1, y1, x2, y2};
  bare_host::Image image;
  image.bounds = bounds;
  image.rowBytes = sourceRowBytes;
  image.data = source;
  effectOf(session).connect("Source", image);
  image.rowBytes = destinationRowBytes;
  image.data = destination;
  effectOf(session).connect("Output", image);
}

/// The same, row after row, from the origin.
extern "C" void ofxConnect(void* session, void* source, void* destination, int width, int height) {
  ofxConnectStrided(session, source, 16 * width, destination, 16 * width, 0, 0, width, height);
}

/// Sets a parameter as a user does: a menu by its option's name.
extern "C" void ofxSetText(void* session, const char* parameter, const char* value) {
  effectOf(session).set(parameter, std::string(value));
}

extern "C" void ofxSetNumber(void* session, const char* parameter, double value) {
  effectOf(session).set(parameter, value);
}

/// The same, as a draft.
extern "C" int ofxRenderDraft(void* session, double time) {
  return effectOf(session).render(static_cast<Session*>(session)->bounds, time, kOfxImageFieldNone, {1, 1}, true);
}

/// The whole picture at a time; the host's status.
extern "C" int ofxRender(void* session, double time) {
  return effectOf(session).render(static_cast<Session*>(session)->bounds, time);
}

namespace {

/// Pictures that lie in OpenCL buffers of the system's first device.
struct DeviceSession {
  DeviceSession(int width, int height) : shape{.bounds = {0, 0, width, height}}, source(shape), destination(shape) {}
  std::unique_ptr<bare_host::DeviceHost> device = bare_host::makeDeviceHost();
  bare_host::Host host{bare_host::builtLibrary(), {.device = device->words().kind}};
  std::unique_ptr<bare_host::Instance> effect = host.create(0);
  bare_host::Frame::Shape shape;
  bare_host::Frame source;
  bare_host::Frame destination;
  std::unique_ptr<bare_host::DeviceFrame> sourceThere;
  std::unique_ptr<bare_host::DeviceFrame> destinationThere;
};

}  // namespace

/// Spectral Transfer in a host whose pictures, float RGBA row after row, lie on a device; null where there is none.
/// Free with ofxCloseDevice.
extern "C" void* ofxOpenDevice(const float* pixels, int width, int height) {
  auto session = std::make_unique<DeviceSession>(width, height);
  if (!session->device->reason().empty()) {
    return nullptr;
  }
  session->source.fill([&](int x, int y) {
    const float* const pixel = pixels + 4 * (static_cast<std::ptrdiff_t>(y) * width + x);
    return bare_host::Frame::Rgba{pixel[0], pixel[1], pixel[2], pixel[3]};
  });
  session->sourceThere = std::make_unique<bare_host::DeviceFrame>(*session->device, session->source);
  session->destinationThere = std::make_unique<bare_host::DeviceFrame>(*session->device, session->destination);
  session->effect->connect("Source", session->sourceThere->image());
  session->effect->connect("Output", session->destinationThere->image());
  session->effect->useDevice(session->device->words().kind, session->device->queue());
  return session.release();
}

extern "C" void ofxCloseDevice(void* session) {
  delete static_cast<DeviceSession*>(session);
}

extern "C" void ofxSetTextOnDevice(void* session, const char* parameter, const char* value) {
  static_cast<DeviceSession*>(session)->effect->set(parameter, std::string(value));
}

/// The whole picture, and waits until it is there; the host's status.
extern "C" int ofxRenderOnDevice(void* session) {
  auto& given = *static_cast<DeviceSession*>(session);
  const OfxStatus status = given.effect->render(given.shape.bounds);
  float first = 0.0F;
  given.device->read(given.destinationThere->image().data, sizeof first, &first);
  return status;
}

/// What is there, float RGBA row after row.
extern "C" void ofxBringFromDevice(void* session, float* pixels) {
  auto& given = *static_cast<DeviceSession*>(session);
  given.destinationThere->bring();
  for (int y = 0; y < given.shape.bounds.y2; ++y) {
    for (int x = 0; x < given.shape.bounds.x2; ++x) {
      for (const float channel : given.destination.at(x, y)) {
        *pixels++ = channel;
      }
    }
  }
}
