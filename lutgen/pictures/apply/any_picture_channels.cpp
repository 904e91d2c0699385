// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "apply/any_picture.h"
#include "apply/sample_types.h"

namespace metamer::lutgen {

using OIIO::ImageSpec;
using OIIO::TypeDesc;

namespace {

/// Samples of one channel, `stride` bytes apart.
struct Samples {
  TypeDesc type;
  std::size_t stride;
};

void convert(const void* from, const Samples& before, void* to, const Samples& after, const ImageSpec& size) {
  const auto apart = [](const Samples& samples) { return static_cast<OIIO::stride_t>(samples.stride); };
  OIIO::convert_image(1, size.width, size.height * size.depth, 1, from, before.type, apart(before), OIIO::AutoStride,
                      OIIO::AutoStride, to, after.type, apart(after), OIIO::AutoStride, OIIO::AutoStride);
}

}  // namespace

std::vector<float> AnyPicture::values(int part, const std::vector<int>& channels) const {
  const Part& own = m_parts[static_cast<std::size_t>(part)];
  const std::size_t count = channels.size();
  std::vector<float> values(own.before.image_pixels() * count);
  for (std::size_t k = 0; k < count; ++k) {
    convert(own.samples.data() + offsetOf(own.before, channels[k]),
            {typeOf(own.before, channels[k]), own.before.pixel_bytes(true)}, &values[k],
            {TypeDesc::FLOAT, count * sizeof(float)}, own.before);
  }
  return values;
}

void AnyPicture::exchange(int part, const std::vector<int>& removed, const std::vector<std::string>& added) {
  Part& own = m_parts[static_cast<std::size_t>(part)];
  const ImageSpec before = own.before;
  ImageSpec after = before;
  after.channelnames.clear();
  after.channelformats.clear();
  after.alpha_channel = after.z_channel = -1;
  std::vector<int> kept;
  for (int c = 0; c < before.nchannels; ++c) {
    if (std::find(removed.begin(), removed.end(), c) != removed.end()) {
      continue;
    }
    after.alpha_channel = c == before.alpha_channel ? static_cast<int>(kept.size()) : after.alpha_channel;
    after.z_channel = c == before.z_channel ? static_cast<int>(kept.size()) : after.z_channel;
    after.channelnames.push_back(before.channelnames[static_cast<std::size_t>(c)]);
    after.channelformats.push_back(isExrType(typeOf(before, c)) ? typeOf(before, c) : TypeDesc(TypeDesc::FLOAT));
    kept.push_back(c);
  }
  for (const std::string& name : added) {
    after.channelnames.push_back(name);
    after.channelformats.emplace_back(TypeDesc::FLOAT);
  }
  after.nchannels = static_cast<int>(after.channelnames.size());
  after.format = TypeDesc::FLOAT;
  const bool isPlain = std::all_of(after.channelformats.begin(), after.channelformats.end(),
                                   [](TypeDesc type) { return type == TypeDesc::FLOAT; });
  if (isPlain) {
    after.channelformats.clear();
  }
  after.erase_attribute("oiio:BitsPerSample");
  if (after.find_attribute("DateTime") == nullptr) {
    after.attribute("DateTime", "");  // else the clock's: the same picture gives the same file
  }

  std::vector<char> samples(after.image_bytes(true));
  for (std::size_t k = 0; k < kept.size(); ++k) {
    const auto place = static_cast<int>(k);
    convert(own.samples.data() + offsetOf(before, kept[k]), {typeOf(before, kept[k]), before.pixel_bytes(true)},
            samples.data() + offsetOf(after, place), {typeOf(after, place), after.pixel_bytes(true)}, before);
  }
  own.samples = std::move(samples);
  own.before = own.after = after;
}

void AnyPicture::put(int part, int first, const std::vector<float>& values) {
  Part& own = m_parts[static_cast<std::size_t>(part)];
  const std::size_t pixels = own.before.image_pixels();
  const std::size_t count = values.size() / std::max<std::size_t>(pixels, 1);
  const std::size_t stride = own.before.pixel_bytes(true);
  char* to = own.samples.data() + offsetOf(own.before, first);
  for (std::size_t i = 0; i < pixels; ++i) {
    std::copy_n(reinterpret_cast<const char*>(&values[i * count]), count * sizeof(float), to + i * stride);
  }
}

std::string AnyPicture::text(int part, const std::string& attribute) const {
  return std::string(m_parts[static_cast<std::size_t>(part)].before.get_string_attribute(attribute));
}

void AnyPicture::setText(int part, const std::string& attribute, const std::string& text) {
  Part& own = m_parts[static_cast<std::size_t>(part)];
  for (ImageSpec* spec : {&own.before, &own.after}) {
    if (text.empty()) {
      spec->erase_attribute(attribute);
    } else {
      spec->attribute(attribute, text);
    }
  }
}

}  // namespace metamer::lutgen
