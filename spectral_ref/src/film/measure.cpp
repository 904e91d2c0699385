// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/measure.h"

#include <OpenImageIO/imageio.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/picture_file.h"
#include "metamer/spectral_ref/film.h"

namespace metamer::spectral_ref {
namespace {

using spectral::InputError;

/// A picture in memory, channels by name.
class PictureFile {
 public:
  explicit PictureFile(const std::filesystem::path& file) : m_where(spectral::utf8(file)) {
    spectral::requirePictureFile(m_where);
    const auto input = OIIO::ImageInput::open(m_where);
    if (!input) {
      const std::string reason = OIIO::geterror();
      throw InputError(m_where, "", "", "cannot be read: " + spectral::pictureReason(reason));
    }
    m_spec = input->spec();
    m_values.resize(m_spec.image_pixels() * static_cast<std::size_t>(m_spec.nchannels));
    if (!input->read_image(0, 0, 0, m_spec.nchannels, OIIO::TypeDesc::FLOAT, m_values.data())) {
      throw InputError(m_where, "", "", "cannot be read: " + spectral::pictureReason(input->geterror()));
    }
  }

  const OIIO::ImageSpec& spec() const { return m_spec; }
  const std::string& where() const { return m_where; }
  int channel(const std::string& name) const { return m_spec.channelindex(name); }
  int require(const std::string& name) const {
    const int index = channel(name);
    if (index < 0) {
      throw InputError(m_where, "channel", name, "is missing; measure reads pictures of spectral_ref render");
    }
    return index;
  }
  double at(int x, int y, int channel) const {
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(m_spec.width) + static_cast<std::size_t>(x);
    return static_cast<double>(
        m_values[pixel * static_cast<std::size_t>(m_spec.nchannels) + static_cast<std::size_t>(channel)]);
  }
  double mean(const PatchArea& area, int channel) const {
    double sum = 0;
    for (int y = area.y; y < area.y + area.height; ++y) {
      for (int x = area.x; x < area.x + area.width; ++x) {
        sum += at(x, y, channel);
      }
    }
    return sum / (static_cast<double>(area.width) * area.height);
  }

 private:
  std::string m_where;
  OIIO::ImageSpec m_spec;
  std::vector<float> m_values;
};

void checkArea(const PictureFile& picture, const PatchArea& area) {
  const OIIO::ImageSpec& spec = picture.spec();
  if (area.width < 1 || area.height < 1 || area.x < 0 || area.y < 0 || area.x > spec.width - area.width ||
      area.y > spec.height - area.height) {
    throw InputError(picture.where(), "patch", area.name,
                     "lies outside the picture, " + std::to_string(spec.width) + " x " + std::to_string(spec.height));
  }
}

void intervalFromReplicates(const PictureFile& picture, PatchMean& mean) {
  std::array<double, kReplicates> sums{};
  std::array<std::uint64_t, kReplicates> counts{};
  for (std::size_t g = 0; g < kReplicates; ++g) {
    const double value = picture.mean(mean.area, picture.require("replicate." + std::to_string(g) + ".Y"));
    // Replicates that have no sample yet are NaN; the others have all but the same number.
    counts[g] = std::isfinite(value) ? 1 : 0;
    sums[g] = std::isfinite(value) ? value : 0;
  }
  const Estimate estimate = Film::estimate(sums, counts);
  mean.variance = estimate.variance;
  mean.degrees = estimate.degrees;
}

void intervalFromPixels(const PictureFile& picture, PatchMean& mean) {
  const int channel = picture.require("variance.Y");
  double sum = 0;
  double squares = 0;
  const PatchArea& area = mean.area;
  for (int y = area.y; y < area.y + area.height; ++y) {
    for (int x = area.x; x < area.x + area.width; ++x) {
      const double variance = picture.at(x, y, channel);
      sum += variance;
      squares += variance * variance;
    }
  }
  const double pixels = static_cast<double>(area.width) * area.height;
  mean.variance = sum / (pixels * pixels);
  // Welch and Satterthwaite, each pixel with one degree less than replicates.
  mean.degrees = squares > 0 ? std::max(1.0, (kReplicates - 1) * sum * sum / squares) : (kReplicates - 1) * pixels;
}

}  // namespace

double studentQuantile(double p, double degrees) {
  // The density integrated by Simpson's rule from 0, and bisection: slow, plain and exact enough for an interval.
  const double scale = std::exp(std::lgamma(0.5 * (degrees + 1)) - std::lgamma(0.5 * degrees)) /
                       std::sqrt(degrees * 3.14159265358979323846);
  const auto below = [&](double t) {
    constexpr int kSteps = 2000;
    const double h = t / kSteps;
    double sum = 0;
    for (int i = 0; i <= kSteps; ++i) {
      const double x = h * i;
      const double weight = i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2;
      sum += weight * std::pow(1.0 + x * x / degrees, -0.5 * (degrees + 1));
    }
    return 0.5 + scale * sum * h / 3;
  };
  double low = 0;
  double high = 64;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (below(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Measurement measure(const std::filesystem::path& file, const std::vector<PatchArea>& areas) {
  const PictureFile picture(file);
  const std::array<int, 3> colour = {picture.require("R"), picture.require("G"), picture.require("B")};
  const bool hasReplicates = picture.channel("replicate.0.Y") >= 0;
  Measurement result;
  std::vector<int> bins;
  for (int c = 0; c < picture.spec().nchannels; ++c) {
    const std::string& name = picture.spec().channelnames[static_cast<std::size_t>(c)];
    if (name.rfind("S0.", 0) == 0) {
      std::string number = name.substr(3);
      std::replace(number.begin(), number.end(), ',', '.');
      result.wavelengthsNm.push_back(std::strtod(number.c_str(), nullptr));
      bins.push_back(c);
    }
  }
  const int luminance = picture.require("Y");
  for (const PatchArea& area : areas) {
    checkArea(picture, area);
    PatchMean mean;
    mean.area = area;
    for (std::size_t c = 0; c < 3; ++c) {
      mean.colour[c] = picture.mean(area, colour[c]);
    }
    mean.luminance = picture.mean(area, luminance);
    if (hasReplicates) {
      intervalFromReplicates(picture, mean);
    } else {
      intervalFromPixels(picture, mean);
    }
    constexpr double kUpper = 0.975;
    mean.halfWidth = mean.degrees >= 1 ? studentQuantile(kUpper, mean.degrees) * std::sqrt(mean.variance)
                                       : std::numeric_limits<double>::quiet_NaN();
    for (const int bin : bins) {
      mean.bins.push_back(picture.mean(area, bin));
    }
    result.patches.push_back(mean);
  }
  return result;
}

}  // namespace metamer::spectral_ref
