// SPDX-License-Identifier: Apache-2.0
#include "stage_pictures/chart_picture.h"

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"
#include "picture.h"
#include "stage_pictures/check_picture.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

bool isTable(const std::filesystem::path& file) {
  const std::string extension = spectral::lowerCase(spectral::utf8(file.extension()));
  return extension == ".csv" || extension == ".txt" || extension == ".tsv";
}

}  // namespace

stage::ChartTable ChartReader::read(const stage::StageChart& chart, std::vector<std::string>& notes,
                                    const std::filesystem::path& checkPicture) const {
  if (isTable(chart.file)) {
    return stage::parseChart(spectral::readTextFile(chart.file), spectral::utf8(chart.file));
  }
  if (chart.corners.empty()) {
    throw InputError(spectral::utf8(chart.file), "corners", "",
                     "are missing; a picture needs the chart's four corners, or give a CSV (patch,R,G,B)");
  }
  const Picture picture(chart.file);
  const stage::ChartSampler::Sampled sampled = [&] {
    try {
      return m_sampler.sample(picture.view(), chart.corners);
    } catch (const InputError& error) {
      throw InputError(spectral::utf8(chart.file), "", "", error.what());
    }
  }();
  if (sampled.quarters != 0) {
    notes.push_back(spectral::utf8(chart.file) + ": the chart lies turned by " + std::to_string(90 * sampled.quarters) +
                    " degrees against its corners; its patches were read that way");
  }
  if (!checkPicture.empty()) {
    writeCheckPicture(picture, sampled.grid, checkPicture);
  }
  return {spectral::utf8(chart.file), m_sampler.names(), sampled.rgb};
}

Eigen::Vector3d readPrimary(const stage::StagePrimary& primary) {
  return primary.value ? *primary.value
                       : stage::meanOfBox(Picture(primary.file).view(), primary.box, spectral::utf8(primary.file));
}

}  // namespace metamer::lutgen
