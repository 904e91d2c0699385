// SPDX-License-Identifier: Apache-2.0
#include "scenes/delaunay.h"

#include <algorithm>

namespace metamer::sip {

namespace {

using Triangle = std::array<int, 3>;
using Edge = std::array<int, 2>;

long double doubleArea(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const long double abx = static_cast<long double>(b.x()) - a.x();
  const long double aby = static_cast<long double>(b.y()) - a.y();
  const long double acx = static_cast<long double>(c.x()) - a.x();
  const long double acy = static_cast<long double>(c.y()) - a.y();
  return abx * acy - aby * acx;
}

/// Positive where d lies inside the circle through the counter-clockwise a, b, c.
long double inCircle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                     const Eigen::Vector2d& d) {
  using Row = std::array<long double, 3>;
  const auto row = [&d](const Eigen::Vector2d& p) -> Row {
    const long double x = static_cast<long double>(p.x()) - d.x();
    const long double y = static_cast<long double>(p.y()) - d.y();
    return {x, y, x * x + y * y};
  };
  const Row ra = row(a);
  const Row rb = row(b);
  const Row rc = row(c);
  return ra[0] * (rb[1] * rc[2] - rb[2] * rc[1]) - ra[1] * (rb[0] * rc[2] - rb[2] * rc[0]) +
         ra[2] * (rb[0] * rc[1] - rb[1] * rc[0]);
}

}  // namespace

std::vector<Triangle> delaunayTriangles(const std::vector<Eigen::Vector2d>& points) {
  const int count = static_cast<int>(points.size());
  if (count < 3) {
    return {};
  }
  Eigen::Vector2d low = points[0];
  Eigen::Vector2d high = points[0];
  for (const auto& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  // Three far corners whose triangle holds every point: so far that no triangle of the hull is missed.
  const Eigen::Vector2d middle = 0.5 * (low + high);
  const double reach = 1e4 * std::max((high - low).maxCoeff(), 1e-12);
  std::vector<Eigen::Vector2d> all = points;
  all.emplace_back(middle + Eigen::Vector2d(-2.0 * reach, -reach));
  all.emplace_back(middle + Eigen::Vector2d(2.0 * reach, -reach));
  all.emplace_back(middle + Eigen::Vector2d(0.0, 2.0 * reach));
  std::vector<Triangle> triangles{{count, count + 1, count + 2}};

  for (int p = 0; p < count; ++p) {
    std::vector<Triangle> kept;
    std::vector<Edge> cavity;
    for (const Triangle& t : triangles) {
      if (inCircle(all[t[0]], all[t[1]], all[t[2]], all[p]) <= 0.0L) {
        kept.push_back(t);
        continue;
      }
      for (int k = 0; k < 3; ++k) {
        const Edge edge{t[k], t[(k + 1) % 3]};
        // An edge met from both sides lies inside the cavity.
        const auto twin = std::find(cavity.begin(), cavity.end(), Edge{edge[1], edge[0]});
        if (twin != cavity.end()) {
          cavity.erase(twin);
        } else {
          cavity.push_back(edge);
        }
      }
    }
    for (const Edge& edge : cavity) {
      kept.push_back({edge[0], edge[1], p});
    }
    triangles = std::move(kept);
  }
  std::erase_if(triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [count](int corner) { return corner >= count; }) ||
           doubleArea(all[t[0]], all[t[1]], all[t[2]]) <= 0.0L;
  });
  return triangles;
}

}  // namespace metamer::sip
