// SPDX-License-Identifier: Apache-2.0
#include "effects/catalogue.h"

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/platform.h"

namespace metamer::ofx {

Catalogue Catalogue::ofThisBundle() {
  Catalogue catalogue;
  static const char inThisLibrary = 0;
  // Contents/<architecture>/metamer.ofx, and Contents/Resources/data.
  const std::filesystem::path contents = spectral::libraryFolder(&inThisLibrary).parent_path();
  try {
    catalogue.m_library = spectral::DataLibrary::open(contents / "Resources" / "data");
    catalogue.illuminants = catalogue.m_library->illuminantNames();
    catalogue.observers = catalogue.m_library->observerNames();
    catalogue.filters = catalogue.m_library->filterNames();
    catalogue.reflectanceSets = catalogue.m_library->reflectanceSetNames();
    catalogue.m_spaces = catalogue.m_library->colourSpaces();
    for (const spectral::ColourSpace& space : catalogue.m_spaces) {
      catalogue.spaces.push_back(space.name);
    }
  } catch (const std::exception& error) {
    catalogue = Catalogue();
    catalogue.m_problem = error.what();
    catalogue.illuminants = {"D65"};
    catalogue.observers = {"CIE 1931 2"};
    catalogue.reflectanceSets = {"colorchecker"};
    catalogue.spaces = {"ACEScg"};
  }
  return catalogue;
}

const spectral::DataLibrary& Catalogue::library() const {
  if (!m_library) {
    throw spectral::InputError("metamer.ofx.bundle", "", "", m_problem + "; install the whole bundle again");
  }
  return *m_library;
}

spectral::ColourSpace Catalogue::space(const std::string& name) const {
  for (const spectral::ColourSpace& space : m_spaces) {
    if (space.name == name) {
      return space;
    }
  }
  return library().colourSpace(name);
}

}  // namespace metamer::ofx
