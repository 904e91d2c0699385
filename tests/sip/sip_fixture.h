// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "metamer/sip/spectral_transform.h"
#include "spectral/fixture.h"

namespace metamer::sip {

using spectral::errorOf;
using spectral::testLibrary;
using spectral::unitRandom;

/// The six pairs of lights that every accuracy figure is given for.
const std::vector<std::pair<std::string, std::string>>& lightPairs();

/// ACEScg, both observers CIE 1931 2, adaptation 0, smooth scene.
TransformSpec specOf(const std::string& inputLight, const std::string& outputLight);

/// The same as a recipe without a scene has it: scene natural, all measured surfaces for training.
TransformSpec naturalSpecOf(const std::string& inputLight, const std::string& outputLight);

/// The 24 patches that the error protocol uses.
std::vector<spectral::Spectrum> chart();

/// A set of data/ on the domain.
std::vector<spectral::DomainSamples> samplesOf(const std::string& set);

/// Samples at the band centres, a column each.
Eigen::MatrixXd onBands(const std::vector<spectral::DomainSamples>& samples, int bandCount);

/// White-normalised weights of a light of data/ under CIE 1931 2: rows sum to 1.
Eigen::Matrix3Xd normalisedWeights(const std::string& light, int bandCount);

/// A few hundred colours that reflectances can make, by mixing blocks of bands; the same ones every run. Many lie close
/// to the locus.
std::vector<Eigen::Vector3d> feasibleTristimuli(const Eigen::Matrix3Xd& weights, int count, unsigned seed = 1);

}  // namespace metamer::sip
