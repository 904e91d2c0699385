// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "metamer/spectral_ref/film_sums.h"
#include "metamer/spectral_ref/scene.h"

namespace metamer::spectral_ref {

/// The samples of a render fall into this many replicates with random numbers of their own, so that the spread between
/// them is an honest variance although the samples within each are stratified.
inline constexpr std::size_t kReplicates = 4;

/// How samples are dealt out to replicates: in blocks of `blockLength`, in turn.
struct Replicates {
  std::uint64_t blockLength = 1;

  std::size_t of(std::uint64_t sample) const { return sample / blockLength % kReplicates; }
  /// Place of a sample within its replicate.
  std::uint64_t index(std::uint64_t sample) const {
    return sample / (blockLength * kReplicates) * blockLength + sample % blockLength;
  }
  /// Samples below `end` that belong to a replicate.
  std::uint64_t countBelow(std::uint64_t end, std::size_t replicate) const;
  bool operator==(const Replicates&) const = default;
};

/// Samples that each pixel has taken: half-open ranges, rising, apart from each other.
using SampleRanges = std::vector<std::array<std::uint64_t, 2>>;

/// Samples in all of the ranges.
std::uint64_t sampleCount(const SampleRanges& ranges);
/// Joins other ranges to these. @return false, and nothing changed, where they overlap
bool uniteRanges(SampleRanges& ranges, const SampleRanges& others);

/// All that turns a film's sums into a picture.
struct FilmFormat {
  int width = 0;
  int height = 0;
  SpectralBins bins;
  Eigen::Matrix3d colourFromResponse = Eigen::Matrix3d::Identity();
  double colourScale = 1;  ///< 1, or 683 lm/W times the integral of the luminance curve for photometric films
  std::string space;
  std::optional<std::array<float, 8>> chromaticities;  ///< as FilmSettings has them
  std::string observer;
  Replicates replicates;
  int unitExponent = 0;  ///< sums are whole numbers of 2^unitExponent

  /// From a scene's settings.
  /// @param brightness  about what surfaces send of a scene's light, Y: sums are exact to 2^-44 of it. Above 0
  static FilmFormat of(const FilmSettings& settings, const Replicates& replicates, double brightness = 1);
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  /// Width of a bin within the domain, nm.
  double binWidthNm(int bin) const;
  bool operator==(const FilmFormat&) const = default;
};

/// A mean and what is known about its error.
struct Estimate {
  double mean = 0;
  double variance = 0;  ///< of the mean; NaN with fewer than two replicates
  int degrees = 0;      ///< degrees of freedom of the variance
};

/// What the pixels have gathered: exact sums, so that order and grouping do not matter.
class Film {
 public:
  explicit Film(FilmFormat format);

  // Channels of a pixel.
  static constexpr std::size_t kColour = 0;                           ///< three responses of the observer
  static constexpr std::size_t kHalf = 3;                             ///< the same, odd replicates alone
  static constexpr std::size_t kLuminance = 6;                        ///< Y by replicate
  static constexpr std::size_t kFirstBin = kLuminance + kReplicates;  ///< radiance times nm
  std::size_t channels() const { return m_channels; }
  FilmSums& sums() { return m_sums; }
  const FilmSums& sums() const { return m_sums; }

  const FilmFormat& format() const { return m_format; }
  const SampleRanges& ranges() const { return m_ranges; }
  /// States which samples the sums hold.
  void setRanges(SampleRanges ranges);
  std::uint64_t samples() const { return m_samples; }
  /// Samples that were left out because their value was no number or out of range. Never silently: every writer says
  /// so.
  std::uint64_t refused = 0;

  /// Colour of a pixel in the film's space.
  Eigen::Vector3d colour(std::size_t pixel) const;
  /// The same from the odd or the even replicates alone.
  Eigen::Vector3d halfColour(std::size_t pixel, bool odd) const;
  /// Y of a pixel, from the spread between replicates.
  Estimate luminance(std::size_t pixel) const;
  /// Mean radiance of a bin.
  double radiance(std::size_t pixel, int bin) const;

  /// The mean and variance of means of replicates, each of `counts` samples.
  static Estimate estimate(const std::array<double, kReplicates>& sums,
                           const std::array<std::uint64_t, kReplicates>& counts);
  const std::array<std::uint64_t, kReplicates>& replicateCounts() const { return m_counts; }

 private:
  FilmFormat m_format;
  std::size_t m_channels;
  FilmSums m_sums;
  SampleRanges m_ranges;
  std::uint64_t m_samples = 0;
  std::array<std::uint64_t, kReplicates> m_counts{};
};

}  // namespace metamer::spectral_ref
