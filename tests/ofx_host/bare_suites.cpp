// SPDX-License-Identifier: Apache-2.0
#include "bare_suites.h"

#include <ofxMessage.h>

#include <cstdarg>
#include <cstdio>
#include <string_view>
#include <thread>

namespace bare_host {
namespace {

std::atomic<int> suiteThreads = 1;
thread_local bool isSpawned = false;

Effect& effectOf(void* handle) {
  return *static_cast<Effect*>(handle);
}

// Image effects.

OfxStatus getPropertySet(OfxImageEffectHandle effect, OfxPropertySetHandle* properties) {
  *properties = effectOf(effect).properties.handle();
  return kOfxStatOK;
}
OfxStatus getParamSet(OfxImageEffectHandle effect, OfxParamSetHandle* set) {
  *set = reinterpret_cast<OfxParamSetHandle>(effect);
  return kOfxStatOK;
}
OfxStatus clipDefine(OfxImageEffectHandle effect, const char* name, OfxPropertySetHandle* properties) {
  auto& clip = effectOf(effect).clips[name];
  clip = std::make_unique<Clip>();
  clip->name = name;
  *properties = clip->properties.handle();
  return kOfxStatOK;
}
OfxStatus clipGetHandle(OfxImageEffectHandle effect, const char* name, OfxImageClipHandle* clip,
                        OfxPropertySetHandle* properties) {
  auto& clips = effectOf(effect).clips;
  const auto found = clips.find(name);
  if (found == clips.end()) {
    return kOfxStatErrBadHandle;
  }
  *clip = reinterpret_cast<OfxImageClipHandle>(found->second.get());
  if (properties != nullptr) {
    *properties = found->second->properties.handle();
  }
  return kOfxStatOK;
}
OfxStatus clipGetPropertySet(OfxImageClipHandle clip, OfxPropertySetHandle* properties) {
  *properties = reinterpret_cast<Clip*>(clip)->properties.handle();
  return kOfxStatOK;
}

/// An image handed out: a property set of its own.
struct HandedImage {
  Properties properties;
  Effect* effect;
};

OfxStatus clipGetImage(OfxImageClipHandle handle, OfxTime, const OfxRectD*, OfxPropertySetHandle* image) {
  Clip& clip = *reinterpret_cast<Clip*>(handle);
  if (!clip.isConnected) {
    *image = nullptr;
    return kOfxStatFailed;
  }
  auto* handed = new HandedImage;
  const Image& shown = clip.image;
  handed->effect = static_cast<Effect*>(std::get<void*>(*clip.properties.find("effect")));
  handed->properties.set(kOfxImagePropData, shown.data);
  handed->properties.setAll(kOfxImagePropBounds, {shown.bounds.x1, shown.bounds.y1, shown.bounds.x2, shown.bounds.y2});
  handed->properties.set(kOfxImagePropRowBytes, shown.rowBytes);
  handed->properties.set(kOfxImageEffectPropPixelDepth, shown.depth);
  handed->properties.set(kOfxImageEffectPropComponents, shown.components);
  handed->properties.set(kOfxImageEffectPropPreMultiplication, shown.premultiplication);
  handed->properties.set(kOfxImagePropField, shown.field);
  handed->properties.set(kOfxImageEffectPropRenderScale, 0, shown.renderScale.x);
  handed->properties.set(kOfxImageEffectPropRenderScale, 1, shown.renderScale.y);
  ++handed->effect->imagesOut;
  *image = handed->properties.handle();
  return kOfxStatOK;
}
OfxStatus clipReleaseImage(OfxPropertySetHandle image) {
  auto* handed = reinterpret_cast<HandedImage*>(image);  // the set is its first member
  --handed->effect->imagesOut;
  delete handed;
  return kOfxStatOK;
}
OfxStatus clipGetRegionOfDefinition(OfxImageClipHandle, OfxTime, OfxRectD*) {
  return kOfxStatFailed;
}
int abortRender(OfxImageEffectHandle effect) {
  Effect& polled = effectOf(effect);
  return polled.polls++ == polled.pollsToAbort ? 1 : 0;
}
OfxStatus imageMemoryAlloc(OfxImageEffectHandle, std::size_t, OfxImageMemoryHandle*) {
  return kOfxStatErrMemory;
}
OfxStatus imageMemoryFree(OfxImageMemoryHandle) {
  return kOfxStatErrBadHandle;
}
OfxStatus imageMemoryLock(OfxImageMemoryHandle, void**) {
  return kOfxStatErrBadHandle;
}
OfxStatus imageMemoryUnlock(OfxImageMemoryHandle) {
  return kOfxStatErrBadHandle;
}

const OfxImageEffectSuiteV1 effectSuite = {
    getPropertySet,     getParamSet,      clipDefine,       clipGetHandle,
    clipGetPropertySet, clipGetImage,     clipReleaseImage, clipGetRegionOfDefinition,
    abortRender,        imageMemoryAlloc, imageMemoryFree,  imageMemoryLock,
    imageMemoryUnlock};

// Parameters.

OfxStatus paramDefine(OfxParamSetHandle set, const char* type, const char* name, OfxPropertySetHandle* properties) {
  Effect& effect = effectOf(set);
  auto& parameter = effect.parameters[name];
  if (parameter != nullptr) {
    return kOfxStatErrExists;
  }
  parameter = std::make_unique<Parameter>();
  parameter->type = type;
  parameter->name = name;
  effect.parameterOrder.emplace_back(name);
  *properties = parameter->properties.handle();
  return kOfxStatOK;
}
OfxStatus paramGetHandle(OfxParamSetHandle set, const char* name, OfxParamHandle* parameter,
                         OfxPropertySetHandle* properties) {
  auto& parameters = effectOf(set).parameters;
  const auto found = parameters.find(name);
  if (found == parameters.end()) {
    return kOfxStatErrUnknown;
  }
  *parameter = reinterpret_cast<OfxParamHandle>(found->second.get());
  if (properties != nullptr) {
    *properties = found->second->properties.handle();
  }
  return kOfxStatOK;
}
OfxStatus paramSetGetPropertySet(OfxParamSetHandle set, OfxPropertySetHandle* properties) {
  *properties = effectOf(set).properties.handle();
  return kOfxStatOK;
}
OfxStatus paramGetPropertySet(OfxParamHandle parameter, OfxPropertySetHandle* properties) {
  *properties = reinterpret_cast<Parameter*>(parameter)->properties.handle();
  return kOfxStatOK;
}

OfxStatus readValue(Parameter& parameter, double time, std::va_list arguments) {
  const std::lock_guard lock(parameter.mutex);
  if (parameter.animation) {
    *va_arg(arguments, double*) = parameter.animation(time);
  } else if (const auto* number = std::get_if<double>(&parameter.value)) {
    *va_arg(arguments, double*) = *number;
  } else if (const auto* integer = std::get_if<int>(&parameter.value)) {
    *va_arg(arguments, int*) = *integer;
  } else if (const auto* text = std::get_if<std::string>(&parameter.value)) {
    if (parameter.oldTexts.empty() || parameter.oldTexts.back() != *text) {
      parameter.oldTexts.push_back(*text);
    }
    *va_arg(arguments, char**) = parameter.oldTexts.back().data();
  }
  return kOfxStatOK;
}

OfxStatus paramGetValue(OfxParamHandle handle, ...) {
  std::va_list arguments;
  va_start(arguments, handle);
  const OfxStatus status = readValue(*reinterpret_cast<Parameter*>(handle), 0, arguments);
  va_end(arguments);
  return status;
}
OfxStatus paramGetValueAtTime(OfxParamHandle handle, OfxTime time, ...) {
  std::va_list arguments;
  va_start(arguments, time);
  const OfxStatus status = readValue(*reinterpret_cast<Parameter*>(handle), time, arguments);
  va_end(arguments);
  return status;
}
OfxStatus paramGetDerivative(OfxParamHandle, OfxTime, ...) {
  return kOfxStatErrUnsupported;
}
OfxStatus paramGetIntegral(OfxParamHandle, OfxTime, OfxTime, ...) {
  return kOfxStatErrUnsupported;
}
OfxStatus paramSetValue(OfxParamHandle handle, ...) {
  auto& parameter = *reinterpret_cast<Parameter*>(handle);
  const std::lock_guard lock(parameter.mutex);
  std::va_list arguments;
  va_start(arguments, handle);
  if (std::holds_alternative<double>(parameter.value)) {
    parameter.value = va_arg(arguments, double);
  } else if (std::holds_alternative<int>(parameter.value)) {
    parameter.value = va_arg(arguments, int);
  } else {
    parameter.value = std::string(va_arg(arguments, const char*));
  }
  va_end(arguments);
  return kOfxStatOK;
}
OfxStatus paramSetValueAtTime(OfxParamHandle, OfxTime, ...) {
  return kOfxStatErrUnsupported;
}
OfxStatus paramGetNumKeys(OfxParamHandle, unsigned int* count) {
  *count = 0;
  return kOfxStatOK;
}
OfxStatus paramGetKeyTime(OfxParamHandle, unsigned int, OfxTime*) {
  return kOfxStatErrBadIndex;
}
OfxStatus paramGetKeyIndex(OfxParamHandle, OfxTime, int, int*) {
  return kOfxStatFailed;
}
OfxStatus paramDeleteKey(OfxParamHandle, OfxTime) {
  return kOfxStatErrBadIndex;
}
OfxStatus paramDeleteAllKeys(OfxParamHandle) {
  return kOfxStatOK;
}
OfxStatus paramCopy(OfxParamHandle, OfxParamHandle, OfxTime, const OfxRangeD*) {
  return kOfxStatErrUnsupported;
}
OfxStatus paramEditBegin(OfxParamSetHandle, const char*) {
  return kOfxStatOK;
}
OfxStatus paramEditEnd(OfxParamSetHandle) {
  return kOfxStatOK;
}

const OfxParameterSuiteV1 parameterSuite = {paramDefine,         paramGetHandle,   paramSetGetPropertySet,
                                            paramGetPropertySet, paramGetValue,    paramGetValueAtTime,
                                            paramGetDerivative,  paramGetIntegral, paramSetValue,
                                            paramSetValueAtTime, paramGetNumKeys,  paramGetKeyTime,
                                            paramGetKeyIndex,    paramDeleteKey,   paramDeleteAllKeys,
                                            paramCopy,           paramEditBegin,   paramEditEnd};

// Messages.

OfxStatus keepMessage(void* handle, const char* format, std::va_list arguments) {
  char text[4096];
  std::vsnprintf(text, sizeof text, format, arguments);
  Effect& effect = effectOf(handle);
  const std::lock_guard lock(effect.messageMutex);
  effect.message = text;
  ++effect.messagesShown;
  return kOfxStatOK;
}
OfxStatus message(void* handle, const char*, const char*, const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  const OfxStatus status = keepMessage(handle, format, arguments);
  va_end(arguments);
  return status;
}
OfxStatus setPersistentMessage(void* handle, const char*, const char*, const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  const OfxStatus status = keepMessage(handle, format, arguments);
  va_end(arguments);
  return status;
}
OfxStatus clearPersistentMessage(void* handle) {
  Effect& effect = effectOf(handle);
  const std::lock_guard lock(effect.messageMutex);
  effect.message.clear();
  return kOfxStatOK;
}

const OfxMessageSuiteV1 messageSuite1 = {message};
const OfxMessageSuiteV2 messageSuite2 = {message, setPersistentMessage, clearPersistentMessage};

// Threads.

OfxStatus multiThread(OfxThreadFunctionV1 function, unsigned int count, void* argument) {
  if (isSpawned) {
    return kOfxStatErrExists;
  }
  std::vector<std::jthread> threads;
  for (unsigned int i = 0; i < count; ++i) {
    threads.emplace_back([=] {
      isSpawned = true;
      function(i, count, argument);
    });
  }
  return kOfxStatOK;
}
OfxStatus multiThreadNumCPUs(unsigned int* count) {
  *count = static_cast<unsigned int>(suiteThreads);
  return kOfxStatOK;
}
OfxStatus multiThreadIndex(unsigned int* index) {
  *index = 0;
  return kOfxStatOK;
}
int multiThreadIsSpawnedThread() {
  return isSpawned ? 1 : 0;
}
OfxStatus noMutex(OfxMutexHandle*, int) {
  return kOfxStatErrUnsupported;
}
OfxStatus noMutexCall(const OfxMutexHandle) {
  return kOfxStatErrUnsupported;
}

const OfxMultiThreadSuiteV1 threadSuite = {
    multiThread, multiThreadNumCPUs, multiThreadIndex, multiThreadIsSpawnedThread, noMutex, noMutexCall,
    noMutexCall, noMutexCall,        noMutexCall};

}  // namespace

void setSuiteThreads(int threads) {
  suiteThreads = threads;
}

const void* fetchSuite(OfxPropertySetHandle host, const char* name, int version) {
  const std::string_view suite(name);
  const auto& state = *static_cast<HostState*>(std::get<void*>(*Properties::of(host).find("state")));
  const Features& features = state.features;
  if (suite == kOfxMessageSuite) {
    if (version == 2) {
      return features.persistentMessages ? &messageSuite2 : nullptr;
    }
    return version == 1 && features.plainMessages ? &messageSuite1 : nullptr;
  }
  if (version != 1) {
    return nullptr;
  }
  if (suite == kOfxPropertySuite) {
    return &propertySuite();
  }
  if (suite == kOfxImageEffectSuite) {
    return &effectSuite;
  }
  if (suite == kOfxParameterSuite) {
    return features.parameters ? &parameterSuite : nullptr;
  }
  return suite == kOfxMultiThreadSuite && features.threads > 0 ? &threadSuite : nullptr;
}

}  // namespace bare_host
