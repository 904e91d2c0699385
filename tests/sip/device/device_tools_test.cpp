// SPDX-License-Identifier: Apache-2.0
// The kernels' texts through the tools of their languages, each where it is installed.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <bit>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "sip/device/device_fixture.h"
#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

struct Ran {
  int status = 0;
  std::string words;
};

Ran run(const std::string& command) {
  Ran ran;
  FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> part{};
  for (std::size_t count = 0; (count = std::fread(part.data(), 1, part.size(), pipe)) > 0;) {
    ran.words.append(part.data(), count);
  }
  const int status = pclose(pipe);
  ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return ran;
}

bool isInstalled(const std::string& tool) {
  return run("command -v " + tool).status == 0;
}

class DeviceToolsTest : public testing::Test {
 protected:
  DeviceToolsTest() {
    std::string name = testing::TempDir() + "metamer_device_XXXXXX";
    m_folder = mkdtemp(name.data());
  }
  ~DeviceToolsTest() override { std::filesystem::remove_all(m_folder); }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(m_folder / name) << text;
    return m_folder / name;
  }
  std::filesystem::path folder() const { return m_folder; }

 private:
  std::filesystem::path m_folder;
};

constexpr std::array kKernels = {DeviceKernel::Map, DeviceKernel::Affine};

void expectClean(const std::string& command) {
  const Ran ran = run(command);
  EXPECT_EQ(ran.status, 0) << command << "\n" << ran.words;
  EXPECT_EQ(ran.words.find("WARNING"), std::string::npos) << ran.words;
}

TEST_F(DeviceToolsTest, GlslAndHlslAreValid) {
  if (!isInstalled("glslangValidator") || !isInstalled("spirv-val")) {
    GTEST_SKIP()
        << "no glslangValidator or spirv-val: the GLSL and HLSL texts are not looked at; install glslang-tools "
           "and spirv-tools";
  }
  for (const DeviceKernel kernel : kKernels) {
    const std::string glsl = write("kernel.comp", deviceText(DeviceDialect::Glsl, kernel));
    const std::string hlsl = write("kernel.hlsl", deviceText(DeviceDialect::Hlsl, kernel));
    const std::string binary = folder() / "kernel.spv";
    expectClean("glslangValidator -G --target-env opengl -S comp -o " + binary + " " + glsl);
    expectClean("spirv-val " + binary);
    expectClean("glslangValidator -D -V --target-env vulkan1.1 -S comp -e " +
                std::string(kernel == DeviceKernel::Map ? "metamerMapPixels" : "metamerAffinePixels") + " -o " +
                binary + " " + hlsl);
    expectClean("spirv-val --target-env vulkan1.1 " + binary);
  }
}

TEST_F(DeviceToolsTest, CudaCompilesToFusedSteps) {
  if (!isInstalled("clang") || run("clang --print-targets").words.find("nvptx64") == std::string::npos) {
    GTEST_SKIP() << "no clang with the target nvptx64: the CUDA text is not compiled; install clang";
  }
  for (const DeviceKernel kernel : kKernels) {
    const std::string text = write("kernel.cu", deviceText(DeviceDialect::Cuda, kernel));
    const std::string ptx = folder() / "kernel.ptx";
    expectClean(
        "clang -x cuda --cuda-device-only -nocudainc -nocudalib --cuda-gpu-arch=sm_50 -Wall -Werror -O2 -S -o " + ptx +
        " " + text);
    std::stringstream written;
    written << std::ifstream(ptx).rdbuf();
    // Rounded once, to the nearest, denormals kept.
    EXPECT_NE(written.str().find("fma.rn.f32"), std::string::npos);
    EXPECT_EQ(written.str().find("fma.rn.ftz"), std::string::npos);
    EXPECT_EQ(written.str().find("div.approx"), std::string::npos);
    EXPECT_EQ(written.str().find("div.full"), std::string::npos);
    EXPECT_NE(written.str().find(kernel == DeviceKernel::Map ? "div.rn.f32" : ".entry metamerAffinePixels"),
              std::string::npos);
  }
}

/// An argument of oclgrind-kernel's.
template <typename Value>
std::string argument(const std::vector<Value>& values) {
  std::ostringstream text;
  text << "<size=" << sizeof(Value) * std::max<std::size_t>(1, values.size()) << " uint>\n";
  for (const Value value : values) {
    text << std::bit_cast<std::uint32_t>(value) << ' ';
  }
  text << (values.empty() ? "0\n" : "\n");
  return text.str();
}

std::string simulation(const std::string& text, const std::string& entry, const DeviceTables& tables,
                       const std::vector<float>& pixels) {
  std::vector<float> nodes;
  for (const auto& node : tables.nodes) {
    nodes.insert(nodes.end(), node.begin(), node.end());
  }
  const std::size_t count = pixels.size() / 4;
  return text + "\n" + entry + "\n" + std::to_string((count + 63) / 64 * 64) + " 1 1\n64 1 1\n" + argument(pixels) +
         argument(pixels) + argument(std::vector{static_cast<std::uint32_t>(count)}) + argument(nodes) +
         argument(tables.cells);
}

TEST_F(DeviceToolsTest, OclgrindFindsNothing) {
  if (!isInstalled("oclgrind-kernel")) {
    GTEST_SKIP() << "no oclgrind-kernel: reads out of bounds are not looked for; install oclgrind";
  }
  const auto judged = [&](const std::string& text, const std::string& entry, const DeviceTables& tables,
                          const std::vector<float>& pixels) {
    const std::string file = write("kernel.cl", text);
    const std::string form = write("kernel.sim", simulation(file, entry, tables, pixels));
    return run("oclgrind-kernel --data-races --uninitialized " + form);
  };
  const std::vector<float> pixels = pixelsOfEveryKind(640, 3);
  const std::string map = deviceText(DeviceDialect::OpenCl, DeviceKernel::Map);
  const DeviceTables tables = deviceTables(buildHomogeneousMap(SpectralTransform(specOf("D65", "HP1"), 41), 1.0));
  const Ran clean = judged(map, "metamerMapPixels", tables, pixels);
  EXPECT_EQ(clean.status, 0);
  EXPECT_EQ(clean.words, "");
  const Ran affine = judged(deviceText(DeviceDialect::OpenCl, DeviceKernel::Affine), "metamerAffinePixels",
                            deviceTables(AffineForm{}), pixels);
  EXPECT_EQ(affine.status, 0);
  EXPECT_EQ(affine.words, "");
  // And where there is something to find, it does.
  DeviceTables cut = tables;
  cut.nodes.resize(cut.nodes.size() / 2);
  EXPECT_NE(judged(map, "metamerMapPixels", cut, pixels).words.find("Invalid read"), std::string::npos);
}

}  // namespace
}  // namespace metamer::sip
