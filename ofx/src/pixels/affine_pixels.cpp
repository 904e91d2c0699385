// SPDX-License-Identifier: Apache-2.0
#include "pixels/affine_pixels.h"

#include <cmath>

#include "metamer/spectral/log_pieces.h"
#include "pixels/device_words.h"

namespace metamer::ofx {

void AffinePixels::apply(std::span<const float> source, std::span<float> destination) const {
  for (std::size_t i = 0; i < source.size(); i += 4) {
    Eigen::Vector3d colour(source[i], source[i + 1], source[i + 2]);
    destination[i + 3] = source[i + 3];
    if (colour.allFinite()) {
      if (m_form.encoding) {
        colour = colour.unaryExpr([&](double signal) { return spectral::decode(*m_form.encoding, signal); });
      }
      colour = (m_form.matrix * colour + m_form.offset).eval();
      if (m_form.clampsBelow) {
        colour = colour.cwiseMax(0.0);
      }
      if (m_form.encoding) {
        colour = colour.unaryExpr([&](double light) { return spectral::encode(*m_form.encoding, light); });
      }
      // A signal of a thousand stops is beyond any number: such a pixel stays too.
      if (!colour.allFinite()) {
        colour = Eigen::Vector3d(source[i], source[i + 1], source[i + 2]);
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      destination[i + k] = static_cast<float>(colour[static_cast<Eigen::Index>(k)]);
    }
  }
}

bool AffinePixels::isIdentity() const {
  return m_form.matrix.isIdentity(0.0) && m_form.offset.isZero(0.0) && !m_form.clampsBelow;
}

sip::DeviceTables AffinePixels::deviceTables() const {
  sip::DeviceTables tables;
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) {
      appendDouble(tables.cells, m_form.matrix(row, column));
    }
  }
  for (const double value : {m_form.offset[0], m_form.offset[1], m_form.offset[2], m_form.clampsBelow ? 1.0 : 0.0,
                             m_form.encoding ? 1.0 : 0.0}) {
    appendDouble(tables.cells, value);
  }
  appendPieces(tables.cells, m_form.encoding ? spectral::piecesOf(*m_form.encoding) : spectral::LogPieces{});
  return tables;
}

}  // namespace metamer::ofx
