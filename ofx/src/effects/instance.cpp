// SPDX-License-Identifier: Apache-2.0
#include "effects/instance.h"

#include "host/colour_management.h"
#include "metamer/spectral/input_error.h"

namespace metamer::ofx {
namespace {

FieldToRender fieldToRender(const PropertySet& arguments, const ClipImage& output) {
  const std::string field = arguments.findString(kOfxImageEffectPropFieldToRender).value_or(kOfxImageFieldNone);
  // An image of one field alone has only rows that are to be rendered.
  const bool isWholeFrame = output.field() == kOfxImageFieldNone || output.field() == kOfxImageFieldBoth;
  if (isWholeFrame && field == kOfxImageFieldLower) {
    return FieldToRender::Lower;
  }
  return isWholeFrame && field == kOfxImageFieldUpper ? FieldToRender::Upper : FieldToRender::Whole;
}

RenderQuality renderQuality(const PropertySet& arguments) {
  // Hosts of before OpenFX 1.4 do not have the property.
  return arguments.findInt(kOfxImageEffectPropRenderQualityDraft).value_or(0) != 0 ? RenderQuality::Draft
                                                                                   : RenderQuality::Final;
}

}  // namespace

Instance::Instance(const HostSuites& host, const Effect& effect, OfxImageEffectHandle handle, const Devices& devices)
    : m_host(host),
      m_effect(effect),
      m_handle(handle),
      m_devices(devices),
      m_values(host, handle, effect.parameters()),
      m_messages(host, handle),
      m_source(clip(kOfxImageEffectSimpleSourceClipName)),
      m_mask(clip(kMaskClipName)),
      m_output(clip(kOfxImageEffectOutputClipName)) {
  m_values.restoreMenus();
  m_effect.enableParameters(m_values);
}

OfxImageClipHandle Instance::clip(const char* name) const {
  OfxImageClipHandle found = nullptr;
  OfxPropertySetHandle properties = nullptr;
  return m_host.effect->clipGetHandle(m_handle, name, &found, &properties) == kOfxStatOK ? found : nullptr;
}

std::string Instance::clipString(OfxImageClipHandle clip, const char* property) const {
  OfxPropertySetHandle properties = nullptr;
  if (clip == nullptr || m_host.effect->clipGetPropertySet(clip, &properties) != kOfxStatOK) {
    return {};
  }
  return PropertySet(m_host, properties).findString(property).value_or("");
}

bool Instance::isConnected(OfxImageClipHandle clip) const {
  OfxPropertySetHandle properties = nullptr;
  return clip != nullptr && m_host.effect->clipGetPropertySet(clip, &properties) == kOfxStatOK &&
         PropertySet(m_host, properties).findInt(kOfxImageClipPropConnected).value_or(0) != 0;
}

void Instance::instanceChanged(const PropertySet& arguments) {
  if (arguments.getString(kOfxPropChangeReason) == kOfxChangeUserEdited &&
      arguments.getString(kOfxPropType) == kOfxTypeParameter) {
    m_values.followEdit(arguments.getString(kOfxPropName));
    m_effect.enableParameters(m_values);
  }
}

std::optional<std::string> Instance::hostSpace() const {
  for (const Parameter& parameter : m_effect.parameters()) {
    if (parameter.name == kHostSpaceName && m_values.flag(kHostSpaceName, 0)) {
      return negotiatedSpace(m_host, m_source);
    }
  }
  return std::nullopt;
}

std::shared_ptr<const PixelTransform> Instance::transformOrMessage(double time) {
  try {
    auto transform = m_effect.transform(m_values, time, hostSpace());
    m_messages.clear();
    return transform;
  } catch (const spectral::InputError& error) {
    m_messages.show(error.what());
    return nullptr;
  }
}

bool Instance::isIdentity(const PropertySet& arguments) {
  const double time = arguments.getDouble(kOfxPropTime);
  if (!(m_values.number(kMixName, time) > 0.0) ||
      clipString(m_source, kOfxImageEffectPropComponents) == kOfxImageComponentAlpha) {
    return true;
  }
  // With nothing but a message the picture passes through in render, where every host shows the message.
  const auto transform = transformOrMessage(time);
  return transform != nullptr && transform->isIdentity();
}

void Instance::clipPreferences(const PropertySet& answers) const {
  // One picture in, the same kind of picture out. Hosts that hold a preference fixed may refuse it.
  const std::string components = clipString(m_source, kOfxImageEffectPropComponents);
  const std::string depth = clipString(m_source, kOfxImageEffectPropPixelDepth);
  const std::string premultiplication = clipString(m_source, kOfxImageEffectPropPreMultiplication);
  const std::string output = std::string("_") + kOfxImageEffectOutputClipName;
  if (isConnected(m_source) && pixelFormat(depth, components)) {
    answers.trySet(("OfxImageClipPropComponents" + output).c_str(), components);
    answers.trySet(("OfxImageClipPropDepth" + output).c_str(), depth);
  }
  if (!premultiplication.empty()) {
    answers.trySet(kOfxImageEffectPropPreMultiplication, premultiplication);
  }
  const std::string wanted = m_effect.wantedSpace(m_values);
  if (!wanted.empty() && offersColourManagement(m_host)) {
    const std::string property =
        std::string(kOfxImageClipPropPreferredColourspaces) + "_" + kOfxImageEffectSimpleSourceClipName;
    const std::vector<std::string> spaces = preferredSpaces(wanted);
    for (std::size_t i = 0; i < spaces.size(); ++i) {
      answers.trySet(property.c_str(), spaces[i], static_cast<int>(i));
    }
  }
}

void Instance::render(const PropertySet& arguments) {
  const double time = arguments.getDouble(kOfxPropTime);
  const auto output = ClipImage::fetch(m_host, m_output, time);
  if (!output) {
    throw HostError(kOfxStatFailed, "no output image");
  }
  const auto source = ClipImage::fetch(m_host, m_source, time);
  const bool hasMask = isConnected(m_mask);
  const auto mask = hasMask ? ClipImage::fetch(m_host, m_mask, time) : std::nullopt;

  RenderJob job;
  job.output = output->pixels();
  job.window = arguments.getRectI(kOfxImageEffectPropRenderWindow);
  job.field = fieldToRender(arguments, *output);
  job.mix = m_values.number(kMixName, time);
  job.hasMask = hasMask;
  if (source) {
    job.source = source->pixels();
    job.premultiplication = source->premultiplication();
  }
  if (mask) {
    job.mask = mask->pixels();
  }
  std::shared_ptr<const PixelTransform> transform;
  if (job.output.format.components != Components::Alpha) {
    transform = transformOrMessage(time);
  }
  if (transform != nullptr && !transform->isIdentity() && job.mix > 0.0) {
    transform->prepare(renderQuality(arguments));
    job.transform = transform.get();
  }
  renderJob(arguments, job);
}

void Instance::renderJob(const PropertySet& arguments, const RenderJob& job) {
  const std::string refused =
      m_devices.render(m_host, arguments, job, [this] { return m_host.effect->abort(m_handle) != 0; });
  if (!refused.empty()) {
    m_messages.note(refused);
  }
}

}  // namespace metamer::ofx
