// SPDX-License-Identifier: Apache-2.0
#include "bake/bake_operators.h"

#include "bake/table_sizes.h"
#include "cube/shaper_curve.h"
#include "metamer/ocio/log_cube.h"
#include "metamer/ocio/shaper.h"
#include "metamer/sip/probe_limits.h"
#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"
#include "operators/chained.h"
#include "operators/signal_probes.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

/// The curve of a cube's signal: the space's own, else the shaper.
Shaper cubeShaper(const WorkingSpace& space, const BakeOptions& options) {
  if (space.encoding) {
    if (options.shaper && *options.shaper != Shaper(*space.encoding)) {
      throw InputError("", "shaper", nameOf(*options.shaper),
                       space.name + " is a log space already; leave the shaper out");
    }
    return *space.encoding;
  }
  return options.shaper.value_or(spectral::LogEncoding::AcesCct);
}

/// The signal of a cube: the space's own pixels where they are a log signal, else those through the shaper.
Signal cubeSignal(const WorkingSpace& space, const Shaper& shaper) {
  if (space.isLog) {
    return {space.toEngine, space.fromEngine};
  }
  return {chained({shaperTransform(shaper, OCIO::TRANSFORM_DIR_INVERSE), space.toEngine}),
          chained({space.fromEngine, shaperTransform(shaper, OCIO::TRANSFORM_DIR_FORWARD)})};
}

}  // namespace

void requireSignal(const LutFormat& format, const BakeOptions& options) {
  if (options.shaper && isDisplay(*options.shaper) && format.content == LutFormat::Content::Operators) {
    throw InputError("", "shaper", nameOf(*options.shaper),
                     "is a display's, and " + format.extension +
                         " takes linear pixels; write .cube or another table of signals, or leave the shaper out");
  }
}

int tableSize(const BakeOptions& options, Representation representation, const LutFormat& format) {
  if (options.size != 0) {
    spectral::requireWithin("size", options.size, kSmallestTable, kLargestTable);
  }
  switch (representation) {
    case Representation::Identity:
    case Representation::Matrix:
    case Representation::HomogeneousMap:
      return 0;
    case Representation::LogCube:
      // A CLF stands for linear pixels of any exposure that its curve holds: finer than the cube of a grading program.
      return options.size != 0 ? options.size : format.extension == ".clf" ? kChainSize : kCubeSize;
    case Representation::ExposureInvariantChain:
      return options.size != 0 ? options.size : kChainSize;
  }
  return 0;
}

bool holdsChain(const LutFormat& format) {
  // CLF has no operator for chromaticities.
  return format.content == LutFormat::Content::Operators && format.extension != ".clf";
}

sip::ErrorProtocol::Options probesWanted(sip::ErrorProtocol::Options probes, const BakeOptions& options) {
  if (options.fullCertificate) {
    probes.chromaticityCount *= 4;
    probes.ringCount *= 4;
  }
  probes.lowestStop = options.lowestStop.value_or(probes.lowestStop);
  probes.highestStop = options.highestStop.value_or(probes.highestStop);
  if (probes.lowestStop > probes.highestStop || probes.lowestStop < -sip::kMostStops ||
      probes.highestStop > sip::kMostStops) {
    throw InputError("", "stops", std::to_string(probes.lowestStop) + ":" + std::to_string(probes.highestStop),
                     "must rise, from -24 to 24");
  }
  return probes;
}

sip::ErrorProtocol::Options probesOf(const LutFormat& format, const WorkingSpace& space, const BakeOptions& options) {
  const bool isTable = options.representation.value_or(Representation::Identity) == Representation::LogCube;
  sip::ErrorProtocol::Options probes;
  if (isTable || !holdsChain(format)) {
    if (!space.isLog && !space.isLinear) {
      throw InputError("", "space", space.name,
                       "is neither linear nor log, which a table needs; name a log space, or write .ctf");
    }
    probes = signalProbes(cubeShaper(space, options));
  }
  return probesWanted(probes, options);
}

Operators operatorsFor(const Prepared& prepared, const BakeOptions& options, const LutFormat& format,
                       Representation representation, Certificate& certificate) {
  if (options.shaperSize != 0) {
    spectral::requireWithin("shaper size", options.shaperSize, kFewestCurveEntries, kMostCurveEntries);
  }
  const WorkingSpace& space = prepared.space;
  const bool isCube = format.content != LutFormat::Content::Operators;
  certificate.representation = representation;
  certificate.fitted = options.fitted;
  certificate.negativesKept = format.holdsNegatives;
  certificate.shaperEntries = 0;
  certificate.size = tableSize(options, isCube ? Representation::LogCube : representation, format);
  if (!isCube && representation != Representation::LogCube) {
    return {space.wrapped(engineOperators(representation, prepared.spec, prepared.transform, certificate.size)),
            space.fromEngine, space.toEngine};
  }
  const Shaper shaper = cubeShaper(space, options);
  const Signal signal = cubeSignal(space, shaper);
  certificate.shaper = space.isLog ? space.name : nameOf(shaper);
  OCIO::GroupTransformRcPtr onSignal = chained({});
  if (representation == Representation::LogCube) {
    OCIO::ConstTransformRcPtr curve;
    // A display's signal is dense in the dark already, and needs its nodes where it is bright.
    if (options.fitted && format.holdsShaperCurve && certificate.size >= kShaperCurveFromSize && !isDisplay(shaper)) {
      certificate.shaperEntries = options.shaperSize != 0 ? options.shaperSize : kShaperCurveEntries;
      curve = shaperCurve(signal, certificate.size, certificate.probes.lowestStop, certificate.shaperEntries);
    }
    const auto table = logCube(prepared.transform, signal,
                               {.size = certificate.size,
                                .fitted = options.fitted,
                                .lowestStop = static_cast<double>(certificate.probes.lowestStop),
                                .highestStop = static_cast<double>(certificate.probes.highestStop),
                                .belowZero = format.holdsNegatives,
                                .shaperCurve = curve});
    onSignal = chained({curve, table});
  } else if (representation != Representation::Identity) {
    onSignal =
        chained({signal.toEngine, engineOperators(representation, prepared.spec, prepared.transform, certificate.size),
                 signal.fromEngine});
  }
  if (isCube || space.isLog) {
    return {onSignal, signal.fromEngine, signal.toEngine};
  }
  return {chained({shaperTransform(shaper, OCIO::TRANSFORM_DIR_FORWARD), onSignal,
                   shaperTransform(shaper, OCIO::TRANSFORM_DIR_INVERSE)}),
          space.fromEngine, space.toEngine};
}

}  // namespace metamer::ocio
