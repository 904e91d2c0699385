// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace metamer::farm {

/// A file or folder that a job names once, so that a farm may put it elsewhere.
struct JobFile {
  enum class Flow { In, Out, InOut };
  std::string name;  ///< letters and digits: "Scene"
  std::filesystem::path path;
  Flow flow = Flow::In;
  bool isFolder = false;
};

/// A word of a command line: text as it stands, the place of a JobFile, or a task's own value.
struct Piece {
  enum class Kind { Text, File, Value };
  Kind kind = Kind::Text;
  std::string text;  ///< of a file or value its name
};
using Word = std::vector<Piece>;

/// A value that each task of a step has one of.
struct TaskValue {
  std::string name;
  std::vector<std::string> values;  ///< one a task
  bool isPath = false;              ///< absolute files, which a farm may put elsewhere
};

/// Calls of the job's program that do not wait for each other.
struct JobStep {
  std::string name;
  std::vector<TaskValue> values;  ///< of one length; none: one task
  std::vector<Word> words;        ///< behind the program
  std::string after;              ///< step that must be done before; empty: none
};

struct FarmJob {
  std::string name;
  std::string description;
  std::filesystem::path program;
  std::vector<JobFile> files;
  std::vector<JobStep> steps;
};

/// A job's folder and what it is written for.
struct JobTarget {
  enum class Engine { OpenJobDescription, Slurm };
  Engine engine = Engine::OpenJobDescription;
  std::filesystem::path folder;
};

/// Most tasks of a step: what Open Job Description lets a list have.
inline constexpr std::size_t kMostTasks = 1024;

/// Writes a job's files into a folder, which is made where it is not there.
///   Open Job Description 2023-09: template.json; parameters.json for `openjd run`, parameter_values.json for a bundle
///   Slurm: a script a step (an array where it has tasks), and submit.sh
/// @return the line to type next
/// @throws spectral::InputError: files that cannot be written, a step of more than kMostTasks tasks
std::string writeJob(const FarmJob& job, const JobTarget& target);

}  // namespace metamer::farm
