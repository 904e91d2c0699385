// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>

namespace metamer::sip {

struct MeasuredSeeds;

/// Measured scenes as lamps and observers see them, kept from one transform to the next: what a scene is made of
/// depends on the light, filters and observer of the shot, on the set and on the bands, not on where colours go.
/// Belongs to whoever makes several transforms (a plug-in, a bake of many files); holds the latest few. Changes the
/// time that a transform takes to make, and nothing else. Safe to share between threads.
class SceneCache {
 public:
  SceneCache();
  ~SceneCache();
  SceneCache(const SceneCache&) = delete;
  SceneCache& operator=(const SceneCache&) = delete;

  /// Used by SpectralTransform: the seeds of these very numbers (MeasuredSeeds), solved where they are not held.
  std::shared_ptr<const MeasuredSeeds> seeds(const Eigen::Matrix3Xd& weights, const Eigen::MatrixXd& reflectances,
                                             const Eigen::VectorXd& noise);

 private:
  struct State;
  std::unique_ptr<State> m_state;
};

}  // namespace metamer::sip
