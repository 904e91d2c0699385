// SPDX-License-Identifier: Apache-2.0
// A C door to the OFX plug-in in the bare test host: one Python process can time it beside its peers.
#include <memory>
#include <string>

#include "bare_host.h"

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
