// SPDX-License-Identifier: Apache-2.0
#include "job/job.h"

#include <algorithm>
#include <utility>

#include "metamer/spectral/platform.h"

namespace metamer::lutgen {

void requireUnderstood(void (*addCommand)(CLI::App&), std::vector<std::string> words) {
  words.erase(std::remove(words.begin(), words.end(), "--quiet"), words.end());
  farm::requireUnderstood(addCommand, std::move(words));
}

farm::Word plain(const std::string& word) {
  return {{farm::Piece::Kind::Text, word}};
}

std::filesystem::path lutgenProgram() {
  return spectral::programFolder() / "lutgen";
}

void addJob(CLI::App& application, const std::vector<std::string>& taskWords) {
  CLI::App* command = kJob.addTo(application);
  command->require_subcommand(1);
  addJobApply(*command, taskWords);
  addJobBake(*command, taskWords);
}

}  // namespace metamer::lutgen
