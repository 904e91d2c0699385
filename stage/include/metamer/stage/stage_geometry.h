// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace metamer::stage {

/// Form factor of a rectangle seen from a small parallel patch on the axis through its centre: the share of the
/// patch's irradiance, against a full hemisphere of the same radiance. 1 m x 1 m at 1 m gives 0.2394.
/// (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-4, four corners.)
/// @param width, height, distance  in one unit, positive
/// @throws spectral::InputError otherwise
double rectangleFormFactor(double width, double height, double distance);

/// beta: irradiance of a chart inside an even sphere of light over that from the calibration square (section 2.7.2.2).
/// A patch sees half the sphere, so it is the inverse of the form factor; 4.18 for 1 m x 1 m at 1 m.
/// @throws spectral::InputError as rectangleFormFactor
double calibrationSquareBeta(double width, double height, double distance);

/// The lat-long pictures of environments, as OpenEXR defines them: y is up, the top row looks along +y, the middle of
/// the picture along +z, and longitude falls from +pi at the left edge to -pi at the right, +pi/2 along +x.
struct LatLong {
  int width = 0;
  int height = 0;

  /// Unit vector through the middle of a pixel.
  Eigen::Vector3d direction(int column, int row) const;
  /// Solid angle of a pixel of a row, sr.
  double solidAngle(int row) const;
};

/// The environment's light on a chart that faces `facing`: irradiance over pi, by which an even environment gives its
/// own radiance back. One row of pixels adds its share to a running sum (section 2.7.2.2's diffuse convolution).
class DiffuseConvolution {
 public:
  /// @param layout  of at least one pixel
  /// @param facing  where the chart looks, any length but 0
  /// @throws spectral::InputError otherwise
  DiffuseConvolution(LatLong layout, const Eigen::Vector3d& facing);

  /// @param row  0 ... height - 1
  /// @param rgb  3 x width, radiance
  /// @throws spectral::InputError otherwise
  void addRow(int row, const Eigen::Ref<const Eigen::Matrix3Xf>& rgb);
  Eigen::Vector3d value() const;

 private:
  LatLong m_layout;
  Eigen::Vector3d m_facing;
  Eigen::Vector3d m_sum = Eigen::Vector3d::Zero();
  double m_weight = 0;
};

}  // namespace metamer::stage
