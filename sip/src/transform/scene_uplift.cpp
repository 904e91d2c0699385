// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/scene_uplift.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "metamer/sip/band_weights.h"
#include "metamer/sip/recipe.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"
#include "transform/recovery.h"
#include "transform/sides.h"

namespace metamer::sip {
namespace {

using spectral::InputError;

/// In steps of 5 nm daylight needs no more.
constexpr int kBands = 81;
/// Colours that are solved side by side: enough to fill vectors, few enough for their spectra to stay in the cache.
constexpr std::size_t kTogether = 64;

constexpr std::array<const char*, 3> kScenes = {"smooth", "natural", "skin"};

std::string plainName(const std::string& name) {
  return spectral::lowerCase(spectral::trimmed(name));
}

std::vector<double> bandCentres() {
  std::vector<double> centres;
  for (int band = 0; band < kBands; ++band) {
    centres.push_back(bandCentreNm(band, kBands));
  }
  return centres;
}

TransformSpec daylightSpec(const std::string& scene, const spectral::DataLibrary& library) {
  Recipe recipe;
  recipe.space = "Rec.709";
  recipe.input.illuminant = recipe.output.illuminant = "D65";
  recipe.scene.kind = sceneKindFromName(scene);
  return resolve(recipe, library);
}

/// The engine's recovery under daylight, before anything is done with the spectra.
class SceneUplift : public spectral::Uplift {
 public:
  SceneUplift(const TransformSpec& spec, const Sides& sides)
      : Uplift(bandCentres(), sides.input.xyzFromResponse * sides.input.white.asDiagonal() * sides.responseFromRgb),
        m_responseFromRgb(sides.responseFromRgb),
        m_recovery(sides.inputWeights(kBands), 0.0, spec.scene) {}

 private:
  void spectrumOf(const Eigen::Vector3d& rgb, double* spectrum) const override { spectraOf({rgb.data(), 3}, spectrum); }

  void spectraOf(std::span<const double> rgb, double* spectra) const override {
    const auto colours = static_cast<Eigen::Index>(rgb.size() / 3);
    for (Eigen::Index first = 0; first < colours; first += kTogether) {
      const Eigen::Index count = std::min<Eigen::Index>(kTogether, colours - first);
      const Eigen::Map<const Eigen::Matrix3Xd> some(rgb.data() + 3 * first, 3, count);
      Eigen::Matrix3Xd responses(3, count);
      Eigen::RowVectorXd sizes(count);
      for (Eigen::Index k = 0; k < count; ++k) {
        // Powers of two change no bits: the solver's tolerances are for colours near 1.
        int exponent = 0;
        std::frexp(some.col(k).cwiseAbs().maxCoeff(), &exponent);
        sizes[k] = std::ldexp(1.0, std::clamp(exponent, -1000, 1000));
        responses.col(k) = m_responseFromRgb * Eigen::Vector3d(some.col(k) / sizes[k]);
      }
      Eigen::Map<Eigen::MatrixXd>(spectra + kBands * first, kBands, count) =
          m_recovery.spectra(responses).array().rowwise() * sizes.array();
    }
  }

  Eigen::Matrix3d m_responseFromRgb;
  Recovery m_recovery;
};

}  // namespace

const std::vector<std::string>& upliftNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = spectral::upliftMethodNames();
    all.insert(all.end(), kScenes.begin(), kScenes.end());
    return all;
  }();
  return names;
}

bool isSceneUplift(const std::string& name) {
  return std::find(kScenes.begin(), kScenes.end(), plainName(name)) != kScenes.end();
}

std::unique_ptr<spectral::Uplift> makeUplift(const std::string& name, const spectral::DataLibrary& library,
                                             const std::optional<spectral::UpliftWeights>& weights) {
  const std::string plain = plainName(name);
  const std::vector<std::string>& names = upliftNames();
  if (std::find(names.begin(), names.end(), plain) == names.end()) {
    throw InputError("", "uplift", name, "must be one of: " + spectral::joined(names));
  }
  if (!isSceneUplift(plain)) {
    return spectral::makeUplift(spectral::upliftMethodNamed(plain), library, weights);
  }
  if (weights) {
    throw InputError("", "weights", "", "are for the published uplifts; " + plain + " has the engine's own");
  }
  const TransformSpec spec = daylightSpec(plain, library);
  return std::make_unique<SceneUplift>(spec, prepareSides(spec));
}

}  // namespace metamer::sip
