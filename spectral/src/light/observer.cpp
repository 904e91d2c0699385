// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/observer.h"

#include <utility>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/observer_of_curves.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

Observer::Response responseOf(const std::vector<Spectrum>& curves) {
  std::string initials;
  for (const Spectrum& curve : curves) {
    const std::string name = lowerCase(curve.name());
    const bool isLetter = name.size() == 1 || name.substr(1) == "_bar" || name.substr(1) == "bar";
    initials += isLetter ? name.front() : '?';
  }
  return initials == "xyz"   ? Observer::Response::Xyz
         : initials == "lms" ? Observer::Response::Lms
                             : Observer::Response::Camera;
}

}  // namespace

Eigen::Matrix<double, kDomainSize, 3> Observer::onDomain() const {
  Eigen::Matrix<double, kDomainSize, 3> samples;
  for (Eigen::Index k = 0; k < 3; ++k) {
    samples.col(k) = curves[static_cast<std::size_t>(k)].onDomain();
  }
  return samples;
}

Observer observerOfCurves(std::string name, const std::vector<Spectrum>& curves) {
  requireAsMany("curves", static_cast<std::int64_t>(curves.size()), "an observer has", 3);
  Observer observer{std::move(name), responseOf(curves), {curves.at(0), curves.at(1), curves.at(2)}, {}};
  if (observer.response == Observer::Response::Xyz) {
    observer.xyzFromResponse = Eigen::Matrix3d::Identity();
  }
  return observer;
}

}  // namespace metamer::spectral
