// SPDX-License-Identifier: Apache-2.0
#include "scene_file/scene_pictures.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectrum.h"
#include "scene_file/scene_pixels.h"

namespace metamer::spectral_ref {
namespace {

using Use = SceneSpectra::Use;

/// Drives from channels, one row an emitter.
Eigen::MatrixXf readMatrix(const YamlMap& section, std::size_t emitters, const Pixels& pixels) {
  const auto value = section.find("matrix");
  if (!value) {
    if (static_cast<std::size_t>(pixels.channels) < emitters) {
      throw section.error("", "the picture has " + std::to_string(pixels.channels) + " channels for " +
                                  std::to_string(emitters) + " emitters; give a matrix");
    }
    return Eigen::MatrixXf::Identity(static_cast<Eigen::Index>(emitters), static_cast<Eigen::Index>(emitters));
  }
  const auto rows = value->items();
  const std::string shape = "must have a row for each of the " + std::to_string(emitters) +
                            " emitters, each with at most " + std::to_string(pixels.channels) + " numbers";
  if (rows.size() != emitters) {
    throw value->error("", shape);
  }
  Eigen::MatrixXf matrix;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto numbers = rows[r].numbers(-1e6, 1e6);
    if (r == 0) {
      matrix.resize(static_cast<Eigen::Index>(emitters), static_cast<Eigen::Index>(numbers.size()));
    }
    if (numbers.empty() || numbers.size() > static_cast<std::size_t>(pixels.channels) ||
        static_cast<Eigen::Index>(numbers.size()) != matrix.cols()) {
      throw rows[r].error("", shape);
    }
    for (std::size_t c = 0; c < numbers.size(); ++c) {
      matrix(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c)) = static_cast<float>(numbers[c]);
    }
  }
  return matrix;
}

std::vector<SpectrumId> readEmitters(const YamlMap& section, SceneSpectra& spectra) {
  std::vector<SpectrumId> ids;
  if (const auto emitters = section.find("emitters")) {
    for (const YamlValue& emitter : emitters->items()) {
      ids.push_back(spectra.find(emitter, Use::Emission));
    }
    if (ids.empty()) {
      throw emitters->error("",
                            "is empty; name a spectrum for each drive, or leave it out for linear Rec.709 pictures");
    }
    return ids;
  }
  const auto observer = spectra.library().observer("CIE 1931 2");
  const Eigen::Matrix3d xyzFromRgb = spectra.library().colourSpace("Rec.709").linear.xyzFromRgb();
  for (int c = 0; c < 3; ++c) {
    ids.push_back(spectra.add(smoothestEmission(xyzFromRgb.col(c), observer)));
  }
  return ids;
}

/// An emitter a channel: linear to the next one's wavelength, nothing beyond the outer ones.
EmitterPicture spectralPicture(const Pixels& pixels, const std::vector<std::pair<double, int>>& channels, float scale,
                               SceneSpectra& spectra) {
  EmitterPicture picture;
  picture.width = pixels.width;
  picture.height = pixels.height;
  std::vector<double> wavelengths;
  wavelengths.reserve(channels.size());
  for (const auto& [nm, channel] : channels) {
    wavelengths.push_back(nm);
  }
  for (std::size_t k = 0; k < channels.size(); ++k) {
    std::vector<double> hat(channels.size(), 0.0);
    hat[k] = 1.0;
    const spectral::Spectrum light("channel", spectral::SpectralQuantity::SpectralPowerDistribution, wavelengths,
                                   std::move(hat));
    picture.emitters.push_back(spectra.add(spectral::onExcitation(light)));
  }
  const std::size_t count = static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height);
  picture.drives.reserve(count * channels.size());
  for (std::size_t i = 0; i < count; ++i) {
    const float* pixel = pixels.values.data() + i * static_cast<std::size_t>(pixels.channels);
    for (const auto& [nm, channel] : channels) {
      picture.drives.push_back(std::max(scale * pixel[channel], 0.0F));  // a lamp cannot take light away
    }
  }
  return picture;
}

}  // namespace

spectral::DomainSamples smoothestEmission(const Eigen::Vector3d& xyz, const spectral::Observer& observer) {
  constexpr int kBands = 41;
  constexpr double kBandNm = 10.0;
  // Hat functions on the bands, as the rest of metamer has them: A x = xyz.
  const auto curves = observer.onDomain();
  Eigen::MatrixXd hats = Eigen::MatrixXd::Zero(spectral::kDomainSize, kBands);
  for (int i = 0; i < spectral::kDomainSize; ++i) {
    const double place = i / kBandNm;
    const int band = std::min(static_cast<int>(place), kBands - 2);
    hats(i, band) = 1.0 - (place - band);
    hats(i, band + 1) = place - band;
  }
  const Eigen::MatrixXd a = curves.transpose() * hats / curves.col(1).sum();
  std::vector<bool> isZero(kBands, false);
  Eigen::VectorXd bands = Eigen::VectorXd::Zero(kBands);
  // The chapter's loop (5.5): the most negative band is held at zero until none is left.
  for (int round = 0; round < kBands; ++round) {
    Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(kBands + 3, kBands + 3);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(kBands + 3);
    for (int b = 0; b < kBands; ++b) {
      if (isZero[static_cast<std::size_t>(b)]) {
        kkt(b, b) = 1.0;
        continue;
      }
      kkt(b, b) = (b > 0 ? 1.0 : 0.0) + (b + 1 < kBands ? 1.0 : 0.0);
      for (const int next : {b - 1, b + 1}) {
        if (next >= 0 && next < kBands) {
          kkt(b, next) = -1.0;
        }
      }
      kkt.block<1, 3>(b, kBands) = a.col(b).transpose();
    }
    kkt.bottomLeftCorner(3, kBands) = a;
    right.tail<3>() = xyz;
    bands = kkt.fullPivLu().solve(right).head(kBands);
    int lowest = -1;
    for (int b = 0; b < kBands; ++b) {
      if (!isZero[static_cast<std::size_t>(b)] && bands[b] < -1e-9 && (lowest < 0 || bands[b] < bands[lowest])) {
        lowest = b;
      }
    }
    if (lowest < 0) {
      break;
    }
    isZero[static_cast<std::size_t>(lowest)] = true;
  }
  return (hats * bands).cwiseMax(0.0);
}

EmitterPicture readPicture(const YamlMap& section, SceneSpectra& spectra) {
  const auto file = section.require("picture", "is missing; name a picture file");
  const Pixels pixels = readPixels(file, spectra.folder());
  const auto scaleValue = section.find("scale");
  const auto scale = static_cast<float>(scaleValue ? scaleValue->number(0.0, 1e12) : 1.0);
  const auto channels = spectralChannels(pixels, spectral::SpectralQuantity::SpectralPowerDistribution);
  if (!channels.empty() && !section.find("emitters") && !section.find("matrix")) {
    return spectralPicture(pixels, channels, scale, spectra);
  }
  EmitterPicture picture;
  picture.width = pixels.width;
  picture.height = pixels.height;
  picture.emitters = readEmitters(section, spectra);
  const Eigen::MatrixXf matrix = readMatrix(section, picture.emitters.size(), pixels);
  const auto count = static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(pixels.height);
  picture.drives.reserve(count * picture.emitters.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Map<const Eigen::VectorXf> pixel(pixels.values.data() + i * static_cast<std::size_t>(pixels.channels),
                                                  matrix.cols());
    const Eigen::VectorXf drives = (matrix * pixel * scale).cwiseMax(0.0F);  // a lamp cannot take light away
    picture.drives.insert(picture.drives.end(), drives.data(), drives.data() + drives.size());
  }
  return picture;
}

}  // namespace metamer::spectral_ref
