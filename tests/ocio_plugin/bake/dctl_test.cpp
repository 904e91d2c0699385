// SPDX-License-Identifier: Apache-2.0
// A .dctl as it is written, compiled as the languages that Resolve makes of it.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "metamer/ocio/shader_bake.h"
#include "metamer/sip/error_protocol.h"
#include "spectral/fixture.h"
#include "spectral/temporary_folder.h"

namespace metamer::ocio {
namespace {

using spectral::testLibrary;

/// The text of a .dctl: its numbers, and what stands before and behind them.
struct DctlParts {
  std::string before, numbers, behind;

  explicit DctlParts(const std::string& text) {
    const std::string opening = "DEFINE_CUBE_LUT(metamerTable)\n{\nLUT_3D_SIZE 65\n";
    const std::size_t table = text.find(opening);
    const std::size_t end = text.find("}\n", table + opening.size());
    before = text.substr(0, table);
    numbers = text.substr(table + opening.size(), end - table - opening.size());
    behind = text.substr(end + 2);
  }
};

/// What Resolve defines in front of the text, as far as the text asks; then the text, its table as an array: of its
/// first numbers, which is enough for a compiler's word on all else.
std::string program(const std::string& words, const std::string& text, int mostNumbers) {
  const DctlParts parts(text);
  std::stringstream numbers(parts.numbers);
  std::string array = "__CONSTANT__ float metamerTable[] = {";
  int count = 0;
  for (std::string number; count < mostNumbers && numbers >> number; ++count) {
    array += number + "f,\n";
  }
  return words + parts.before + array + "};\n" + parts.behind;
}

constexpr const char* kSlider =
    "#define DEFINE_UI_PARAMS(name, label, kind, initial, least, most, step) __CONSTANT__ float name = initial##f;\n";
constexpr const char* kLookUp = R"(
#define APPLY_LUT(r, g, b, table) nodeOf(r, g, b)
__DEVICE__ float3 nodeOf(float r, float g, float b);
)";
/// The text asks for nodes alone: what lies at one is all that is needed.
constexpr const char* kNode = R"(
__DEVICE__ float3 nodeOf(float r, float g, float b) {
  int at = 3 * ((int)(r * 64.0f + 0.5f) + 65 * ((int)(g * 64.0f + 0.5f) + 65 * (int)(b * 64.0f + 0.5f)));
  return make_float3(metamerTable[at], metamerTable[at + 1], metamerTable[at + 2]);
}
)";

std::string asCpp(const std::string& text) {
  const std::string words = R"(#include <cmath>
struct float3 { float x, y, z; };
static float3 make_float3(float x, float y, float z) { return {x, y, z}; }
#define __DEVICE__ static
#define __CONSTANT__ static const
#define _powf(x, y) std::pow((x), (y))
)";
  // The table is filled by whoever loads this: a compiler takes seconds for as many numbers.
  const DctlParts parts(text);
  return words + kSlider + kLookUp + parts.before + R"(
static float metamerTable[3 * 65 * 65 * 65];
extern "C" float* table() { return metamerTable; }
)" + parts.behind +
         kNode + R"(
extern "C" void apply(float* rgba, long count) {
  for (long i = 0; i < 4 * count; i += 4) {
    const float3 result = transform(1, 1, 0, 0, rgba[i], rgba[i + 1], rgba[i + 2]);
    rgba[i] = result.x;
    rgba[i + 1] = result.y;
    rgba[i + 2] = result.z;
  }
}
)";
}

constexpr int kAllNumbers = 3 * 65 * 65 * 65;
constexpr int kFewNumbers = 3000;

std::string asOpenCl(const std::string& text, int mostNumbers) {
  const std::string words = R"(
static float3 make_float3(float x, float y, float z) { return (float3)(x, y, z); }
#define __DEVICE__ static
#define __CONSTANT__ __constant
#define _powf(x, y) pow((x), (y))
)";
  return program(words + kSlider + kLookUp, text, mostNumbers) + kNode +
         "__kernel void entry(__global float* p) { p[0] = transform(1, 1, 0, 0, p[0], p[1], p[2]).x; }\n";
}

std::string asCuda(const std::string& text) {
  const std::string words = R"(
#define __device__ __attribute__((device))
struct float3 { float x, y, z; };
static __device__ float3 make_float3(float x, float y, float z) { return float3{x, y, z}; }
#define __DEVICE__ static __device__
#define __CONSTANT__ static __attribute__((constant)) const
static __device__ float _powf(float x, float y) { return x * y; }
)";
  return program(words + kSlider + kLookUp, text, kFewNumbers) + kNode +
         "__attribute__((global)) void entry(float* p) { p[0] = transform(1, 1, 0, 0, p[0], p[1], p[2]).x; }\n";
}

bool runs(const std::string& command) {
  return std::system((command + " > /dev/null 2>&1").c_str()) == 0;
}

using Apply = void(float* rgba, long count);
using Table = float*();

class DctlTest : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(m_folder / name) << text;
    return (m_folder / name).string();
  }
  /// The text's own function; null where it does not compile. The library stays.
  Apply* compiled(const std::string& text, const std::string& name) const {
    const std::string library = (m_folder / (name + ".so")).string();
    const std::string source = write(name + ".cpp", asCpp(text));
    if (!runs("c++ -std=c++17 -O2 -shared -fPIC -o " + library + " " + source)) {
      return nullptr;
    }
    void* const handle = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
      return nullptr;
    }
    float* const table = reinterpret_cast<Table*>(dlsym(handle, "table"))();
    std::stringstream numbers(DctlParts(text).numbers);
    int count = 0;
    for (float number = 0.0F; count < kAllNumbers && numbers >> number; ++count) {
      table[count] = number;
    }
    EXPECT_EQ(count, kAllNumbers);
    return reinterpret_cast<Apply*>(dlsym(handle, "apply"));
  }

  TemporaryFolder m_folder;
};

TEST_F(DctlTest, TwoHundredThousandColoursThroughItsOwnText) {
  if (!runs("command -v c++")) {
    GTEST_SKIP() << "no c++: the DCTL text is not compiled";
  }
  const std::string recipes = std::string(METAMER_DATA_FOLDER) + "/../demo/recipes/day_to_";
  // METAMER_LONG=1: all nine of the demo.
  std::vector<std::string> names = {"sodium_000"};
  if (std::getenv("METAMER_LONG") != nullptr) {
    names = {"rgb_led_000", "rgb_led_050",  "rgb_led_100",  "sodium_000",  "sodium_050",
             "sodium_100",  "tungsten_000", "tungsten_050", "tungsten_100"};
  }
  for (const std::string& name : names) {
    SCOPED_TRACE(name);
    const sip::Recipe recipe = sip::readRecipe(recipes + name + ".yaml");
    const BakedText baked = bakeShaderText(recipe, testLibrary(), *findShaderFormat("", "dctl"));
    Apply* const apply = compiled(baked.text, name);
    ASSERT_NE(apply, nullptr);
    const sip::TransformSpec spec = sip::resolve(recipe, testLibrary(), testLibrary().colourSpace(recipe.space).linear);
    const sip::ErrorProtocol protocol(spec, testLibrary().reflectances(sip::ErrorProtocol::kChart).samples,
                                      {.chromaticityCount = 9400, .ringCount = 200});
    const auto report =
        protocol.measure([&](std::span<float> rgba) { apply(rgba.data(), static_cast<long>(rgba.size() / 4)); });
    std::printf("[ dctl ] %s: %zu colours, p99 %.3f, max %.3f\n", name.c_str(), report.count, report.p99, report.max);
    EXPECT_GE(report.count, 200'000U);
    EXPECT_LE(report.p99, 0.25);
    EXPECT_LE(report.max, 2.0);
  }
}

TEST_F(DctlTest, IsOpenClAndCudaToo) {
  if (!runs("command -v clang")) {
    GTEST_SKIP() << "no clang: the DCTL text is not compiled as OpenCL C and CUDA";
  }
  const BakedText baked =
      bakeShaderText(sip::readRecipe(std::string(METAMER_DATA_FOLDER) + "/../demo/recipes/day_to_tungsten_000.yaml"),
                     testLibrary(), *findShaderFormat("", "dctl"));
  const std::string openCl = write("look.cl", asOpenCl(baked.text, kAllNumbers));
  EXPECT_TRUE(runs("clang -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only " + openCl));
  const std::string cuda = write("look.cu", asCuda(baked.text));
  EXPECT_TRUE(
      runs("clang -x cuda --cuda-device-only -nocudainc -nocudalib --cuda-gpu-arch=sm_50 -fsyntax-only " + cuda));
  // And what is wrong is seen.
  EXPECT_FALSE(runs("clang -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only " +
                    write("wrong.cl", asOpenCl(baked.text, kFewNumbers) + "float wrong(float3 a) { return a; }\n")));
}

}  // namespace
}  // namespace metamer::ocio
