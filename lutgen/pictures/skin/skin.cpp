// SPDX-License-Identifier: Apache-2.0
#include "picture_commands.h"
#include "skin/skin_commands.h"

namespace metamer::lutgen {

void addSkin(CLI::App& application) {
  CLI::App* skin = kSkin.addTo(application);
  skin->require_subcommand(1);
  addSkinEstimate(*skin);
  addSkinEdit(*skin);
  addSkinSample(*skin);
}

}  // namespace metamer::lutgen
