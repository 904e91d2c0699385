// SPDX-License-Identifier: Apache-2.0
#include "materials/reflectance_texture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace metamer::spectral_ref {
namespace {

/// Two pixels side by side and the second one's share.
struct Pair {
  std::size_t first;
  std::size_t second;
  double share;
};

/// @param place  from edge to edge of the picture, 0 ... 1
/// @param wraps  whether the last pixel lies beside the first
Pair pairAt(double place, int count, bool wraps) {
  const double pixel = (wraps ? place - std::floor(place) : std::clamp(place, 0.0, 1.0)) * count - 0.5;
  const int below = static_cast<int>(std::floor(pixel));
  const auto inside = [&](int k) {
    return static_cast<std::size_t>(wraps ? (k + count) % count : std::clamp(k, 0, count - 1));
  };
  return {inside(below), inside(below + 1), pixel - below};
}

}  // namespace

ReflectanceTexture::ReflectanceTexture(const Texture& texture) : m_texture(&texture) {
  const std::vector<double>& nodes = texture.picture.nodesNm;
  std::uint32_t node = 0;
  for (int cell = 0; cell < kCells; ++cell) {
    const double nm = spectral::kDomainStartNm + cell;
    while (node + 2 < nodes.size() && nodes[node + 1] < nm) {
      ++node;
    }
    m_places.push_back({node, static_cast<float>((nm - nodes[node]) / (nodes[node + 1] - nodes[node]))});
  }
}

std::array<double, 2> ReflectanceTexture::placeOf(const Hit& hit) const {
  const double u = hit.u;
  const double v = hit.v;
  switch (m_texture->wrap) {
    case Texture::Wrap::Rectangle:
      break;
    case Texture::Wrap::Sphere: {
      const Eigen::Vector3d out = (hit.position.cast<double>() - m_texture->center).normalized();
      return {0.5 + 0.5 * std::atan2(out.x(), out.z()) * std::numbers::inv_pi,
              0.5 + std::asin(std::clamp(out.y(), -1.0, 1.0)) * std::numbers::inv_pi};
    }
    case Texture::Wrap::Mesh: {
      const auto& corners = m_texture->corners[hit.primitive];
      const auto mixed = [&](std::size_t k) {
        return (1.0 - u - v) * corners[0][k] + u * corners[1][k] + v * corners[2][k];
      };
      return {mixed(0), mixed(1)};
    }
  }
  return {u, v};
}

std::array<ReflectanceTexture::Pixel, 4> ReflectanceTexture::pixelsAt(const Hit& hit) const {
  const ReflectancePicture& picture = m_texture->picture;
  const auto [u, v] = placeOf(hit);
  const Pair column = pairAt(u, picture.width, m_texture->wrap != Texture::Wrap::Rectangle);
  // The top row is the first.
  const Pair row = pairAt(1.0 - v, picture.height, m_texture->wrap == Texture::Wrap::Mesh);
  const auto pixel = [&](std::size_t x, std::size_t y, double weight) {
    const std::size_t index = y * static_cast<std::size_t>(picture.width) + x;
    return Pixel{picture.values.data() + index * picture.nodesNm.size(),
                 static_cast<float>(weight / ReflectancePicture::kLargest)};
  };
  return {pixel(column.first, row.first, (1.0 - column.share) * (1.0 - row.share)),
          pixel(column.second, row.first, column.share * (1.0 - row.share)),
          pixel(column.first, row.second, (1.0 - column.share) * row.share),
          pixel(column.second, row.second, column.share * row.share)};
}

}  // namespace metamer::spectral_ref
