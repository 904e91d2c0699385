// SPDX-License-Identifier: Apache-2.0
// Camera log spaces to ACES2065-1, against OpenColorIO's built-in transforms.
#include <OpenColorIO/OpenColorIO.h>
#include <gtest/gtest.h>

#include <array>

#include "metamer/spectral/chromatic_adaptation.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

namespace ocio = OCIO_NAMESPACE;

/// OpenColorIO computes in single precision (6e-8) and feeds it to curves that multiply a relative error of the signal
/// by up to 40 at 0.8 of full scale: 2.4e-6. For LogC3 it takes ARRI's unrounded constants where ours are the six
/// printed digits: 6e-6.
constexpr double kSinglePrecision = 1e-5;

Eigen::Vector3d acesFromSignal(const ColourSpace& space, ChromaticAdaptation cat, const Eigen::Vector3d& signal) {
  const RgbSpace aces = testLibrary().colourSpace("ACES2065-1").linear;
  Eigen::Vector3d linear;
  for (Eigen::Index k = 0; k < 3; ++k) {
    linear[k] = decode(space.encoding.value(), signal[k]);
  }
  return aces.rgbFromXyz() * adaptXyz(cat, space.linear.whiteXyz(), aces.whiteXyz()) * space.linear.xyzFromRgb() *
         linear;
}

double relativeDifference(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(1.0, b.cwiseAbs().maxCoeff());
}

TEST(OcioBuiltinsTest, NewestReleaseAgrees) {
  MaxDifference difference("camera spaces against OpenColorIO 2.6, relative", kSinglePrecision);
  for (const FixtureRow& row : readFixture("ocio_builtins.csv")) {
    const ColourSpace space = testLibrary().colourSpace(row.text(1));
    const Eigen::Vector3d ours = acesFromSignal(space, chromaticAdaptationFromName(row.text(2)), row.vector(3));
    difference.add(relativeDifference(ours, row.vector(6)), 0);
  }
}

TEST(OcioBuiltinsTest, InstalledReleaseAgrees) {
  struct Style {
    const char* name;
    const char* space;
    ChromaticAdaptation cat;
  };
  const std::array<Style, 8> styles{{
      {"ACEScct_to_ACES2065-1", "ACEScct", ChromaticAdaptation::Cat02},
      {"ARRI_ALEXA-LOGC-EI800-AWG_to_ACES2065-1", "ARRI LogC3", ChromaticAdaptation::Cat02},
      {"SONY_SLOG3-SGAMUT3_to_ACES2065-1", "S-Log3 S-Gamut3", ChromaticAdaptation::Cat02},
      {"SONY_SLOG3-SGAMUT3.CINE_to_ACES2065-1", "S-Log3 S-Gamut3.Cine", ChromaticAdaptation::Cat02},
      {"PANASONIC_VLOG-VGAMUT_to_ACES2065-1", "V-Log V-Gamut", ChromaticAdaptation::Bradford},
      {"RED_LOG3G10-RWG_to_ACES2065-1", "Log3G10 REDWideGamutRGB", ChromaticAdaptation::Bradford},
      {"CANON_CLOG2-CGAMUT_to_ACES2065-1", "Canon Log 2 Cinema Gamut", ChromaticAdaptation::Cat02},
      {"CANON_CLOG3-CGAMUT_to_ACES2065-1", "Canon Log 3 Cinema Gamut", ChromaticAdaptation::Cat02},
  }};
  const ocio::ConstConfigRcPtr config = ocio::Config::CreateRaw();
  int compared = 0;
  for (const Style& style : styles) {
    const ocio::BuiltinTransformRcPtr transform = ocio::BuiltinTransform::Create();
    try {
      transform->setStyle(style.name);
    } catch (const ocio::Exception&) {
      continue;  // of a later release than the one installed
    }
    ++compared;
    MaxDifference difference(std::string(style.name) + ", relative", kSinglePrecision);
    const ColourSpace space = testLibrary().colourSpace(style.space);
    const auto processor = config->getProcessor(transform)->getOptimizedCPUProcessor(ocio::OPTIMIZATION_NONE);
    for (int i = 0; i < 64; ++i) {
      const auto level = [&](int step) { return static_cast<float>((i * step) % 64) / 80.0F; };
      const std::array<float, 3> in{level(1), level(7), level(13)};
      std::array<float, 3> out = in;
      processor->applyRGB(out.data());
      const Eigen::Vector3d ours = acesFromSignal(space, style.cat, {in[0], in[1], in[2]});
      difference.add(relativeDifference(ours, Eigen::Vector3d(out[0], out[1], out[2])), 0);
    }
  }
  EXPECT_GE(compared, 5);
}

}  // namespace
}  // namespace metamer::spectral
