// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "report/baked_forms.h"
#include "report/charts.h"
#include "report/known_surfaces.h"
#include "report/shown_pictures.h"

namespace metamer::lutgen {

/// All that the page tells.
struct PageContents {
  sip::Recipe recipe;
  std::vector<BakedForm> forms;
  std::vector<SurfaceGroup> groups;
  std::vector<ShownPicture> pictures;
  std::string view;                ///< the film-like view's name
  std::string live;                ///< the playground's page; empty: left out
  bool hasOwnPhotographs = false;  ///< pictures are the page's own
  std::vector<Chart> spectra;
  Chart field;
  std::vector<Chart> surfaces;  ///< one a group
  std::vector<Chart> maps;      ///< one a form
};

/// The page: one HTML file that needs nothing beside it. The same for the same contents: no times, no folders.
std::string htmlOf(const PageContents& contents);

}  // namespace metamer::lutgen
