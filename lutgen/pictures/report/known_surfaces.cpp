// SPDX-License-Identifier: Apache-2.0
#include "report/known_surfaces.h"

#include <Eigen/LU>
#include <cmath>

#include "metamer/sip/error_protocol.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/validation/foliage.h"

namespace metamer::lutgen {
namespace {

using Eigen::Vector3d;

/// Independent noise of one size in three channels.
double growthOf(const Eigen::Matrix3d& derivative) {
  return derivative.norm() / std::sqrt(3.0);
}

class Judge {
 public:
  Judge(const sip::TransformSpec& spec, const sip::SpectralTransform& transform)
      : m_transform(transform),
        m_input(prepare(spec.input, spec.training, spec.standardObserver)),
        m_output(prepare(spec.output, spec.training, spec.standardObserver)),
        m_rgbFromResponse(transform.responseFromRgb().inverse()),
        m_plain(transform.plainAdaptation()),
        m_xyzFromRgb(spec.space.xyzFromRgb()),
        m_white(spec.space.whiteXyz()) {}

  KnownSurface judged(const spectral::Spectrum& surface) const {
    const spectral::DomainSamples reflectance = surface.onDomain();
    KnownSurface known;
    known.name = surface.name();
    known.asShot = m_rgbFromResponse * responseOf(m_input, reflectance).cwiseQuotient(m_input.white);
    known.truth = m_transform.rgbFromOutputResponse() * responseOf(m_output, reflectance);
    const auto near = m_transform.linearise(known.asShot);
    known.engine = near.value;
    known.plain = m_plain * known.asShot;
    known.engineError = difference(known.engine, known.truth);
    known.plainError = difference(known.plain, known.truth);
    known.noise = growthOf(m_transform.isIdentity() ? Eigen::Matrix3d::Identity() : near.matrix);
    known.plainNoise = growthOf(m_plain);
    return known;
  }

 private:
  static Vector3d responseOf(const sip::PreparedPipeline& side, const spectral::DomainSamples& reflectance) {
    return side.curves.transpose() * side.light.cwiseProduct(reflectance);
  }
  double difference(const Vector3d& a, const Vector3d& b) const {
    return spectral::deltaE2000(spectral::lab(m_xyzFromRgb * a, m_white), spectral::lab(m_xyzFromRgb * b, m_white));
  }

  const sip::SpectralTransform& m_transform;
  sip::PreparedPipeline m_input;
  sip::PreparedPipeline m_output;
  Eigen::Matrix3d m_rgbFromResponse;
  Eigen::Matrix3d m_plain;
  Eigen::Matrix3d m_xyzFromRgb;
  Vector3d m_white;
};

}  // namespace

GroupMeans meansOf(const SurfaceGroup& group) {
  GroupMeans means;
  for (const KnownSurface& surface : group.surfaces) {
    const double share = 1.0 / static_cast<double>(group.surfaces.size());
    means.engine += share * surface.engineError;
    means.plain += share * surface.plainError;
    means.noise += share * surface.noise;
    means.plainNoise += share * surface.plainNoise;
  }
  return means;
}

std::vector<SurfaceGroup> knownSurfaces(const sip::TransformSpec& spec, const sip::SpectralTransform& transform,
                                        const spectral::DataLibrary& library) {
  const Judge judge(spec, transform);
  const auto group = [&](const std::string& title, const std::vector<spectral::Spectrum>& spectra) {
    SurfaceGroup result{title, {}};
    for (const spectral::Spectrum& spectrum : spectra) {
      result.surfaces.push_back(judge.judged(spectrum));
    }
    return result;
  };
  const auto chart = library.reflectances(sip::ErrorProtocol::kChart).samples;
  std::vector<spectral::Spectrum> skins(chart.begin(), chart.begin() + 2);  // dark skin, light skin
  const auto measured = library.reflectances("skin").samples;
  skins.insert(skins.end(), measured.begin(), measured.end());
  std::vector<spectral::Spectrum> leaves = {chart[3]};  // foliage
  for (const char* set : {"tm30", "cri", "rawtoaces 190"}) {
    for (const spectral::Spectrum& leaf : validation::foliageAmong(library.reflectances(set).samples)) {
      leaves.push_back(leaf);
    }
  }
  return {group("Skin", skins), group("Chart", chart), group("Foliage", leaves)};
}

}  // namespace metamer::lutgen
