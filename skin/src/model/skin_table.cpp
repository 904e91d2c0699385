// SPDX-License-Identifier: Apache-2.0
#include "metamer/skin/skin_table.h"

#include <algorithm>
#include <cmath>

#include "metamer/spectral/input_error.h"

namespace metamer::skin {
namespace {

// Knots along each axis, chosen so that the table's error is below 5e-4 rms over all skins of table 3.2.
constexpr int kThicknesses = 14;
constexpr int kDepths = 40;
constexpr int kDermes = 28;
constexpr std::size_t kPerThickness = static_cast<std::size_t>(kDepths) * kDermes;
constexpr std::size_t kPerBand = kThicknesses * kPerThickness;

// Thickness goes in by t / (t + 100 um): its scattering saturates.
constexpr float kThicknessHalf = 100;
// The epidermis's absorption goes in as its optical depth x, by x / (x + 0.5).
constexpr float kDepthHalf = 0.5F;

float thicknessAxis(float thicknessUm) {
  const auto of = [](float t) { return t / (t + kThicknessHalf); };
  const float low = of(kThinnestEpidermisUm);
  return (of(thicknessUm) - low) / (of(kThickestEpidermisUm) - low) * (kThicknesses - 1);
}

double thicknessAt(int knot) {
  const auto of = [](double t) { return t / (t + kThicknessHalf); };
  const double low = of(kThinnestEpidermisUm);
  const double at = low + (of(kThickestEpidermisUm) - low) * knot / (kThicknesses - 1);
  return kThicknessHalf * at / (1 - at);
}

/// The last knot stands for a depth through which nothing comes.
double depthAt(int knot) {
  constexpr double kOpaque = 1e4;
  const double at = static_cast<double>(knot) / (kDepths - 1);
  return knot == kDepths - 1 ? kOpaque : kDepthHalf * at / (1 - at);
}

/// The dermis's absorption goes in by the similarity parameter (van de Hulst), in which the albedo of a deep medium is
/// nearly linear.
double similarity(double absorption, double reducedScattering) {
  return std::sqrt(absorption / (absorption + reducedScattering));
}

}  // namespace

SkinTable::SkinTable(const SkinModel& model) {
  const SkinOptics& optics = model.optics();
  if (optics.wavelengthsNm() != skinWavelengths()) {
    throw spectral::InputError("", "wavelengths", std::to_string(optics.wavelengthsNm().size()),
                               "the table is of the skin bands, 380, 390, ..., 780 nm");
  }
  const auto padded = [](const Eigen::ArrayXd& values) {
    Bands result = Bands::Constant(static_cast<float>(values[kSkinBands - 1]));
    result.head<kSkinBands>() = values.cast<float>();
    return result;
  };
  m_eumelanin = padded(optics.eumelanin());
  m_pheomelanin = padded(optics.pheomelanin());
  m_epidermisRest = padded(optics.epidermisRest());
  m_deoxyhaemoglobin = padded(optics.deoxyhaemoglobin());
  m_oxyhaemoglobin = padded(optics.oxyhaemoglobin());
  m_bloodRest = padded(optics.bloodRest());
  m_baseline = padded(optics.baseline());
  m_reducedScattering = padded(optics.reducedScattering());

  m_knots.resize(kSkinBands * kPerBand);
  Eigen::ArrayXd start(kSkinBands);
  Eigen::ArrayXd scale(kSkinBands);
  std::vector<double> albedos(kPerThickness);
  for (int band = 0; band < kSkinBands; ++band) {
    const double reduced = optics.reducedScattering()[band];
    const double blood = std::max(optics.deoxyhaemoglobin()[band], optics.oxyhaemoglobin()[band]);
    const double least = similarity(
        std::min(optics.baseline()[band],
                 std::min(optics.deoxyhaemoglobin()[band], optics.oxyhaemoglobin()[band]) + optics.bloodRest()[band]),
        reduced);
    const double most = similarity(blood + optics.bloodRest()[band], reduced);
    start[band] = least;
    scale[band] = (kDermes - 1) / (most - least);
    LayerGrid grid{std::vector<double>(kDepths),
                   std::vector<double>(kDermes),
                   optics.scattering()[band],
                   optics.anisotropy()[band],
                   0,
                   model.dermisThicknessCm()};
    for (int i = 0; i < kDermes; ++i) {
      const double s = least + (most - least) * static_cast<double>(i) / (kDermes - 1);
      grid.dermisAbsorptions[static_cast<std::size_t>(i)] = reduced * s * s / (1 - s * s);
    }
    for (int thickness = 0; thickness < kThicknesses; ++thickness) {
      grid.epidermisThicknessCm = thicknessAt(thickness) * 1e-4;
      for (int i = 0; i < kDepths; ++i) {
        grid.epidermisAbsorptions[static_cast<std::size_t>(i)] = depthAt(i) / grid.epidermisThicknessCm;
      }
      layeredAlbedoGrid(grid, albedos);
      std::copy(albedos.begin(), albedos.end(),
                m_knots.begin() + static_cast<std::ptrdiff_t>(
                                      (static_cast<std::size_t>(band * kThicknesses + thickness)) * kPerThickness));
    }
  }
  m_dermisStart = padded(start);
  m_dermisScale = padded(scale);
}

SkinSpectrum SkinTable::albedo(const SkinParameters& skin) const {
  requireSkin(skin);
  const auto melanin = static_cast<float>(skin.melanin);
  const auto eumelanin = static_cast<float>(skin.eumelanin);
  const auto blood = static_cast<float>(skin.blood);
  const auto deoxy = static_cast<float>(skin.deoxyhaemoglobin);
  const auto thickness = static_cast<float>(skin.thicknessUm);
  const Bands depth = (thickness * 1e-4F) * (melanin * (eumelanin * m_eumelanin + (1 - eumelanin) * m_pheomelanin) +
                                             (1 - melanin) * m_epidermisRest);
  const Bands dermis =
      blood * (deoxy * m_deoxyhaemoglobin + (1 - deoxy) * m_oxyhaemoglobin + m_bloodRest) + (1 - blood) * m_baseline;
  const Bands alongDepth = (depth / (depth + kDepthHalf)) * (kDepths - 1.0F);
  const Bands alongDermis = ((dermis / (dermis + m_reducedScattering)).sqrt() - m_dermisStart) * m_dermisScale;
  const float alongThickness = thicknessAxis(thickness);
  const int cellThickness = std::clamp(static_cast<int>(alongThickness), 0, kThicknesses - 2);
  const float c = alongThickness - static_cast<float>(cellThickness);

  SkinSpectrum result;
  for (int band = 0; band < kSkinBands; ++band) {
    const int cellDepth = std::clamp(static_cast<int>(alongDepth[band]), 0, kDepths - 2);
    const int cellDermis = std::clamp(static_cast<int>(alongDermis[band]), 0, kDermes - 2);
    const float b = alongDepth[band] - static_cast<float>(cellDepth);
    const float a = alongDermis[band] - static_cast<float>(cellDermis);
    const float* const at = m_knots.data() + static_cast<std::size_t>(band) * kPerBand +
                            static_cast<std::size_t>(cellThickness) * kPerThickness +
                            static_cast<std::size_t>(cellDepth * kDermes + cellDermis);
    const float* const next = at + kPerThickness;
    const float p = at[0] + a * (at[1] - at[0]);
    const float q = at[kDermes] + a * (at[kDermes + 1] - at[kDermes]);
    const float r = next[0] + a * (next[1] - next[0]);
    const float s = next[kDermes] + a * (next[kDermes + 1] - next[kDermes]);
    const float near = p + b * (q - p);
    const float far = r + b * (s - r);
    result[band] = static_cast<double>(near + c * (far - near));
  }
  return result;
}

}  // namespace metamer::skin
