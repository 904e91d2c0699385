// SPDX-License-Identifier: Apache-2.0
// ocio_run_config CONFIG: every look, named transform and view of a config on the CPU, and as GPU shader text, with the
// OCIO that this is linked with. One line each on stdout: kind, name, and what the probe colours become.
#include <OpenColorIO/OpenColorIO.h>

#include <array>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

namespace {

namespace OCIO = OCIO_NAMESPACE;

/// Neutral, bright, dark, saturated and a little negative.
constexpr std::array<std::array<float, 3>, 6> kProbes{{{0.18F, 0.18F, 0.18F},
                                                       {8.0F, 6.0F, 5.0F},
                                                       {0.002F, 0.003F, 0.001F},
                                                       {0.5F, 0.1F, 0.05F},
                                                       {0.05F, 0.3F, 0.6F},
                                                       {0.4F, 0.3F, -0.01F}}};

void run(const std::string& kind, const std::string& name, const OCIO::ConstProcessorRcPtr& processor) {
  const auto flags =
      static_cast<OCIO::OptimizationFlags>(OCIO::OPTIMIZATION_DEFAULT & ~OCIO::OPTIMIZATION_FAST_LOG_EXP_POW);
  const auto cpu = processor->getOptimizedCPUProcessor(OCIO::BIT_DEPTH_F32, OCIO::BIT_DEPTH_F32, flags);
  auto shader = OCIO::GpuShaderDesc::CreateShaderDesc();
  shader->setLanguage(OCIO::GPU_LANGUAGE_GLSL_4_0);
  processor->getDefaultGPUProcessor()->extractGpuShaderInfo(shader);
  if (std::string(shader->getShaderText()).find("OCIOMain") == std::string::npos) {
    throw std::runtime_error(kind + " " + name + ": no shader text");
  }
  std::printf("%s\t%s", kind.c_str(), name.c_str());
  for (std::array<float, 3> rgb : kProbes) {
    cpu->applyRGB(rgb.data());
    std::printf("\t%.9g %.9g %.9g", static_cast<double>(rgb[0]), static_cast<double>(rgb[1]),
                static_cast<double>(rgb[2]));
  }
  std::printf("\n");
}

void runAll(const OCIO::ConstConfigRcPtr& config) {
  config->validate();
  for (int k = 0; k < config->getNumLooks(); ++k) {
    const char* name = config->getLookNameByIndex(k);
    auto look = OCIO::LookTransform::Create();
    look->setSrc("aces_interchange");
    look->setDst("aces_interchange");
    look->setLooks(name);
    run("look", name, config->getProcessor(look));
  }
  for (int k = 0; k < config->getNumNamedTransforms(); ++k) {
    const auto named = config->getNamedTransform(config->getNamedTransformNameByIndex(k));
    auto direction = OCIO::TRANSFORM_DIR_FORWARD;
    if (!named->getTransform(direction)) {
      direction = OCIO::TRANSFORM_DIR_INVERSE;
    }
    run("named transform", named->getName(), config->getProcessor(named->getTransform(direction)));
  }
  for (int d = 0; d < config->getNumDisplays(); ++d) {
    const char* display = config->getDisplay(d);
    for (int v = 0; v < config->getNumViews(display); ++v) {
      const char* view = config->getView(display, v);
      run("view", std::string(display) + ", " + view,
          config->getProcessor(OCIO::ROLE_SCENE_LINEAR, display, view, OCIO::TRANSFORM_DIR_FORWARD));
    }
  }
}

}  // namespace

int main(int argumentCount, char** arguments) {
  if (argumentCount != 2) {
    std::fputs("usage: ocio_run_config CONFIG\n", stderr);
    return 2;
  }
  try {
    runAll(OCIO::Config::CreateFromFile(arguments[1]));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ocio_run_config: %s\n", error.what());
    return 1;
  }
}
