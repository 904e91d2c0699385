// SPDX-License-Identifier: Apache-2.0
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "metamer/sip/pairs.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "transform/perceptual_metric.h"
#include "transform/recovery.h"
#include "transform/sides.h"

namespace metamer::sip {

namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr const char* kWhiteName = "white";
/// Brightness at which two chromaticities are compared.
constexpr double kEqualMean = 0.4;
/// Notes name so many, and count the rest.
constexpr std::size_t kMostNamed = 3;
constexpr int kConflictBandCount = 81;
/// What measurement makes of white.
constexpr double kBrightest = 1.02;

std::string nameOf(const ReferenceScene& scene, Index pair) {
  if (pair == PairField::kWhite) {
    return kWhiteName;
  }
  const auto at = static_cast<std::size_t>(pair);
  return at < scene.pairNames.size() ? scene.pairNames[at] : "pair " + std::to_string(pair + 1);
}

/// Pairs as the input side receives them: relative XYZ at equal brightness.
struct Seen {
  explicit Seen(const TransformSpec& spec) : sides(prepareSides(spec)) {
    const Eigen::Matrix3Xd weights = sides.inputWeights(kConvergedBandCount);
    responses.resize(3, static_cast<Index>(spec.scene.pairs.size()));
    for (Index k = 0; k < responses.cols(); ++k) {
      responses.col(k) = weights * spec.scene.pairs[static_cast<std::size_t>(k)];
    }
    level =
        (sides.relativeFromResponse * responses).array().rowwise() * (kEqualMean / responses.colwise().mean().array());
  }
  /// CIEDE2000 between the chromaticities of two pairs, or of one and white.
  double distance(Index a, Index b) const { return spectral::deltaE2000(labOf(a), labOf(b)); }
  Vector3d labOf(Index pair) const {
    return spectral::lab(pair == PairField::kWhite ? Vector3d::Constant(kEqualMean) : Vector3d(level.col(pair)),
                         Vector3d::Ones());
  }

  Sides sides;
  Eigen::Matrix3Xd responses;
  Eigen::Matrix3Xd level;
};

double brightestOf(const spectral::DomainSamples& reflectance) {
  return reflectance.maxCoeff();
}

}  // namespace

std::vector<CheckedPair> checkPairs(const TransformSpec& spec) {
  const ReferenceScene& scene = spec.scene;
  if (scene.kind != ReferenceScene::Kind::Pairs) {
    throw spectral::InputError("recipe", "scene.kind", sip::nameOf(scene.kind), "is not of pairs: nothing to check");
  }
  const SpectralTransform transform(spec, kConvergedBandCount);
  TransformSpec without = spec;
  without.scene.kind = scene.over;
  const SpectralTransform before(without, kConvergedBandCount);
  const Seen seen(spec);
  const auto recovery = std::static_pointer_cast<const Recovery>(transform.recovery());
  const PairField& field = *recovery->pairs();
  const PreparedPipeline& output = seen.sides.output;
  const Eigen::Matrix3d xyzFromRgb = spec.space.xyzFromRgb();
  const PerceptualMetric metric(spec.space);
  const auto error = [&](const Vector3d& a, const Vector3d& b) {
    return spectral::deltaE2000(spectral::lab(xyzFromRgb * a, transform.whiteXyz()),
                                spectral::lab(xyzFromRgb * b, transform.whiteXyz()));
  };
  const auto count = static_cast<Index>(scene.pairs.size());
  std::vector<CheckedPair> checked;
  for (Index k = 0; k < count; ++k) {
    const spectral::DomainSamples& reflectance = scene.pairs[static_cast<std::size_t>(k)];
    CheckedPair pair;
    pair.name = nameOf(scene, k);
    pair.brightest = brightestOf(reflectance);
    pair.rgb = transform.responseFromRgb().inverse() * seen.responses.col(k);
    const Vector3d xyz = xyzFromRgb * pair.rgb;
    pair.chromaticity = xyz.head<2>() / xyz.sum();
    pair.isDark = field.isDark(k);
    if (!pair.isDark) {
      const Vector3d truth =
          transform.rgbFromOutputResponse() * (output.curves.transpose() * reflectance.cwiseProduct(output.light));
      const SpectralTransform::Linearisation local = transform.linearise(pair.rgb);
      pair.errorBefore = error(before.apply(pair.rgb), truth);
      pair.error = error(local.value, truth);
      const Eigen::Matrix3d gain =
          metric.at(pair.rgb, local.value) * local.matrix * metric.at(pair.rgb, pair.rgb).inverse();
      pair.gain = Eigen::JacobiSVD<Eigen::Matrix3d>(gain).singularValues()[0];
      pair.distance = std::numeric_limits<double>::infinity();
      for (Index other = PairField::kWhite; other < count; ++other) {
        if (other == k || (other >= 0 && field.isDark(other))) {
          continue;
        }
        if (const double distance = seen.distance(k, other); distance < pair.distance) {
          pair.distance = distance;
          pair.nearest = nameOf(scene, other);
        }
      }
      for (const Index other : field.conflictsOf(k)) {
        pair.conflicts.push_back(nameOf(scene, other));
      }
    }
    checked.push_back(std::move(pair));
  }
  return checked;
}

std::vector<std::string> notesOfPairs(const TransformSpec& spec) {
  const ReferenceScene& scene = spec.scene;
  if (scene.kind != ReferenceScene::Kind::Pairs) {
    return {};
  }
  const Seen seen(spec);
  // Which pairs conflict depends on neither the bands nor the relaxation but by a hair.
  const Recovery recovery(seen.sides.inputWeights(kConflictBandCount), 0.0, scene);
  const PairField& field = *recovery.pairs();
  std::vector<std::string> notes;
  std::size_t conflictCount = 0;
  for (Index k = 0; k < field.count(); ++k) {
    const std::string name = "'" + nameOf(scene, k) + "'";
    if (field.isDark(k)) {
      notes.push_back(name + " is black under the input light, and is left out");
    }
    if (const double brightest = brightestOf(scene.pairs[static_cast<std::size_t>(k)]); brightest > kBrightest) {
      notes.push_back(name + " reflects up to " + spectral::formatted("%.3g", brightest) +
                      " of the light, more than a reflectance can: fluorescence, or a white that was set too low");
    }
    for (const Index other : field.conflictsOf(k)) {
      if (other > k || other == PairField::kWhite) {
        if (conflictCount++ < kMostNamed) {
          const std::string near = spectral::formatted("%.2f", seen.distance(k, other));
          notes.push_back(
              other == PairField::kWhite
                  ? name + " is " + near +
                        " CIEDE2000 from white's chromaticity with another spectrum: white stays exact, and " + name +
                        " keeps what both agree on"
                  : name + " and '" + nameOf(scene, other) + "', " + near +
                        " CIEDE2000 apart in chromaticity, have two spectra for one colour: both keep what "
                        "they agree on, and neither is exact");
        }
      }
    }
  }
  if (conflictCount > kMostNamed) {
    notes.push_back(std::to_string(conflictCount - kMostNamed) +
                    " more conflicts between pairs (lutgen pairs check lists them)");
  }
  return notes;
}

}  // namespace metamer::sip
