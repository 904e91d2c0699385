// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "commands.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/platform.h"
#include "run.h"

namespace {

using namespace metamer::lutgen;

/// Reading pictures takes libraries that are slow to load; what does without them need not wait.
constexpr const char* kPicturesProgram = "lutgen-pictures";

bool isForPictures(const char* argument) {
  return std::any_of(kPictureCommands.begin(), kPictureCommands.end(),
                     [argument](const CommandName& command) { return command.name == argument; });
}

void addCommands(CLI::App& application) {
  addBake(application);
  addList(application);
  addConfig(application);
  addDiff(application);
  addSpectrum(application);
  addPairs(application);
  for (const CommandName& command : kPictureCommands) {  // for the help alone
    command.addTo(application)->callback([] { throw CLI::ValidationError("command", "must come first"); });
  }
}

}  // namespace

int main(int argumentCount, char** arguments) {
  if (argumentCount > 1 && isForPictures(arguments[1])) {
    const auto program = metamer::spectral::programFolder() / kPicturesProgram;
    metamer::spectral::becomeProgram(program, arguments);
    return fail(metamer::spectral::utf8(program) + ": cannot be run; it belongs beside lutgen, install both", kFailure);
  }
  return run(argumentCount, arguments, addCommands);
}
