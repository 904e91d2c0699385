// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

// A host for tests, on the OpenFX project's own HostSupport library. This header knows nothing of that library, which
// is C++14, so that tests of any standard can use it.
namespace photo_host {

struct Window {
  int x1 = 0;
  int y1 = 0;
  int x2 = 0;
  int y2 = 0;
};

/// Float RGBA, bottom row first, at a position of the image plane.
struct Picture {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  std::vector<float> rgba;
};

/// How the host stores and hands over the clips.
struct ClipKind {
  std::string depth = "OfxBitDepthFloat";
  std::string components = "OfxImageComponentRGBA";
  std::string premultiplication = "OfxImageAlphaUnPremultiplied";
};

class Effect;

/// One running host. Only one may be at a time: HostSupport has a global.
class Host {
 public:
  /// Scans a folder of bundles. `threads` > 1: the host's multi-thread suite runs that many.
  Host(const std::string& pluginFolder, int threads);
  ~Host();

  /// Identifiers of the effects found.
  std::vector<std::string> plugins() const;
  std::vector<std::string> contexts(const std::string& plugin) const;

  /// An instance with its default parameters, `settings` set before it is created as a loaded project does.
  /// @throws std::runtime_error
  std::unique_ptr<Effect> create(const std::string& plugin, const std::string& context, const ClipKind& kind,
                                 const std::map<std::string, std::string>& settings = {});

 private:
  struct State;
  std::unique_ptr<State> m_state;
};

class Effect {
 public:
  virtual ~Effect() = default;

  /// Sets a parameter as a user does: a number, 0 or 1, a menu's option by label, a text. The effect is told.
  virtual void set(const std::string& parameter, const std::string& value) = 0;
  virtual std::string get(const std::string& parameter) const = 0;
  /// Every parameter that is kept, as text: the host's project file. create() takes it back.
  virtual std::map<std::string, std::string> save() const = 0;
  virtual std::vector<std::string> menuOptions(const std::string& parameter) const = 0;
  virtual bool isEnabled(const std::string& parameter) const = 0;

  /// Pictures of the clips; no mask: not connected.
  virtual void setSource(const Picture& picture) = 0;
  virtual void setMask(const Picture& picture) = 0;

  /// Name of the clip that stands for the result; empty where the effect is no identity.
  virtual std::string identityClip(const Window& window) = 0;
  /// Renders the windows one after the other into one output with the source's bounds.
  virtual Picture render(const std::vector<Window>& windows, double time = 0) = 0;
  /// Of the last render action.
  virtual int lastStatus() const = 0;
  /// What the effect shows persistently; empty: nothing.
  virtual std::string message() const = 0;
};

}  // namespace photo_host
