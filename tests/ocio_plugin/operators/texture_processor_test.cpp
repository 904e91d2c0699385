// SPDX-License-Identifier: Apache-2.0
// The emulation of OpenColorIO's shader against the shader itself, which OpenGL runs on the processor.
#include "metamer/ocio/texture_processor.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <vector>

#include "metamer/ocio/bake.h"
#include "ocio_plugin/bake/look_recipe.h"
#include "sip/device/egl_device.h"
#include "spectral/fixture.h"
#include "spectral/temporary_folder.h"

// Releases before tell less of their textures, and hold no shader with all as pictures of two dimensions.
#if OCIO_VERSION_HEX >= 0x02040000

namespace metamer::ocio {
namespace {

using spectral::testLibrary;

/// OCIO's own shader of a file, as a compute shader, with its textures.
class Shader {
 public:
  explicit Shader(const OCIO::ConstTransformRcPtr& transform) : m_text(OCIO::GpuShaderDesc::CreateShaderDesc()) {
    m_text->setLanguage(OCIO::GPU_LANGUAGE_GLSL_4_0);
    m_text->setFunctionName("ocioColour");
    m_text->setAllowTexture1D(false);
    OCIO::Config::CreateRaw()->getProcessor(transform)->getDefaultGPUProcessor()->extractGpuShaderInfo(m_text);
  }

  std::vector<float> run(const sip::EglDevice& device, const std::vector<float>& pixels, TextureDepth depth) const {
    const std::string text = std::string("#version 430\n") + m_text->getShaderText() + R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Source { vec4 source[]; };
layout(std430, binding = 1) writeonly buffer Destination { vec4 destination[]; };
layout(location = 0) uniform uint pixelCount;
void main() {
  uint at = gl_GlobalInvocationID.x;
  if (at < pixelCount) { destination[at] = ocioColour(source[at]); }
}
)";
    return device.run(text, {.nodes = {{}}, .cells = {0}}, pixels, textures(depth));
  }

  unsigned tableCount() const { return m_text->getNumTextures() + m_text->getNum3DTextures(); }

 private:
  std::vector<sip::EglDevice::Texture> textures(TextureDepth depth) const {
    std::vector<sip::EglDevice::Texture> all;
    const char* name = nullptr;
    const char* sampler = nullptr;
    for (unsigned k = 0; k < m_text->getNumTextures(); ++k) {
      sip::EglDevice::Texture& texture = all.emplace_back();
      OCIO::GpuShaderDesc::TextureType channels{};
      OCIO::GpuShaderDesc::TextureDimensions dimensions{};
      OCIO::Interpolation interpolation{};
      m_text->getTexture(k, name, sampler, texture.size[0], texture.size[1], channels, dimensions, interpolation);
      m_text->getTextureValues(k, texture.values);
      texture.hasOneChannel = channels == OCIO::GpuShaderDesc::TEXTURE_RED_CHANNEL;
      texture.isNearest = interpolation == OCIO::INTERP_NEAREST;
      texture.sampler = sampler;
    }
    for (unsigned k = 0; k < m_text->getNum3DTextures(); ++k) {
      sip::EglDevice::Texture& texture = all.emplace_back();
      OCIO::Interpolation interpolation{};
      m_text->get3DTexture(k, name, sampler, texture.size[0], interpolation);
      texture.size[1] = texture.size[2] = texture.size[0];
      m_text->get3DTextureValues(k, texture.values);
      texture.isNearest = interpolation == OCIO::INTERP_NEAREST || interpolation == OCIO::INTERP_TETRAHEDRAL;
      texture.sampler = sampler;
    }
    for (sip::EglDevice::Texture& texture : all) {
      texture.isHalf = depth == TextureDepth::Half;
    }
    return all;
  }

  OCIO::GpuShaderDescRcPtr m_text;
};

/// Colours of many exposures, most of them inside the gamut.
std::vector<float> colours() {
  std::vector<float> rgba;
  for (int k = 0; k < 20'000; ++k) {
    const auto along = [&](double step) { return std::fmod(0.5 + step * k, 1.0); };
    const double exposure = std::exp2(14.0 * along(0.123456789) - 9.0);
    for (const double step : {0.8191725134, 0.6710436067, 0.5497004779}) {
      rgba.push_back(static_cast<float>(exposure * (1.05 * along(step) - 0.02)));
    }
    rgba.push_back(1.0F);
  }
  return rgba;
}

struct Case {
  const char* extension;
  int size;
  double room;  ///< what a shader's own arithmetic may make, of a pixel's size
};

class TextureProcessorTest : public testing::Test {
 protected:
  void expectTheShadersPixels(const Case& given, const sip::EglDevice& device) {
    SCOPED_TRACE(given.extension);
    const auto file = m_folder.path() / (std::string("look") + given.extension);
    BakeOptions options;
    options.size = given.size;
    bakeFile(recipeOf("D65", "HP1"), testLibrary(), file, "", options);
    const Shader shader(fileTransform(file));
    ASSERT_GT(shader.tableCount(), 0U);
    std::vector<float> pixels = colours();
    if (std::string(given.extension) == ".cube") {
      for (float& value : pixels) {
        value = std::min(1.0F, std::abs(value));
      }
    }
    std::vector<float> floats;
    for (const TextureDepth depth : {TextureDepth::Float, TextureDepth::Half}) {
      const std::vector<float> expected = shader.run(device, pixels, depth);
      std::vector<float> emulated = pixels;
      textureProcessor(shaderOperators(file), depth).apply(emulated);
      const double off = largestShare(expected, emulated, pixels);
      std::printf("[ shader ] %s, %s: off by %.2g of a pixel's size at most\n", given.extension,
                  depth == TextureDepth::Half ? "halves" : "floats", off);
      EXPECT_LE(off, given.room);
      if (depth == TextureDepth::Float) {
        floats = emulated;
      } else {
        // And the depth is something that one sees.
        EXPECT_GT(largestShare(floats, emulated, pixels), 10.0 * off);
      }
    }
  }

  static double largestShare(const std::vector<float>& a, const std::vector<float>& b, const std::vector<float>& of) {
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); i += 4) {
      const auto pixel = [&](const std::vector<float>& pixels) {
        return Eigen::Map<const Eigen::Vector3f>(pixels.data() + i).cast<double>().eval();
      };
      const double off = (pixel(a) - pixel(b)).cwiseAbs().maxCoeff();
      largest = std::max(largest, std::isfinite(off) ? off / pixel(of).cwiseAbs().maxCoeff() : 1e30);
    }
    return largest;
  }

  TemporaryFolder m_folder;
};

TEST_F(TextureProcessorTest, HasTheShadersPixels) {
  std::string reason;
  const auto device = sip::EglDevice::find(reason);
  if (!device) {
    GTEST_SKIP() << reason << ": OpenColorIO's shader is not run; install libegl1 and libgl1-mesa-dri";
  }
  for (const Case& each : {Case{".ctf", 33, 1e-4}, Case{".clf", 33, 1e-4}, Case{".cube", 33, 1e-4}}) {
    expectTheShadersPixels(each, *device);
  }
}

TEST_F(TextureProcessorTest, FloatTexturesAreTheFile) {
  const auto file = m_folder.path() / "look.cube";
  BakeOptions options;
  options.size = 9;
  const Certificate certificate = bakeFile(recipeOf("D65", "HP1"), testLibrary(), file, "", options);
  std::vector<float> expected = colours();
  std::vector<float> given = expected;
  PixelProcessor::fromFile(file).apply(expected);
  textureProcessor(shaderOperators(file), TextureDepth::Float).apply(given);
  EXPECT_EQ(given, expected);
  // And so does the certificate say.
  ASSERT_TRUE(certificate.onCards.has_value());
  EXPECT_EQ(certificate.onCards->floats.p99, certificate.error.p99);
  EXPECT_NE(certificate.onCards->halves.p99, certificate.error.p99);
  EXPECT_NEAR(certificate.onCards->halves.p99, certificate.error.p99, 1.0);
  // A text says the same of itself, but for the digits that it keeps of its tables.
  const auto ofText = bakeText(recipeOf("D65", "HP1"), testLibrary(), certificate.format, options).certificate.onCards;
  ASSERT_TRUE(ofText.has_value());
  EXPECT_NEAR(ofText->floats.p99, certificate.onCards->floats.p99, 1e-3);
  EXPECT_NEAR(ofText->halves.p99, certificate.onCards->halves.p99, 0.02);
  EXPECT_NE(certificate.json().find("\"half_textures\""), std::string::npos);
}

TEST_F(TextureProcessorTest, RefusesWhatIsNoFile) {
  EXPECT_NE(spectral::errorOf([&] {
              textureProcessor(shaderOperators(m_folder.path() / "none.cube"), TextureDepth::Half);
            }).find("no such file"),
            std::string::npos);
}

}  // namespace
}  // namespace metamer::ocio

#endif
