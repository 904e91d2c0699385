// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <mutex>
#include <optional>
#include <variant>
#include <vector>

#include "metamer/sip/spectral_transform.h"
#include "pairs/pair_field.h"
#include "scenes/dataset_scene.h"
#include "scenes/measured_scene.h"
#include "scenes/uplift_scene.h"
#include "soft_bound/soft_bound_solver.h"

namespace metamer::sip {

/// Which spectrum a white-normalised response is given, and how that changes: all of a transform that does not depend
/// on where the colours go. Immutable, safe to share between threads and transforms.
class Recovery {
 public:
  /// @param weights     of the input side, as SoftBoundSolver takes them
  /// @param relaxation  likewise
  /// @throws spectral::InputError where the scene has no meaning
  Recovery(const Eigen::Matrix3Xd& weights, double relaxation, const ReferenceScene& scene);

  const SoftBoundSolver& solver() const { return m_solver; }
  /// Whether it is without a scene.
  bool isSmooth() const { return std::holds_alternative<std::monostate>(m_scene) && !m_pairs; }
  /// Null where the scene is not one of these alone.
  const MeasuredScene* measured() const { return m_pairs ? nullptr : std::get_if<MeasuredScene>(&m_scene); }
  /// Null where there are none.
  const PairField* pairs() const { return m_pairs ? &*m_pairs : nullptr; }

  /// The spectra of some responses, a column each.
  /// @param clamped  where not null, an entry a response: the bands that are below zero
  Eigen::MatrixXd spectra(const Eigen::Matrix3Xd& responses, std::vector<ClampedBands>* clamped = nullptr) const;
  /// The derivative of a spectrum by the response, B x 3. @param clamped  of that spectrum
  BandTriple slope(const Eigen::Vector3d& response, const ClampedBands& clamped) const;

  /// spectra() of responses that are asked for again and again: the training surfaces'.
  Eigen::MatrixXd spectraOfTraining(const Eigen::Matrix3Xd& responses) const;

 private:
  /// What a scene makes of responses that know no pairs: B x n, or empty where that is nothing.
  Eigen::MatrixXd sceneDeviations(const Eigen::Matrix3Xd& responses) const;

  SoftBoundSolver m_solver;
  std::variant<std::monostate, MeasuredScene, DatasetScene, UpliftScene> m_scene;
  std::optional<PairField> m_pairs;
  mutable std::mutex m_mutex;
  mutable Eigen::Matrix3Xd m_trainingResponses;  // the latest
  mutable Eigen::MatrixXd m_trainingSpectra;
};

}  // namespace metamer::sip
