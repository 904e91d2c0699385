// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "metamer/stage/non_negative_least_squares.h"

namespace metamer::stage {

/// A chart in the real place, and where it looked.
struct SceneChart {
  Eigen::Matrix3Xd rgb;    ///< patches as columns, the same ones as the emitters' charts
  Eigen::Vector3d facing;  ///< of any length but 0; the axes of LatLong
};

/// Emitters a driver can have: their subsets are looked up by bits.
inline constexpr int kMostEnvironmentEmitters = 16;

/// Drives of multispectral lights for every direction of an RGB environment (section 2.5.3; LeGendre et al. 2016).
///
/// For each direction a virtual chart: the scene's charts, each divided by its own white, are interpolated (weights
/// fall with the squared distance of their directions) and tinted so that white has the pixel's colour. The drives are
/// those whose charts add up to it, by non-negative least squares over patches and channels.
///
/// With the set of lit emitters given, drives are linear in the pixel: neighbours mostly share a set, which is guessed
/// and checked by its conditions (no drive and no slope of the wrong sign). Immutable; share it between threads.
class EnvironmentDriver {
 public:
  /// @param emitterCharts  one an emitter at a drive of 1, 3 x patches, as a whole sphere of it would light the chart
  /// @param sceneCharts    one to six, or more
  /// @param whitePatch     column of the white patch
  /// @throws spectral::InputError: no emitters or too many, no charts, charts of different patches, a white that is not
  ///         there or without light, bad limits
  EnvironmentDriver(const std::vector<Eigen::Matrix3Xd>& emitterCharts, const std::vector<SceneChart>& sceneCharts,
                    int whitePatch, DriveLimits limits = {});

  int emitterCount() const { return static_cast<int>(m_emitters.cols()); }

  /// What a thread keeps between pixels: sets of lit emitters that it has met. It changes the time; begin each row with
  /// startRow, and results do not depend on how rows are shared out.
  class Memory {
   public:
    Memory();
    ~Memory();
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    void startRow();

   private:
    friend class EnvironmentDriver;
    struct State;
    std::unique_ptr<State> m_state;
  };

  /// @param rgb        radiance of a direction, camera RGB; components below 0 or not finite count as 0
  /// @param direction  unit vector
  /// @param drives     emitterCount values out
  void solve(const Eigen::Vector3d& rgb, const Eigen::Vector3d& direction, Memory& memory, double* drives) const;

 private:
  struct Piece;
  const Piece& pieceOf(std::uint32_t support, Memory& memory) const;

  Eigen::MatrixXd m_emitters;               // reduced: n x n
  std::vector<Eigen::MatrixX3d> m_targets;  // reduced: n x 3 a scene chart, from the pixel's colour
  std::vector<Eigen::Vector3d> m_facings;
  DriveLimits m_limits;
};

}  // namespace metamer::stage
