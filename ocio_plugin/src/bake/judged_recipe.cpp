// SPDX-License-Identifier: Apache-2.0
#include "bake/judged_recipe.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "metamer/spectral/input_error.h"
#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

/// Bands of the engine behind a baked transform: p99 within 0.13 CIEDE2000 of 401 bands on spiky lamps, 0.05 on others.
constexpr int kBakeBandCount = 161;

Certificate newCertificate(const sip::Recipe& recipe, const spectral::DataLibrary& library, const Prepared& prepared,
                           const sip::ErrorProtocol& protocol) {
  Certificate certificate;
  certificate.recipe = recipe;
  certificate.inputs = certifiedInputs(recipe, library);
  certificate.notes = sip::notesOf(recipe, prepared.spec);
  certificate.bandCount = prepared.transform.bandCount();
  certificate.gamut = prepared.space.engine.name;
  certificate.diagnostics = prepared.transform.diagnostics();
  const auto& probes = protocol.probes();
  std::vector<Eigen::Matrix3d> slopes(probes.size());
  parallelFor(static_cast<int>(probes.size()),
              [&](int k) { slopes[k] = prepared.transform.linearise(probes[k].rgb).matrix; });
  std::size_t folded = 0;
  for (const Eigen::Matrix3d& slope : slopes) {
    folded += slope.determinant() < 0.0 ? 1 : 0;
    certificate.gain = std::max(certificate.gain, Eigen::JacobiSVD<Eigen::Matrix3d>(slope).singularValues()[0]);
  }
  certificate.folds =
      static_cast<double>(folded) / static_cast<double>(std::max<std::size_t>(1, protocol.probes().size()));
  return certificate;
}

}  // namespace

JudgedRecipe::JudgedRecipe(const sip::Recipe& recipe, const spectral::DataLibrary& library, const BakeOptions& options,
                           const Probes& probes)
    : m_options(options) {
  const sip::ErrorProtocol::Options wanted = prepare(recipe, library, probes);
  m_certificate = newCertificate(recipe, library, *m_prepared, *m_protocol);
  m_certificate.probes = wanted;
  m_certificate.brightening = m_pixels->brightening();
  tell(kPreparedShare);
  if (options.fullCertificate) {
    m_certificate.surfaces = sip::heldOutErrors(m_prepared->spec, library, parallelFor);
  }
}

/// Reads, then builds the two engines, of which the converged one is the judge's.
sip::ErrorProtocol::Options JudgedRecipe::prepare(const sip::Recipe& recipe, const spectral::DataLibrary& library,
                                                  const Probes& probes) {
  std::optional<WorkingSpace> space;
  std::optional<sip::TransformSpec> spec;
  std::vector<spectral::Spectrum> chart;
  std::vector<spectral::SetPixel> pixels;
  inParallel(
      [&] {
        space = workingSpaceOf(recipe, library, m_options.config);
        spec = sip::resolve(recipe, library, space->engine);
      },
      [&] {
        chart = library.reflectances(sip::ErrorProtocol::kChart).samples;
        pixels = library.certificatePixels();
      });
  const sip::ErrorProtocol::Options wanted = probes(*space);
  inParallel(
      [&] {
        m_prepared.emplace(Prepared{*space, *spec, sip::SpectralTransform(*spec, kBakeBandCount)});
        m_pixels.emplace(m_prepared->transform, pixels);
      },
      [&] { m_protocol.emplace(*spec, chart, wanted); });
  return wanted;
}

void JudgedRecipe::certify(const std::function<void(std::span<float> rgba)>& candidate) {
  inParallel([&] { m_certificate.error = m_protocol->search(candidate); },
             [&] { m_certificate.pixels = m_pixels->measure(candidate); });
  if (!std::isfinite(m_certificate.error.max) || !std::isfinite(m_certificate.pixels.largest)) {
    throw spectral::InputError("", "transform", "not a number",
                               "colours come out infinite or as no number; name another light, observer or format");
  }
}

void JudgedRecipe::certifyOnCards(const std::function<void(std::span<float> rgba)>& floats,
                                  const std::function<void(std::span<float> rgba)>& halves) {
  Certificate::OnCards& onCards = m_certificate.onCards.emplace();
  inParallel([&] { onCards.floats = m_protocol->search(floats); },
             [&] { onCards.halves = m_protocol->search(halves); });
}

LutDescription descriptionOf(const Certificate& certificate) {
  return {certificate.recipe.name, "metamer-" + sha256(sip::toYaml(certificate.recipe)).substr(0, 16),
          certificate.lines()};
}

}  // namespace metamer::ocio
