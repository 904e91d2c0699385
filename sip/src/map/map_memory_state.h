// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "metamer/sip/map_memory.h"
#include "metamer/sip/spectral_transform.h"

namespace metamer::sip {

/// The spectra of one part of a map, by the place of its nodes. Used by one build at a time.
class PartMemory {
 public:
  /// Held while a part is built.
  std::mutex mutex;

  /// Forgets what the build before did not use, where that has become much.
  void beginBuild();
  /// The spectrum of a node: empty where it was not solved yet.
  SpectralTransform::SolvedSpectrum* at(std::uint64_t place);

 private:
  struct Kept {
    SpectralTransform::SolvedSpectrum spectrum;
    unsigned usedBy = 0;
  };
  std::unordered_map<std::uint64_t, Kept> m_kept;
  unsigned m_build = 0;
  std::size_t m_used = 0;
};

struct MapMemory::State {
  using Parts = std::deque<PartMemory>;

  /// The parts for a transform: the ones before where it gives the same spectra, else new ones.
  std::shared_ptr<Parts> partsFor(const SpectralTransform& transform, std::size_t count);

 private:
  std::mutex m_mutex;
  std::shared_ptr<const void> m_recovery;
  Eigen::Matrix3d m_responseFromRgb = Eigen::Matrix3d::Zero();
  std::shared_ptr<Parts> m_parts;
};

}  // namespace metamer::sip
