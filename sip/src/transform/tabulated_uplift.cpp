// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/tabulated_uplift.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace metamer::sip {
namespace {

/// Steps from one corner of the plane to another; a multiple of three, so that white is a node.
constexpr int kSteps = 960;
/// Nodes along and across that are computed together.
constexpr int kTile = 8;
constexpr int kTiles = kSteps / kTile + 1;

/// Components of a colour in a space, scaled so that Rec.709's white is (1, 1, 1).
Eigen::Matrix3d componentsFromRgb(const spectral::RgbSpace& space, const Eigen::Matrix3d& xyzFromRgb) {
  const Eigen::Matrix3d unscaled = space.rgbFromXyz() * xyzFromRgb;
  return unscaled.rowwise().sum().cwiseInverse().asDiagonal() * unscaled;
}

class TabulatedUplift : public spectral::Uplift {
 public:
  TabulatedUplift(std::unique_ptr<spectral::Uplift> exact, const spectral::RgbSpace& space)
      : Uplift(exact->wavelengthsNm(), exact->xyzFromRgb()),
        m_exact(std::move(exact)),
        m_bands(m_exact->wavelengthsNm().size()),
        m_componentsFromRgb(componentsFromRgb(space, m_exact->xyzFromRgb())),
        m_rgbFromComponents(m_componentsFromRgb.inverse()),
        m_tiles(static_cast<std::size_t>(kTiles) * kTiles) {}

 private:
  /// Spectra of kTile x kTile nodes, of colours whose components add up to one.
  struct Tile {
    std::once_flag once;
    std::vector<float> spectra;
    std::atomic<const float*> ready = nullptr;
  };

  void spectrumOf(const Eigen::Vector3d& rgb, double* spectrum) const override { spectraOf({rgb.data(), 3}, spectrum); }

  void spectraOf(std::span<const double> rgb, double* spectra) const override {
    // Those outside are solved side by side.
    std::vector<std::size_t> outside;
    std::vector<double> theirs;
    for (std::size_t k = 0; k < rgb.size() / 3; ++k) {
      const Eigen::Map<const Eigen::Vector3d> colour(rgb.data() + 3 * k);
      if (!interpolate(colour, spectra + k * m_bands)) {
        outside.push_back(k);
        theirs.insert(theirs.end(), colour.begin(), colour.end());
      }
    }
    std::vector<double> solved(outside.size() * m_bands);
    m_exact->spectra(theirs, solved);
    for (std::size_t k = 0; k < outside.size(); ++k) {
      std::copy_n(&solved[k * m_bands], m_bands, spectra + outside[k] * m_bands);
    }
  }

  /// Whether the colour lies on the plane; then with its spectrum.
  bool interpolate(const Eigen::Vector3d& rgb, double* spectrum) const {
    const Eigen::Vector3d components = m_componentsFromRgb * rgb;
    const double size = components.sum();
    if (!(components.minCoeff() >= 0.0 && size > 0.0)) {
      return false;
    }
    const double u = components[0] / size * kSteps;
    const double v = components[1] / size * kSteps;
    const int i = std::clamp(static_cast<int>(u), 0, kSteps - 1);
    const int j = std::clamp(static_cast<int>(v), 0, kSteps - 1 - i);
    const double along = u - i;
    const double across = v - j;
    const bool isFar = along + across > 1.0 && i + j + 2 <= kSteps;
    const std::array<const float*, 3> node = {isFar ? at(i + 1, j + 1) : at(i, j), at(i + 1, j), at(i, j + 1)};
    const std::array<double, 3> weight = {size * (isFar ? along + across - 1.0 : 1.0 - along - across),
                                          size * (isFar ? 1.0 - across : along), size * (isFar ? 1.0 - along : across)};
    for (std::size_t band = 0; band < m_bands; ++band) {
      spectrum[band] = weight[0] * static_cast<double>(node[0][band]) + weight[1] * static_cast<double>(node[1][band]) +
                       weight[2] * static_cast<double>(node[2][band]);
    }
    return true;
  }

  /// Of the node whose first two components are i and j steps.
  const float* at(int i, int j) const {
    const int row = i / kTile;
    const int column = j / kTile;
    Tile& tile = m_tiles[static_cast<std::size_t>(row) * kTiles + static_cast<std::size_t>(column)];
    const float* ready = tile.ready.load(std::memory_order_acquire);
    if (ready == nullptr) {
      std::call_once(tile.once, [&] { fill(tile, row * kTile, column * kTile); });
      ready = tile.spectra.data();
    }
    return ready + static_cast<std::size_t>((i % kTile) * kTile + j % kTile) * m_bands;
  }

  void fill(Tile& tile, int firstRow, int firstColumn) const {
    std::vector<double> rgb;
    for (int i = firstRow; i < firstRow + kTile; ++i) {
      for (int j = firstColumn; j < firstColumn + kTile; ++j) {
        // What lies beyond the plane's edge is asked for by nobody.
        const int third = std::max(kSteps - i - j, 0);
        const Eigen::Vector3d colour = m_rgbFromComponents * (Eigen::Vector3d(i, j, third) / kSteps);
        rgb.insert(rgb.end(), colour.begin(), colour.end());
      }
    }
    std::vector<double> spectra(rgb.size() / 3 * m_bands);
    m_exact->spectra(rgb, spectra);
    tile.spectra.assign(spectra.begin(), spectra.end());
    tile.ready.store(tile.spectra.data(), std::memory_order_release);
  }

  std::unique_ptr<spectral::Uplift> m_exact;
  std::size_t m_bands;
  Eigen::Matrix3d m_componentsFromRgb;
  Eigen::Matrix3d m_rgbFromComponents;
  mutable std::vector<Tile> m_tiles;
};

}  // namespace

std::unique_ptr<spectral::Uplift> tabulated(std::unique_ptr<spectral::Uplift> exact, const spectral::RgbSpace& space) {
  return std::make_unique<TabulatedUplift>(std::move(exact), space);
}

}  // namespace metamer::sip
