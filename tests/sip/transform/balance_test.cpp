// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/balance.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cstdio>

#include "metamer/sip/recipe.h"
#include "metamer/spectral/colorimetry.h"
#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using spectral::ChromaticAdaptation;
using spectral::DomainSamples;

constexpr const char* kCamera = "Nikon D5100";
constexpr const char* kEye = "CIE 1931 2";
/// Every way to balance; `camera` stands for the camera's own picture.
constexpr std::array kBalances = {"vonkries", "bradford", "cat02", "cat16", "rgb", "camera", "none"};

TransformSpec specWith(const std::string& fields, const std::string& input = "{illuminant: A}",
                       const std::string& output = "{illuminant: D65, adaptation: 1}") {
  return resolve(parseRecipe("metamer: 1\ninput: " + input + "\noutput: " + output + "\n" + fields, "r.yaml"),
                 testLibrary());
}

std::string balancedBy(const std::string& name) {
  return "scene: {kind: smooth}\nbalanced: " + name + "\n";
}

/// A light on an observer; an eye, but for the camera's own balance.
std::string side(const std::string& light, const std::string& balance, const std::string& more = "") {
  return "{illuminant: " + light + ", observer: " + (balance == "camera" ? kCamera : kEye) + more + "}";
}

/// What an observer gets of reflectances under a light, one a column, over the perfect reflector's middle channel.
Eigen::Matrix3Xd seen(const std::string& light, const std::vector<DomainSamples>& reflectances,
                      const std::string& observer = kEye) {
  const DomainSamples power = testLibrary().illuminant(light).onDomain();
  const auto curves = testLibrary().observer(observer).onDomain();
  Eigen::Matrix3Xd result(3, reflectances.size());
  for (std::size_t i = 0; i < reflectances.size(); ++i) {
    result.col(static_cast<Eigen::Index>(i)) = curves.transpose() * reflectances[i].cwiseProduct(power);
  }
  return result / (curves.transpose() * power).y();
}

Vector3d whiteOf(const std::string& light, const std::string& observer = kEye) {
  return seen(light, {DomainSamples::Ones()}, observer).col(0);
}

Matrix3d gains(const Matrix3d& space, const Vector3d& from, const Vector3d& to) {
  return space.inverse() * (space * to).cwiseQuotient(space * from).asDiagonal() * space;
}

/// Reflectances shot under a light and balanced as `name` says, by the definitions: RGB of the working space.
Eigen::Matrix3Xd shot(const TransformSpec& spec, const std::string& name, const std::string& light,
                      const std::vector<DomainSamples>& reflectances) {
  const Vector3d white = spec.space.whiteXyz();
  const Matrix3d rgbFromXyz = spec.space.rgbFromXyz();
  if (name == "camera") {
    // What a camera's maker ships: a matrix for daylight by least squares, behind gains on its channels.
    const Matrix3d matrix = seen("D65", spec.training, kCamera)
                                .transpose()
                                .colPivHouseholderQr()
                                .solve(seen("D65", spec.training).transpose())
                                .transpose();
    const Vector3d daylight = whiteOf("D65", kCamera);
    const Vector3d gain = daylight.cwiseQuotient(whiteOf(light, kCamera));
    return rgbFromXyz * gains(spectral::lmsFromXyz(ChromaticAdaptation::Bradford), matrix * daylight, white) * matrix *
           gain.asDiagonal() * seen(light, reflectances, kCamera);
  }
  if (name == "none") {
    return rgbFromXyz * seen(light, reflectances);
  }
  const Matrix3d space = name == "rgb" ? rgbFromXyz : spectral::lmsFromXyz(spectral::chromaticAdaptationFromName(name));
  return rgbFromXyz * gains(space, whiteOf(light), white) * seen(light, reflectances);
}

/// Mean CIEDE2000 between pictures, one pixel a column.
double meanDifference(const TransformSpec& spec, const Eigen::Matrix3Xd& a, const Eigen::Matrix3Xd& b) {
  const auto lab = [&](const Vector3d& rgb) {
    return spectral::lab(spec.space.xyzFromRgb() * rgb, spec.space.whiteXyz());
  };
  double sum = 0;
  for (Eigen::Index i = 0; i < a.cols(); ++i) {
    sum += spectral::deltaE2000(lab(a.col(i)), lab(b.col(i)));
  }
  return sum / static_cast<double>(a.cols());
}

Eigen::Matrix3Xd applied(const SpectralTransform& transform, const Eigen::Matrix3Xd& picture) {
  Eigen::Matrix3Xd result = picture;
  for (Eigen::Index i = 0; i < picture.cols(); ++i) {
    result.col(i) = transform.apply(Vector3d(picture.col(i)));
  }
  return result;
}

TEST(BalanceTest, Names) {
  for (const char* const name : kBalances) {
    EXPECT_EQ(nameOf(balanceFromName(name)), name);
  }
  EXPECT_EQ(balanceFromName("Cat02"), (Balance{Balance::Kind::Cat, ChromaticAdaptation::Cat02}));
  EXPECT_EQ(errorOf([] { balanceFromName("auto"); }),
            "balanced 'auto': must be camera, rgb, none, vonkries, bradford, cat02 or cat16");
}

TEST(BalanceTest, EachBalanceFindsTheResponseThatThePictureWasMadeFrom) {
  const std::vector<DomainSamples> chart = samplesOf("colorchecker");
  for (const std::string light : {"A", "FL2", "LED-RGB1"}) {
    for (const std::string name : kBalances) {
      const TransformSpec spec = specWith(balancedBy(name), side(light, name));
      const SpectralTransform transform(spec);
      const std::string observer = name == "camera" ? kCamera : kEye;
      const Eigen::Matrix3Xd response =
          whiteOf(light, observer).cwiseInverse().asDiagonal() * seen(light, chart, observer);
      const Eigen::Matrix3Xd found = transform.responseFromRgb() * shot(spec, name, light, chart);
      // Two least squares and their scale agree to 1e-13; the rest is exact.
      EXPECT_LE((found - response).cwiseAbs().maxCoeff(), 1e-11) << light << ", " << name;
    }
  }
}

TEST(BalanceTest, NeutralsStayNeutralAndUnbalancedOnesKeepTheirCast) {
  for (const std::string name : kBalances) {
    for (const std::string adaptation : {"0", "0.4", "1"}) {
      const TransformSpec spec = specWith("cat: cat16\n" + balancedBy(name), side("A", name),
                                          side("FL2", name, ", adaptation: " + adaptation));
      const SpectralTransform transform(spec);
      const bool raw = name == "none";
      const Vector3d before = shot(spec, name, "A", {DomainSamples::Ones()}).col(0);
      EXPECT_LE((before - Vector3d::Ones()).cwiseAbs().maxCoeff() < 1e-12, !raw) << name;
      // The eye: D W / W_out + (1 - D) W / W_in on the new light; left out, for the picture that holds A: W / W_in.
      const PreparedPipeline input = prepare(spec.input, spec.training, spec.standardObserver);
      const PreparedPipeline output = prepare(spec.output, spec.training, spec.standardObserver);
      const Matrix3d cones = spectral::lmsFromXyz(ChromaticAdaptation::Cat16);
      const Vector3d inputCones = cones * input.whiteXyz();
      const Vector3d seenCones = spec.adaptation * inputCones + (1.0 - spec.adaptation) * cones * output.whiteXyz();
      const Vector3d from =
          raw ? Vector3d(Vector3d::Ones()) : Vector3d((cones * spec.space.whiteXyz()).cwiseQuotient(inputCones));
      const Vector3d wanted = spec.space.rgbFromXyz() * cones.inverse() * from.asDiagonal() * seenCones;
      for (const double grey : {0.18, 20.0}) {
        EXPECT_LE((transform.apply(Vector3d(grey * before)) / grey - wanted).cwiseAbs().maxCoeff(), 1e-10)
            << name << ", " << adaptation;
      }
      if (adaptation == "1") {
        EXPECT_LE((wanted - before).cwiseAbs().maxCoeff(), 1e-12) << name;
      }
    }
  }
}

TEST(BalanceTest, EqualPipelinesDoNothingHoweverTheShotWasBalanced) {
  const std::vector<DomainSamples> chart = samplesOf("colorchecker");
  for (const std::string name : kBalances) {
    for (const std::string adaptation : {", adaptation: 0", ", adaptation: 1"}) {
      const std::string fields = "cat: vonkries\n" + balancedBy(name);
      EXPECT_TRUE(SpectralTransform(specWith(fields, side("A", name), side("A", name, adaptation))).isIdentity());
      // Nor does it jump there: A is the blackbody of 2856 K.
      const TransformSpec spec = specWith(fields, side("A", name), side("2856 K", name, adaptation));
      const Eigen::Matrix3Xd picture = shot(spec, name, "A", chart);
      EXPECT_LE(meanDifference(spec, applied(SpectralTransform(spec), picture), picture), 0.05) << name << adaptation;
    }
  }
}

TEST(BalanceTest, TheRightOneRecoversTheChartInDaylight) {
  const std::vector<DomainSamples> chart = samplesOf("colorchecker");
  for (const std::string light : {"A", "FL2"}) {
    for (const std::string name : kBalances) {
      const bool raw = name == "none";
      // The unbalanced shot stays one: in the new light's colour, with the eye where it was.
      const std::string daylight = std::string("{illuminant: D65, adaptation: ") + (raw ? "0}" : "1}");
      const TransformSpec spec = specWith("balanced: " + name + "\n", side(light, name), daylight);
      const Eigen::Matrix3Xd picture = shot(spec, name, light, chart);
      const Eigen::Matrix3Xd truth = shot(spec, raw ? "none" : "bradford", "D65", chart);
      const double nothing = meanDifference(spec, picture, truth);
      const double done = meanDifference(spec, applied(SpectralTransform(spec), picture), truth);
      std::printf("[ balance ] %s, %s: nothing %.2f, transform %.2f\n", light.c_str(), name.c_str(), nothing, done);
      // By the same experiment in another implementation 0.6 to 0.7 for the eye, 1.3 for this camera.
      EXPECT_LE(done, name == "camera" ? 1.5 : 0.8) << light << ", " << name;
      EXPECT_LE(done, 0.5 * nothing) << light << ", " << name;
    }
  }
}

TEST(BalanceTest, NoneGivenIsTheChromaticAdaptation) {
  for (const std::string cat : {"vonkries", "cat16"}) {
    const SpectralTransform given(specWith("cat: " + cat + "\n" + balancedBy(cat)));
    const SpectralTransform leftOut(specWith("cat: " + cat + "\nscene: {kind: smooth}\n"));
    const Vector3d colour(0.7, 0.2, 0.05);
    EXPECT_EQ(given.apply(colour), leftOut.apply(colour)) << cat;
    EXPECT_NE(given.apply(colour), SpectralTransform(specWith("cat: " + cat + "\n" + balancedBy("rgb"))).apply(colour));
  }
}

TEST(BalanceTest, AnObserverThatIsNoCameraIsBalancedAsBradford) {
  const Vector3d colour(0.7, 0.2, 0.05);
  EXPECT_EQ(SpectralTransform(specWith(balancedBy("camera"))).apply(colour),
            SpectralTransform(specWith(balancedBy("bradford"))).apply(colour));
}

TEST(BalanceTest, RefusesLightsOutOfReach) {
  EXPECT_EQ(errorOf([] { SpectralTransform(specWith(balancedBy("bradford"), "{illuminant: LPS}")); }),
            "r.yaml: LPS: balanced 'bradford': does not reach this light (no response in one channel); use vonkries");
  EXPECT_EQ(errorOf([] { SpectralTransform(specWith("space: Rec.709\n" + balancedBy("rgb"), "{illuminant: HP1}")); }),
            "r.yaml: HP1: balanced 'rgb': does not reach this light (no response in one channel); use vonkries");
  EXPECT_EQ(errorOf([] {
              SpectralTransform(specWith("cat: bradford\n" + balancedBy("vonkries"), "{illuminant: LPS}",
                                         "{illuminant: D65, adaptation: 0}"));
            }),
            "r.yaml: LPS: cat 'bradford': does not reach this light (no response in one cone); use vonkries");
  // Deep red reaches a camera made for it, and no blue cone.
  const auto over = [](const char* name, spectral::SpectralQuantity quantity, double from) {
    return spectral::Spectrum(name, quantity, {from, from + 10, from + 20, from + 30}, {0, 1, 1, 0});
  };
  TransformSpec red = specWith("", "{illuminant: A}");
  red.input.illuminant = over("deep red", spectral::SpectralQuantity::SpectralPowerDistribution, 690);
  red.input.observer.response = spectral::Observer::Response::Camera;
  red.input.observer.xyzFromResponse.reset();
  for (Eigen::Index k = 0; k < 3; ++k) {
    red.input.observer.curves[static_cast<std::size_t>(k)] =
        over("red", spectral::SpectralQuantity::Sensitivity, 680 + 10 * static_cast<double>(k));
  }
  EXPECT_NE(errorOf([&] { SpectralTransform{red}; }).find("(no response in one channel); use another light"),
            std::string::npos)
      << errorOf([&] { SpectralTransform{red}; });
  TransformSpec spec = specWith(balancedBy("camera"), side("A", "camera"));
  spec.daylight.reset();
  EXPECT_EQ(errorOf([&] { SpectralTransform{spec}; }),
            "Nikon D5100: balanced 'camera': needs the daylight that the camera's matrix is made for");
}

}  // namespace
}  // namespace metamer::sip
