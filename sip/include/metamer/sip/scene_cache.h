// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>

namespace metamer::sip {

class Recovery;
struct ReferenceScene;

/// Input sides with their scenes, kept from one transform to the next: which spectra colours are given depends on the
/// light, filters and observer of the shot, on the scene and on the bands, not on where the colours go. Belongs to
/// whoever makes several transforms (a plug-in, a bake of many files); holds the latest few. Changes the time that a
/// transform takes to make, and nothing else. Safe to share between threads.
class SceneCache {
 public:
  SceneCache();
  ~SceneCache();
  SceneCache(const SceneCache&) = delete;
  SceneCache& operator=(const SceneCache&) = delete;

  /// Used by SpectralTransform: the recovery of these very numbers, made where it is not held.
  std::shared_ptr<const Recovery> recovery(const Eigen::Matrix3Xd& weights, double relaxation,
                                           const ReferenceScene& scene);

 private:
  struct State;
  std::unique_ptr<State> m_state;
};

}  // namespace metamer::sip
