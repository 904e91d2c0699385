// SPDX-License-Identifier: Apache-2.0
#include "findings.h"

#include <Eigen/LU>

#include "cube.h"
#include "metamer/sip/error_protocol.h"
#include "metamer/spectral/colorimetry.h"

namespace metamer::playground {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

constexpr int kShownIntervalNm = 5;

json numbers(const Vector3d& values) {
  return {values[0], values[1], values[2]};
}

json spectrumOf(const sip::PreparedPipeline& side) {
  json values = json::array();
  const double peak = side.light.maxCoeff();
  for (int i = 0; i < spectral::kDomainSize; i += kShownIntervalNm) {
    values.push_back(side.light[i] / peak);
  }
  return values;
}

json named(const spectral::DataLibrary& library, const std::string& group, const std::vector<std::string>& names) {
  json list = json::array();
  for (const std::string& name : names) {
    list.push_back({{"name", name}, {"text", library.description(group, name).text}});
  }
  return list;
}

std::vector<spectral::Spectrum> shownSurfaces(const spectral::DataLibrary& library) {
  std::vector<spectral::Spectrum> surfaces = library.reflectances(sip::ErrorProtocol::kChart).samples;
  const auto skins = library.reflectances("skin").samples;
  surfaces.insert(surfaces.end(), skins.begin(), skins.end());
  return surfaces;
}

}  // namespace

json namesOf(const spectral::DataLibrary& library) {
  return {{"illuminants", named(library, "illuminants", library.illuminantNames())},
          {"filters", named(library, "filters", library.filterNames())},
          {"spaces", cubeSpaces(library)}};
}

json findingsOf(const Session& session) {
  const sip::TransformSpec& spec = session.spec();
  const sip::SpectralTransform& transform = session.transform();
  const auto input = prepare(spec.input, spec.training, spec.standardObserver);
  const auto output = prepare(spec.output, spec.training, spec.standardObserver);
  const Eigen::Matrix3d rgbFromResponse = transform.responseFromRgb().inverse();
  const Eigen::Matrix3d xyzFromRgb = spec.space.xyzFromRgb();
  const Vector3d white = spec.space.whiteXyz();
  const auto difference = [&](const Vector3d& a, const Vector3d& b) {
    return spectral::deltaE2000(spectral::lab(xyzFromRgb * a, white), spectral::lab(xyzFromRgb * b, white));
  };
  const auto responseOf = [](const sip::PreparedPipeline& side, const spectral::DomainSamples& reflectance) {
    return Vector3d(side.curves.transpose() * side.light.cwiseProduct(reflectance));
  };
  json surfaces = json::array();
  for (const spectral::Spectrum& surface : shownSurfaces(session.library())) {
    const spectral::DomainSamples reflectance = surface.onDomain();
    const Vector3d asShot = rgbFromResponse * responseOf(input, reflectance).cwiseQuotient(input.white);
    const Vector3d engine = transform.apply(asShot);
    const Vector3d truth = transform.rgbFromOutputResponse() * responseOf(output, reflectance);
    const Vector3d plain = transform.plainAdaptation() * asShot;
    surfaces.push_back({{"name", surface.name()},
                        {"asShot", numbers(asShot)},
                        {"engine", numbers(engine)},
                        {"truth", numbers(truth)},
                        {"plain", numbers(plain)},
                        {"engineError", difference(engine, truth)},
                        {"plainError", difference(plain, truth)}});
  }
  return {{"lights", {spectrumOf(input), spectrumOf(output)}},
          {"identity", transform.isIdentity()},
          {"surfaces", std::move(surfaces)}};
}

}  // namespace metamer::playground
