// SPDX-License-Identifier: Apache-2.0
#include "transform/recovery.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "metamer/spectral/input_error.h"
#include "response/samples_on_bands.h"

namespace metamer::sip {

using spectral::InputError;

namespace {

/// Noise of a measured sample in the scene, over the kernel's 1, by cross-validation.
constexpr double kSampleNoise = 0.2;
constexpr double kSkinNoise = 0.1;
/// The skin scene follows its skins more closely, by this much at strength 1, so that samples and Gaussian say much the
/// same where one passes into the other. Closer still costs charts.
constexpr double kNoiseOfFollowedSkin = 0.5;
/// What the skin scene's Gaussian counts for among skins at strength 1; the rest is the samples'. More folds
/// chromaticities under sodium.
constexpr double kSkinShare = 0.84;
/// Fewer skins have no covariance.
constexpr std::size_t kFewestSkins = 4;

using Scene = std::variant<std::monostate, MeasuredScene, DatasetScene, UpliftScene>;

/// The kind of scene that is there beside pairs.
ReferenceScene::Kind kindBesidePairs(const ReferenceScene& scene) {
  return scene.kind == ReferenceScene::Kind::Pairs ? scene.over : scene.kind;
}

/// The Gaussian of a skin scene.
std::optional<SkinGaussian> skinOf(const ReferenceScene& scene, const SoftBoundSolver& solver,
                                   const MeasuredSeeds& seeds) {
  if (kindBesidePairs(scene) != ReferenceScene::Kind::Skin || scene.strength == 0.0) {
    return std::nullopt;
  }
  return SkinGaussian(
      seeds.differences, NodeBands(MeasuredScene::kNodeCount, solver.bandCount()).nodeWeights(solver.weights()),
      samplesOnBands(scene.virtualSkins, MeasuredScene::kNodeCount), kSkinShare * scene.strength, scene.fade);
}

void checkSkin(const ReferenceScene& scene) {
  if (!(scene.fade >= kLeastSkinFade && scene.fade <= kLargestSkinFade)) {
    throw InputError("recipe", "scene.fade", std::to_string(scene.fade), "give a number from 0.5 to 4");
  }
  if (scene.virtualSkins.size() < kFewestSkins) {
    throw InputError("recipe", "scene.virtualSkins", std::to_string(scene.virtualSkins.size()),
                     "a scene of skin needs four or more");
  }
}

double skinNoiseOf(const ReferenceScene& scene) {
  const bool isSkin = kindBesidePairs(scene) == ReferenceScene::Kind::Skin;
  return isSkin ? kSkinNoise * std::pow(kNoiseOfFollowedSkin, scene.strength) : kSkinNoise;
}

/// Samples and skins of a scene with their noise, as an observer sees them.
MeasuredSeeds seedsOf(const ReferenceScene& scene, const SoftBoundSolver& solver) {
  const Eigen::MatrixXd samples = samplesOnBands(scene.samples, MeasuredScene::kNodeCount);
  const Eigen::MatrixXd skins = samplesOnBands(scene.skins, MeasuredScene::kNodeCount);
  Eigen::MatrixXd all(MeasuredScene::kNodeCount, samples.cols() + skins.cols());
  all << samples, skins;
  Eigen::VectorXd noise(all.cols());
  noise << Eigen::VectorXd::Constant(samples.cols(), kSampleNoise),
      Eigen::VectorXd::Constant(skins.cols(), skinNoiseOf(scene));
  return {solver.weights(), all, noise};
}

void checkPairs(const ReferenceScene& scene) {
  if (scene.pairs.empty() || scene.pairs.size() > kMostPairs) {
    throw InputError("recipe", "scene.pairs", std::to_string(scene.pairs.size()),
                     "give from 1 to " + std::to_string(kMostPairs) + " pairs");
  }
  if (!(scene.radius >= kLeastPairRadius && scene.radius <= kLargestPairRadius)) {
    throw InputError("recipe", "scene.radius", std::to_string(scene.radius), "give a number from 0.05 to 20");
  }
  const bool isOverScene = scene.over == ReferenceScene::Kind::Natural || scene.over == ReferenceScene::Kind::Skin ||
                           scene.over == ReferenceScene::Kind::Smooth;
  if (!isOverScene || scene.samples.empty()) {
    throw InputError("recipe", "scene.over", nameOf(scene.over),
                     "pairs lie over natural, skin or smooth, and need the measured surfaces to tell near from far");
  }
}

Scene makeScene(const ReferenceScene& scene, const SoftBoundSolver& solver) {
  if (scene.kind == ReferenceScene::Kind::Pairs) {
    checkPairs(scene);
  }
  if (kindBesidePairs(scene) == ReferenceScene::Kind::Smooth) {
    return {};
  }
  if (scene.samples.empty()) {
    throw InputError("recipe", "scene.set", "", "a scene of measured spectra needs a set of reflectances");
  }
  if (!(scene.strength >= 0.0 && scene.strength <= 1.0)) {
    throw InputError("recipe", "scene.strength", std::to_string(scene.strength), "give a number from 0 to 1");
  }
  if (kindBesidePairs(scene) == ReferenceScene::Kind::Skin) {
    checkSkin(scene);
  }
  if (scene.kind == ReferenceScene::Kind::Dataset) {
    return DatasetScene(solver, samplesOnBands(scene.samples, solver.bandCount()));
  }
  if (upliftOf(scene.kind)) {
    return UpliftScene(solver, scene.uplift, samplesOnBands(scene.samples, solver.bandCount()), scene.sampleColours);
  }
  const MeasuredSeeds seeds = seedsOf(scene, solver);
  return MeasuredScene(solver, seeds, skinOf(scene, solver, seeds));
}

}  // namespace

Recovery::Recovery(const Eigen::Matrix3Xd& weights, double relaxation, const ReferenceScene& scene)
    : m_solver(weights, relaxation), m_scene(makeScene(scene, m_solver)) {
  if (scene.kind != ReferenceScene::Kind::Pairs) {
    return;
  }
  const Eigen::MatrixXd reflectances = samplesOnBands(scene.pairs, m_solver.bandCount());
  const Eigen::Matrix3Xd responses = weights * reflectances;
  Eigen::MatrixXd deviations = reflectances - m_solver.unclamped() * responses;
  if (const Eigen::MatrixXd known = sceneDeviations(responses); known.cols() > 0) {
    deviations -= known;
  }
  m_pairs.emplace(MeasuredSeeds::kReach / std::numbers::sqrt3 * seedsOf(scene, m_solver).differences, responses,
                  deviations, scene.radius);
}

Eigen::MatrixXd Recovery::sceneDeviations(const Eigen::Matrix3Xd& responses) const {
  return std::visit(
      [&](const auto& kind) -> Eigen::MatrixXd {
        if constexpr (requires { kind.deviations(responses); }) {
          return kind.deviations(responses);
        } else {
          return {};
        }
      },
      m_scene);
}

Eigen::MatrixXd Recovery::spectra(const Eigen::Matrix3Xd& responses, std::vector<ClampedBands>* clamped) const {
  Eigen::MatrixXd priors = sceneDeviations(responses);
  if (m_pairs) {
    if (priors.cols() == 0) {
      priors.setZero(m_solver.bandCount(), responses.cols());
    }
    m_pairs->addTo(priors, responses);
  }
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
  if (isSmooth()) {
    return m_solver.derivative(clamped);
  }
  BandTriple priorSlope = BandTriple::Zero(m_solver.bandCount(), 3);
  std::visit(
      [&](const auto& kind) {
        if constexpr (requires { kind.local(response); }) {
          priorSlope = kind.local(response).slope;
        }
      },
      m_scene);
  if (m_pairs) {
    m_pairs->addTo(priorSlope, response);
  }
  return m_solver.derivative(clamped, &priorSlope);
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
