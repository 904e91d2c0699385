// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/held_out.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "metamer/spectral/colorimetry.h"
#include "scenes/measured_surfaces.h"

namespace metamer::sip {

namespace {

using Samples = std::vector<spectral::DomainSamples>;
using Features = Eigen::Matrix<double, 6, 1>;

constexpr int kBandCount = 81;

/// The samples that are no twin of one that is held out.
Samples without(const Samples& samples, const Samples& heldOut) {
  Samples kept;
  for (const auto& sample : samples) {
    if (!hasTwin(heldOut, sample)) {
      kept.push_back(sample);
    }
  }
  return kept;
}

Features featuresOf(const Eigen::Vector3d& response) {
  const Eigen::Vector3d c = response.cwiseMax(0.0);
  Features features;
  features << c, std::sqrt(c[0] * c[1]), std::sqrt(c[1] * c[2]), std::sqrt(c[0] * c[2]);
  return features;
}

/// Reflectances as a recipe sees them and as they would be in truth.
struct Seen {
  Eigen::Matrix3Xd responses;
  Eigen::Matrix3Xd input;  ///< RGB
  Eigen::Matrix3Xd truth;  ///< RGB
};

Seen seenBy(const TransformSpec& spec, const SpectralTransform& transform, const Samples& surfaces) {
  const PreparedPipeline input = prepare(spec.input, spec.training, spec.standardObserver);
  const PreparedPipeline output = prepare(spec.output, spec.training, spec.standardObserver);
  const Eigen::Matrix3d rgbFromResponse = transform.responseFromRgb().inverse();
  const auto count = static_cast<Eigen::Index>(surfaces.size());
  Seen seen{Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count), Eigen::Matrix3Xd(3, count)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const spectral::DomainSamples& surface = surfaces[static_cast<std::size_t>(k)];
    const Eigen::Vector3d response = input.curves.transpose() * surface.cwiseProduct(input.light);
    seen.responses.col(k) = response.cwiseQuotient(input.white);
    seen.input.col(k) = rgbFromResponse * seen.responses.col(k);
    seen.truth.col(k) =
        transform.rgbFromOutputResponse() * (output.curves.transpose() * surface.cwiseProduct(output.light));
  }
  return seen;
}

std::optional<HeldOutSet> judge(const TransformSpec& spec, const std::string& name, const Samples& heldOut) {
  TransformSpec rest = spec;
  rest.training = without(spec.training, heldOut);
  if (!upliftOf(spec.scene.kind)) {  // which knows none of them
    rest.scene.samples = without(spec.scene.samples, heldOut);
  }
  rest.scene.skins = without(spec.scene.skins, heldOut);
  rest.scene.pairs = without(spec.scene.pairs, heldOut);
  rest.scene.pairNames = {};
  if (rest.scene.kind == ReferenceScene::Kind::Pairs && rest.scene.pairs.empty()) {
    rest.scene.kind = rest.scene.over;
  }
  const bool isEmpty = rest.scene.kind != ReferenceScene::Kind::Smooth && rest.scene.samples.empty();
  if (isEmpty || rest.training.size() < static_cast<std::size_t>(Features::RowsAtCompileTime)) {
    return std::nullopt;
  }
  const SpectralTransform transform(rest, kBandCount);
  if (transform.isIdentity()) {
    return std::nullopt;
  }
  const Seen learnt = seenBy(rest, transform, rest.training);
  Eigen::Matrix<double, Eigen::Dynamic, Features::RowsAtCompileTime> features(learnt.responses.cols(),
                                                                              Features::RowsAtCompileTime);
  for (Eigen::Index k = 0; k < features.rows(); ++k) {
    features.row(k) = featuresOf(learnt.responses.col(k)).transpose();
  }
  const Eigen::Matrix<double, 3, Features::RowsAtCompileTime> polynomial =
      features.colPivHouseholderQr().solve(learnt.truth.transpose()).transpose();

  const Seen seen = seenBy(rest, transform, heldOut);
  std::vector<Eigen::Vector3d> results;
  for (Eigen::Index k = 0; k < seen.input.cols(); ++k) {
    results.emplace_back(seen.input.col(k));
  }
  transform.apply(results);
  const Eigen::Matrix3d xyzFromRgb = spec.space.xyzFromRgb();
  const auto error = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return spectral::deltaE2000(spectral::lab(xyzFromRgb * a, transform.whiteXyz()),
                                spectral::lab(xyzFromRgb * b, transform.whiteXyz()));
  };
  HeldOutSet set{name, heldOut.size()};
  const double share = 1.0 / static_cast<double>(heldOut.size());
  for (Eigen::Index k = 0; k < seen.truth.cols(); ++k) {
    const Eigen::Vector3d truth = seen.truth.col(k);
    set.engine += share * error(truth, results[static_cast<std::size_t>(k)]);
    set.adaptation += share * error(truth, transform.plainAdaptation() * seen.input.col(k));
    set.rootPolynomial += share * error(truth, polynomial * featuresOf(seen.responses.col(k)));
  }
  return set;
}

}  // namespace

std::vector<HeldOutSet> heldOutErrors(const TransformSpec& spec, const spectral::DataLibrary& library,
                                      const ParallelFor& parallelFor) {
  const std::vector<std::string> names = judgedSetNames(library);
  std::vector<std::optional<HeldOutSet>> judged(names.size());
  parallelFor(static_cast<int>(names.size()), [&](int k) {
    const auto at = static_cast<std::size_t>(k);
    judged[at] = judge(spec, names[at], onDomain(library.reflectances(names[at])));
  });
  std::vector<HeldOutSet> sets;
  for (const auto& set : judged) {
    if (set) {
      sets.push_back(*set);
    }
  }
  return sets;
}

}  // namespace metamer::sip
