// SPDX-License-Identifier: Apache-2.0
#include "materials/gel_sheet.h"

#include <algorithm>

namespace metamer::spectral_ref {
namespace {

/// Reflectance of a face, straight on.
double faceReflectance(double index) {
  const double r = (index - 1.0) / (index + 1.0);
  return r * r;
}

/// What the matter itself passes, from what a sheet does: solves (1 - R)^2 t / (1 - R^2 t^2) = sheet for t.
double withinSheet(double sheet, double reflectance) {
  const double in = (1.0 - reflectance) * (1.0 - reflectance);
  // The root of R^2 sheet t^2 + in t - sheet = 0 in the form that does not cancel.
  const double root = std::sqrt(in * in + 4.0 * reflectance * reflectance * sheet * sheet);
  return 2.0 * sheet / (in + root);
}

}  // namespace

double clearSheet(double index) {
  const double reflectance = faceReflectance(index);
  return (1.0 - reflectance) / (1.0 + reflectance);
}

GelSheet::GelSheet(const spectral::ExcitationSamples& transmittance, double index)
    : m_index(static_cast<float>(index)) {
  const double reflectance = faceReflectance(index);
  m_logWithin.reserve(static_cast<std::size_t>(transmittance.size()));
  for (const double sheet : transmittance) {
    // Of black it is minus infinity, and what passes is nothing at every angle.
    m_logWithin.push_back(static_cast<float>(std::log(std::clamp(withinSheet(sheet, reflectance), 0.0, 1.0))));
  }
}

GelSheet::Faces GelSheet::facesAt(float cosine) const {
  const float sine = std::sqrt(std::max(0.0F, 1.0F - cosine * cosine)) / m_index;
  const float inside = std::sqrt(std::max(0.0F, 1.0F - sine * sine));
  const float across = (cosine - m_index * inside) / (cosine + m_index * inside);
  const float parallel = (m_index * cosine - inside) / (m_index * cosine + inside);
  return {across * across, parallel * parallel, 1.0F / std::max(inside, 1e-6F)};
}

}  // namespace metamer::spectral_ref
