// SPDX-License-Identifier: Apache-2.0
#include "farm_job.h"

#include <algorithm>
#include <deque>

#include "engines.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/pending_folder.h"

namespace metamer::farm {
namespace {

using spectral::InputError;

void requireFewTasks(const FarmJob& job) {
  for (const JobStep& step : job.steps) {
    for (const TaskValue& value : step.values) {
      if (value.values.size() > kMostTasks) {
        throw InputError(
            "", "tasks", std::to_string(value.values.size()),
            "are more than the " + std::to_string(kMostTasks) + " that a farm takes in a step; make the chunks longer");
      }
    }
  }
}

/// All of a job or none of it, its folders among it.
void writeTogether(const std::vector<JobText>& texts, const std::filesystem::path& folder,
                   std::deque<spectral::PendingFolder>& folders) {
  std::deque<spectral::PendingFile> pending;
  std::vector<spectral::PendingFile*> files;
  for (const JobText& text : texts) {
    pending.emplace_back(folder / spectral::pathOf(text.name)).write(text.text);
    files.push_back(&pending.back());
  }
  const spectral::SignalsWait untilAllAreThere;
  spectral::commitAll(files);
  for (spectral::PendingFolder& made : folders) {
    made.keep();
  }
}

}  // namespace

std::string writeJob(const FarmJob& job, const JobTarget& target) {
  requireFewTasks(job);
  const std::filesystem::path folder = std::filesystem::absolute(target.folder).lexically_normal();
  std::deque<spectral::PendingFolder> folders;
  folders.emplace_back(folder);
  for (const JobFile& file : job.files) {
    if (file.isFolder && file.flow != JobFile::Flow::In) {
      folders.emplace_back(file.path);
    }
  }
  if (target.engine == JobTarget::Engine::Slurm) {
    folders.emplace_back(folder / "logs");
    writeTogether(slurmScripts(job, folder), folder, folders);
    return "sh " + typedWord(spectral::utf8(target.folder / "submit.sh"));
  }
  writeTogether(openJobDescription(job), folder, folders);
  return "openjd run " + typedWord(spectral::utf8(target.folder / "template.json")) + " --job-param " +
         typedWord("file://" + spectral::utf8(target.folder / "parameters.json"));
}

}  // namespace metamer::farm
