// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "farm_job.h"

namespace metamer::farm {

/// A file of a job's folder.
struct JobText {
  std::string name;
  std::string text;
};

/// For the Open Job Description, version jobtemplate-2023-09.
std::vector<JobText> openJobDescription(const FarmJob& job);

/// For Slurm's sbatch. @param folder  where the scripts will lie, and their logs
std::vector<JobText> slurmScripts(const FarmJob& job, const std::filesystem::path& folder);

/// A word that means itself to a POSIX shell, in quotes where it needs them.
std::string typedWord(const std::string& text);

}  // namespace metamer::farm
