// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "metamer/ocio/config_source.h"
#include "metamer/sip/spectral_transform.h"
#include "report/baked_forms.h"
#include "report/film_view.h"
#include "report/screen.h"

namespace metamer::lutgen {

/// A picture of the page.
struct ShownPicture {
  std::string title;
  std::string pixels;  ///< what the file's pixels are, in words
  int width = 0;
  int height = 0;
  std::vector<float> linear;  ///< RGBA of the recipe's space, made small
  bool isFilm = false;        ///< seen through the film-like view; else as an sRGB screen shows it, clipped
  std::string before;         ///< JPEG files
  std::string after;
  std::vector<double> p99;  ///< CIEDE2000 of each baked form from the engine, 99th percentile of a sample of pixels
};

/// Pictures are shown at most this large, on their longer side.
inline constexpr int kShownSide = 640;

/// Pictures of files: colours through the doors of `lutgen apply`, made small in linear light. Those of scenes, linear
/// or log, are seen through the film-like view; a screen's signal comes back as it was, as `lutgen apply` gives it.
/// @param pictureSpace  stated for all; empty: what each file says
/// @param space  of the recipe's pixels
/// @throws spectral::InputError: cannot be read, no unmistakable layer, an unknown space
std::vector<ShownPicture> shownPictures(const std::vector<std::string>& files, const std::string& pictureSpace,
                                        const PictureSpace& space, const spectral::DataLibrary& library,
                                        const ocio::ConfigSource& config);

/// The page's own photographs: the light that the view shows as them.
std::vector<ShownPicture> ownPhotographs(const PictureSpace& space, const FilmView& film,
                                         const spectral::DataLibrary& library, const WorkFolder& folder);

/// Bytes of one JPEG file: sixteen of them make a page of less than 3 MB, the second beside the playground too.
inline constexpr std::size_t kLargestJpeg = 120000;
inline constexpr std::size_t kLargestJpegBesideEngine = 60000;

/// Fills before, after and p99.
void relight(std::vector<ShownPicture>& pictures, const sip::SpectralTransform& transform,
             const std::vector<BakedForm>& forms, const Screen& screen, const FilmView& film, const WorkFolder& folder,
             std::size_t largestJpeg);

}  // namespace metamer::lutgen
