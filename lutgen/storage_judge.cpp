// SPDX-License-Identifier: Apache-2.0
#include "storage_judge.h"

#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/input_error.h"

namespace metamer::lutgen {
namespace {

using spectral::DomainSamples;

/// Gathers means of spectra and the largest difference.
class Gathered {
 public:
  void add(const std::string& spectrum, const std::vector<double>& differences, const std::vector<std::string>& where) {
    double sum = 0;
    for (std::size_t k = 0; k < differences.size(); ++k) {
      sum += differences[k];
      if (differences[k] >= m_error.largest) {
        m_error.largest = differences[k];
        m_error.largestWhere = spectrum + ", " + where[k];
      }
    }
    const double mean = sum / static_cast<double>(differences.size());
    m_sum += mean;
    ++m_count;
    if (mean >= m_error.worst) {
      m_error.worst = mean;
      m_error.worstName = spectrum;
    }
  }
  StorageError error() {
    m_error.mean = m_sum / static_cast<double>(m_count);
    return m_error;
  }

 private:
  StorageError m_error;
  double m_sum = 0;
  std::size_t m_count = 0;
};

double difference(const DomainSamples& a, const Eigen::Matrix3Xd& underA, const DomainSamples& b,
                  const Eigen::Matrix3Xd& underB) {
  const Eigen::Vector3d white = underA.rowwise().sum();
  return spectral::deltaE2000(spectral::lab(underA * a, white), spectral::lab(underB * b, white));
}

}  // namespace

StorageJudge::StorageJudge(const spectral::DataLibrary& library, const std::vector<std::string>& lightNames)
    : m_curves(library.observer("CIE 1931 2").onDomain()), m_lightNames(lightNames) {
  for (const std::string& name : lightNames) {
    const DomainSamples light = library.illuminant(name).onDomain();
    const Eigen::Vector3d white = m_curves.transpose() * light;
    if (!(white.minCoeff() > 0)) {
      throw spectral::InputError("--lights", "light", name,
                                 "leaves a channel of the eye dark: colours have no differences");
    }
    m_lights.emplace_back(m_curves.transpose() * light.asDiagonal() / white.y());
  }
  for (const spectral::Spectrum& patch : library.reflectances("colorchecker").samples) {
    m_patchNames.push_back(patch.name());
    m_patches.push_back(patch.onDomain());
  }
}

StorageError StorageJudge::ofReflectances(const std::vector<std::string>& names,
                                          const std::vector<DomainSamples>& before,
                                          const std::vector<DomainSamples>& after) const {
  Gathered gathered;
  for (std::size_t k = 0; k < before.size(); ++k) {
    std::vector<double> differences;
    for (const Eigen::Matrix3Xd& light : m_lights) {
      differences.push_back(difference(before[k], light, after[k], light));
    }
    gathered.add(names[k], differences, m_lightNames);
  }
  return gathered.error();
}

StorageError StorageJudge::ofLights(const std::vector<std::string>& names, const std::vector<DomainSamples>& before,
                                    const std::vector<DomainSamples>& after) const {
  Gathered gathered;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const Eigen::Vector3d white = m_curves.transpose() * before[k];
    if (!(white.minCoeff() > 0)) {
      throw spectral::InputError(names[k], "light", "",
                                 "leaves a channel of the eye dark: colours under it have no "
                                 "differences; store it by --numbers, without --tolerance");
    }
    const Eigen::Matrix3Xd underIt = m_curves.transpose() * before[k].asDiagonal() / white.y();
    const Eigen::Matrix3Xd underStored = m_curves.transpose() * after[k].asDiagonal() / white.y();
    std::vector<double> differences;
    for (const DomainSamples& patch : m_patches) {
      differences.push_back(difference(patch, underIt, patch, underStored));
    }
    gathered.add(names[k], differences, m_patchNames);
  }
  return gathered.error();
}

}  // namespace metamer::lutgen
