// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/stage_files.h"

#include <array>
#include <memory>

#include "metamer/ocio/lut_writer.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/text.h"
#include "operators/matrix_operator.h"

namespace metamer::ocio {
namespace {

/// The offsets of a .spimtx count 16-bit steps.
constexpr double kSpiMatrixScale = 65535;

OCIO::GroupTransformRcPtr wallTransform(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& offset) {
  auto group = OCIO::GroupTransform::Create();
  auto transform = matrixOperator(matrix);
  if (!offset.isZero(0)) {
    const std::array<double, 4> values = {offset[0], offset[1], offset[2], 0};
    transform->setOffset(values.data());
  }
  group->appendTransform(transform);
  auto range = OCIO::RangeTransform::Create();
  range->setMinInValue(0);
  range->setMinOutValue(0);
  group->appendTransform(range);
  return group;
}

std::string spiMatrixText(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& offset) {
  std::string text;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) {
      text += spectral::shortestNumber(matrix(row, column)) + " ";
    }
    text += spectral::shortestNumber(kSpiMatrixScale * offset[row]) + "\n";
  }
  return text;
}

}  // namespace

OCIO::GroupTransformRcPtr outOfFrustumTransform(const StageMatrices& stage) {
  return wallTransform(stage.wallFromContent, Eigen::Vector3d::Zero());
}

OCIO::GroupTransformRcPtr inFrustumTransform(const StageMatrices& stage) {
  return wallTransform(stage.frustumFromContent, stage.frustumOffset);
}

OCIO::GroupTransformRcPtr postCorrectionTransform(const StageMatrices& stage) {
  auto group = OCIO::GroupTransform::Create();
  group->appendTransform(matrixOperator(stage.correctedFromCamera));
  return group;
}

OCIO::GroupTransformRcPtr signalTransform(const StageMatrices& stage) {
  auto group = OCIO::GroupTransform::Create();
  auto range = OCIO::RangeTransform::Create();
  range->setMinInValue(0);
  range->setMinOutValue(0);
  range->setMaxInValue(1);
  range->setMaxOutValue(1);
  group->appendTransform(range);
  auto root = OCIO::ExponentTransform::Create();
  root->setValue({1 / stage.signals[0].gamma, 1 / stage.signals[1].gamma, 1 / stage.signals[2].gamma, 1});
  group->appendTransform(root);
  auto table = OCIO::Lut1DTransform::Create(stage.signals[0].signals.size(), false);
  for (std::size_t i = 0; i < stage.signals[0].signals.size(); ++i) {
    table->setValue(i, static_cast<float>(stage.signals[0].signals[i]), static_cast<float>(stage.signals[1].signals[i]),
                    static_cast<float>(stage.signals[2].signals[i]));
  }
  group->appendTransform(table);
  return group;
}

std::vector<std::filesystem::path> writeStageFiles(const StageMatrices& stage, const std::filesystem::path& prefix) {
  struct Part {
    const char* suffix;
    const char* use;
    OCIO::GroupTransformRcPtr group;
    Eigen::Matrix3d matrix;
    Eigen::Vector3d offset;
    bool isSignal = false;
  };
  std::vector<Part> parts = {
      Part{"_out_of_frustum", "wall drives outside the camera's view, from camera RGB (M)",
           outOfFrustumTransform(stage), stage.wallFromContent, Eigen::Vector3d::Zero()},
      Part{"_in_frustum", "wall drives in the camera's view, from camera RGB (N and the black offset)",
           inFrustumTransform(stage), stage.frustumFromContent, stage.frustumOffset},
      Part{"_post_correction", "correction of the recorded picture, in camera RGB (Q)", postCorrectionTransform(stage),
           stage.correctedFromCamera, Eigen::Vector3d::Zero()},
  };
  if (!stage.signals.empty()) {
    parts.push_back({"_signal", "what is sent for wall drives, by the wall's fitted EOTF", signalTransform(stage),
                     Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), true});
  }
  std::vector<std::unique_ptr<spectral::PendingFile>> pending;
  const auto add = [&](const Part& part, const char* extension, const std::string& text) {
    pending.push_back(
        std::make_unique<spectral::PendingFile>(spectral::pathOf(spectral::utf8(prefix) + part.suffix + extension)));
    pending.back()->write(text);
  };
  for (const Part& part : parts) {
    const LutDescription description{stage.name + part.suffix,
                                     "metamer:" + stage.name + part.suffix,
                                     {std::string("LED stage ") + stage.name + ": " + part.use}};
    if (!part.isSignal) {
      add(part, ".spimtx", spiMatrixText(part.matrix, part.offset));
    }
    for (const char* extension : {".clf", ".ctf"}) {
      add(part, extension,
          lutText(lutFormat(spectral::pathOf("file" + std::string(extension)), ""), part.group, 0, description));
    }
  }
  std::vector<spectral::PendingFile*> written;
  std::vector<std::filesystem::path> files;
  for (const auto& file : pending) {
    written.push_back(file.get());
    files.push_back(file->target());
  }
  spectral::commitAll(written);
  return files;
}

}  // namespace metamer::ocio
