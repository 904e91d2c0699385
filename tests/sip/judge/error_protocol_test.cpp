// SPDX-License-Identifier: Apache-2.0
#include "metamer/sip/error_protocol.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sip/sip_fixture.h"

namespace metamer::sip {
namespace {

// A bump whose top lies between the probes, and whose foot some of them see.
TEST(ErrorProtocolTest, TheLargestErrorIsLookedForBetweenTheProbes) {
  const TransformSpec spec = specOf("D65", "A");
  const ErrorProtocol protocol(spec, chart(), {.lowestStop = 0, .highestStop = 0});
  const Eigen::Matrix3d xyzFromRgb = spec.space.xyzFromRgb();
  const Eigen::Vector2d top(0.3717, 0.4119);
  const auto candidate = [&](std::span<float> rgba) {
    for (std::size_t k = 0; k < rgba.size(); k += 4) {
      Eigen::Map<Eigen::Vector3f> rgb(rgba.data() + k);
      const Eigen::Vector3d in = rgb.cast<double>();
      const Eigen::Vector3d xyz = xyzFromRgb * in;
      const double distance = (xyz.head<2>() / xyz.sum() - top).norm() / 0.004;
      rgb = ((1.0 + std::exp(-distance * distance)) * protocol.converged().apply(in)).cast<float>();
    }
  };
  const auto measured = protocol.measure(candidate);
  const auto found = protocol.search(candidate);
  // Twice as bright at 18 % grey's luminance is worth 16 CIEDE2000.
  EXPECT_LT(measured.max, 14.0);
  EXPECT_GT(found.max, 15.0);
  EXPECT_NE(found.worstProbe.find("near xy 0.37"), std::string::npos) << found.worstProbe;
  EXPECT_EQ(found.mean, measured.mean);
  EXPECT_EQ(found.p99, measured.p99);
  EXPECT_EQ(found.count, measured.count);
}

}  // namespace
}  // namespace metamer::sip
