// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/pipeline.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cstdio>
#include <limits>

#include "metamer/spectral/colorimetry.h"
#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SpectralTransformTest, ErrorsNameWhatGivesNoLight) {
  const spectral::Spectrum opaque("black tape", spectral::SpectralQuantity::Transmittance, {400.0, 700.0}, {0.0, 0.0});
  TransformSpec spec = specOf("D65", "A");
  spec.output.filters = {{opaque, 1.0}};
  EXPECT_EQ(errorOf([&] { SpectralTransform transform(spec); }),
            "A through black tape: filters '1': the filters stop all the light; lower a density or take one away");
  spec.output.filters = {{opaque, 0.0}};
  EXPECT_EQ(errorOf([&] { SpectralTransform transform(spec); }), "no InputError");
  spec.output.filters = {{opaque, -1.0}};
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("black tape: density '-1"), std::string::npos);

  spec = specOf("D65", "A");
  spec.input.illuminant =
      spectral::Spectrum("infrared", spectral::SpectralQuantity::SpectralPowerDistribution, {800.0, 900.0}, {1.0, 1.0});
  EXPECT_EQ(errorOf([&] { SpectralTransform transform(spec); }),
            "illuminant 'infrared': gives the observer CIE 1931 2 nothing between 380 and 780 nm; name another light");
  spec = specOf("D65", "A");
  spec.adaptation = kNan;
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("adaptation"), std::string::npos);
  spec = specOf("D65", "A");
  spec.output.observer = testLibrary().observer("Nikon D5100");
  EXPECT_NE(errorOf([&] { SpectralTransform transform(spec); }).find("training"), std::string::npos);
}

TEST(SpectralTransformTest, AChannelThatTheLightLeavesDarkIsRefused) {
  // Low-pressure sodium, one line at 590 nm, where the blue curve of CIE 1964 is zero: no white to normalise by.
  TransformSpec spec = specOf("LPS", "D65");
  spec.input.observer = testLibrary().observer("CIE 1964 10");
  const std::string error = errorOf([&] { SpectralTransform transform(spec); });
  EXPECT_NE(error.find("LPS"), std::string::npos) << error;
  EXPECT_NE(error.find("CIE 1964 10"), std::string::npos) << error;
  // As the output it is a light like any other.
  spec = specOf("D65", "LPS");
  spec.output.observer = testLibrary().observer("CIE 1964 10");
  EXPECT_TRUE(SpectralTransform(spec).apply(Eigen::Vector3d(0.2, 0.5, 0.3)).allFinite());
}

TEST(SpectralTransformTest, PipelinesWithoutOverlap) {
  TransformSpec spec = specOf("D65", "D65");
  const auto power = spectral::SpectralQuantity::SpectralPowerDistribution;
  spec.input.illuminant = spectral::Spectrum("blue half", power, {380.0, 480.0, 490.0}, {1.0, 1.0, 0.0});
  spec.output.illuminant = spectral::Spectrum("red half", power, {600.0, 610.0, 780.0}, {0.0, 1.0, 1.0});
  const SpectralTransform transform(spec);
  double gain = 0.0;
  for (const Vector3d& colour : colours(500)) {
    const Vector3d result = transform.apply(colour);
    ASSERT_TRUE(result.allFinite()) << colour.transpose();
    gain = std::max(gain, result.norm() / colour.norm());
  }
  std::printf("[ no overlap ] condition %.3g, largest gain %.3g\n", transform.diagnostics().conditionNumber, gain);
  EXPECT_LT(gain, 100.0);
}

TEST(SpectralTransformTest, FiltersStackByDensity) {
  const spectral::Spectrum gel = testLibrary().filter("Lee 204 Full C.T. Orange");
  TransformSpec twoSheets = specOf("D65", "D65");
  twoSheets.output.filters = {{gel, 1.0}, {gel, 1.0}};
  TransformSpec thick = specOf("D65", "D65");
  thick.output.filters = {{gel, 2.0}};
  const SpectralTransform a(twoSheets);
  const SpectralTransform b(thick);
  spectral::MaxDifference difference("density 2 and two sheets", 1e-12);
  for (const Vector3d& colour : colours(300)) {
    difference.add(a.apply(colour), b.apply(colour));
  }
  // Two halves are the whole, and none is nothing.
  thick.output.filters = {{gel, 0.5}, {gel, 0.5}};
  TransformSpec one = specOf("D65", "D65");
  one.output.filters = {{gel, 1.0}};
  const SpectralTransform c(thick);
  const SpectralTransform d(one);
  for (const Vector3d& colour : colours(300)) {
    difference.add(c.apply(colour), d.apply(colour));
  }
  thick.output.filters = {{gel, 0.0}};
  EXPECT_TRUE(SpectralTransform(thick).isIdentity());
  // The gel on both sides changes nothing, whatever the rest.
  thick.input.filters = {{gel, 1.5}};
  thick.output.filters = {{gel, 1.5}};
  EXPECT_TRUE(SpectralTransform(thick).isIdentity());
}

TEST(SpectralTransformTest, KeptExposureKeepsTheLossOfAFilter) {
  const spectral::Spectrum gel = testLibrary().filter("Lee 204 Full C.T. Orange");
  const spectral::DomainSamples light = testLibrary().illuminant("D65").onDomain();
  const spectral::DomainSamples luminosity = testLibrary().observer("CIE 1931 2").onDomain().col(1);
  const double transmission = light.cwiseProduct(gel.onDomain()).dot(luminosity) / light.dot(luminosity);
  for (const bool onInput : {false, true}) {
    TransformSpec spec = specOf("D65", "D65");
    (onInput ? spec.input : spec.output).filters = {{gel, 1.0}};
    const SpectralTransform evened(spec);
    spec.keepExposure = true;
    const SpectralTransform kept(spec);
    const double expected = onInput ? 1.0 / transmission : transmission;
    const Eigen::RowVector3d luminance = spec.space.xyzFromRgb().row(1);
    spectral::MaxDifference difference(onInput ? "exposure won" : "exposure lost", 1e-12);
    for (const Vector3d& colour : colours(100)) {
      difference.add(kept.apply(colour), expected * evened.apply(colour));
    }
    if (!onInput) {
      // With the eye on the input light, luminance tells the loss: white's Y is 1 without the filter's.
      EXPECT_NEAR(luminance.dot(kept.apply(Vector3d::Ones())) / luminance.dot(evened.apply(Vector3d::Ones())),
                  transmission, 1e-12);
    }
  }
}

TEST(SpectralTransformTest, CamerasBothWays) {
  for (const char* const camera : {"Nikon D5100", "Canon EOS 5D Mark II", "ACES RICD"}) {
    for (const bool cameraOut : {true, false}) {
      TransformSpec spec = specOf("D65", "D65");
      spec.training = samplesOf("rawtoaces 190");
      (cameraOut ? spec.output : spec.input).observer = testLibrary().observer(camera);
      spec.adaptation = 1.0;
      const SpectralTransform transform(spec, 81);
      EXPECT_FALSE(transform.isIdentity());
      EXPECT_LE((transform.apply(Vector3d::Ones()) - Vector3d::Ones()).norm(), 1e-9) << camera;
      double largest = 0.0;
      for (const spectral::DomainSamples& patch : samplesOf("colorchecker")) {
        const Vector3d rgb = inputRgb(spec, transform, patch);
        const Matrix3d xyz = spec.space.xyzFromRgb();
        const Vector3d white = spec.space.whiteXyz();
        largest = std::max(largest, spectral::deltaE2000(spectral::lab(xyz * rgb, white),
                                                         spectral::lab(xyz * transform.apply(rgb), white)));
      }
      std::printf("[ camera ] %s as %s: chart patches move by at most %.2f CIEDE2000\n", camera,
                  cameraOut ? "output" : "input", largest);
      // A camera with a matrix sees nearly what the eye sees.
      EXPECT_LT(largest, 12.0) << camera;
      for (const Vector3d& colour : colours(200)) {
        ASSERT_TRUE(transform.apply(colour).allFinite()) << camera << ": " << colour.transpose();
      }
    }
    TransformSpec same = specOf("D65", "D65");
    same.training = samplesOf("rawtoaces 190");
    same.input.observer = testLibrary().observer(camera);
    same.output.observer = same.input.observer;
    EXPECT_TRUE(SpectralTransform(same, 81).isIdentity()) << camera;
  }
}

}  // namespace
}  // namespace metamer::sip
