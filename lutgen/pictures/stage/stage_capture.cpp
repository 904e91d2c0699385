// SPDX-License-Identifier: Apache-2.0
#include "stage/stage_capture.h"

#include <algorithm>
#include <cctype>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/near_names.h"
#include "metamer/spectral/text.h"
#include "metamer/stage/emitter_model.h"
#include "metamer/stage/stage_geometry.h"
#include "metamer/stage/wall_spectra.h"
#include "stage/chart_picture.h"
#include "stage/environment_picture.h"
#include "stage/fixture.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};
/// Taken for the camera's linear RGB where nothing is said of it.
constexpr const char* kAssumedSpace = "ACEScg";

std::vector<int> patchesWith(const std::vector<std::string>& names, const std::string& word, bool atStart) {
  std::vector<int> found;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::size_t at = spectral::lowerCase(names[i]).find(spectral::lowerCase(word));
    if (at != std::string::npos && (!atStart || at == 0)) {
      found.push_back(static_cast<int>(i));
    }
  }
  return found;
}

void findWhite(const stage::StageDescription& stage, StageCapture& capture) {
  const auto& names = capture.wall.patchNames;
  const std::string wanted = stage.whitePatch.empty() ? "white" : stage.whitePatch;
  capture.whitePatch = patchNamed(names, wanted);
  if (capture.whitePatch >= 0) {
    return;
  }
  Eigen::Index brightest = -1;
  if (capture.wall.target.cols() > 0) {
    capture.wall.target.row(1).maxCoeff(&brightest);
  }
  std::string reason = "is not among the patches";
  for (const stage::ExcludedPatch& patch : capture.excluded) {
    if (spectral::lowerCase(patch.name) == spectral::lowerCase(wanted)) {
      reason = "was left out: " + patch.reason;
    }
  }
  if (stage.preserveWhite) {
    const auto near = spectral::nearNames(wanted, names, 3);
    std::string remedy = reason + "; q.preserve_white needs it";
    for (const std::string& name : near) {
      remedy += (&name == &near.front() ? "; near names: " : ", ") + name;
    }
    if (near.empty() && brightest >= 0) {
      remedy += "; the brightest patch is '" + names[static_cast<std::size_t>(brightest)] + "'";
    }
    throw InputError(stage.where, "q.white_patch", wanted, remedy);
  }
  if (brightest >= 0) {
    capture.whitePatch = static_cast<int>(brightest);
    capture.notes.push_back("white patch '" + wanted + "' " + reason + "; the brightest, '" +
                            names[static_cast<std::size_t>(brightest)] + "', stands for it in colour differences");
  }
}

void readSpectra(const stage::StageDescription& stage, const spectral::DataLibrary& library, StageCapture& capture) {
  const stage::StageSpectra& named = *stage.spectra;
  const spectral::Observer camera = library.observer(named.camera, stage.folder);
  const spectral::Spectrum target = library.illuminant(named.target, stage.folder);
  stage::WallSpectra spectra;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto emitters = stage::emittersFrom(named.emitters[k], library, stage.folder);
    if (emitters.size() != 1) {
      throw InputError(stage.where, std::string("spectra.emitters.") + kChannels[k], named.emitters[k],
                       "holds " + std::to_string(emitters.size()) + " spectra; give a file with one");
    }
    spectra.emitters[k] = emitters.front().spectrum.onDomain();
    if (emitters.front().isModel) {
      capture.notes.push_back("emitter " + std::string(kChannels[k]) +
                              " is a model, not a measurement: " + named.emitters[k]);
    }
  }
  spectra.camera = camera.onDomain();
  spectra.reflectances = library.reflectances(named.reflectances, stage.folder).samples;
  spectra.target = target.onDomain();
  spectra.beta = capture.wall.beta;
  const double beta = capture.wall.beta;
  const Eigen::Vector3d black = capture.wall.blackLevel;
  capture.wall = stage::captureOf(spectra);
  capture.wall.beta = beta;
  capture.wall.blackLevel = black;

  capture.xyzFromCamera = xyzFromResponseUnder(target, camera, library);
  capture.cameraWhite = capture.wall.environmentWhite;
  capture.spectra = CaptureSpectra{spectra.emitters, target};
  capture.colourSpace = "camera RGB of " + named.camera + " under " + named.target;
}

void keepPatches(const std::vector<std::string>& unwanted, StageCapture& capture) {
  std::vector<stage::ChartTable> tables;
  for (const Eigen::Matrix3Xd* chart :
       {&capture.wall.charts[0], &capture.wall.charts[1], &capture.wall.charts[2], &capture.wall.target}) {
    tables.push_back({"spectra", capture.wall.patchNames, *chart});
  }
  auto aligned = stage::alignCharts(tables, std::numeric_limits<double>::infinity(), unwanted);
  capture.wall.patchNames = std::move(aligned.names);
  capture.excluded = std::move(aligned.excluded);
  capture.wall.target = aligned.charts[3];
  std::copy_n(aligned.charts.begin(), 3, capture.wall.charts.begin());
}

void readCharts(const stage::StageDescription& stage, const spectral::DataLibrary& library,
                const std::string& checkPictures, StageCapture& capture) {
  for (std::size_t k = 0; k < 3; ++k) {
    capture.wall.cameraFromWall.col(static_cast<Eigen::Index>(k)) = readPrimary(stage.primaries[k]);
  }
  const ChartReader reader(stage.layout, library, stage.folder, stage.saturation);
  const auto checkPicture = [&](const std::string& name) {
    return checkPictures.empty() ? std::filesystem::path() : std::filesystem::path(checkPictures + "_" + name + ".png");
  };
  std::vector<stage::ChartTable> tables;
  for (std::size_t k = 0; k < 3; ++k) {
    tables.push_back(reader.read(stage.charts[k], capture.notes, checkPicture(kChannels[k])));
  }
  tables.push_back(reader.read(stage.target, capture.notes, checkPicture("target")));
  for (const stage::ChartTable& table : tables) {
    const auto negatives = (table.rgb.array() < 0).count();
    if (negatives > 0) {
      capture.notes.push_back(table.where + " holds " + std::to_string(negatives) +
                              " negative values (noise below black); they are used as they are");
    }
  }
  auto aligned = stage::alignCharts(tables, stage.saturation, stage.excluded);
  if (aligned.names.empty()) {
    const std::string reason =
        aligned.excluded.empty() ? "" : "; " + aligned.excluded.front().name + ": " + aligned.excluded.front().reason;
    throw InputError(stage.where, "charts", "", "no patch is in all four charts with values that can be used" + reason);
  }
  capture.wall.patchNames = std::move(aligned.names);
  capture.excluded = std::move(aligned.excluded);
  capture.wall.target = aligned.charts[3];
  std::copy_n(aligned.charts.begin(), 3, capture.wall.charts.begin());
}

}  // namespace

int patchNamed(const std::vector<std::string>& names, const std::string& name) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (spectral::lowerCase(names[i]) == spectral::lowerCase(name)) {
      return static_cast<int>(i);
    }
  }
  const std::vector<int> starting = patchesWith(names, name, true);
  return starting.size() == 1 ? starting.front() : -1;
}

StageCapture readCapture(const stage::StageDescription& stage, const spectral::DataLibrary& library,
                         const std::string& checkPictures) {
  StageCapture capture;
  capture.columns = stage.layout.columns;
  capture.wall.beta = stage::calibrationSquareBeta(stage.widthM, stage.heightM, stage.distanceM);
  capture.wall.blackLevel = stage.blackLevel;
  if (stage.spectra) {
    readSpectra(stage, library, capture);
    keepPatches(stage.excluded, capture);
  } else {
    readCharts(stage, library, checkPictures, capture);
  }
  if (!stage.colourSpace.empty() || !stage.spectra) {
    capture.colourSpace = stage.colourSpace.empty() ? kAssumedSpace : stage.colourSpace;
    capture.cameraWhite = Eigen::Vector3d::Ones();
    capture.xyzFromCamera = library.colourSpace(capture.colourSpace).linear.xyzFromRgb();
    if (stage.colourSpace.empty()) {
      capture.notes.push_back(std::string("colour_space is not given: colour differences take the camera's RGB for ") +
                              kAssumedSpace + "; matrices do not depend on it");
    }
  }
  findWhite(stage, capture);
  capture.skinPatches = patchesWith(capture.wall.patchNames, "skin", false);
  if (!stage.skinPatches.empty()) {
    capture.skinPatches.clear();
    for (const std::string& name : stage.skinPatches) {
      const int patch = patchNamed(capture.wall.patchNames, name);
      if (patch < 0) {
        throw InputError(stage.where, "q.skin_patches", name, "is not among the patches, or was left out");
      }
      capture.skinPatches.push_back(patch);
    }
  }
  if (stage.environmentWhite) {
    capture.wall.environmentWhite = *stage.environmentWhite;
  } else if (!stage.environmentFile.empty()) {
    capture.wall.environmentWhite = diffuseLight(stage.environmentFile, stage.facing);
  } else if (!stage.spectra) {
    if (capture.whitePatch < 0) {
      throw InputError(stage.where, "environment.white", "", "is missing, and no white patch is there to take it from");
    }
    capture.wall.environmentWhite = capture.wall.target.col(capture.whitePatch) / stage.whiteReflectance;
    capture.notes.push_back("environment is not given: w_avg is the target's white patch, '" +
                            capture.wall.patchNames[static_cast<std::size_t>(capture.whitePatch)] + "'");
  }
  return capture;
}

}  // namespace metamer::lutgen
