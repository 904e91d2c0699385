// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/film.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace metamer::spectral_ref {

std::uint64_t Replicates::countBelow(std::uint64_t end, std::size_t replicate) const {
  const std::uint64_t round = blockLength * kReplicates;
  const std::uint64_t rest = end % round;
  const std::uint64_t start = blockLength * replicate;
  return end / round * blockLength + (rest > start ? std::min(rest - start, blockLength) : 0);
}

std::uint64_t sampleCount(const SampleRanges& ranges) {
  std::uint64_t count = 0;
  for (const auto& [begin, end] : ranges) {
    count += end - begin;
  }
  return count;
}

bool uniteRanges(SampleRanges& ranges, const SampleRanges& others) {
  SampleRanges all = ranges;
  all.insert(all.end(), others.begin(), others.end());
  std::sort(all.begin(), all.end());
  SampleRanges united;
  for (const auto& range : all) {
    if (range[0] == range[1]) {
      continue;
    }
    if (!united.empty() && range[0] < united.back()[1]) {
      return false;
    }
    if (!united.empty() && range[0] == united.back()[1]) {
      united.back()[1] = range[1];
    } else {
      united.push_back(range);
    }
  }
  ranges = united;
  return true;
}

FilmFormat FilmFormat::of(const FilmSettings& settings, const Replicates& replicates, double brightness) {
  // 19 bits are left for samples and for what is brighter than expected; beyond them sums take more memory.
  constexpr int kBitsBelow = 44;
  constexpr int kDimmest = -24;  // with it a film still holds millions of the largest terms
  constexpr int kBrightest = 36;
  FilmFormat format;
  format.width = settings.width;
  format.height = settings.height;
  format.bins = settings.bins;
  format.colourFromResponse = settings.colourFromResponse;
  format.space = settings.space;
  format.chromaticities = settings.chromaticities;
  format.observer = settings.observer.name;
  format.replicates = replicates;
  format.unitExponent = std::clamp(std::ilogb(brightness), kDimmest, kBrightest) - kBitsBelow;
  if (settings.photometric) {
    constexpr double kLumensPerWatt = 683.0;
    const Eigen::Vector3d sums = settings.observer.onDomain().colwise().sum().transpose();
    format.colourScale = kLumensPerWatt * settings.luminanceOfResponse.dot(sums);
  }
  return format;
}

double FilmFormat::binWidthNm(int bin) const {
  const double low = bins.centreNm(bin) - 0.5 * bins.stepNm;
  constexpr double kFirst = spectral::kDomainStartNm - 0.5;
  constexpr double kLast = spectral::kDomainEndNm + 0.5;
  return std::min(low + bins.stepNm, kLast) - std::max(low, kFirst);
}

Film::Film(FilmFormat format)
    : m_format(std::move(format)),
      m_channels(kFirstBin + static_cast<std::size_t>(m_format.bins.count)),
      m_sums(m_format.width, m_format.height, m_channels, m_format.unitExponent) {}

void Film::setRanges(SampleRanges ranges) {
  m_ranges = std::move(ranges);
  m_samples = sampleCount(m_ranges);
  m_counts = {};
  for (const auto& [begin, end] : m_ranges) {
    for (std::size_t g = 0; g < kReplicates; ++g) {
      m_counts[g] += m_format.replicates.countBelow(end, g) - m_format.replicates.countBelow(begin, g);
    }
  }
}

Eigen::Vector3d Film::colour(std::size_t index) const {
  const Eigen::Vector3d response(m_sums.value(index, kColour), m_sums.value(index, kColour + 1),
                                 m_sums.value(index, kColour + 2));
  return m_format.colourFromResponse * response * (m_format.colourScale / static_cast<double>(m_samples));
}

Eigen::Vector3d Film::halfColour(std::size_t index, bool odd) const {
  Eigen::Vector3d response;
  const std::uint64_t oddCount = m_counts[1] + m_counts[3];
  const std::uint64_t count = odd ? oddCount : m_samples - oddCount;
  for (std::size_t c = 0; c < 3; ++c) {
    const double half = m_sums.value(index, kHalf + c);
    response[static_cast<Eigen::Index>(c)] = odd ? half : m_sums.value(index, kColour + c) - half;
  }
  return m_format.colourFromResponse * response * (m_format.colourScale / static_cast<double>(count));
}

Estimate Film::luminance(std::size_t index) const {
  std::array<double, kReplicates> sums{};
  for (std::size_t g = 0; g < kReplicates; ++g) {
    sums[g] = m_sums.value(index, kLuminance + g) * m_format.colourScale;
  }
  return estimate(sums, m_counts);
}

double Film::radiance(std::size_t index, int bin) const {
  return m_sums.value(index, kFirstBin + static_cast<std::size_t>(bin)) /
         (static_cast<double>(m_samples) * m_format.binWidthNm(bin));
}

Estimate Film::estimate(const std::array<double, kReplicates>& sums,
                        const std::array<std::uint64_t, kReplicates>& counts) {
  Estimate result;
  double total = 0;
  double samples = 0;
  int used = 0;
  for (std::size_t g = 0; g < kReplicates; ++g) {
    total += sums[g];
    samples += static_cast<double>(counts[g]);
    used += counts[g] > 0 ? 1 : 0;
  }
  result.mean = total / samples;
  result.degrees = used - 1;
  if (used < 2) {
    result.variance = std::numeric_limits<double>::quiet_NaN();
    return result;
  }
  // A replicate of n samples is taken to have variance s / n: s from the weighted spread, s / samples for their mean.
  double spread = 0;
  for (std::size_t g = 0; g < kReplicates; ++g) {
    if (counts[g] > 0) {
      const auto n = static_cast<double>(counts[g]);
      const double difference = sums[g] / n - result.mean;
      spread += n * difference * difference;
    }
  }
  result.variance = spread / (result.degrees * samples);
  return result;
}

}  // namespace metamer::spectral_ref
