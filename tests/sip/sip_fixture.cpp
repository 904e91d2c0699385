// SPDX-License-Identifier: Apache-2.0
#include "sip/sip_fixture.h"

#include <algorithm>
#include <random>

#include "metamer/sip/band_weights.h"
#include "metamer/sip/recipe.h"

namespace metamer::sip {

const std::vector<std::pair<std::string, std::string>>& lightPairs() {
  static const std::vector<std::pair<std::string, std::string>> pairs{
      {"D65", "A"}, {"D65", "HP1"}, {"D65", "FL11"}, {"D65", "LED-RGB1"}, {"A", "D65"}, {"FL11", "D50"}};
  return pairs;
}

TransformSpec specOf(const std::string& inputLight, const std::string& outputLight) {
  const spectral::DataLibrary& library = testLibrary();
  const spectral::Observer eye = library.observer("CIE 1931 2");
  return {library.colourSpace("ACEScg").linear,
          {library.illuminant(inputLight), {}, eye},
          {library.illuminant(outputLight), {}, eye},
          0.0,
          spectral::ChromaticAdaptation::VonKries,
          false,
          {},
          {},
          eye};
}

TransformSpec naturalSpecOf(const std::string& inputLight, const std::string& outputLight) {
  static const TransformSpec base =
      resolve(parseRecipe("metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: A}\n", "fixture"), testLibrary());
  TransformSpec spec = base;
  spec.input.illuminant = testLibrary().illuminant(inputLight);
  spec.output.illuminant = testLibrary().illuminant(outputLight);
  return spec;
}

std::vector<spectral::Spectrum> chart() {
  return testLibrary().reflectances("colorchecker").samples;
}

std::vector<spectral::DomainSamples> samplesOf(const std::string& set) {
  std::vector<spectral::DomainSamples> samples;
  for (const spectral::Spectrum& sample : testLibrary().reflectances(set).samples) {
    samples.push_back(sample.onDomain());
  }
  return samples;
}

Eigen::MatrixXd onBands(const std::vector<spectral::DomainSamples>& samples, int bandCount) {
  Eigen::MatrixXd bands(bandCount, static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    bands.col(static_cast<Eigen::Index>(i)) = atBandCentres(samples[i], bandCount);
  }
  return bands;
}

Eigen::Matrix3Xd normalisedWeights(const std::string& light, int bandCount) {
  const Eigen::Matrix3Xd weights = bandWeights(testLibrary().illuminant(light).onDomain(),
                                               testLibrary().observer("CIE 1931 2").onDomain(), bandCount);
  return weights.rowwise().sum().cwiseInverse().asDiagonal() * weights;
}

std::vector<Eigen::Vector3d> feasibleTristimuli(const Eigen::Matrix3Xd& weights, int count, unsigned seed) {
  // Numbers straight from the engine: distributions differ between standard libraries.
  std::mt19937 random(seed);
  const auto below = [&random](unsigned limit) { return static_cast<unsigned>(random()) % limit; };
  const auto bands = static_cast<unsigned>(weights.cols());
  const std::vector<int> halfWidths{0, 1, 3, 10};
  const std::vector<double> floors{0.0, 1e-4, 1e-2, 0.1};
  std::vector<Eigen::Vector3d> tristimuli;
  while (static_cast<int>(tristimuli.size()) < count) {
    Eigen::VectorXd spectrum = Eigen::VectorXd::Constant(weights.cols(), floors[below(4)]);
    for (unsigned block = 1 + below(5); block > 0; --block) {
      const int middle = static_cast<int>(below(bands));
      const int half = halfWidths[below(4)];
      const int first = std::max(0, middle - half);
      const int last = std::min(static_cast<int>(bands) - 1, middle + half);
      spectrum.segment(first, last - first + 1).array() += 1e-3 * (1 + below(1000));
    }
    const Eigen::Vector3d tristimulus = weights * spectrum;
    // Bands at the ends of the range weigh next to nothing; what only they make is outside the engine's domain.
    if (tristimulus.sum() > 1e-6) {
      tristimuli.push_back(tristimulus / tristimulus.sum());
    }
  }
  return tristimuli;
}

}  // namespace metamer::sip
