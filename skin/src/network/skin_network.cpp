// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_network.h"

#include <cmath>
#include <fstream>
#include <string>

#include "colours/brightness.h"
#include "colours/in_parallel.h"
#include "colours/pixel_checks.h"
#include "metamer/spectral/missing_file_error.h"
#include "metamer/spectral/path_text.h"
#include "network/perceptron.h"

namespace metamer::skin {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using nlohmann::json;

constexpr const char* kIlluminant = "D65";
constexpr const char* kObserver = "CIE 1931 2";
constexpr const char* kSpace = "Rec.709";

/// Weights lie beside the prior that they were trained on.
json weightsOf(const spectral::DataLibrary& library, std::string& where) {
  const std::filesystem::path file = library.skinPriorFile().parent_path() / "skin_network.json";
  where = spectral::utf8(file);
  std::ifstream stream(file);
  if (!stream) {
    throw spectral::MissingFileError(where, "skin network", "", "cannot be read; use the data folder of this release");
  }
  json document = json::parse(stream, nullptr, false);
  if (!document.is_object()) {
    throw spectral::InputError(where, "skin network", "", "is no JSON object; use the data folder of this release");
  }
  return document;
}

SkinView viewOf(const spectral::DataLibrary& library, const spectral::RgbSpace& space) {
  return {library.illuminant(kIlluminant), library.observer(kObserver), space};
}

/// Numbers as a network takes and gives them: of mean 0 and deviation 1 over its training.
struct Scale {
  Eigen::VectorXd mean;
  Eigen::VectorXd deviation;

  Scale(const json& given, Eigen::Index count, const std::string& where)
      : mean(numbersOf(given.is_object() ? given.value("mean", json()) : json(), count, where)),
        deviation(numbersOf(given.is_object() ? given.value("deviation", json()) : json(), count, where)) {}
  Eigen::VectorXd scaled(const Eigen::VectorXd& numbers) const { return (numbers - mean).cwiseQuotient(deviation); }
  Eigen::VectorXd unscaled(const Eigen::VectorXd& numbers) const { return numbers.cwiseProduct(deviation) + mean; }
};

}  // namespace

struct SkinNetwork::State {
  SkinColours colours;
  Eigen::Matrix3d ownFromRgb;  ///< to the space that it was trained in
  Scale features;
  Scale coordinates;
  Perceptron encoder;
  Perceptron decoder;

  State(const spectral::DataLibrary& library, const spectral::RgbSpace& space, const json& weights, const json& own,
        Eigen::Index decodes, const std::string& where)
      : colours(library, viewOf(library, space)),
        ownFromRgb(viewOf(library, library.colourSpace(kSpace).linear).rgbWeights() * colours.view().smoothest()),
        features(weights.value("features", json()), 3, where),
        coordinates(weights.value("coordinates", json()), 5, where),
        encoder(own.value("encoder", json()), 3, 5, where),
        decoder(own.value("decoder", json()), 5, decodes, where) {}
};

SkinNetwork::SkinNetwork(const spectral::DataLibrary& library, const spectral::RgbSpace& space, Loss loss) {
  std::string where;
  const json weights = weightsOf(library, where);
  const char* name = loss == Loss::Rgb ? "rgb" : "spectral";
  const json networks = weights.value("networks", json::object());
  const json own = networks.is_object() ? networks.value(name, json::object()) : json::object();
  if (!own.is_object()) {
    throw spectral::InputError(where, name, "", "is no network; use the data folder of this release");
  }
  m_state = std::make_shared<const State>(library, space, weights, own, loss == Loss::Rgb ? 3 : kSkinBands, where);
}

const SkinColours& SkinNetwork::colours() const {
  return m_state->colours;
}

SkinPixel SkinNetwork::estimate(const Vector3f& rgb) const {
  const State& state = *m_state;
  const Vector3d given = rgb.cast<double>();
  const Vector3d own = state.ownFromRgb * given;
  if (!canBeSkin(given) || !canBeSkin(own)) {
    return state.colours.pixel(skinOf(state.colours.prior().mean), 0, rgb);
  }
  const double mean = own.mean();
  const double gain = gainOf(mean);
  const Vector3d features((own[0] - own[1]) / mean, (own[2] - own[1]) / mean, std::log(mean / gain));
  const Eigen::VectorXd found = state.encoder(state.features.scaled(features));
  return state.colours.pixel(skinOf(state.coordinates.unscaled(found)), gain, rgb);
}

void SkinNetwork::estimate(std::span<const float> rgb, std::span<SkinPixel> pixels, int threads) const {
  requireThree(rgb.size(), pixels.size());
  requireThreads(threads);
  inParallel(pixels.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      pixels[i] = estimate(Vector3f(rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]));
    }
  });
}

Eigen::VectorXd SkinNetwork::decoded(const SkinParameters& skin) const {
  requireSkin(skin);
  return m_state->decoder(m_state->coordinates.scaled(coordinatesOf(skin)));
}

}  // namespace metamer::skin
