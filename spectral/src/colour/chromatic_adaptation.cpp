// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/chromatic_adaptation.h"

#include <Eigen/LU>
#include <array>
#include <utility>
#include <vector>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/near_names.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

struct NamedMethod {
  ChromaticAdaptation method;
  const char* name;
};

constexpr std::array<NamedMethod, 4> kMethods{{{ChromaticAdaptation::VonKries, "vonkries"},
                                               {ChromaticAdaptation::Bradford, "bradford"},
                                               {ChromaticAdaptation::Cat02, "cat02"},
                                               {ChromaticAdaptation::Cat16, "cat16"}}};

}  // namespace

ChromaticAdaptation chromaticAdaptationFromName(const std::string& name) {
  const std::string wanted = lowerCase(name);
  for (const NamedMethod& candidate : kMethods) {
    if (wanted == candidate.name) {
      return candidate.method;
    }
  }
  throw InputError("", "chromatic adaptation", name, "must be vonkries, bradford, cat02 or cat16");
}

std::string nameOf(ChromaticAdaptation method) {
  for (const NamedMethod& candidate : kMethods) {
    if (method == candidate.method) {
      return candidate.name;
    }
  }
  return {};
}

Eigen::Matrix3d lmsFromXyz(ChromaticAdaptation method) {
  Eigen::Matrix3d m;
  switch (method) {
    case ChromaticAdaptation::VonKries:  // Hunt 1991, Fairchild 2013, equation 9.1
      m << 0.40024, 0.70760, -0.08081, -0.22630, 1.16532, 0.04570, 0.0, 0.0, 0.91822;
      break;
    case ChromaticAdaptation::Bradford:  // Lam 1985; ICC.1:2010, annex E
      m << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296;
      break;
    case ChromaticAdaptation::Cat02:  // CIE 159:2004, equation 7
      m << 0.7328, 0.4296, -0.1624, -0.7036, 1.6975, 0.0061, 0.0030, 0.0136, 0.9834;
      break;
    case ChromaticAdaptation::Cat16:  // Li et al. 2017, equation 8
      m << 0.401288, 0.650173, -0.051461, -0.250268, 1.204414, 0.045854, -0.002079, 0.048952, 0.953127;
      break;
  }
  return m;
}

Eigen::Matrix3d adaptXyz(ChromaticAdaptation method, const Eigen::Vector3d& sourceWhite,
                         const Eigen::Vector3d& destinationWhite) {
  const Eigen::Matrix3d toLms = lmsFromXyz(method);
  const Eigen::Vector3d source = toLms * sourceWhite;
  const Eigen::Vector3d destination = toLms * destinationWhite;
  for (const auto& [white, lms] : {std::pair{sourceWhite, source}, std::pair{destinationWhite, destination}}) {
    // allFinite refuses infinities, the comparison NaN.
    if (!lms.allFinite() || !(lms.minCoeff() > 0)) {
      throw InputError("", "white", numberText(white.x()) + " " + numberText(white.y()) + " " + numberText(white.z()),
                       "has no positive cone response under '" + nameOf(method) +
                           "': adapt to a less saturated light or use another chromatic adaptation");
    }
  }
  return toLms.inverse() * destination.cwiseQuotient(source).asDiagonal() * toLms;
}

Eigen::Matrix3d adaptRgb(ChromaticAdaptation method, const RgbSpace& source, const RgbSpace& destination) {
  return destination.rgbFromXyz() * adaptXyz(method, source.whiteXyz(), destination.whiteXyz()) * source.xyzFromRgb();
}

}  // namespace metamer::spectral
