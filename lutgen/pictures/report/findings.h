// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "report/baked_forms.h"
#include "report/known_surfaces.h"
#include "report/shown_pictures.h"

namespace metamer::lutgen {

/// What the figures say to somebody who does not read figures, a sentence or two each.
std::vector<std::string> findings(const std::vector<BakedForm>& forms, const std::vector<SurfaceGroup>& groups,
                                  const std::vector<ShownPicture>& pictures);

/// How noise grows, beside plain adaptation.
std::string noiseWords(const std::vector<SurfaceGroup>& groups, const ocio::Certificate& certificate);

/// Under a picture: what its pixels are, how it is seen, and how far the files are from the engine on it.
/// @param view  the film-like view's name
std::string pictureWords(const ShownPicture& picture, const std::vector<BakedForm>& forms, const std::string& view);

}  // namespace metamer::lutgen
