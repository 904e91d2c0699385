// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/bake.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "metamer/ocio/pending_file.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/shaper.h"
#include "metamer/ocio/working_space.h"
#include "metamer/spectral/input_error.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

/// Bands of the engine behind a baked transform: p99 within 0.13 CIEDE2000 of 401 bands on spiky lamps, 0.05 on others.
constexpr int kBakeBandCount = 161;
constexpr int kChainSize = 65;
constexpr int kCubeSize = 33;
constexpr const char* kChart = "colorchecker";
/// The exposures a cube is judged on: what log footage carries, short of the shaper's last two stops.
constexpr int kCubeStops = 7;

/// A recipe with all it names looked up and its engine built.
struct Prepared {
  WorkingSpace space;
  sip::TransformSpec spec;
  sip::SpectralTransform transform;
};

Prepared prepare(const sip::Recipe& recipe, const spectral::DataLibrary& library, const BakeOptions& options) {
  WorkingSpace space = findWorkingSpace(recipe.space, library, options.config);
  sip::TransformSpec spec = sip::resolve(recipe, library, space.engine);
  sip::SpectralTransform transform(spec, kBakeBandCount);
  return {std::move(space), std::move(spec), std::move(transform)};
}

int tableSize(const BakeOptions& options, Representation representation) {
  if (options.size != 0 && (options.size < kSmallestTable || options.size > kLargestTable)) {
    throw InputError("", "size", std::to_string(options.size),
                     "must be from " + std::to_string(kSmallestTable) + " to " + std::to_string(kLargestTable));
  }
  switch (representation) {
    case Representation::Identity:
    case Representation::Matrix:
      return 0;
    case Representation::LogCube:
      return options.size != 0 ? options.size : kCubeSize;
    case Representation::ExposureInvariantChain:
      return options.size != 0 ? options.size : kChainSize;
  }
  return 0;
}

/// The log curve of a cube's signal: the space's own, else the shaper.
spectral::LogEncoding cubeEncoding(const WorkingSpace& space, const BakeOptions& options) {
  if (space.encoding) {
    if (options.shaper && *options.shaper != *space.encoding) {
      throw InputError("", "shaper", spectral::nameOf(*options.shaper),
                       space.name + " is a log space already; leave the shaper out");
    }
    return *space.encoding;
  }
  return options.shaper.value_or(spectral::LogEncoding::AcesCct);
}

sip::ErrorProtocol::Options cubeProbes(spectral::LogEncoding encoding) {
  const double stops = std::log2(spectral::decode(encoding, 1.0) / 0.18);
  sip::ErrorProtocol::Options probes;
  probes.insideGamutOnly = true;
  probes.lowestStop = -kCubeStops;
  probes.highestStop = std::min(kCubeStops, static_cast<int>(std::floor(stops)) - 2);
  return probes;
}

/// Runs linear pixels of the engine through a transform of pixels of the working space, or of a cube's signal.
class Candidate {
 public:
  /// @param toPixels, fromPixels  null: pixels are the engine's
  Candidate(PixelProcessor processor, const OCIO::ConstTransformRcPtr& toPixels,
            const OCIO::ConstTransformRcPtr& fromPixels)
      : m_processor(std::move(processor)) {
    if (toPixels) {
      m_toPixels.emplace(toPixels);
      m_fromPixels.emplace(fromPixels);
    }
  }
  void operator()(std::span<float> rgba) const {
    if (m_toPixels) {
      m_toPixels->apply(rgba);
    }
    m_processor.apply(rgba);
    if (m_fromPixels) {
      m_fromPixels->apply(rgba);
    }
  }

 private:
  PixelProcessor m_processor;
  std::optional<PixelProcessor> m_toPixels;
  std::optional<PixelProcessor> m_fromPixels;
};

OCIO::GroupTransformRcPtr inOrder(std::initializer_list<OCIO::ConstTransformRcPtr> transforms) {
  auto group = OCIO::GroupTransform::Create();
  for (const auto& transform : transforms) {
    if (transform) {
      group->appendTransform(transform->createEditableCopy());
    }
  }
  return group;
}

/// The signal of a cube: the space's own pixels where they are a log signal, else those through the shaper.
Signal cubeSignal(const WorkingSpace& space, spectral::LogEncoding encoding) {
  if (space.isLog) {
    return {space.toEngine, space.fromEngine};
  }
  return {inOrder({shaperTransform(encoding, OCIO::TRANSFORM_DIR_INVERSE), space.toEngine}),
          inOrder({space.fromEngine, shaperTransform(encoding, OCIO::TRANSFORM_DIR_FORWARD)})};
}

/// A recipe as operators on what a file of the content holds, and the way there from the engine's pixels.
struct Operators {
  OCIO::GroupTransformRcPtr group;
  OCIO::ConstTransformRcPtr toPixels;
  OCIO::ConstTransformRcPtr fromPixels;
};

Operators operatorsFor(const Prepared& prepared, const BakeOptions& options, LutFormat::Content content,
                       Representation representation, Certificate& certificate) {
  const WorkingSpace& space = prepared.space;
  const bool isCube = content == LutFormat::Content::Cube;
  certificate.representation = representation;
  certificate.size = tableSize(options, isCube ? Representation::LogCube : representation);
  if (!isCube && representation != Representation::LogCube) {
    return {space.wrapped(engineOperators(representation, prepared.spec, prepared.transform, certificate.size)),
            space.fromEngine, space.toEngine};
  }
  if (!space.isLog && !space.isLinear) {
    throw InputError("", "space", space.name,
                     "is neither linear nor log, which a table needs; name a log space, or write .ctf");
  }
  const spectral::LogEncoding encoding = cubeEncoding(space, options);
  const Signal signal = cubeSignal(space, encoding);
  certificate.shaper = space.isLog ? space.name : spectral::nameOf(encoding);
  certificate.probes = cubeProbes(encoding);
  OCIO::ConstTransformRcPtr onSignal;
  if (representation == Representation::LogCube) {
    onSignal = logCube(prepared.transform, signal,
                       {.size = certificate.size,
                        .fitted = options.fitted,
                        .lowestStop = static_cast<double>(certificate.probes.lowestStop),
                        .highestStop = static_cast<double>(certificate.probes.highestStop)});
  } else if (representation != Representation::Identity) {
    onSignal =
        inOrder({signal.toEngine, engineOperators(representation, prepared.spec, prepared.transform, certificate.size),
                 signal.fromEngine});
  }
  if (isCube || space.isLog) {
    return {inOrder({onSignal}), signal.fromEngine, signal.toEngine};
  }
  return {inOrder({shaperTransform(encoding, OCIO::TRANSFORM_DIR_FORWARD), onSignal,
                   shaperTransform(encoding, OCIO::TRANSFORM_DIR_INVERSE)}),
          space.fromEngine, space.toEngine};
}

Certificate newCertificate(const sip::Recipe& recipe, const spectral::DataLibrary& library, const Prepared& prepared) {
  Certificate certificate;
  certificate.recipe = recipe;
  certificate.inputs = certifiedInputs(recipe, library);
  certificate.bandCount = prepared.transform.bandCount();
  certificate.gamut = prepared.space.engine.name;
  certificate.diagnostics = prepared.transform.diagnostics();
  return certificate;
}

Representation chosen(const Prepared& prepared, const BakeOptions& options, Representation usual) {
  return options.representation.value_or(prepared.transform.isIdentity() ? Representation::Identity : usual);
}

}  // namespace

Baked bake(const sip::Recipe& recipe, const spectral::DataLibrary& library, const BakeOptions& options) {
  const Prepared prepared = prepare(recipe, library, options);
  Baked baked{nullptr, newCertificate(recipe, library, prepared)};
  const Operators operators =
      operatorsFor(prepared, options, LutFormat::Content::Operators,
                   chosen(prepared, options, Representation::ExposureInvariantChain), baked.certificate);
  const sip::ErrorProtocol protocol(prepared.spec, library.reflectances(kChart).samples, baked.certificate.probes);
  const PixelProcessor processor(operators.group);
  baked.certificate.error = protocol.measure(Candidate(processor, operators.toPixels, operators.fromPixels));
  baked.group = operators.group;
  return baked;
}

Certificate bakeFile(const sip::Recipe& recipe, const spectral::DataLibrary& library, const std::filesystem::path& file,
                     const std::string& formatName, const BakeOptions& options) {
  const LutFormat& format = lutFormat(file, formatName);
  // The places first: what cannot be written is not worth the work.
  PendingFile lut(file);
  PendingFile json(file.string() + ".json");

  const Prepared prepared = prepare(recipe, library, options);
  Certificate certificate = newCertificate(recipe, library, prepared);
  certificate.format = format.name;
  // CLF has no operator for chromaticities.
  const bool holdsChain = format.content == LutFormat::Content::Operators && format.extension != ".clf";
  const Representation usual = holdsChain ? Representation::ExposureInvariantChain : Representation::LogCube;
  const Operators operators =
      operatorsFor(prepared, options, format.content, chosen(prepared, options, usual), certificate);

  const sip::ErrorProtocol protocol(prepared.spec, library.reflectances(kChart).samples, certificate.probes);
  const auto measure = [&](const PixelProcessor& processor) {
    return protocol.measure(Candidate(processor, operators.toPixels, operators.fromPixels));
  };
  // Twice: what the file says of itself is known before it is written, what the certificate says after.
  certificate.error = measure(PixelProcessor(operators.group));
  const LutDescription description{recipe.name, "metamer-" + sha256(sip::toYaml(recipe)).substr(0, 16),
                                   certificate.lines()};
  const std::string text = lutText(format, operators.group, certificate.size, description);
  lut.write(text);
  certificate.sha256 = sha256(text);
  certificate.error = measure(PixelProcessor::fromFile(lut.path()));
  json.write(certificate.json());
  lut.commit();
  json.commit();
  return certificate;
}

}  // namespace metamer::ocio
