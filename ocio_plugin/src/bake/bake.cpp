// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/bake.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>

#include "bake/bake_operators.h"
#include "bake/ladder.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/spectral_files.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

constexpr const char* kChart = "colorchecker";
/// What a tolerance may ask for by itself: beyond it a table is slow to load and gains little.
constexpr int kLargestUsual = 65;

Certificate newCertificate(const sip::Recipe& recipe, const spectral::DataLibrary& library, const Prepared& prepared,
                           const sip::ErrorProtocol& protocol) {
  Certificate certificate;
  certificate.recipe = recipe;
  certificate.inputs = certifiedInputs(recipe, library);
  certificate.bandCount = prepared.transform.bandCount();
  certificate.gamut = prepared.space.engine.name;
  certificate.diagnostics = prepared.transform.diagnostics();
  std::size_t folded = 0;
  for (const auto& probe : protocol.probes()) {
    const Eigen::Matrix3d slope = prepared.transform.linearise(probe.rgb).matrix;
    folded += slope.determinant() < 0.0 ? 1 : 0;
    certificate.gain = std::max(certificate.gain, Eigen::JacobiSVD<Eigen::Matrix3d>(slope).singularValues()[0]);
  }
  certificate.folds =
      static_cast<double>(folded) / static_cast<double>(std::max<std::size_t>(1, protocol.probes().size()));
  return certificate;
}

struct Made {
  Operators operators;
  Certificate certificate;
};

/// The operators of a recipe in a format, chosen by tolerance where there is one; without the error of the result.
Made make(const sip::Recipe& recipe, const spectral::DataLibrary& library, const LutFormat& format,
          const BakeOptions& options, const Prepared& prepared, const sip::ErrorProtocol::Options& probes,
          const sip::ErrorProtocol& protocol) {
  Made made{{}, newCertificate(recipe, library, prepared, protocol)};
  Certificate& certificate = made.certificate;
  certificate.probes = probes;
  const Representation usual = holdsChain(format) ? Representation::ExposureInvariantChain : Representation::LogCube;
  if (!options.tolerance) {
    const Representation representation =
        options.representation.value_or(prepared.transform.isIdentity() ? Representation::Identity : usual);
    made.operators = operatorsFor(prepared, options, format, representation, certificate);
    return made;
  }
  if (!(*options.tolerance > 0.0) || options.representation) {
    throw InputError(
        "", "tolerance", std::to_string(*options.tolerance),
        options.representation ? "chooses the representation itself; name one or the other" : "must be above 0");
  }
  if (prepared.transform.isIdentity()) {
    made.operators = operatorsFor(prepared, options, format, Representation::Identity, certificate);
    return made;
  }
  BakeOptions tried = options;
  const int largest = options.size != 0 ? tableSize(options, usual) : kLargestUsual;
  const auto measure = [&](const Rung& rung) {
    tried.size = rung.size;
    made.operators = operatorsFor(prepared, tried, format, rung.representation, certificate);
    return protocol.measure(
        Candidate(PixelProcessor(made.operators.group), made.operators.toPixels, made.operators.fromPixels));
  };
  certificate.choice = climb(rungsOf(format.content, holdsChain(format), largest), *options.tolerance, measure);
  return made;
}

LutDescription descriptionOf(const Certificate& certificate) {
  return {certificate.recipe.name, "metamer-" + sha256(sip::toYaml(certificate.recipe)).substr(0, 16),
          certificate.lines()};
}

}  // namespace

Baked bake(const sip::Recipe& recipe, const spectral::DataLibrary& library, const BakeOptions& options) {
  const LutFormat& format = lutFormats().front();
  const Prepared prepared = prepare(recipe, library, options);
  const sip::ErrorProtocol::Options probes = probesOf(format, prepared, options);
  const sip::ErrorProtocol protocol(prepared.spec, library.reflectances(kChart).samples, probes);
  Made made = make(recipe, library, format, options, prepared, probes, protocol);
  made.certificate.error = protocol.measure(
      Candidate(PixelProcessor(made.operators.group), made.operators.toPixels, made.operators.fromPixels));
  return {made.operators.group, std::move(made.certificate)};
}

BakedText bakeText(const sip::Recipe& recipe, const spectral::DataLibrary& library, const std::string& formatName,
                   const BakeOptions& options) {
  const LutFormat& format = lutFormatNamed(formatName);
  const Prepared prepared = prepare(recipe, library, options);
  const sip::ErrorProtocol::Options probes = probesOf(format, prepared, options);
  const sip::ErrorProtocol protocol(prepared.spec, library.reflectances(kChart).samples, probes);
  Made made = make(recipe, library, format, options, prepared, probes, protocol);
  made.certificate.format = format.name;
  made.certificate.error = protocol.measure(
      Candidate(PixelProcessor(made.operators.group), made.operators.toPixels, made.operators.fromPixels));
  std::string text =
      lutText(format, made.operators.group, made.certificate.size, descriptionOf(made.certificate), options.shaperSize);
  made.certificate.sha256 = sha256(text);
  return {std::move(text), std::move(made.certificate)};
}

Certificate bakeFile(const sip::Recipe& recipe, const spectral::DataLibrary& library, const std::filesystem::path& file,
                     const std::string& formatName, const BakeOptions& options) {
  const LutFormat& format = lutFormat(file, formatName);
  // The places first: what cannot be written is not worth the work.
  spectral::PendingFile lut(file);
  spectral::PendingFile json(file.string() + ".json");

  const Prepared prepared = prepare(recipe, library, options);
  const sip::ErrorProtocol::Options probes = probesOf(format, prepared, options);
  const sip::ErrorProtocol protocol(prepared.spec, library.reflectances(kChart).samples, probes);
  auto [operators, certificate] = make(recipe, library, format, options, prepared, probes, protocol);
  certificate.format = format.name;
  const auto measure = [&, &made = operators](const PixelProcessor& processor) {
    return protocol.measure(Candidate(processor, made.toPixels, made.fromPixels));
  };
  // Twice: what the file says of itself is known before it is written, what the certificate says after.
  certificate.error = measure(PixelProcessor(operators.group));
  const std::string text =
      lutText(format, operators.group, certificate.size, descriptionOf(certificate), options.shaperSize);
  lut.write(text);
  certificate.sha256 = sha256(text);
  certificate.error = measure(PixelProcessor::fromFile(lut.path()));
  if (options.tolerance && certificate.error.p99 > 1.01 * *options.tolerance) {
    throw InputError(file.string(), "tolerance", std::to_string(*options.tolerance),
                     "is lost in the digits of " + format.name + "; name a format that keeps more");
  }
  json.write(certificate.json());
  lut.commit();
  json.commit();
  return certificate;
}

std::string convertedLuts(const std::vector<std::filesystem::path>& luts, const LutFormat& format, int size,
                          int shaperSize) {
  BakeOptions options;
  options.size = size;
  auto group = OCIO::GroupTransform::Create();
  LutDescription description;
  for (const auto& lut : luts) {
    // Read once for its own error; then as one of the group.
    PixelProcessor::fromFile(lut);
    auto transform = OCIO::FileTransform::Create();
    transform->setSrc(std::filesystem::absolute(lut).string().c_str());
    transform->setInterpolation(OCIO::INTERP_BEST);
    group->appendTransform(transform);
    description.name += (description.name.empty() ? "" : " + ") + lut.filename().string();
    description.lines.push_back(lut.filename().string() + " sha256 " + sha256(spectral::readTextFile(lut)));
  }
  const auto resolved = OCIO::Config::CreateRaw()->getProcessor(group)->createGroupTransform();
  description.id = "metamer-" + sha256(description.name).substr(0, 16);
  return lutText(format, resolved, tableSize(options, Representation::LogCube), description, shaperSize);
}

}  // namespace metamer::ocio
