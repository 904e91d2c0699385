// SPDX-License-Identifier: Apache-2.0
#include "farm_job.h"

#include <algorithm>
#include <deque>
#include <system_error>

#include "engines.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"

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

void makeFolder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error || !std::filesystem::is_directory(folder)) {
    throw InputError(spectral::utf8(folder), "folder", "", "cannot be made (" + error.message() + "); name another");
  }
}

/// All of a job or none of it.
void writeTogether(const std::vector<JobText>& texts, const std::filesystem::path& folder) {
  std::deque<spectral::PendingFile> pending;
  std::vector<spectral::PendingFile*> files;
  for (const JobText& text : texts) {
    pending.emplace_back(folder / text.name).write(text.text);
    files.push_back(&pending.back());
  }
  spectral::commitAll(files);
}

}  // namespace

std::string writeJob(const FarmJob& job, const JobTarget& target) {
  requireFewTasks(job);
  const std::filesystem::path folder = std::filesystem::absolute(target.folder).lexically_normal();
  makeFolder(folder);
  for (const JobFile& file : job.files) {
    if (file.isFolder && file.flow != JobFile::Flow::In) {
      makeFolder(file.path);
    }
  }
  if (target.engine == JobTarget::Engine::Slurm) {
    makeFolder(folder / "logs");
    writeTogether(slurmScripts(job, folder), folder);
    return "sh " + typedWord(spectral::utf8(target.folder / "submit.sh"));
  }
  writeTogether(openJobDescription(job), folder);
  return "openjd run " + typedWord(spectral::utf8(target.folder / "template.json")) + " --job-param " +
         typedWord("file://" + spectral::utf8(target.folder / "parameters.json"));
}

}  // namespace metamer::farm
