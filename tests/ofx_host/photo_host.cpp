// SPDX-License-Identifier: Apache-2.0
#include "photo_host.h"

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <thread>

#include "host_support.h"
#include "photo_clips.h"
#include "photo_parameters.h"

namespace photo_host {
namespace {

namespace ImageEffect = OFX::Host::ImageEffect;

std::string formatted(const char* format, va_list arguments) {
  char text[4096];
  std::vsnprintf(text, sizeof text, format, arguments);
  return text;
}

/// HostSupport's effect with pictures for clips and texts for parameters.
class EffectInstance final : public ImageEffect::Instance, public Effect {
 public:
  EffectInstance(ImageEffect::ImageEffectPlugin* plugin, ImageEffect::Descriptor& descriptor,
                 const std::string& context, ClipKind kind)
      : Instance(plugin, descriptor, context, false), m_kind(std::move(kind)) {}

  // Effect.
  void set(const std::string& parameter, const std::string& value) override {
    setSilently(parameter, value);
    beginInstanceChangedAction(kOfxChangeUserEdited);
    paramInstanceChangedAction(parameter, kOfxChangeUserEdited, 0, {1, 1});
    endInstanceChangedAction(kOfxChangeUserEdited);
  }
  std::string get(const std::string& parameter) const override { return value(parameter).text(); }
  std::map<std::string, std::string> save() const override {
    std::map<std::string, std::string> project;
    for (const auto& parameter : getParams()) {
      const auto* held = dynamic_cast<const TextValue*>(parameter.second);
      if (held != nullptr && parameter.second->getIsPersistant()) {
        project[parameter.first] = held->text();
      }
    }
    return project;
  }
  std::vector<std::string> menuOptions(const std::string& parameter) const override {
    const auto& properties = getParam(parameter)->getProperties();
    std::vector<std::string> options;
    for (int i = 0; i < properties.getDimension(kOfxParamPropChoiceOption); ++i) {
      options.push_back(properties.getStringProperty(kOfxParamPropChoiceOption, i));
    }
    return options;
  }
  bool isEnabled(const std::string& parameter) const override { return getParam(parameter)->getEnabled(); }

  void setSource(const Picture& picture) override {
    clipNamed(kOfxImageEffectSimpleSourceClipName).show(picture);
    Picture empty = picture;
    std::fill(empty.rgba.begin(), empty.rgba.end(), 0.0F);
    clipNamed(kOfxImageEffectOutputClipName).show(empty);
    getClipPreferences();
  }
  void setMask(const Picture& picture) override { clipNamed("Mask").show(picture); }

  std::string identityClip(const Window& window) override {
    OfxTime time = 0;
    std::string clip;
    const OfxStatus status =
        isIdentityAction(time, kOfxImageFieldNone, {window.x1, window.y1, window.x2, window.y2}, {1, 1}, clip);
    return status == kOfxStatOK ? clip : "";
  }

  Picture render(const std::vector<Window>& windows, double time) override {
    const OfxPointD scale = {1, 1};
    beginRenderAction(time, time, 1, false, scale, true, false);
    for (const Window& window : windows) {
      OfxRectD region = {double(window.x1), double(window.y1), double(window.x2), double(window.y2)};
      std::map<ImageEffect::ClipInstance*, OfxRectD> regions;
      getRegionOfInterestAction(time, scale, region, regions);
      m_status = renderAction(time, kOfxImageFieldNone, {window.x1, window.y1, window.x2, window.y2}, scale, true,
                              false, false);
      if (m_status != kOfxStatOK) {
        break;
      }
    }
    endRenderAction(time, time, 1, false, scale, true, false);
    return clipNamed(kOfxImageEffectOutputClipName).shown();
  }
  int lastStatus() const override { return m_status; }
  std::string message() const override { return m_message; }

  void setSilently(const std::string& parameter, const std::string& text) { assign(parameter, text); }

  // ImageEffect::Instance.
  const std::string& getDefaultOutputFielding() const override {
    static const std::string none(kOfxImageFieldNone);
    return none;
  }
  ImageEffect::ClipInstance* newClipInstance(ImageEffect::Instance* effect, ImageEffect::ClipDescriptor* descriptor,
                                             int) override {
    ClipKind kind = m_kind;
    if (descriptor->isMask()) {
      kind.components = kOfxImageComponentAlpha;
    }
    return new Clip(effect, *descriptor, kind);
  }
  OfxStatus vmessage(const char*, const char*, const char* format, va_list arguments) override {
    m_message = formatted(format, arguments);
    return kOfxStatOK;
  }
  OfxStatus setPersistentMessage(const char* type, const char* id, const char* format, va_list arguments) override {
    return vmessage(type, id, format, arguments);
  }
  OfxStatus clearPersistentMessage() override {
    m_message.clear();
    return kOfxStatOK;
  }
  void getProjectSize(double& x, double& y) const override { x = y = 4096; }
  void getProjectOffset(double& x, double& y) const override { x = y = 0; }
  void getProjectExtent(double& x, double& y) const override { x = y = 4096; }
  double getProjectPixelAspectRatio() const override { return 1; }
  double getEffectDuration() const override { return 1e6; }
  double getFrameRate() const override { return 24; }
  double getFrameRecursive() const override { return 0; }
  void getRenderScaleRecursive(double& x, double& y) const override { x = y = 1; }

  // Param::SetInstance, Progress, TimeLine.
  OFX::Host::Param::Instance* newParam(const std::string&, OFX::Host::Param::Descriptor& descriptor) override {
    return newParameter(this, descriptor);
  }
  OfxStatus editBegin(const std::string&) override { return kOfxStatOK; }
  OfxStatus editEnd() override { return kOfxStatOK; }
  void progressStart(const std::string&, const std::string&) override {}
  void progressEnd() override {}
  bool progressUpdate(double) override { return true; }
  double timeLineGetTime() override { return 0; }
  void timeLineGotoTime(double) override {}
  void timeLineGetBounds(double& first, double& last) override {
    first = 0;
    last = 1e6;
  }

 private:
  Clip& clipNamed(const std::string& name) const { return dynamic_cast<Clip&>(*getClip(name)); }
  TextValue& value(const std::string& parameter) const {
    auto* held = dynamic_cast<TextValue*>(getParam(parameter));
    if (held == nullptr) {
      throw std::runtime_error("no parameter " + parameter);
    }
    return *held;
  }
  void assign(const std::string& parameter, const std::string& text) const {
    TextValue& held = value(parameter);
    try {
      held.setText(text);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(parameter + ": " + error.what());
    }
  }

  ClipKind m_kind;
  int m_status = kOfxStatOK;
  std::string m_message;
};

/// HostSupport's host with a real multi-thread suite.
class HostDescription final : public ImageEffect::Host {
 public:
  explicit HostDescription(int threads) : m_threads(threads) {
    _properties.setStringProperty(kOfxPropName, "org.metamer.PhotoHost");
    _properties.setStringProperty(kOfxPropLabel, "Photo host");
    _properties.setIntProperty(kOfxPropAPIVersion, 1, 0);
    _properties.setIntProperty(kOfxPropAPIVersion, 4, 1);
    _properties.setIntProperty(kOfxImageEffectPropSupportsMultiResolution, 1);
    _properties.setIntProperty(kOfxImageEffectPropSupportsTiles, 1);
    _properties.setIntProperty(kOfxImageEffectPropSupportsMultipleClipDepths, 1);
    const char* components[] = {kOfxImageComponentRGBA, kOfxImageComponentRGB, kOfxImageComponentAlpha};
    for (int i = 0; i < 3; ++i) {
      _properties.setStringProperty(kOfxImageEffectPropSupportedComponents, components[i], i);
    }
    _properties.setStringProperty(kOfxImageEffectPropSupportedContexts, kOfxImageEffectContextFilter, 0);
    _properties.setStringProperty(kOfxImageEffectPropSupportedContexts, kOfxImageEffectContextGeneral, 1);
  }

  ClipKind kindOfNext;

  ImageEffect::Instance* newInstance(void*, ImageEffect::ImageEffectPlugin* plugin, ImageEffect::Descriptor& descriptor,
                                     const std::string& context) override {
    return new EffectInstance(plugin, descriptor, context, kindOfNext);
  }
  ImageEffect::Descriptor* makeDescriptor(ImageEffect::ImageEffectPlugin* plugin) override {
    return new ImageEffect::Descriptor(plugin);
  }
  ImageEffect::Descriptor* makeDescriptor(const ImageEffect::Descriptor& root,
                                          ImageEffect::ImageEffectPlugin* plugin) override {
    return new ImageEffect::Descriptor(root, plugin);
  }
  ImageEffect::Descriptor* makeDescriptor(const std::string& bundle, ImageEffect::ImageEffectPlugin* plugin) override {
    return new ImageEffect::Descriptor(bundle, plugin);
  }
  OfxStatus vmessage(const char*, const char*, const char*, va_list) override { return kOfxStatOK; }
  OfxStatus setPersistentMessage(const char*, const char*, const char*, va_list) override { return kOfxStatOK; }
  OfxStatus clearPersistentMessage() override { return kOfxStatOK; }

  OfxStatus multiThread(OfxThreadFunctionV1 function, unsigned int count, void* argument) override {
    std::vector<std::thread> threads;
    for (unsigned int i = 1; i < count; ++i) {
      threads.emplace_back(function, i, count, argument);
    }
    function(0, count, argument);
    for (std::thread& thread : threads) {
      thread.join();
    }
    return kOfxStatOK;
  }
  OfxStatus multiThreadNumCPUS(unsigned int* count) const override {
    *count = static_cast<unsigned int>(m_threads);
    return kOfxStatOK;
  }
  OfxStatus multiThreadIndex(unsigned int* index) const override {
    *index = 0;
    return kOfxStatOK;
  }
  int multiThreadIsSpawnedThread() const override { return 0; }
  // The effect under test takes no mutex of the host's.
  OfxStatus mutexCreate(OfxMutexHandle*, int) override { return kOfxStatErrUnsupported; }
  OfxStatus mutexDestroy(const OfxMutexHandle) override { return kOfxStatErrUnsupported; }
  OfxStatus mutexLock(const OfxMutexHandle) override { return kOfxStatErrUnsupported; }
  OfxStatus mutexUnLock(const OfxMutexHandle) override { return kOfxStatErrUnsupported; }
  OfxStatus mutexTryLock(const OfxMutexHandle) override { return kOfxStatErrUnsupported; }

 private:
  int m_threads;
};

}  // namespace

struct Host::State {
  explicit State(int threads) : description(threads), effects(description) {}

  HostDescription description;
  ImageEffect::PluginCache effects;
};

Host::Host(const std::string& pluginFolder, int threads) : m_state(std::make_unique<State>(threads)) {
  OFX::Host::PluginCache& cache = *OFX::Host::PluginCache::getPluginCache();
  m_state->effects.registerInCache(cache);
  cache.addFileToPath(pluginFolder);
  cache.scanPluginFiles();
}

Host::~Host() {
  OFX::Host::PluginCache::clearPluginCache();
}

std::vector<std::string> Host::plugins() const {
  std::vector<std::string> names;
  for (const auto* plugin : m_state->effects.getPlugins()) {
    names.push_back(plugin->getIdentifier());
  }
  return names;
}

std::vector<std::string> Host::contexts(const std::string& plugin) const {
  const auto& contexts = m_state->effects.getPluginById(plugin)->getContexts();
  return {contexts.begin(), contexts.end()};
}

std::unique_ptr<Effect> Host::create(const std::string& plugin, const std::string& context, const ClipKind& kind,
                                     const std::map<std::string, std::string>& settings) {
  ImageEffect::ImageEffectPlugin* found = m_state->effects.getPluginById(plugin);
  if (found == nullptr) {
    throw std::runtime_error("no plug-in " + plugin + " in the folder; list prints those that are");
  }
  m_state->description.kindOfNext = kind;
  std::unique_ptr<ImageEffect::Instance> made(found->createInstance(context, nullptr));
  auto* effect = dynamic_cast<EffectInstance*>(made.get());
  if (effect == nullptr) {
    throw std::runtime_error("no instance of " + plugin);
  }
  for (const auto& setting : settings) {
    effect->setSilently(setting.first, setting.second);
  }
  if (effect->createInstanceAction() != kOfxStatOK) {
    throw std::runtime_error("createInstance failed for " + plugin);
  }
  static_cast<void>(made.release());  // it is the same object, owned as an Effect from here on
  return std::unique_ptr<Effect>(effect);
}

}  // namespace photo_host
