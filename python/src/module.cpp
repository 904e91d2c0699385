// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"

NB_MODULE(_core, module) {
  using namespace metamer::python;
  module.doc() = "The engine behind the package metamer: spectra, recipes, transforms and their error.";
  module.attr("version") = METAMER_VERSION;
  bindErrors(module);
  bindSpectra(module);
  bindLibrary(module);
  bindColorimetry(module);
  bindRecipe(module);
  bindTransform(module);
  bindComparison(module);
  bindStage(module);
  bindSkin(module);
  bindUplift(module);
}
