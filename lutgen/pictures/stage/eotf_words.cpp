// SPDX-License-Identifier: Apache-2.0
#include "stage/eotf_words.h"

#include "metamer/spectral/formatted.h"

namespace metamer::lutgen {

Json toJson(const stage::PanelEotf& eotf) {
  return {{"model", eotf.isCurve ? "curve" : "power"},
          {"gamma", numberToJson(eotf.gamma)},
          {"offset", eotf.offset},
          {"gain", numberToJson(eotf.gain)},
          {"black", eotf.black},
          {"residual", eotf.residual},
          {"drives", eotf.drives},
          {"light", eotf.light}};
}

std::string textOf(const stage::PanelEotf& eotf) {
  return eotf.isCurve ? spectral::formatted("a curve of %zu steps (no power; the nearest is %.2f), residual %.2f %%",
                                            eotf.drives.size(), eotf.gamma, 100 * eotf.residual)
                      : spectral::formatted("power %.3f, dead below %.3f, residual %.2f %%", eotf.gamma, -eotf.offset,
                                            100 * eotf.residual);
}

}  // namespace metamer::lutgen
