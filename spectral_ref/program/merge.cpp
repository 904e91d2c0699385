// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include "commands.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral_ref/exr_film.h"

namespace metamer::spectral_ref {
namespace {

struct MergeArguments {
  std::vector<std::string> files;
  std::string output;
  bool keepsState = false;
  std::string expected;
};

/// The parts of FIRST:END that no range covers.
SampleRanges missingOf(const std::array<std::uint64_t, 2>& expected, const SampleRanges& ranges) {
  SampleRanges missing;
  auto [first, end] = expected;
  for (const auto& [begin, behind] : ranges) {
    if (begin > first && first < end) {
      missing.push_back({first, std::min(begin, end)});
    }
    first = std::max(first, behind);
  }
  if (first < end) {
    missing.push_back({first, end});
  }
  return missing;
}

/// @throws spectral::InputError where samples are missing, or more than was expected
void checkComplete(const MergeArguments& arguments, const SampleRanges& ranges) {
  const std::array<std::uint64_t, 2> expected = parseRange("--expect", arguments.expected);
  const SampleRanges missing = missingOf(expected, ranges);
  if (!missing.empty()) {
    throw spectral::InputError(
        arguments.output, "samples", rangesText(missing),
        "are missing of " + arguments.expected + "; render them: --samples " + rangesText({missing.front()}));
  }
  if (ranges.front()[0] < expected[0] || ranges.back()[1] > expected[1]) {
    throw spectral::InputError(arguments.output, "samples", rangesText(ranges),
                               "are more than " + arguments.expected + "; leave a file out, or expect them");
  }
}

void merge(const MergeArguments& arguments) {
  requireExr(arguments.output);
  spectral::requireWritable(spectral::pathOf(arguments.output));
  auto [film, notes] = readExrState(spectral::pathOf(arguments.files.front()));
  for (std::size_t i = 1; i < arguments.files.size(); ++i) {
    const std::string& file = arguments.files[i];
    const auto [other, otherNotes] = readExrState(spectral::pathOf(file));
    for (std::size_t n = 0; n < notes.size(); ++n) {
      if (n >= otherNotes.size() || notes[n] != otherNotes[n]) {
        throw spectral::InputError(file, notes[n].first, n < otherNotes.size() ? otherNotes[n].second : "",
                                   "differs from the first file's, '" + notes[n].second +
                                       "'; merge renders of one scene with the same options");
      }
    }
    mergeFilm(film, other, file);
  }
  if (!arguments.expected.empty()) {
    checkComplete(arguments, film.ranges());
  }
  const bool withReplicates = std::any_of(
      notes.begin(), notes.end(), [](const auto& note) { return note.first == "restir" && note.second != "off"; });
  writeExr(film, notes, spectral::pathOf(arguments.output), arguments.keepsState, withReplicates);
  if (film.refused > 0) {
    warn(arguments.output + ": " + std::to_string(film.refused) +
         " samples were no finite number and are left out; the picture is too dark by their share");
  }
}

}  // namespace

void addMerge(CLI::App& application) {
  CLI::App* command =
      application.add_subcommand("merge", "Add up sample ranges: bit by bit the picture of one longer render");
  const auto arguments = std::make_shared<MergeArguments>();
  command->add_option("FILE", arguments->files, "Pictures rendered with --samples")->required()->expected(1, -1);
  command->add_option("-o,--output", arguments->output, "Picture to write, .exr")->required();
  command->add_flag("--keep-state", arguments->keepsState, "Keep the exact sums, to merge on later");
  command->add_option(
      "--expect", arguments->expected,
      "FIRST:END, the samples that must be there; else nothing is written, and those missing are named");
  command->callback([arguments] { merge(*arguments); });
}

}  // namespace metamer::spectral_ref
