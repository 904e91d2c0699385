// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>

#include "engines.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/text.h"

namespace metamer::farm {
namespace {

/// Text that stands for itself within double quotes.
std::string withinQuotes(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    escaped += std::string("\"$`\\").find(c) == std::string::npos ? std::string(1, c) : std::string("\\") + c;
  }
  return escaped;
}

std::string textOf(const Word& word) {
  if (word.size() == 1 && word[0].kind == Piece::Kind::Text) {
    return typedWord(word[0].text);
  }
  std::string text = "\"";
  for (const Piece& piece : word) {
    switch (piece.kind) {
      case Piece::Kind::Text:
        text += withinQuotes(piece.text);
        break;
      case Piece::Kind::File:
        text += "${" + piece.text + "}";
        break;
      case Piece::Kind::Value:
        text += "${" + piece.text + "[$SLURM_ARRAY_TASK_ID]}";
        break;
    }
  }
  return text + "\"";
}

/// Comments of sbatch end a value at white space unless it is quoted.
std::string directive(const std::string& text) {
  return "#SBATCH " + text + "\n";
}

std::string scriptOf(const FarmJob& job, const JobStep& step, const std::filesystem::path& folder) {
  const bool isArray = !step.values.empty();
  std::string text = "#!/bin/bash\n";
  text += directive("--job-name=\"" + job.name + " " + step.name + "\"");
  text += directive(
      "--output=\"" +
      spectral::utf8(folder / "logs" / (spectral::lowerCase(step.name) + (isArray ? ".%a" : "") + ".log")) + "\"");
  text += directive("--open-mode=append");
  text += directive("--requeue");
  if (isArray) {
    text += directive("--array=0-" + std::to_string(step.values.front().values.size() - 1));
  }
  text += "set -euo pipefail\n";
  text += "Program=" + typedWord(spectral::utf8(job.program)) + "\n";
  for (const JobFile& file : job.files) {
    text += file.name + "=" + typedWord(spectral::utf8(std::filesystem::absolute(file.path).lexically_normal())) + "\n";
  }
  for (const TaskValue& value : step.values) {
    text += value.name + "=(";
    for (const std::string& one : value.values) {
      text += (&one == &value.values.front() ? "" : " ") + typedWord(one);
    }
    text += ")\n";
  }
  text += "exec \"$Program\"";
  for (const Word& word : step.words) {
    text += " " + textOf(word);
  }
  return text + "\n";
}

}  // namespace

std::string typedWord(const std::string& text) {
  const bool isPlain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string("_-+.,:/=@%").find(static_cast<char>(c)) != std::string::npos;
  });
  if (isPlain) {
    return text;
  }
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  }
  return quoted + "'";
}

std::vector<JobText> slurmScripts(const FarmJob& job, const std::filesystem::path& folder) {
  std::vector<JobText> texts;
  std::string submit =
      "#!/bin/sh\n"
      "# " +
      job.description +
      "\n"
      "# Options for sbatch may follow.\n"
      "set -eu\n"
      "cd \"$(dirname \"$0\")\"\n";
  for (const JobStep& step : job.steps) {
    const std::string name = spectral::lowerCase(step.name);
    texts.push_back({name + ".sh", scriptOf(job, step, folder)});
    submit += name + "=$(sbatch --parsable " +
              (step.after.empty()
                   ? ""
                   : "--dependency=\"afterok:$" + spectral::lowerCase(step.after) + "\" --kill-on-invalid-dep=yes ") +
              "\"$@\" " + name + ".sh)\n";
    submit += "echo \"" + step.name + ": job $" + name + "\"\n";
  }
  texts.push_back({"submit.sh", submit});
  return texts;
}

}  // namespace metamer::farm
