// SPDX-License-Identifier: Apache-2.0
#include "stage/stage_reading.h"

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "stage/fixture_options.h"
#include "stage_pictures/chart_picture.h"
#include "stage_pictures/environment_picture.h"

namespace metamer::lutgen {
namespace {

constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};

stage::StageReadings readFiles(const stage::StageDescription& stage, const spectral::DataLibrary& library,
                               const std::string& checkPictures) {
  stage::StageReadings readings;
  for (std::size_t k = 0; k < 3; ++k) {
    readings.primaries[k] = readPrimary(stage.primaries[k]);
  }
  const ChartReader reader(stage.layout, library, stage.folder, stage.saturation);
  const auto checkPicture = [&](const std::string& name) {
    return checkPictures.empty() ? std::filesystem::path() : spectral::pathOf(checkPictures + "_" + name + ".png");
  };
  for (std::size_t k = 0; k < 3; ++k) {
    readings.charts[k] = reader.read(stage.charts[k], readings.notes, checkPicture(kChannels[k]));
  }
  readings.target = reader.read(stage.target, readings.notes, checkPicture("target"));
  return readings;
}

std::optional<std::array<stage::PanelEotf, 3>> fitRamps(const stage::StageDescription& stage) {
  if (!stage.ramps[0].isGiven()) {
    return std::nullopt;
  }
  std::array<stage::PanelEotf, 3> eotf;
  for (std::size_t k = 0; k < 3; ++k) {
    const stage::StageRamp& ramp = stage.ramps[k];
    const std::string file = ramp.series ? stage.where + ": ramps." + kChannels[k] : spectral::utf8(ramp.file);
    const stage::DriveSeries series =
        ramp.series ? *ramp.series : stage::parseDriveSeries(spectral::readTextFile(ramp.file), file);
    eotf[k] = stage::fitEotf(series, file);
  }
  return eotf;
}

}  // namespace

stage::StageCapture readCapture(const stage::StageDescription& stage, const spectral::DataLibrary& library,
                                const std::string& checkPictures) {
  std::optional<stage::StageReadings> readings;
  if (!stage.spectra) {
    readings = readFiles(stage, library, checkPictures);
  }
  std::optional<Eigen::Vector3d> environmentWhite;
  if (!stage.environmentWhite && !stage.environmentFile.empty()) {
    environmentWhite = diffuseLight(stage.environmentFile, stage.facing);
  }
  const auto xyzFromResponse = [&](const spectral::Spectrum& light, const spectral::Observer& observer) {
    return xyzFromResponseUnder(light, observer, library);
  };
  stage::StageCapture capture = stage::captureOf(stage, library, xyzFromResponse, readings, environmentWhite);
  capture.eotf = fitRamps(stage);
  return capture;
}

}  // namespace metamer::lutgen
