// SPDX-License-Identifier: Apache-2.0
// How near a map of the measured scene is to its transform: on the error protocol, and where it is worst.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cstdio>
#include <random>

#include "metamer/sip/error_protocol.h"
#include "metamer/sip/homogeneous_map.h"
#include "metamer/spectral/colorimetry.h"
#include "sip/transform/transform_fixture.h"

namespace metamer::sip {
namespace {

using Eigen::Vector3d;

/// A map beside its transform, seen from the map's own coordinates.
class Pairing {
 public:
  Pairing(const SpectralTransform& transform, const HomogeneousMap& map)
      : m_transform(transform),
        m_map(map),
        m_rgbFromCube(Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(map.cubeFromRgb.data())
                          .cast<double>()
                          .inverse()) {}

  /// CIEDE2000 between both at a place of the front face, -1 ... 1, at Y = 0.18.
  double errorAt(const Eigen::Vector2d& place) const {
    const Vector3d rgb = m_rgbFromCube * Vector3d(place.x(), place.y(), 1.0);
    const double luminance = m_transform.space().xyzFromRgb().row(1).dot(rgb);
    if (!(luminance > 0.02 * rgb.norm())) {
      return 0.0;
    }
    std::array<float, 4> pixel{};
    Eigen::Map<Eigen::Vector3f>(pixel.data()) = (0.18 / luminance * rgb).cast<float>();
    const Vector3d given = Eigen::Map<Eigen::Vector3f>(pixel.data()).cast<double>();
    m_map.apply(pixel);
    return difference(m_transform.apply(given), Eigen::Map<Eigen::Vector3f>(pixel.data()).cast<double>());
  }

 private:
  double difference(const Vector3d& a, const Vector3d& b) const {
    const Eigen::Matrix3d& xyz = m_transform.space().xyzFromRgb();
    const Vector3d white = m_transform.whiteXyz();
    return spectral::deltaE2000(spectral::lab(xyz * a, white), spectral::lab(xyz * b, white));
  }

  const SpectralTransform& m_transform;
  const HomogeneousMap& m_map;
  Eigen::Matrix3d m_rgbFromCube;
};

/// The worst error over evenly drawn places, and what climbing from the worst of them finds.
struct Worst {
  double even = 0.0;
  double climbed = 0.0;
};

Worst worstOf(const Pairing& pairing) {
  struct Place {
    double error;
    Eigen::Vector2d place;
  };
  std::mt19937 random(12);
  const auto any = [&random]() -> Eigen::Vector2d {
    Eigen::Vector2d place{unitRandom(random), unitRandom(random)};
    return 2.0 * place - Eigen::Vector2d::Ones();
  };
  std::vector<Place> places;
  for (int i = 0; i < 6000; ++i) {
    const Eigen::Vector2d place = any();
    places.push_back({pairing.errorAt(place), place});
  }
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.error > b.error; });
  Worst worst{places.front().error, places.front().error};
  for (std::size_t i = 0; i < 40; ++i) {
    Place place = places[i];
    for (double step = 0.02; step > 2e-4; step *= 0.8) {
      for (int attempt = 0; attempt < 3; ++attempt) {
        const Eigen::Vector2d next = (place.place + step * any()).cwiseMax(-1.0).cwiseMin(1.0);
        const double error = pairing.errorAt(next);
        if (error > place.error) {
          place = {error, next};
        }
      }
    }
    worst.climbed = std::max(worst.climbed, place.error);
  }
  return worst;
}

TEST(HomogeneousMapTest, OfTheMeasuredSceneAgainstItsTransform) {
  for (const auto& pair : {lightPairs()[1], lightPairs()[3]}) {
    const TransformSpec spec = naturalSpecOf(pair.first, pair.second);
    const SpectralTransform transform(spec);
    const HomogeneousMap map = buildHomogeneousMap(transform);
    EXPECT_EQ(map.linearNormalCount, 0);
    const ErrorProtocol protocol(spec, chart(), {1024, 96, 0, 0, false});
    const auto report = protocol.measureAgainst(transform, [&](std::span<float> rgba) { map.apply(rgba); });
    const Worst worst = worstOf(Pairing(transform, map));
    std::printf("[ map ] %s, natural: mean %.4f p99 %.4f max %.4f, worst %s; found %.4f, by climbing %.4f; %d solves\n",
                pairName(pair).c_str(), report.mean, report.p99, report.max, report.worstProbe.c_str(), worst.even,
                worst.climbed, map.statistics.solves);
    EXPECT_LE(report.p99, 0.09) << pairName(pair);
    EXPECT_LE(report.max, 0.8) << pairName(pair);
    EXPECT_LE(worst.climbed, 0.8) << pairName(pair);
  }
}

}  // namespace
}  // namespace metamer::sip
