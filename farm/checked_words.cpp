// SPDX-License-Identifier: Apache-2.0
#include "checked_words.h"

#include <algorithm>

#include "metamer/spectral/path_text.h"

namespace metamer::farm {

void requireUnderstood(const std::function<void(CLI::App&)>& addCommand, std::vector<std::string> words) {
  CLI::App application;
  addCommand(application);
  for (CLI::App* command : application.get_subcommands([](const CLI::App*) { return true; })) {
    command->callback([] {});
    command->set_help_flag();
  }
  std::reverse(words.begin(), words.end());  // as CLI11 takes them
  application.parse(words);
}

std::vector<std::string> takeTaskWords(int& argumentCount, char** arguments) {
  if (argumentCount < 2 || std::string(arguments[1]) != "job") {
    return {};
  }
  char** const end = arguments + argumentCount;
  char** const mark = std::find(arguments + 2, end, std::string("--"));
  argumentCount = static_cast<int>(mark - arguments);
  return mark == end ? std::vector<std::string>() : std::vector<std::string>(mark + 1, end);
}

void TargetOptions::addTo(CLI::App& command) {
  command.add_option("--openjd", m_openJd, "Folder for the job as an Open Job Description, for engines that speak it");
  command.add_option("--slurm", m_slurm, "Folder for the job as scripts for Slurm's sbatch");
}

JobTarget TargetOptions::target() const {
  if (m_openJd.empty() == m_slurm.empty()) {
    throw CLI::ValidationError("job", "needs either --openjd DIR or --slurm DIR");
  }
  return m_slurm.empty() ? JobTarget{JobTarget::Engine::OpenJobDescription, spectral::pathOf(m_openJd)}
                         : JobTarget{JobTarget::Engine::Slurm, spectral::pathOf(m_slurm)};
}

}  // namespace metamer::farm
