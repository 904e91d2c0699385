// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "metamer/spectral/log_encoding.h"
#include "pixels/pixel_transform.h"

namespace metamer::ofx {

/// A matrix and an offset on linear pixels, in double precision.
class AffinePixels final : public PixelTransform {
 public:
  struct Form {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();  ///< rows red, green, blue
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    bool clampsBelow = false;  ///< no result below 0
    std::optional<spectral::LogEncoding> encoding;
  };

  explicit AffinePixels(Form form) : m_form(std::move(form)) {}

  void apply(std::span<const float> source, std::span<float> destination) const override;
  bool isIdentity() const override;
  bool isHomogeneous() const override { return m_form.offset.isZero(0.0) && !m_form.encoding; }
  std::optional<DeviceForm> deviceForm() const override { return DeviceForm{DeviceForm::Kernel::Affine, &m_resident}; }

 private:
  /// Doubles: matrix, offset, whether it clamps, whether there is a curve, its pieces.
  sip::DeviceTables deviceTables() const;

  Form m_form;
  ResidentTables m_resident{[this] { return deviceTables(); }};
};

}  // namespace metamer::ofx
