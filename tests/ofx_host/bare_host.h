// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ofxCore.h>
#include <ofxImageEffect.h>
#include <ofxMultiThread.h>
#include <ofxParam.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "bare_properties.h"
#include "system.h"

// A host at the level of the C interface, for what a well-behaved host never does: pictures in any shape of memory,
// renders at once from many threads, suites that are missing.
namespace bare_host {

/// What the host has.
struct Features {
  int threads = 0;  ///< of its multi-thread suite; 0: it has none
  bool persistentMessages = true;
  bool plainMessages = true;
  bool parameters = true;
  std::string colourManagement = {};  ///< style; empty: it knows nothing of it
  std::string device = {};            ///< where its images may lie: "OpenCL", "Cuda", "Metal"; empty: in memory alone
};

/// An image as a clip hands it over. The memory is the test's.
struct Image {
  void* data = nullptr;
  OfxRectI bounds{};
  int rowBytes = 0;
  std::string depth = kOfxBitDepthFloat;
  std::string components = kOfxImageComponentRGBA;
  std::string premultiplication = kOfxImageUnPreMultiplied;
  std::string field = kOfxImageFieldNone;
  OfxPointD renderScale{1, 1};
};

struct Clip {
  Properties properties;
  bool isConnected = false;
  Image image;
  std::string name;
};

/// A parameter of an instance: one value for all times, or a function of time.
struct Parameter {
  std::string type;
  std::string name;
  Properties properties;
  mutable std::mutex mutex;
  Properties::Value value;
  std::function<double(double time)> animation;
  std::deque<std::string> oldTexts;  ///< texts handed out stay where they are
};

/// A descriptor or an instance.
struct Effect {
  Properties properties;
  std::map<std::string, std::unique_ptr<Clip>> clips;
  std::vector<std::string> parameterOrder;
  std::map<std::string, std::unique_ptr<Parameter>> parameters;
  std::atomic<int> imagesOut = 0;      ///< fetched and not given back
  std::atomic<int> pollsToAbort = -1;  ///< the poll that is answered yes; -1: none
  std::atomic<int> polls = 0;
  std::mutex messageMutex;
  std::string message;
  std::atomic<int> messagesShown = 0;

  OfxImageEffectHandle handle() { return reinterpret_cast<OfxImageEffectHandle>(this); }
};

class Instance;

/// Loads a bundle's library and talks to it. Several may be at once, one after the other over the same library.
class Host {
 public:
  explicit Host(const std::filesystem::path& library, const Features& features = {});
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  int pluginCount() const;
  OfxPlugin& plugin(int index) const;
  /// An action of a plug-in.
  OfxStatus act(int plugin, const char* action, Effect* effect, Properties* in, Properties* out) const;
  /// Load, describe, describe in the context: a descriptor.
  std::unique_ptr<Effect> describe(int plugin, const std::string& context) const;
  /// An instance; `settings` set before it is created.
  std::unique_ptr<Instance> create(int plugin, const std::map<std::string, Properties::Value>& settings = {},
                                   const std::string& context = kOfxImageEffectContextFilter) const;

 private:
  LoadedLibrary m_library;
  std::unique_ptr<struct HostState> m_state;
};

/// A bundle's library in the build tree.
std::filesystem::path builtLibrary();

class Instance {
 public:
  Instance(const Host& host, int plugin, std::unique_ptr<Effect> effect)
      : m_host(host), m_plugin(plugin), m_effect(std::move(effect)) {}
  ~Instance();
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  Effect& effect() { return *m_effect; }
  Clip& clip(const std::string& name) { return *m_effect->clips.at(name); }
  void connect(const std::string& clip, const Image& image);
  std::string message() const;

  /// Sets a parameter by hand, without telling the plug-in.
  void setSilently(const std::string& parameter, const Properties::Value& value);
  void animate(const std::string& parameter, std::function<double(double)> values);
  /// As a user does: a menu by its option's name. The plug-in is told.
  void set(const std::string& parameter, const Properties::Value& value);
  Properties::Value get(const std::string& parameter) const;
  std::string menuOption(const std::string& parameter) const;

  OfxStatus act(const char* action, Properties* in, Properties* out) const;
  /// @param window  in pixels at that scale
  OfxStatus render(const OfxRectI& window, double time = 0, const std::string& field = kOfxImageFieldNone,
                   OfxPointD renderScale = {1, 1}, bool isDraft = false) const;
  /// Renders from now on where the images' data say, a kind of Features::device, on this queue; "": in memory.
  void useDevice(const std::string& kind, void* queue = nullptr) {
    m_device = kind;
    m_queue = queue;
  }
  /// Name of the clip that stands for the result, or nothing.
  std::string identity(const OfxRectI& window, double time = 0) const;

 private:
  const Host& m_host;
  int m_plugin;
  std::unique_ptr<Effect> m_effect;
  std::string m_device;
  void* m_queue = nullptr;
};

}  // namespace bare_host
