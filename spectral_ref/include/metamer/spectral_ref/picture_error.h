// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/spectral_ref/film.h"

namespace metamer::spectral_ref {

/// Expected CIEDE2000 of a pixel by noise, averaged over the picture: half the difference between the pictures of the
/// odd and of the even replicates. The white has the 99th percentile of the picture's Y; for a film in a space other
/// than XYZ or a camera's, the three channels go through `xyzFromColour` first.
/// @return NaN with fewer than two replicates
double pictureError(const Film& film, const Eigen::Matrix3d& xyzFromColour);

/// XYZ from the film's colour: for CIE observers and cameras with a matrix; else the channels stand for XYZ.
Eigen::Matrix3d xyzFromColour(const FilmSettings& settings);

}  // namespace metamer::spectral_ref
