// SPDX-License-Identifier: Apache-2.0
#include "exr_channels.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/missing_file_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_picture.h"

namespace metamer::spectral {
namespace {

/// Values of a row of pixels, all channels: more is no picture.
constexpr std::int64_t kMostRowValues = std::int64_t{1} << 26U;
constexpr std::int64_t kFloatBytes = sizeof(float);

void requireFile(const std::string& file) {
  std::error_code none;
  const auto status = std::filesystem::status(pathOf(file), none);
  if (status.type() == std::filesystem::file_type::not_found) {
    throw MissingFileError(file, "", "", "no such file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(file, "", "", "is a folder, device or pipe; give a regular file");
  }
}

/// Names of a part's channels that are wanted. Subsampled ones are none.
std::vector<std::string> wantedChannels(const Imf::Header& header,
                                        const std::function<bool(const std::string& channel)>& isWanted) {
  std::vector<std::string> names;
  if (header.hasType() && Imf::isDeepData(header.type())) {
    return names;
  }
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    if (channel.channel().xSampling == 1 && channel.channel().ySampling == 1 && isWanted(channel.name())) {
      names.emplace_back(channel.name());
    }
  }
  return names;
}

std::vector<ChannelValue> readPart(Imf::MultiPartInputFile& input, int part, const std::vector<std::string>& names,
                                   const std::string& file, const std::optional<PicturePlace>& place) {
  const Imath::Box2i window = input.header(part).dataWindow();
  const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1;
  const std::int64_t height = std::int64_t{window.max.y} - window.min.y + 1;
  if (width < 1 || height < 1 || width * static_cast<std::int64_t>(names.size()) > kMostRowValues) {
    throw InputError(file, "data window", std::to_string(width) + " x " + std::to_string(height),
                     "is empty or too wide; give a smaller picture");
  }
  if (place &&
      (place->x < window.min.x || place->x > window.max.x || place->y < window.min.y || place->y > window.max.y)) {
    throw InputError(file, "pixel", std::to_string(place->x) + "," + std::to_string(place->y),
                     "is outside the picture, which has x " + std::to_string(window.min.x) + " to " +
                         std::to_string(window.max.x) + ", y " + std::to_string(window.min.y) + " to " +
                         std::to_string(window.max.y));
  }
  std::vector<std::vector<float>> row(names.size(), std::vector<float>(static_cast<std::size_t>(width)));
  Imf::FrameBuffer buffer;
  for (std::size_t k = 0; k < names.size(); ++k) {
    // The address of x = 0; every row lies in the same place.
    auto* const zero = reinterpret_cast<char*>(row[k].data()) - std::int64_t{window.min.x} * kFloatBytes;
    buffer.insert(names[k], Imf::Slice(Imf::FLOAT, zero, sizeof(float), 0));
  }
  Imf::InputPart pixels(input, part);
  pixels.setFrameBuffer(buffer);
  std::vector<double> sums(names.size(), 0.0);
  const int first = place ? place->y : window.min.y;
  const int last = place ? place->y : window.max.y;
  for (int y = first; y <= last; ++y) {
    pixels.readPixels(y, y);
    for (std::size_t k = 0; k < names.size(); ++k) {
      if (place) {
        sums[k] = static_cast<double>(row[k][static_cast<std::size_t>(place->x - window.min.x)]);
        continue;
      }
      for (const float value : row[k]) {
        sums[k] += static_cast<double>(value);
      }
    }
  }
  std::vector<ChannelValue> values;
  for (std::size_t k = 0; k < names.size(); ++k) {
    const double mean = place ? sums[k] : sums[k] / (static_cast<double>(width) * static_cast<double>(height));
    if (!std::isfinite(mean)) {
      throw InputError(file, "channel", names[k], "has a pixel that is no finite number; name another, FILE:x,y");
    }
    values.push_back({names[k], mean});
  }
  return values;
}

}  // namespace

std::vector<ChannelValue> readExrChannels(const std::string& file, const std::optional<PicturePlace>& place,
                                          const std::function<bool(const std::string& channel)>& isWanted) {
  requireFile(file);
  try {
    Imf::MultiPartInputFile input(file.c_str(), 0);
    for (int part = 0; part < input.parts(); ++part) {
      const std::vector<std::string> names = wantedChannels(input.header(part), isWanted);
      if (!names.empty()) {
        return readPart(input, part, names, file, place);
      }
    }
    return {};
  } catch (const InputError&) {
    throw;
  } catch (const std::exception&) {
    throw InputError(file, "OpenEXR", "", "is damaged, cut short or no OpenEXR picture; write it again");
  }
}

}  // namespace metamer::spectral
