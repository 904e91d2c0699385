// SPDX-License-Identifier: Apache-2.0
#include "effects/led_stage.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <utility>

#include "effects/file_stamp.h"
#include "effects/shared_cache.h"
#include "effects/stage_file.h"
#include "host/parameter_makers.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "pixels/affine_pixels.h"

namespace metamer::ofx {
namespace {

using spectral::InputError;

constexpr const char* kContent = "M: content in the camera's view";
constexpr const char* kLighting = "N: content that lights the set";
constexpr const char* kPost = "Q: the camera's picture";
constexpr const char* kBlack = "Black offset";
constexpr const char* kForward = "Forward";
constexpr const char* kInverse = "Inverse";
constexpr const char* kLinear = "Linear";
constexpr std::size_t kKeptStages = 16;
/// A matrix that shrinks some colour by more than this, beside its largest gain, cannot be undone on float pixels.
constexpr double kLargestCondition = 1e6;

std::vector<Parameter> ledStageParameters() {
  std::vector<std::string> curves = {kLinear};
  for (const spectral::LogEncoding encoding : spectral::allLogEncodings()) {
    curves.push_back(spectral::nameOf(encoding));
  }
  return {
      makeFile("stageFile", "Stage file", "", "What lutgen stage solve wrote (.json). None: nothing changes."),
      makeMenu("operation", "Apply", "", {kContent, kLighting, kPost, kBlack}, kContent,
               "M and N turn linear camera RGB into wall drives; Q corrects what the camera recorded; the black offset "
               "takes the wall's black level out of the drives."),
      makeMenu("direction", "Direction", "", {kForward, kInverse}, kForward, "Inverse undoes Forward."),
      makeFlag("clampBlack", "No drive below 0", "", true, true,
               "Black offset, forward: what would be below 0 becomes 0, as a wall shows it."),
      makeMenu("curve", "Curve", "", curves, kLinear, "How the pixels are encoded; undone before and done after."),
      makeNumber(kMixName, "Mix", "", 1.0, {0, 1}, {0, 1},
                 "0: the picture as it came; 1: the result. The mask scales it."),
  };
}

class LedStage final : public Effect {
 public:
  LedStage()
      : Effect({"org.metamer.LEDStage", "LED Stage",
                "Applies the matrices that lutgen stage solve found for an LED stage: M to what the camera sees on the "
                "wall, N to what lights the set, Q to the camera's picture, and the black offset. Pixels are camera "
                "RGB."},
               ledStageParameters()) {}

  std::shared_ptr<const PixelTransform> transform(const ParameterValues& values, double time,
                                                  const std::optional<std::string>& /*hostSpace*/) const override {
    const std::string file = values.text("stageFile", time);
    if (file.empty()) {
      return std::make_shared<AffinePixels>(AffinePixels::Form{});
    }
    requireFile(spectral::pathOf(file), "stageFile", "choose what lutgen stage solve wrote anew, or clear the field");
    const auto stage = m_stages.get(file, [&] {
      FileStamps files;
      files.add(spectral::pathOf(file));
      return SharedCache<Stage>::Built{std::make_shared<const Stage>(readStageFile(spectral::pathOf(file))),
                                       std::move(files)};
    });
    AffinePixels::Form form = formOf(*stage, values, time, file);
    const std::string curve = values.menu("curve", time);
    for (const spectral::LogEncoding encoding : spectral::allLogEncodings()) {
      if (spectral::nameOf(encoding) == curve) {
        form.encoding = encoding;
      }
    }
    return std::make_shared<AffinePixels>(form);
  }

  std::string wantedSpace(const ParameterValues& /*values*/) const override { return {}; }

  void enableParameters(const ParameterValues& values) const override {
    const bool hasFile = !values.text("stageFile", 0).empty();
    for (const char* name : {"operation", "direction", "curve", kMixName}) {
      values.enable(name, hasFile);
    }
    values.enable("clampBlack",
                  hasFile && values.menu("operation", 0) == kBlack && values.menu("direction", 0) == kForward);
  }

 private:
  static AffinePixels::Form formOf(const Stage& stage, const ParameterValues& values, double time,
                                   const std::string& file) {
    const std::string operation = values.menu("operation", time);
    const bool isInverse = values.menu("direction", time) == kInverse;
    AffinePixels::Form form;
    if (operation == kBlack) {
      form.offset = isInverse ? Eigen::Vector3d(-stage.offset) : stage.offset;
      form.clampsBelow = !isInverse && values.flag("clampBlack", time);
      return form;
    }
    form.matrix = operation == kPost ? stage.q : operation == kLighting ? stage.n : stage.m;
    if (isInverse) {
      const Eigen::Vector3d gains = Eigen::JacobiSVD<Eigen::Matrix3d>(form.matrix).singularValues();
      if (!(gains[2] * kLargestCondition > gains[0])) {
        throw InputError(file, operation.substr(0, 1), "",
                         "has no inverse that float pixels could hold; use Forward, or solve the stage again");
      }
      form.matrix = form.matrix.inverse().eval();
    }
    return form;
  }

  mutable SharedCache<Stage> m_stages{kKeptStages};
};

}  // namespace

std::unique_ptr<Effect> makeLedStage() {
  return std::make_unique<LedStage>();
}

}  // namespace metamer::ofx
