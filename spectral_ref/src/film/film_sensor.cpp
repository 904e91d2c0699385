// SPDX-License-Identifier: Apache-2.0
#include "film/film_sensor.h"

namespace metamer::spectral_ref {

FilmSensor::FilmSensor(const FilmSettings& settings) : m_bins(settings.bins), m_curves(kCells) {
  const auto curves = settings.observer.onDomain();
  // Responses are scaled so that a radiance of 1 at every wavelength gives a luminance of 1.
  const double scale = 1.0 / settings.luminanceOfResponse.dot(curves.colwise().sum().transpose());
  for (int i = 0; i < kCells; ++i) {
    const Eigen::Vector3d response = curves.row(i).transpose() * scale;
    m_curves[static_cast<std::size_t>(i)] << response.cast<float>().array(),
        static_cast<float>(settings.luminanceOfResponse.dot(response));
  }
}

Eigen::Matrix<double, kCells, 4> FilmSensor::channels() const {
  Eigen::Matrix<double, kCells, 4> channels;
  for (Eigen::Index cell = 0; cell < kCells; ++cell) {
    channels.row(cell) = m_curves[static_cast<std::size_t>(cell)].abs().cast<double>().matrix().transpose();
  }
  return channels;
}

/// What gathered responses do not take.
void FilmSensor::addLarge(FilmSums& sums, std::size_t pixel, std::size_t replicate, const Eigen::Array4f& response) {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto value = static_cast<double>(response[static_cast<Eigen::Index>(c)]);
    sums.add(pixel, Film::kColour + c, value);
    if ((replicate & 1U) != 0) {
      sums.add(pixel, Film::kHalf + c, value);
    }
  }
  sums.add(pixel, Film::kLuminance + replicate, static_cast<double>(response[3]));
}

}  // namespace metamer::spectral_ref
