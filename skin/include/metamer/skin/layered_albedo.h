// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <span>
#include <vector>

namespace metamer::skin {

/// Two plane layers of one scattering and two absorptions at one wavelength, of one refractive index with what lies
/// above: an epidermis on a dermis (section 3.3). Coefficients are 1/cm, depths cm.
struct LayerOptics {
  double epidermisAbsorption = 0;
  double dermisAbsorption = 0;
  double scattering = 0;  ///< not reduced: reduced / (1 - anisotropy)
  double anisotropy = 0;  ///< g of Henyey and Greenstein, 0 ... 1
  double epidermisThicknessCm = 0;
  double dermisThicknessCm = std::numeric_limits<double>::infinity();  ///< below it nothing comes back
};

/// How many directions a hemisphere the fast solver has (Gauss points of each hemisphere): within 5e-4 of twelve
/// wherever skin can be, 6e-5 root mean square. Three would leave 1.5e-3.
inline constexpr int kStreamsPerHemisphere = 4;

/// The share of diffuse (Lambertian) light that comes back: radiative transfer with a Henyey-Greenstein phase function,
/// delta-M scaled (Wiscombe 1977), by doubling each layer from a start of high order, and adding them (van de Hulst).
/// @param layers   scattering above 0, anisotropy 0 ... 0.99, the rest not negative; thicknesses may be infinite
/// @param albedos  as many
/// @throws spectral::InputError outside those ranges
void layeredAlbedos(std::span<const LayerOptics> layers, std::span<double> albedos);
double layeredAlbedo(const LayerOptics& layers);

/// Epidermes of one thickness on dermes of one thickness, of one scattering: every absorption of the one on every one
/// of the other. Units and ranges are LayerOptics's.
struct LayerGrid {
  std::vector<double> epidermisAbsorptions;
  std::vector<double> dermisAbsorptions;
  double scattering = 0;
  double anisotropy = 0;
  double epidermisThicknessCm = 0;
  double dermisThicknessCm = std::numeric_limits<double>::infinity();
};

/// The same bits as layeredAlbedos of all pairs, many times faster: each layer is solved once.
/// @param albedos  one a pair, the dermis's absorption fastest
/// @throws spectral::InputError where layeredAlbedos does
void layeredAlbedoGrid(const LayerGrid& grid, std::span<double> albedos);

/// The same by plain adding-doubling of reflection and transmission matrices from a thin start, with any number of
/// directions: slow, for comparison.
/// @param streamsPerHemisphere  2 ... 32
double layeredAlbedoByPlainDoubling(const LayerOptics& layers, int streamsPerHemisphere);

}  // namespace metamer::skin
