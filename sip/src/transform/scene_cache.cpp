// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/scene_cache.h"

#include <algorithm>
#include <mutex>
#include <vector>

#include "metamer/sip/spectral_transform.h"
#include "transform/recovery.h"

namespace metamer::sip {

namespace {

/// A light and the one before it, at two numbers of bands.
constexpr std::size_t kMostHeld = 4;

struct Held {
  Eigen::Matrix3Xd weights;
  double relaxation;
  ReferenceScene scene;
  std::shared_ptr<const Recovery> recovery;

  bool isOf(const Eigen::Matrix3Xd& otherWeights, double otherRelaxation, const ReferenceScene& other) const {
    return weights.cols() == otherWeights.cols() && weights == otherWeights && relaxation == otherRelaxation &&
           scene.kind == other.kind && scene.strength == other.strength && scene.samples == other.samples &&
           scene.skins == other.skins && scene.fade == other.fade && scene.virtualSkins == other.virtualSkins &&
           scene.over == other.over && scene.radius == other.radius && scene.pairs == other.pairs &&
           scene.sampleColours == other.sampleColours;
  }
};

}  // namespace

struct SceneCache::State {
  std::mutex mutex;
  std::vector<Held> held;  // the latest last
};

SceneCache::SceneCache() : m_state(std::make_unique<State>()) {}
SceneCache::~SceneCache() = default;

std::shared_ptr<const Recovery> SceneCache::recovery(const Eigen::Matrix3Xd& weights, double relaxation,
                                                     const ReferenceScene& scene) {
  const std::lock_guard lock(m_state->mutex);
  std::vector<Held>& held = m_state->held;
  const auto found =
      std::find_if(held.begin(), held.end(), [&](const Held& one) { return one.isOf(weights, relaxation, scene); });
  if (found != held.end()) {
    std::rotate(found, found + 1, held.end());
  } else {
    if (held.size() == kMostHeld) {
      held.erase(held.begin());
    }
    held.push_back({weights, relaxation, scene, std::make_shared<const Recovery>(weights, relaxation, scene)});
  }
  return held.back().recovery;
}

}  // namespace metamer::sip
