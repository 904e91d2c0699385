// SPDX-License-Identifier: Apache-2.0
#include "bare_host.h"

#include <stdexcept>
#include <string_view>

#include "bare_suites.h"

namespace bare_host {
namespace {

constexpr const char* kColourManagementStyle = "OfxImageEffectPropColourManagementStyle";
// OFX 1.5's properties of devices begin with this and the device's name.
constexpr const char* kDeviceProperty = "OfxImageEffectProp";

template <typename Function>
Function* symbol(const LoadedLibrary& library, const char* name) {
  return reinterpret_cast<Function*>(library.symbol(name));
}

/// An instance's parameter as its descriptor declares it, at its default.
std::unique_ptr<Parameter> instanceOf(const Parameter& descriptor) {
  auto parameter = std::make_unique<Parameter>();
  parameter->type = descriptor.type;
  parameter->name = descriptor.name;
  parameter->properties.set(kOfxParamPropEnabled, 1);
  for (int i = 0; i < descriptor.properties.dimension(kOfxParamPropChoiceOption); ++i) {
    parameter->properties.set(kOfxParamPropChoiceOption, i, descriptor.properties.text(kOfxParamPropChoiceOption, i));
  }
  if (descriptor.type == kOfxParamTypeDouble) {
    parameter->value = descriptor.properties.number(kOfxParamPropDefault);
  } else if (descriptor.type == kOfxParamTypeString) {
    parameter->value = descriptor.properties.text(kOfxParamPropDefault);
  } else {
    parameter->value = descriptor.properties.integer(kOfxParamPropDefault);
  }
  return parameter;
}

/// A menu's option by name as its position.
Properties::Value positioned(const Parameter& parameter, const Properties::Value& value) {
  const auto* option = std::get_if<std::string>(&value);
  if (parameter.type != kOfxParamTypeChoice || option == nullptr) {
    return value;
  }
  for (int i = 0; i < parameter.properties.dimension(kOfxParamPropChoiceOption); ++i) {
    if (parameter.properties.text(kOfxParamPropChoiceOption, i) == *option) {
      return i;
    }
  }
  throw std::runtime_error(parameter.name + " has no option " + *option);
}

}  // namespace

std::filesystem::path builtLibrary() {
  const std::filesystem::path given = libraryOfEnvironment();
  return given.empty() ? METAMER_OFX_LIBRARY : given;
}

Host::Host(const std::filesystem::path& library, const Features& features)
    : m_library(library), m_state(std::make_unique<HostState>()) {
  m_state->features = features;
  m_state->properties.set("state", static_cast<void*>(m_state.get()));
  if (!features.colourManagement.empty()) {
    m_state->properties.set(kColourManagementStyle, features.colourManagement);
  }
  if (!features.device.empty()) {
    m_state->properties.set(kDeviceProperty + features.device + "RenderSupported", "true");
  }
  m_state->host = {m_state->properties.handle(), fetchSuite};
  setSuiteThreads(features.threads);
  for (int i = 0; i < pluginCount(); ++i) {
    plugin(i).setHost(&m_state->host);
  }
}

Host::~Host() = default;

int Host::pluginCount() const {
  return symbol<int()>(m_library, "OfxGetNumberOfPlugins")();
}

OfxPlugin& Host::plugin(int index) const {
  return *symbol<OfxPlugin*(int)>(m_library, "OfxGetPlugin")(index);
}

OfxStatus Host::act(int index, const char* action, Effect* effect, Properties* in, Properties* out) const {
  return plugin(index).mainEntry(action, effect, in == nullptr ? nullptr : in->handle(),
                                 out == nullptr ? nullptr : out->handle());
}

std::unique_ptr<Effect> Host::describe(int index, const std::string& context) const {
  auto descriptor = std::make_unique<Effect>();
  Properties in;
  in.set(kOfxImageEffectPropContext, context);
  if (act(index, kOfxActionLoad, nullptr, nullptr, nullptr) != kOfxStatOK ||
      act(index, kOfxActionDescribe, descriptor.get(), nullptr, nullptr) != kOfxStatOK ||
      act(index, kOfxImageEffectActionDescribeInContext, descriptor.get(), &in, nullptr) != kOfxStatOK) {
    throw std::runtime_error("the plug-in cannot be described");
  }
  return descriptor;
}

std::unique_ptr<Instance> Host::create(int index, const std::map<std::string, Properties::Value>& settings,
                                       const std::string& context) const {
  const auto descriptor = describe(index, context);
  auto effect = std::make_unique<Effect>();
  effect->properties.set(kOfxImageEffectPropContext, context);
  effect->properties.set(kOfxPropInstanceData, static_cast<void*>(nullptr));
  for (const auto& [name, described] : descriptor->clips) {
    auto clip = std::make_unique<Clip>();
    clip->name = name;
    clip->properties.set("effect", static_cast<void*>(effect.get()));
    clip->properties.set(kOfxImageClipPropConnected, 0);
    effect->clips[name] = std::move(clip);
  }
  for (const auto& [name, described] : descriptor->parameters) {
    effect->parameters[name] = instanceOf(*described);
  }
  for (const auto& [name, value] : settings) {
    Parameter& parameter = *effect->parameters.at(name);
    parameter.value = positioned(parameter, value);
  }
  if (act(index, kOfxActionCreateInstance, effect.get(), nullptr, nullptr) != kOfxStatOK) {
    throw std::runtime_error("no instance could be created");
  }
  return std::make_unique<Instance>(*this, index, std::move(effect));
}

Instance::~Instance() {
  act(kOfxActionDestroyInstance, nullptr, nullptr);
  m_host.act(m_plugin, kOfxActionUnload, nullptr, nullptr, nullptr);
}

void Instance::connect(const std::string& name, const Image& image) {
  Clip& target = clip(name);
  target.isConnected = true;
  target.image = image;
  target.properties.set(kOfxImageClipPropConnected, 1);
  target.properties.set(kOfxImageEffectPropComponents, image.components);
  target.properties.set(kOfxImageEffectPropPixelDepth, image.depth);
  target.properties.set(kOfxImageEffectPropPreMultiplication, image.premultiplication);
}

std::string Instance::message() const {
  const std::lock_guard lock(m_effect->messageMutex);
  return m_effect->message;
}

void Instance::setSilently(const std::string& name, const Properties::Value& value) {
  Parameter& parameter = *m_effect->parameters.at(name);
  const std::lock_guard lock(parameter.mutex);
  parameter.value = positioned(parameter, value);
}

void Instance::animate(const std::string& name, std::function<double(double)> values) {
  m_effect->parameters.at(name)->animation = std::move(values);
}

void Instance::set(const std::string& name, const Properties::Value& value) {
  setSilently(name, value);
  Properties in;
  in.set(kOfxPropType, kOfxTypeParameter);
  in.set(kOfxPropName, name);
  in.set(kOfxPropChangeReason, kOfxChangeUserEdited);
  in.set(kOfxPropTime, 0.0);
  act(kOfxActionInstanceChanged, &in, nullptr);
}

Properties::Value Instance::get(const std::string& name) const {
  const Parameter& parameter = *m_effect->parameters.at(name);
  const std::lock_guard lock(parameter.mutex);
  return parameter.value;
}

std::string Instance::menuOption(const std::string& name) const {
  return m_effect->parameters.at(name)->properties.text(kOfxParamPropChoiceOption, std::get<int>(get(name)));
}

OfxStatus Instance::act(const char* action, Properties* in, Properties* out) const {
  return m_host.act(m_plugin, action, m_effect.get(), in, out);
}

OfxStatus Instance::render(const OfxRectI& window, double time, const std::string& field, OfxPointD scale,
                           bool isDraft) const {
  Properties in;
  in.set(kOfxPropTime, time);
  in.set(kOfxImageEffectPropFieldToRender, field);
  in.setAll(kOfxImageEffectPropRenderWindow, {window.x1, window.y1, window.x2, window.y2});
  in.set(kOfxImageEffectPropRenderScale, 0, scale.x);
  in.set(kOfxImageEffectPropRenderScale, 1, scale.y);
  in.set(kOfxImageEffectPropRenderQualityDraft, isDraft ? 1 : 0);
  if (!m_device.empty()) {
    const std::string prefix = kDeviceProperty + m_device;
    in.set(prefix + "Enabled", 1);
    if (m_queue != nullptr) {
      in.set(prefix + (m_device == "Cuda" ? "Stream" : "CommandQueue"), m_queue);
    }
  }
  return act(kOfxImageEffectActionRender, &in, nullptr);
}

std::string Instance::identity(const OfxRectI& window, double time) const {
  Properties in;
  Properties out;
  in.set(kOfxPropTime, time);
  in.set(kOfxImageEffectPropFieldToRender, kOfxImageFieldNone);
  in.setAll(kOfxImageEffectPropRenderWindow, {window.x1, window.y1, window.x2, window.y2});
  return act(kOfxImageEffectActionIsIdentity, &in, &out) == kOfxStatOK ? out.text(kOfxPropName) : "";
}

}  // namespace bare_host
