// SPDX-License-Identifier: Apache-2.0
#include "checked_words.h"
#include "picture_commands.h"
#include "run.h"

// The commands that read pictures or render: lutgen hands over to this program.
int main(int argumentCount, char** arguments) {
  const std::vector<std::string> taskWords = metamer::farm::takeTaskWords(argumentCount, arguments);
  return metamer::lutgen::run(argumentCount, arguments, [&taskWords](CLI::App& application) {
    metamer::lutgen::addApply(application);
    metamer::lutgen::addCompare(application);
    metamer::lutgen::addJob(application, taskWords);
    metamer::lutgen::addReport(application);
    metamer::lutgen::addSkin(application);
    metamer::lutgen::addStage(application);
    metamer::lutgen::addUplift(application);
    metamer::lutgen::addValidate(application);
  });
}
