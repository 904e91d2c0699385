// SPDX-License-Identifier: Apache-2.0
// The transform against the same definition in another language and by other algebra (tests/oracle/bounded_engine.py).
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <tuple>

#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Vector3d;

TEST(TransformOracleTest, AgreesWithDenseAlgebra) {
  using Key = std::tuple<std::string, std::string, std::string, std::string>;
  struct Case {
    std::unique_ptr<SpectralTransform> full;
    std::unique_ptr<SpectralTransform> none;
    double largest = 0.0;
    int count = 0;
  };
  std::map<Key, Case> cases;
  for (const spectral::FixtureRow& row : spectral::readFixture("bounded_engine.csv")) {
    Case& its = cases[{row.text(0), row.text(1), row.text(2), row.text(3)}];
    if (!its.full) {
      TransformSpec spec = naturalSpecOf(row.text(0), row.text(1));
      spec.input.observer = testLibrary().observer(row.text(2));
      spec.scene.kind = sceneKindFromName(row.text(3));
      spec.adaptation = 1.0;
      its.full = std::make_unique<SpectralTransform>(spec, 81);
      spec.adaptation = 0.0;
      its.none = std::make_unique<SpectralTransform>(spec, 81);
      EXPECT_EQ(its.full->diagnostics().relaxation, 0.0);
    }
    const Vector3d rgb = row.vector(4);
    const auto add = [&](const SpectralTransform& transform, const Vector3d& expected) {
      const double size = std::max(expected.cwiseAbs().maxCoeff(), 1e-300);
      const double difference = (transform.apply(rgb) - expected).cwiseAbs().maxCoeff() / size;
      its.largest = difference <= its.largest ? its.largest : difference;  // NaN stays
      ++its.count;
    };
    add(*its.full, row.vector(7));
    add(*its.none, row.vector(10));
  }
  EXPECT_EQ(cases.size(), 12U);
  for (const auto& [key, its] : cases) {
    std::printf("[ oracle ] %s -> %s, %s, %s: within %.2g over %d colours\n", std::get<0>(key).c_str(),
                std::get<1>(key).c_str(), std::get<2>(key).c_str(), std::get<3>(key).c_str(), its.largest, its.count);
    // Both are a few hundred operations in double precision on lights of moderate condition.
    EXPECT_LE(its.largest, 1e-12) << std::get<0>(key) << " -> " << std::get<1>(key) << ", " << std::get<2>(key);
    EXPECT_GE(its.count, 60);
  }
}

}  // namespace
}  // namespace metamer::sip
