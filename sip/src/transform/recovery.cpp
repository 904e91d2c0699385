// SPDX-License-Identifier: Apache-2.0
#include "transform/recovery.h"

#include <cmath>

#include "metamer/spectral/input_error.h"
#include "response/samples_on_bands.h"

namespace metamer::sip {

using spectral::InputError;

namespace {

/// Noise of a measured sample in the scene, over the kernel's 1, by cross-validation.
constexpr double kSampleNoise = 0.2;
constexpr double kSkinNoise = 0.1;
/// The skin scene's skins are followed by this much more closely at strength 1.
constexpr double kSkinSceneFactor = 0.1;

using Scene = std::variant<std::monostate, MeasuredScene, DatasetScene>;

Scene makeScene(const ReferenceScene& scene, const SoftBoundSolver& solver) {
  if (scene.kind == ReferenceScene::Kind::Smooth) {
    return {};
  }
  if (scene.samples.empty()) {
    throw InputError("recipe", "scene.set", "", "a scene of measured spectra needs a set of reflectances");
  }
  if (!(scene.strength >= 0.0 && scene.strength <= 1.0)) {
    throw InputError("recipe", "scene.strength", std::to_string(scene.strength), "give a number from 0 to 1");
  }
  if (scene.kind == ReferenceScene::Kind::Dataset) {
    return DatasetScene(solver, samplesOnBands(scene.samples, solver.bandCount()));
  }
  const Eigen::MatrixXd samples = samplesOnBands(scene.samples, MeasuredScene::kNodeCount);
  const Eigen::MatrixXd skins = samplesOnBands(scene.skins, MeasuredScene::kNodeCount);
  Eigen::MatrixXd all(MeasuredScene::kNodeCount, samples.cols() + skins.cols());
  all << samples, skins;
  const double strength = scene.kind == ReferenceScene::Kind::Skin ? scene.strength : 0.0;
  Eigen::VectorXd noise(all.cols());
  noise << Eigen::VectorXd::Constant(samples.cols(), kSampleNoise),
      Eigen::VectorXd::Constant(skins.cols(), kSkinNoise * std::pow(kSkinSceneFactor, strength));
  return MeasuredScene(solver, all, noise);
}

}  // namespace

Recovery::Recovery(const Eigen::Matrix3Xd& weights, double relaxation, const ReferenceScene& scene)
    : m_solver(weights, relaxation), m_scene(makeScene(scene, m_solver)) {}

Eigen::MatrixXd Recovery::spectra(const Eigen::Matrix3Xd& responses, std::vector<ClampedBands>* clamped) const {
  const Eigen::MatrixXd priors = std::visit(
      [&](const auto& kind) -> Eigen::MatrixXd {
        if constexpr (requires { kind.deviations(responses); }) {
          return kind.deviations(responses);
        } else {
          return {};
        }
      },
      m_scene);
  Eigen::MatrixXd spectra(m_solver.bandCount(), responses.cols());
  std::vector<SoftBoundSolver::Problem> problems(static_cast<std::size_t>(responses.cols()));
  for (Eigen::Index k = 0; k < responses.cols(); ++k) {
    SoftBoundSolver::Problem& problem = problems[static_cast<std::size_t>(k)];
    problem.tristimulus = responses.col(k);
    problem.prior = priors.cols() > 0 ? priors.col(k).data() : nullptr;
    problem.reflectance = spectra.col(k).data();
  }
  m_solver.solve(problems);
  if (clamped != nullptr) {
    clamped->clear();
    for (const SoftBoundSolver::Problem& problem : problems) {
      clamped->push_back(problem.clamped);
    }
  }
  return spectra;
}

BandTriple Recovery::slope(const Eigen::Vector3d& response, const ClampedBands& clamped) const {
  if (const auto* scene = std::get_if<MeasuredScene>(&m_scene)) {
    const BandTriple priorSlope = scene->local(response).slope;
    return m_solver.derivative(clamped, &priorSlope);
  }
  if (const auto* scene = std::get_if<DatasetScene>(&m_scene)) {
    const BandTriple priorSlope = scene->local(response).slope;
    return m_solver.derivative(clamped, &priorSlope);
  }
  return m_solver.derivative(clamped);
}

Eigen::MatrixXd Recovery::spectraOfTraining(const Eigen::Matrix3Xd& responses) const {
  const std::lock_guard lock(m_mutex);
  if (m_trainingResponses.cols() != responses.cols() || m_trainingResponses != responses) {
    m_trainingSpectra = spectra(responses);
    m_trainingResponses = responses;
  }
  return m_trainingSpectra;
}

}  // namespace metamer::sip
