// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include "apply/frames.h"
#include "apply/sequence.h"
#include "apply/transform.h"
#include "job/job.h"
#include "library.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"

namespace metamer::lutgen {
namespace {

using farm::Piece;

struct Arguments {
  std::string transform;
  std::vector<std::string> pictures;
  std::string frames;
  int framesATask = 10;
  std::vector<std::string> applyWords;
  farm::TargetOptions target;
};

/// Frames as a word of a command line: "1001-1010" or "1,3,5".
std::string frameWord(const std::vector<int>& frames) {
  std::string word = framesText(frames);
  word.erase(std::remove(word.begin(), word.end(), ' '), word.end());
  return word;
}

std::vector<std::string> tasksOf(const std::vector<Frame>& frames, int framesATask) {
  std::vector<std::string> tasks;
  std::vector<int> together;
  for (const Frame& frame : frames) {
    together.push_back(frame.number);
    if (together.size() == static_cast<std::size_t>(framesATask) || &frame == &frames.back()) {
      tasks.push_back(frameWord(together));
      together.clear();
    }
  }
  return tasks;
}

/// Where a name's files lie: a folder that a farm may put elsewhere.
farm::JobFile folderOf(const std::string& name, const std::filesystem::path& pattern, farm::JobFile::Flow flow) {
  return {name, std::filesystem::absolute(pattern).parent_path(), flow, true};
}

void write(const Arguments& arguments) {
  const farm::JobTarget target = arguments.target.target();
  for (const std::string& name : arguments.pictures) {
    if (!FramePattern::in(name)) {
      throw spectral::InputError(name, "frames", "", "are no sequence; write the number's place as ####");
    }
  }
  const std::vector<Frame> frames = framesOf(arguments.pictures[0], arguments.pictures[1], arguments.frames);
  const std::vector<std::string> tasks = tasksOf(frames, arguments.framesATask);
  std::vector<std::string> words = {"apply",    arguments.transform, arguments.pictures[0], arguments.pictures[1],
                                    "--frames", tasks.front()};
  words.insert(words.end(), arguments.applyWords.begin(), arguments.applyWords.end());
  requireUnderstood(addApply, words);
  TransformRequest request;
  request.transform = arguments.transform;
  appliedTransform(request, openLibrary(), ocio::ConfigSource::environment());

  const std::filesystem::path transform = spectral::pathOf(arguments.transform);
  const std::filesystem::path input = spectral::pathOf(arguments.pictures[0]);
  const std::filesystem::path output = spectral::pathOf(arguments.pictures[1]);
  farm::JobStep step{"Apply", {{"Frames", tasks, false}}, {}, ""};
  step.words = {plain("apply"),
                {{Piece::Kind::File, "Transform"}},
                {{Piece::Kind::File, "Input"}, {Piece::Kind::Text, "/" + spectral::utf8(input.filename())}},
                {{Piece::Kind::File, "Result"}, {Piece::Kind::Text, "/" + spectral::utf8(output.filename())}},
                plain("--frames"),
                {{Piece::Kind::Value, "Frames"}}};
  for (const std::string& word : arguments.applyWords) {
    step.words.push_back(plain(word));
  }
  const farm::FarmJob job{
      "apply " + spectral::utf8(transform.stem()),
      spectral::formatted("%zu frames of %s through %s", frames.size(), spectral::utf8(input.filename()).c_str(),
                          spectral::utf8(transform.filename()).c_str()),
      lutgenProgram(),
      {{"Transform", transform, farm::JobFile::Flow::In, false},
       folderOf("Input", input, farm::JobFile::Flow::In),
       folderOf("Result", output, farm::JobFile::Flow::Out)},
      {step}};
  const std::string next = farm::writeJob(job, target);
  summarise(spectral::formatted("%s: %zu frames in %zu tasks; next: %s", spectral::utf8(target.folder).c_str(),
                                frames.size(), tasks.size(), next.c_str()));
}

}  // namespace

void addJobApply(CLI::App& job, const std::vector<std::string>& words) {
  CLI::App* command = job.add_subcommand("apply", "Frames of a sequence, so many a task");
  const auto arguments = std::make_shared<Arguments>();
  arguments->applyWords = words;
  command->add_option("TRANSFORM", arguments->transform, "Recipe (.yaml), or a LUT file that OpenColorIO reads")
      ->required();
  command->add_option("PICTURES", arguments->pictures, "IN OUT: shot.####.exr relit.####.exr")->required()->expected(2);
  command->add_option("--frames", arguments->frames, "Frames: 1001-1100, 1-100x5; left out: all that are there");
  command->add_option("--frames-per-task", arguments->framesATask, "10 by default")->check(CLI::Range(1, 1000000));
  arguments->target.addTo(*command);
  command->footer("After --: options of apply for every task: lutgen job apply ... -- --engine map");
  command->callback([arguments] { write(*arguments); });
}

}  // namespace metamer::lutgen
