// SPDX-License-Identifier: Apache-2.0
#include "report/shown_pictures.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/parallel.h>

#include <algorithm>
#include <cmath>

#include "apply/any_picture.h"
#include "apply/layers.h"
#include "apply/picture_clues.h"
#include "metamer/sip/comparison.h"
#include "metamer/sip/homogeneous_map.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "report/page_parts.h"
#include "run.h"

namespace metamer::lutgen {
namespace {

namespace fs = std::filesystem;
using spectral::InputError;

constexpr std::int64_t kMostPixels = std::int64_t{1} << 28;
/// Every so-manieth pixel is solved exactly.
constexpr std::size_t kSampleStep = 16;

PictureSpace spaceOf(const SpaceClues& clues, const std::string& file, const PictureSpace& own,
                     const spectral::DataLibrary& library) {
  std::string doubt;
  const auto said = pictureSpaceOf(clues, file, library, doubt);
  if (!doubt.empty()) {
    note({doubt});
  }
  if (said) {
    return *said;
  }
  const bool isCoded = !clues.isFloat && own.isLinear();
  note({file + ": it does not say what its pixels are: taken as " + (isCoded ? "sRGB" : "the recipe's, " + own.name) +
        "; --picture-space names what they are"});
  return isCoded ? pictureSpaceNamed("sRGB", file, library, ocio::ConfigSource()) : own;
}

/// Rows of a picture, averaged in linear light over boxes; what is no number is left out.
class Shrinker {
 public:
  Shrinker(int width, int height)
      : m_width(width),
        m_height(height),
        m_scale(std::min(1.0, static_cast<double>(kShownSide) / std::max(width, height))),
        m_shownWidth(std::max(1, static_cast<int>(std::lround(width * m_scale)))),
        m_shownHeight(std::max(1, static_cast<int>(std::lround(height * m_scale)))),
        m_sums(static_cast<std::size_t>(m_shownWidth) * m_shownHeight * 4, 0.0) {}

  int width() const { return m_shownWidth; }
  int height() const { return m_shownHeight; }

  void add(int y, const std::vector<float>& rgba) {
    const auto row = static_cast<std::size_t>(static_cast<std::int64_t>(y) * m_shownHeight / m_height);
    for (int x = 0; x < m_width; ++x) {
      const float* pixel = &rgba[4 * static_cast<std::size_t>(x)];
      if (!std::isfinite(pixel[0]) || !std::isfinite(pixel[1]) || !std::isfinite(pixel[2])) {
        continue;
      }
      const auto column = static_cast<std::size_t>(static_cast<std::int64_t>(x) * m_shownWidth / m_width);
      double* sum = &m_sums[4 * (row * static_cast<std::size_t>(m_shownWidth) + column)];
      for (std::size_t k = 0; k < 3; ++k) {
        sum[k] += pixel[k];
      }
      sum[3] += 1;
    }
  }

  std::vector<float> rgba() const {
    std::vector<float> result(m_sums.size(), 1.0F);
    for (std::size_t i = 0; i < m_sums.size(); i += 4) {
      for (std::size_t k = 0; k < 3; ++k) {
        result[i + k] = m_sums[i + 3] > 0 ? static_cast<float>(m_sums[i + k] / m_sums[i + 3]) : 0.0F;
      }
    }
    return result;
  }

 private:
  int m_width;
  int m_height;
  double m_scale;
  int m_shownWidth;
  int m_shownHeight;
  std::vector<double> m_sums;
};

ShownPicture shownPicture(const fs::path& path, const std::string& file, const std::optional<PictureSpace>& stated,
                          const PictureSpace& own, const spectral::DataLibrary& library) {
  AnyPicture picture(path, kMostPixels);
  const std::vector<ColourLayer> layers = chooseLayers(picture.facts(), {}, file);
  const ColourLayer& layer = layers[0];
  const OIIO::ImageSpec& spec = picture.spec(layer.part);
  if (spec.deep || spec.depth > 1) {
    throw InputError(file, "pixels", spec.deep ? "deep" : "volume", "have no rows; flatten the picture first");
  }
  const PictureSpace from = stated ? *stated : spaceOf(cluesOf(picture, layer), file, own, library);
  const PixelFunction toOwn = inTurn({from.decode, between(from.linear, own.linear)});
  picture.load();
  const std::vector<float> rgb = picture.values(layer.part, {layer.channels.begin(), layer.channels.end()});
  Shrinker shrinker(spec.width, spec.height);
  const auto width = static_cast<std::size_t>(spec.width);
  std::vector<float> row(4 * width, 1.0F);
  for (int y = 0; y < spec.height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      std::copy_n(&rgb[3 * (static_cast<std::size_t>(y) * width + x)], 3, &row[4 * x]);
    }
    if (toOwn) {
      toOwn(row);
    }
    shrinker.add(y, row);
  }
  ShownPicture shown;
  shown.title = spectral::utf8(spectral::pathOf(file).filename());
  shown.pixels = from.name;
  shown.isFilm = !from.isDisplay;
  shown.width = shrinker.width();
  shown.height = shrinker.height();
  shown.linear = shrinker.rgba();
  return shown;
}

/// As a JPEG file, as small as need be. @param signals  RGBA, 0 ... 1
std::string jpegOf(const ShownPicture& picture, const std::vector<float>& signals, const fs::path& file,
                   std::size_t largest) {
  OIIO::ImageBuf pixels(OIIO::ImageSpec(picture.width, picture.height, 3, OIIO::TypeDesc::FLOAT));
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const std::size_t at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + x);
      pixels.setpixel(x, y, 0, &signals[at], 3);
    }
  }
  std::string bytes;
  for (const int quality : {88, 75, 60, 40, 20}) {
    pixels.specmod().attribute("Compression", "jpeg:" + std::to_string(quality));
    if (!pixels.write(spectral::utf8(file), OIIO::TypeDesc::UINT8, "jpeg")) {
      throw InputError(picture.title, "picture of the report", "", "cannot be written: " + pixels.geterror());
    }
    bytes = spectral::readTextFile(file);
    if (bytes.size() <= largest) {
      break;
    }
  }
  return bytes;
}

void inParallel(int count, const std::function<void(int)>& body) {
  OIIO::parallel_for(0, count, [&](std::int64_t k) { body(static_cast<int>(k)); });
}

std::vector<float> sampled(const std::vector<float>& rgba) {
  std::vector<float> sample;
  for (std::size_t at = 0; at < rgba.size(); at += 4 * kSampleStep) {
    sample.insert(sample.end(), &rgba[at], &rgba[at] + 4);
  }
  return sample;
}

}  // namespace

std::vector<ShownPicture> shownPictures(const std::vector<std::string>& files, const std::string& pictureSpace,
                                        const PictureSpace& space, const spectral::DataLibrary& library,
                                        const ocio::ConfigSource& config) {
  std::optional<PictureSpace> stated;
  if (!pictureSpace.empty()) {
    stated = pictureSpaceNamed(pictureSpace, "--picture-space", library, config);
  }
  std::vector<ShownPicture> pictures;
  for (const std::string& file : files) {
    pictures.push_back(shownPicture(spectral::pathOf(file), file, stated, space, library));
  }
  return pictures;
}

std::vector<ShownPicture> ownPhotographs(const PictureSpace& space, const FilmView& film,
                                         const spectral::DataLibrary& library, const WorkFolder& folder) {
  const PictureSpace shown{
      "what " + film.name() + "'s view shows", space.linear, [&film](std::span<float> rgba) { film.undo(rgba); }, {}};
  std::vector<ShownPicture> pictures;
  for (const auto& [name, title] : {std::pair("astronaut", "Portrait"), std::pair("coffee", "Coffee")}) {
    const std::string file = std::string(name) + ".jpg";
    pictures.push_back(shownPicture(folder.write(file, pagePart(file)), file, shown, space, library));
    pictures.back().title = title;
  }
  return pictures;
}

void relight(std::vector<ShownPicture>& pictures, const sip::SpectralTransform& transform,
             const std::vector<BakedForm>& forms, const Screen& screen, const FilmView& film, const WorkFolder& folder,
             std::size_t largestJpeg) {
  const sip::HomogeneousMap map = sip::buildHomogeneousMap(transform, sip::kDefaultMapTolerance, inParallel);
  const auto signals = [&](const ShownPicture& picture, std::vector<float> rgba) {
    picture.isFilm ? film.show(rgba) : screen.show(rgba);
    return rgba;
  };
  for (ShownPicture& picture : pictures) {
    std::vector<float> after(picture.linear.size());
    map.apply(picture.linear, after);
    picture.before = jpegOf(picture, signals(picture, picture.linear), folder.place("before.jpg"), largestJpeg);
    picture.after = jpegOf(picture, signals(picture, after), folder.place("after.jpg"), largestJpeg);
    const std::vector<float> sample = sampled(picture.linear);
    std::vector<float> exact = sample;
    transform.apply(exact);
    for (const BakedForm& form : forms) {
      std::vector<float> baked = sample;
      form.apply(baked);
      picture.p99.push_back(sip::comparePixels(transform.space(), exact, baked).p99);
    }
  }
}

}  // namespace metamer::lutgen
