// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/bake.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "bake/bake_operators.h"
#include "bake/ladder.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/spectral_files.h"
#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

/// Bands of the engine behind a baked transform: p99 within 0.13 CIEDE2000 of 401 bands on spiky lamps, 0.05 on others.
constexpr int kBakeBandCount = 161;

/// What a tolerance may ask for by itself: beyond it a table is slow to load and gains little.
constexpr int kLargestUsual = 65;

/// Of the time that a bake takes, about.
constexpr double kPreparedShare = 0.1;
constexpr double kChosenShare = 0.5;
constexpr double kCertifiedShare = 0.75;

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

/// A recipe on its way into a format: what it was prepared to, what judges it, and its operators.
class Baking {
 public:
  /// Chooses the operators, by tolerance where there is one.
  Baking(const sip::Recipe& recipe, const spectral::DataLibrary& library, const LutFormat& format,
         const BakeOptions& options)
      : m_format(format), m_options(options) {
    requireSignal(format, options);
    prepare(recipe, library);
    m_certificate = newCertificate(recipe, library, *m_prepared, *m_protocol);
    noteDisplay();
    m_certificate.probes = m_probes;
    m_certificate.brightening = m_pixels->brightening();
    tell(kPreparedShare);
    if (options.fullCertificate) {
      m_certificate.surfaces = sip::heldOutErrors(m_prepared->spec, library, parallelFor);
    }
    choose();
    tell(kChosenShare);
  }

  /// Puts the error of a transform of the format's pixels into the certificate.
  /// @throws spectral::InputError where it gives what is not a number: no certificate says that
  void certify(const PixelProcessor& processor) {
    const Candidate candidate(processor, m_operators.toPixels, m_operators.fromPixels);
    inParallel([&] { m_certificate.error = m_protocol->search(candidate); },
               [&] { m_certificate.pixels = m_pixels->measure(candidate); });
    if (!std::isfinite(m_certificate.error.max) || !std::isfinite(m_certificate.pixels.largest)) {
      throw InputError("", "transform", "not a number",
                       "colours come out infinite or as no number; name another light, observer or format");
    }
  }
  void certify() {
    certify(PixelProcessor(m_operators.group));
    tell(kCertifiedShare);
  }

  const OCIO::GroupTransformRcPtr& group() const { return m_operators.group; }
  /// With the error of the result once certify() ran.
  Certificate& certificate() { return m_certificate; }
  const Certificate& certificate() const { return m_certificate; }

 private:
  void prepare(const sip::Recipe& recipe, const spectral::DataLibrary& library);
  void choose();
  /// A display's curve over the primaries of no display is right, but seldom what was meant.
  void noteDisplay();
  void tell(double share) const {
    if (m_options.progress) {
      m_options.progress(share);
    }
  }

  const LutFormat& m_format;
  const BakeOptions& m_options;
  std::optional<Prepared> m_prepared;
  sip::ErrorProtocol::Options m_probes;
  std::optional<sip::ErrorProtocol> m_protocol;
  std::optional<PixelProtocol> m_pixels;
  Certificate m_certificate;
  Operators m_operators;
};

/// Reads, then builds the two engines, of which the converged one is the judge's.
void Baking::prepare(const sip::Recipe& recipe, const spectral::DataLibrary& library) {
  std::optional<WorkingSpace> space;
  std::optional<sip::TransformSpec> spec;
  std::vector<spectral::Spectrum> chart;
  std::vector<spectral::SetPixel> pixels;
  inParallel(
      [&] {
        space = findWorkingSpace(recipe.space, library, m_options.config);
        spec = sip::resolve(recipe, library, space->engine);
      },
      [&] {
        chart = library.reflectances(sip::ErrorProtocol::kChart).samples;
        pixels = library.certificatePixels();
      });
  m_probes = probesOf(m_format, *space, m_options);
  inParallel(
      [&] {
        m_prepared.emplace(Prepared{*space, *spec, sip::SpectralTransform(*spec, kBakeBandCount)});
        m_pixels.emplace(m_prepared->transform, pixels);
      },
      [&] { m_protocol.emplace(*spec, chart, m_probes); });
}

void Baking::noteDisplay() {
  constexpr std::array kDisplays = {"Rec.709", "Rec.2020", "P3-D65"};
  const std::string& space = m_prepared->space.engine.name;
  if (m_options.shaper && isDisplay(*m_options.shaper) &&
      std::find(kDisplays.begin(), kDisplays.end(), space) == kDisplays.end()) {
    m_certificate.notes.push_back("the signals are " + space + " by the curve " + nameOf(*m_options.shaper) +
                                  "; for a timeline in Rec.709 add --space Rec.709");
  }
}

void Baking::choose() {
  const bool isIdentity = m_prepared->transform.isIdentity();
  const Representation usual = holdsChain(m_format) ? Representation::ExposureInvariantChain : Representation::LogCube;
  const auto make = [&](const BakeOptions& options, Representation representation) {
    m_operators = operatorsFor(*m_prepared, options, m_format, representation, m_certificate);
  };
  if (!m_options.tolerance) {
    make(m_options, m_options.representation.value_or(isIdentity ? Representation::Identity : usual));
    return;
  }
  if (!(*m_options.tolerance > 0.0) || m_options.representation) {
    throw InputError(
        "", "tolerance", std::to_string(*m_options.tolerance),
        m_options.representation ? "chooses the representation itself; name one or the other" : "must be above 0");
  }
  if (isIdentity) {
    make(m_options, Representation::Identity);
    return;
  }
  BakeOptions tried = m_options;
  const int largest = m_options.size != 0 ? tableSize(m_options, usual, m_format) : kLargestUsual;
  const std::vector<Rung> rungs = rungsOf(m_format.content, holdsChain(m_format), largest);
  double share = kPreparedShare;
  m_certificate.choice = climb(rungs, *m_options.tolerance, [&](const Rung& rung) {
    tell(share);
    share += (kChosenShare - kPreparedShare) / static_cast<double>(rungs.size());
    tried.size = rung.size;
    make(tried, rung.representation);
    return m_protocol->measure(
        Candidate(PixelProcessor(m_operators.group), m_operators.toPixels, m_operators.fromPixels));
  });
}

std::string textOf(const Baking& baking, const LutFormat& format, const BakeOptions& options) {
  const Certificate& certificate = baking.certificate();
  const LutDescription description{
      certificate.recipe.name, "metamer-" + sha256(sip::toYaml(certificate.recipe)).substr(0, 16), certificate.lines()};
  return lutText(format, baking.group(), certificate.size, description, options.shaperSize);
}

}  // namespace

Baked bake(const sip::Recipe& recipe, const spectral::DataLibrary& library, const BakeOptions& options) {
  Baking baking(recipe, library, lutFormats().front(), options);
  baking.certify();
  return {baking.group(), std::move(baking.certificate())};
}

BakedText bakeText(const sip::Recipe& recipe, const spectral::DataLibrary& library, const std::string& formatName,
                   const BakeOptions& options) {
  const LutFormat& format = lutFormatNamed(formatName);
  Baking baking(recipe, library, format, options);
  Certificate& certificate = baking.certificate();
  certificate.format = format.name;
  baking.certify();
  std::string text = textOf(baking, format, options);
  certificate.sha256 = sha256(text);
  return {std::move(text), std::move(certificate)};
}

Certificate bakeFile(const sip::Recipe& recipe, const spectral::DataLibrary& library, const std::filesystem::path& file,
                     const std::string& formatName, const BakeOptions& options) {
  const LutFormat& format = lutFormat(file, formatName);
  // The places first: what cannot be written is not worth the work.
  spectral::PendingFile lut(file);
  std::optional<spectral::PendingFile> json;
  if (!lut.isStream()) {
    json.emplace(spectral::pathOf(spectral::utf8(file) + ".json"));
  }

  Baking baking(recipe, library, format, options);
  Certificate& certificate = baking.certificate();
  certificate.format = format.name;
  // Twice: what the file says of itself is known before it is written, what the certificate says after.
  baking.certify();
  const std::string text = textOf(baking, format, options);
  lut.write(text);
  certificate.sha256 = sha256(text);
  baking.certify(PixelProcessor::fromFile(lut.path()));
  if (options.tolerance && certificate.error.p99 > 1.01 * *options.tolerance) {
    throw InputError(spectral::utf8(file), "tolerance", std::to_string(*options.tolerance),
                     "is lost in the digits of " + format.name + "; name a format that keeps more");
  }
  if (json) {
    json->write(certificate.json());
    spectral::commitAll({&lut, &*json});
  } else {
    lut.commit();
  }
  return std::move(certificate);
}

std::string convertedLuts(const std::vector<std::filesystem::path>& luts, const LutFormat& format, int size,
                          int shaperSize) {
  if (luts.empty()) {
    throw InputError("", "LUT files", "0", "are none; name at least one");
  }
  BakeOptions options;
  options.size = size;
  auto group = OCIO::GroupTransform::Create();
  LutDescription description;
  for (const auto& lut : luts) {
    // Read once for its own error; then as one of the group.
    PixelProcessor::fromFile(lut);
    auto transform = OCIO::FileTransform::Create();
    transform->setSrc(spectral::utf8(std::filesystem::absolute(lut)).c_str());
    transform->setInterpolation(OCIO::INTERP_BEST);
    group->appendTransform(transform);
    description.name += (description.name.empty() ? "" : " + ") + spectral::utf8(lut.filename());
    description.lines.push_back(spectral::utf8(lut.filename()) + " sha256 " + sha256(spectral::readTextFile(lut)));
  }
  const auto resolved = OCIO::Config::CreateRaw()->getProcessor(group)->createGroupTransform();
  description.id = "metamer-" + sha256(description.name).substr(0, 16);
  return lutText(format, resolved, tableSize(options, Representation::LogCube, format), description, shaperSize);
}

}  // namespace metamer::ocio
