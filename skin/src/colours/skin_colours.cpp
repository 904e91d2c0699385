// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_colours.h"

#include "colours/in_parallel.h"
#include "colours/pixel_checks.h"

namespace metamer::skin {

using Eigen::Vector3d;
using Eigen::Vector3f;

struct SkinColours::State {
  SkinPrior prior;
  SkinTable table;
  SkinView view;
  SkinView::Weights weights;  ///< RGB from the table's albedo, the misfit repaired

  State(const spectral::DataLibrary& library, const SkinView& given)
      : prior(SkinPrior::read(library)),
        table(SkinModel(library)),
        view(given),
        weights(given.rgbWeights() * (1 + prior.misfit.array()).matrix().asDiagonal()) {}

  Vector3f model(const SkinPixel& pixel) const {
    return (static_cast<double>(pixel.gain) * (weights * table.albedo(withinRanges(pixel.parameters())))).cast<float>();
  }
};

SkinColours::SkinColours(const spectral::DataLibrary& library, const SkinView& view)
    : m_state(std::make_shared<const State>(library, view)) {}

const SkinPrior& SkinColours::prior() const {
  return m_state->prior;
}

const SkinView& SkinColours::view() const {
  return m_state->view;
}

SkinSpectrum SkinColours::albedo(const SkinParameters& skin) const {
  return repaired(m_state->table.albedo(skin), m_state->prior);
}

Vector3d SkinColours::rgb(const SkinParameters& skin) const {
  return m_state->weights * m_state->table.albedo(skin);
}

Vector3f SkinColours::colour(const SkinPixel& pixel) const {
  const Vector3f residual(pixel.residual[0], pixel.residual[1], pixel.residual[2]);
  return pixel.gain == 0 ? residual : Vector3f(m_state->model(pixel) + residual);
}

void SkinColours::colour(std::span<const SkinPixel> pixels, std::span<float> rgb, int threads) const {
  requireThree(rgb.size(), pixels.size());
  requireThreads(threads);
  inParallel(pixels.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Vector3f::Map(&rgb[3 * i]) = colour(pixels[i]);
    }
  });
}

SkinSpectrum SkinColours::spectrum(const SkinPixel& pixel) const {
  const Vector3d residual(pixel.residual[0], pixel.residual[1], pixel.residual[2]);
  return static_cast<double>(pixel.gain) * albedo(withinRanges(pixel.parameters())) +
         m_state->view.smoothest() * residual;
}

SkinPixel SkinColours::pixel(const SkinParameters& skin, double gain, const Vector3f& rgb) const {
  SkinPixel result;
  result.skin = {static_cast<float>(skin.melanin), static_cast<float>(skin.blood), static_cast<float>(skin.thicknessUm),
                 static_cast<float>(skin.eumelanin), static_cast<float>(skin.deoxyhaemoglobin)};
  result.gain = static_cast<float>(gain);
  // Of the rounded numbers, so that they give the colour back.
  Vector3f::Map(result.residual.data()) = gain == 0 ? rgb : Vector3f(rgb - m_state->model(result));
  return result;
}

}  // namespace metamer::skin
