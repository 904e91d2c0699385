// SPDX-License-Identifier: Apache-2.0
#include "apply/picture_space.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "metamer/ocio/display_curve.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/working_space.h"
#include "metamer/spectral/chromatic_adaptation.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/near_names.h"
#include "metamer/spectral/text.h"
#include "space_names.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

/// The newest of OpenColorIO's own configs with camera and display spaces.
constexpr const char* kOwnConfig = "ocio://studio-config-latest";
/// Chromaticities are written with three to six digits.
constexpr double kSameChromaticity = 1.5e-3;

PixelFunction eachColour(const std::function<double(double)>& curve) {
  return [curve](std::span<float> rgba) {
    for (std::size_t i = 0; i < rgba.size(); ++i) {
      if (i % 4 != 3) {
        rgba[i] = static_cast<float>(curve(rgba[i]));
      }
    }
  };
}

PictureSpace displaySpace(const std::string& name, const ocio::DisplayCurve& curve, const spectral::RgbSpace& linear) {
  return {name, linear, eachColour([curve](double signal) { return curve.decoded(signal); }),
          eachColour([curve](double light) { return curve.encoded(light); }), true};
}

PictureSpace fromWorkingSpace(const ocio::WorkingSpace& space) {
  PictureSpace result{space.name, space.engine, {}, {}};
  if (space.encoding) {
    const spectral::LogEncoding encoding = *space.encoding;
    result.decode = eachColour([encoding](double signal) { return decode(encoding, signal); });
    result.encode = eachColour([encoding](double light) { return encode(encoding, light); });
  } else if (space.toEngine) {
    const ocio::PixelProcessor decode(space.toEngine);
    const ocio::PixelProcessor encode(space.fromEngine);
    result.decode = [decode](std::span<float> rgba) { decode.apply(rgba); };
    result.encode = [encode](std::span<float> rgba) { encode.apply(rgba); };
  }
  return result;
}

bool isSame(const spectral::RgbSpace& a, const spectral::RgbSpace& b) {
  bool same = (a.white - b.white).cwiseAbs().maxCoeff() <= kSameChromaticity;
  for (std::size_t k = 0; k < 3; ++k) {
    same = same && (a.primaries[k] - b.primaries[k]).cwiseAbs().maxCoeff() <= kSameChromaticity;
  }
  return same;
}

PictureSpace fromChromaticities(const std::array<float, 8>& xy, const std::string& file,
                                const spectral::DataLibrary& library) {
  spectral::RgbSpace space;
  space.name = "the chromaticities of the file";
  for (std::size_t k = 0; k < 3; ++k) {
    space.primaries[k] = {xy[2 * k], xy[2 * k + 1]};
  }
  space.white = {xy[6], xy[7]};
  for (const spectral::ColourSpace& known : library.colourSpaces()) {
    if (!known.encoding && isSame(known.linear, space)) {
      return {known.name, known.linear, {}, {}};
    }
  }
  const bool isFinite = std::all_of(xy.begin(), xy.end(), [](float value) { return std::isfinite(value); });
  const Eigen::Matrix3d matrix = isFinite && xy[7] > 0 ? space.xyzFromRgb() : Eigen::Matrix3d::Zero();
  if (!(std::abs(matrix.determinant()) > 1e-6) || !matrix.allFinite()) {
    throw InputError(file, "chromaticities", "", "span no colours; say what the pixels are: --picture-space NAME");
  }
  return {space.name, space, {}, {}};
}

}  // namespace

PictureSpace pictureSpaceNamed(const std::string& name, const std::string& field, const spectral::DataLibrary& library,
                               const ocio::ConfigSource& config) {
  if (const auto curve = ocio::displayCurveNamed(name)) {
    return displaySpace(name, *curve, library.colourSpace("Rec.709").linear);
  }
  try {
    return fromWorkingSpace(ocio::findWorkingSpace(name, library, config));
  } catch (const InputError& first) {
    // OpenColorIO's own config knows more; where it does not, what was said first is better.
    try {
      return fromWorkingSpace(ocio::findWorkingSpace(name, library, {ocio::configNamed(kOwnConfig), kOwnConfig}));
    } catch (const InputError&) {
      throw InputError(field, "", "", first.what());
    }
  }
}

std::optional<PictureSpace> pictureSpaceOf(const SpaceClues& clues, const std::string& file,
                                           const spectral::DataLibrary& library, std::string& note) {
  const std::string named = spectral::lowerCase(clues.named);
  const ocio::ConfigSource none;
  const auto known = [&](const std::string& name) { return pictureSpaceNamed(name, file, library, none); };
  if (clues.isInks) {
    throw InputError(file, "colour space", "CMYK",
                     "is of inks, not of light; convert the picture to RGB by its profile first");
  }
  if (!clues.profileColours.empty() && clues.profileColours != "RGB ") {
    throw InputError(file, "ICC profile", std::string(spectral::trimmed(clues.profileColours)),
                     "is not of RGB; convert the picture to RGB by it first, or say what the pixels are: "
                     "--picture-space sRGB");
  }
  if (!clues.isFloat && !clues.profile.empty()) {
    const std::string profile = spectral::lowerCase(clues.profile);
    if (profile.find("p3") != std::string::npos && profile.find("display") != std::string::npos) {
      return displaySpace("Display P3", {}, library.colourSpace("P3-D65").linear);
    }
    if (profile.find("srgb") == std::string::npos) {
      note = file + ": its ICC profile '" + spectral::shortened(clues.profile, 40) +
             "' is not followed: its pixels are taken for sRGB; --picture-space names what they are";
    }
    return known("sRGB");
  }
  if (const std::string name = spaceNamedInFile(named); !name.empty()) {
    return known(name);
  }
  if (const auto curve = named.rfind("gamma", 0) == 0 ? ocio::displayCurveNamed(named) : std::nullopt) {
    return displaySpace("Gamma " + spectral::numberText(*curve->gamma), *curve, library.colourSpace("Rec.709").linear);
  }
  if (named == "kodaklog" || named == "adx" || named == "log" || named == "printing density") {
    throw InputError(
        file, "colour space", clues.named,
        "is a log of film densities; say which camera's log the pixels are: --picture-space \"ARRI LogC3\"");
  }
  if (clues.chromaticities) {
    PictureSpace space = fromChromaticities(*clues.chromaticities, file, library);
    if (clues.isFloat) {
      return space;
    }
  }
  return std::nullopt;
}

PixelFunction between(const spectral::RgbSpace& from, const spectral::RgbSpace& to) {
  if (isSame(from, to)) {
    return {};
  }
  const Eigen::Matrix3f matrix = spectral::adaptRgb(spectral::ChromaticAdaptation::Bradford, from, to).cast<float>();
  return [matrix](std::span<float> rgba) {
    for (std::size_t i = 0; i + 3 < rgba.size(); i += 4) {
      const float r = rgba[i];
      const float g = rgba[i + 1];
      const float b = rgba[i + 2];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        rgba[i + k] = matrix(row, 0) * r + matrix(row, 1) * g + matrix(row, 2) * b;
      }
    }
  };
}

PixelFunction inTurn(std::vector<PixelFunction> functions) {
  functions.erase(std::remove(functions.begin(), functions.end(), nullptr), functions.end());
  if (functions.size() < 2) {
    return functions.empty() ? PixelFunction() : functions[0];
  }
  return [functions = std::move(functions)](std::span<float> rgba) {
    for (const PixelFunction& function : functions) {
      function(rgba);
    }
  };
}

}  // namespace metamer::lutgen
