// SPDX-License-Identifier: Apache-2.0
#include "metamer/stage/stage_capture.h"

#include <algorithm>
#include <limits>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/near_names.h"
#include "metamer/spectral/text.h"
#include "metamer/stage/emitter_model.h"
#include "metamer/stage/patch_names.h"
#include "metamer/stage/skin_priority.h"
#include "metamer/stage/stage_geometry.h"
#include "metamer/stage/wall_spectra.h"

namespace metamer::stage {
namespace {

using spectral::InputError;

constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};
/// Taken for the camera's linear RGB where nothing is said of it.
constexpr const char* kAssumedSpace = "ACEScg";

void findWhite(const StageDescription& description, StageCapture& capture) {
  const auto& names = capture.wall.patchNames;
  const std::string wanted = description.whitePatch.empty() ? "white" : description.whitePatch;
  capture.whitePatch = patchNamed(names, wanted);
  if (capture.whitePatch >= 0) {
    return;
  }
  Eigen::Index brightest = -1;
  if (capture.wall.target.cols() > 0) {
    capture.wall.target.row(1).maxCoeff(&brightest);
  }
  std::string reason = "is not among the patches";
  for (const ExcludedPatch& patch : capture.excluded) {
    if (spectral::lowerCase(patch.name) == spectral::lowerCase(wanted)) {
      reason = "was left out: " + patch.reason;
    }
  }
  if (description.preserveWhite) {
    const auto near = spectral::nearNames(wanted, names, 3);
    std::string remedy = reason + "; q.preserve_white needs it";
    for (const std::string& name : near) {
      remedy += (&name == &near.front() ? "; near names: " : ", ") + name;
    }
    if (near.empty() && brightest >= 0) {
      remedy += "; the brightest patch is '" + names[static_cast<std::size_t>(brightest)] + "'";
    }
    throw InputError(description.where, "q.white_patch", wanted, remedy);
  }
  if (brightest >= 0) {
    capture.whitePatch = static_cast<int>(brightest);
    capture.notes.push_back("white patch '" + wanted + "' " + reason + "; the brightest, '" +
                            names[static_cast<std::size_t>(brightest)] + "', stands for it in colour differences");
  }
}

void readSpectra(const StageDescription& description, const spectral::DataLibrary& library,
                 const XyzFromResponse& xyzFromResponse, StageCapture& capture) {
  const StageSpectra& named = *description.spectra;
  const spectral::Observer camera = library.observer(named.camera, description.folder);
  const spectral::Spectrum target = library.illuminant(named.target, description.folder);
  WallSpectra spectra;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto emitters = emittersFrom(named.emitters[k], library, description.folder);
    if (emitters.size() != 1) {
      throw InputError(description.where, std::string("spectra.emitters.") + kChannels[k], named.emitters[k],
                       "holds " + std::to_string(emitters.size()) + " spectra; give a file with one");
    }
    spectra.emitters[k] = emitters.front().spectrum.onDomain();
    if (emitters.front().isModel) {
      capture.notes.push_back("emitter " + std::string(kChannels[k]) +
                              " is a model, not a measurement: " + named.emitters[k]);
    }
  }
  spectra.camera = camera.onDomain();
  spectra.reflectances = library.reflectances(named.reflectances, description.folder).samples;
  spectra.target = target.onDomain();
  spectra.beta = capture.wall.beta;
  const double beta = capture.wall.beta;
  const Eigen::Vector3d black = capture.wall.blackLevel;
  capture.wall = captureOf(spectra);
  capture.wall.beta = beta;
  capture.wall.blackLevel = black;
  spectra.reflectances = virtualSkins(library);
  capture.skins = captureOf(spectra);

  capture.xyzFromCamera = xyzFromResponse(target, camera);
  capture.cameraWhite = capture.wall.environmentWhite;
  capture.spectra = CaptureSpectra{spectra.emitters, target};
  capture.colourSpace = "camera RGB of " + named.camera + " under " + named.target;
}

void keepPatches(const std::vector<std::string>& unwanted, StageCapture& capture) {
  std::vector<ChartTable> tables;
  for (const Eigen::Matrix3Xd* chart :
       {&capture.wall.charts[0], &capture.wall.charts[1], &capture.wall.charts[2], &capture.wall.target}) {
    tables.push_back({"spectra", capture.wall.patchNames, *chart});
  }
  auto aligned = alignCharts(tables, std::numeric_limits<double>::infinity(), unwanted);
  capture.wall.patchNames = std::move(aligned.names);
  capture.excluded = std::move(aligned.excluded);
  capture.wall.target = aligned.charts[3];
  std::copy_n(aligned.charts.begin(), 3, capture.wall.charts.begin());
}

void readCharts(const StageDescription& description, const StageReadings& readings, StageCapture& capture) {
  for (std::size_t k = 0; k < 3; ++k) {
    capture.wall.cameraFromWall.col(static_cast<Eigen::Index>(k)) = readings.primaries[k];
  }
  capture.notes = readings.notes;
  const std::vector<ChartTable> tables = {readings.charts[0], readings.charts[1], readings.charts[2], readings.target};
  for (const ChartTable& table : tables) {
    const auto negatives = (table.rgb.array() < 0).count();
    if (negatives > 0) {
      capture.notes.push_back(table.where + " holds " + std::to_string(negatives) +
                              " negative values (noise below black); they are used as they are");
    }
  }
  auto aligned = alignCharts(tables, description.saturation, description.excluded);
  if (aligned.names.empty()) {
    const std::string reason =
        aligned.excluded.empty() ? "" : "; " + aligned.excluded.front().name + ": " + aligned.excluded.front().reason;
    throw InputError(description.where, "charts", "",
                     "no patch is in all four charts with values that can be used" + reason);
  }
  capture.wall.patchNames = std::move(aligned.names);
  capture.excluded = std::move(aligned.excluded);
  capture.wall.target = aligned.charts[3];
  std::copy_n(aligned.charts.begin(), 3, capture.wall.charts.begin());
}

}  // namespace

StageCapture captureOf(const StageDescription& description, const spectral::DataLibrary& library,
                       const XyzFromResponse& xyzFromResponse, const std::optional<StageReadings>& readings,
                       const std::optional<Eigen::Vector3d>& environmentWhite) {
  StageCapture capture;
  capture.columns = description.layout.columns;
  capture.wall.beta = calibrationSquareBeta(description.widthM, description.heightM, description.distanceM);
  capture.wall.blackLevel = description.blackLevel;
  if (description.spectra) {
    readSpectra(description, library, xyzFromResponse, capture);
    keepPatches(description.excluded, capture);
  } else {
    readCharts(description, readings.value(), capture);
    capture.expectation = expectationOf(capture.wall.patchNames,
                                        library.reflectances(description.layout.reflectances, description.folder),
                                        description.layout.columns, description.layout.rows);
  }
  if (!description.colourSpace.empty() || !description.spectra) {
    capture.colourSpace = description.colourSpace.empty() ? kAssumedSpace : description.colourSpace;
    capture.cameraWhite = Eigen::Vector3d::Ones();
    capture.xyzFromCamera = library.colourSpace(capture.colourSpace).linear.xyzFromRgb();
    if (description.colourSpace.empty()) {
      capture.notes.push_back(std::string("colour_space is not given: colour differences take the camera's RGB for ") +
                              kAssumedSpace + "; matrices do not depend on it");
    }
  }
  findWhite(description, capture);
  capture.skinPatches = patchesWith(capture.wall.patchNames, "skin", false);
  if (!description.skinPatches.empty()) {
    capture.skinPatches.clear();
    for (const std::string& name : description.skinPatches) {
      const int patch = patchNamed(capture.wall.patchNames, name);
      if (patch < 0) {
        throw InputError(description.where, "q.skin_patches", name, "is not among the patches, or was left out");
      }
      capture.skinPatches.push_back(patch);
    }
  }
  if (description.environmentWhite) {
    capture.wall.environmentWhite = *description.environmentWhite;
  } else if (environmentWhite) {
    capture.wall.environmentWhite = *environmentWhite;
  } else if (!description.spectra) {
    if (capture.whitePatch < 0) {
      throw InputError(description.where, "environment.white", "",
                       "is missing, and no white patch is there to take it from");
    }
    capture.whiteIsFromTarget = true;
    capture.wall.environmentWhite = capture.wall.target.col(capture.whitePatch) / description.whiteReflectance;
    capture.notes.push_back("environment is not given: w_avg is the target's white patch, '" +
                            capture.wall.patchNames[static_cast<std::size_t>(capture.whitePatch)] + "'");
  }
  return capture;
}

}  // namespace metamer::stage
