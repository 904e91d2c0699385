// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iostream>
#include <memory>

#include "checked_words.h"
#include "commands.h"
#include "exr_channels.h"
#include "farm_job.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/platform.h"
#include "metamer/spectral_ref/exr_film.h"
#include "metamer/spectral_ref/renderer.h"
#include "metamer/spectral_ref/scene_reader.h"

namespace metamer::spectral_ref {
namespace {

using farm::Piece;

struct JobArguments {
  std::string scene;
  std::string output;
  std::uint64_t samplesPerPixel = 0;
  std::uint64_t chunks = 0;
  std::vector<std::string> renderWords;
  farm::TargetOptions target;
};

/// Ranges of samples, as equal as whole blocks of those that belong together are.
/// @throws CLI::ValidationError where there are fewer blocks than chunks
SampleRanges chunksOf(std::uint64_t samples, std::uint64_t count) {
  const std::uint64_t blocks = (samples + kSamplesTogether - 1) / kSamplesTogether;
  if (count > blocks) {
    throw CLI::ValidationError("--chunks", std::to_string(count) + " are more than the " + std::to_string(blocks) +
                                               " whole blocks of " + std::to_string(kSamplesTogether) +
                                               " samples; name fewer, or more samples");
  }
  SampleRanges chunks;
  for (std::uint64_t k = 0; k < count; ++k) {
    chunks.push_back(
        {k * blocks / count * kSamplesTogether, std::min(samples, (k + 1) * blocks / count * kSamplesTogether)});
  }
  return chunks;
}

farm::Word text(const std::string& word) {
  return {{Piece::Kind::Text, word}};
}

farm::Word part(const Piece& first, const Piece& end) {
  return {{Piece::Kind::File, "Parts"}, {Piece::Kind::Text, "/part."}, first, {Piece::Kind::Text, "-"}, end,
          {Piece::Kind::Text, ".exr"}};
}

farm::JobStep renderStep(const JobArguments& arguments, const SampleRanges& chunks, farm::JobTarget::Engine engine) {
  const Piece first{Piece::Kind::Value, "First"};
  const Piece end{Piece::Kind::Value, "End"};
  farm::JobStep step{"Render", {{"First", {}, false}, {"End", {}, false}}, {}, ""};
  for (const auto& [begin, behind] : chunks) {
    step.values[0].values.push_back(std::to_string(begin));
    step.values[1].values.push_back(std::to_string(behind));
  }
  step.words = {text("render"),    {{Piece::Kind::File, "Scene"}},         text("-o"),      part(first, end),
                text("--samples"), {first, {Piece::Kind::Text, ":"}, end}, text("--resume")};
  step.words.push_back(text("--progress"));
  step.words.push_back(text(engine == farm::JobTarget::Engine::Slurm ? "lines" : "openjd"));
  for (const std::string& word : arguments.renderWords) {
    step.words.push_back(text(word));
  }
  return step;
}

farm::JobStep mergeStep(const JobArguments& arguments, const SampleRanges& chunks) {
  farm::JobStep step{"Merge", {}, {text("merge")}, "Render"};
  for (const auto& [begin, behind] : chunks) {
    step.words.push_back(part({Piece::Kind::Text, std::to_string(begin)}, {Piece::Kind::Text, std::to_string(behind)}));
  }
  step.words.push_back(text("-o"));
  step.words.push_back({{Piece::Kind::File, "Output"}});
  step.words.push_back(text("--expect"));
  step.words.push_back(text("0:" + std::to_string(arguments.samplesPerPixel)));
  return step;
}

void writeJob(const JobArguments& arguments) {
  const farm::JobTarget target = arguments.target.target();
  requireExr(arguments.output);
  spectral::requireWritable(spectral::pathOf(arguments.output));
  const SampleRanges chunks = chunksOf(arguments.samplesPerPixel, arguments.chunks);
  std::vector<std::string> words = {"render",         arguments.scene, "-o",
                                    arguments.output, "--samples",     rangesText({chunks.front()})};
  words.insert(words.end(), arguments.renderWords.begin(), arguments.renderWords.end());
  farm::requireUnderstood(addRender, words);
  // What a scene lacks is better known before the farm starts.
  readScene(spectral::pathOf(arguments.scene), spectral::DataLibrary::openDefault(spectral::readExrChannels));

  const std::filesystem::path scene = spectral::pathOf(arguments.scene);
  using Flow = farm::JobFile::Flow;
  const farm::FarmJob job{"render " + spectral::utf8(scene.stem()),
                          std::to_string(arguments.samplesPerPixel) + " samples a pixel of " +
                              spectral::utf8(scene.filename()) + " in " + std::to_string(chunks.size()) + " chunks",
                          spectral::programFolder() / "spectral_ref",
                          {{"Scene", scene, Flow::In, false},
                           {"Parts", target.folder / "parts", Flow::InOut, true},
                           {"Output", spectral::pathOf(arguments.output), Flow::Out, false}},
                          {renderStep(arguments, chunks, target.engine), mergeStep(arguments, chunks)}};
  const std::string next = farm::writeJob(job, target);
  std::cout << spectral::utf8(target.folder) << ": " << chunks.size() << " chunks and their merge; next: " << next
            << '\n';
}

}  // namespace

void addJob(CLI::App& application, std::vector<std::string> renderWords) {
  CLI::App* command = application.add_subcommand("job", "Write a render in chunks as a job for a farm");
  const auto arguments = std::make_shared<JobArguments>();
  arguments->renderWords = std::move(renderWords);
  command->add_option("SCENE", arguments->scene, "Scene file (YAML)")->required();
  command->add_option("-o,--output", arguments->output, "Picture that the job ends with, .exr")->required();
  command->add_option("--spp", arguments->samplesPerPixel, "Samples a pixel")
      ->required()
      ->check(CLI::Range(std::uint64_t{1}, kMostSamples));
  command->add_option("--chunks", arguments->chunks, "Tasks that the samples are shared out to")
      ->required()
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{farm::kMostTasks}));
  arguments->target.addTo(*command);
  command->footer("After --: options of render for every chunk: spectral_ref job ... -- --restir lanes");
  command->callback([arguments] { writeJob(*arguments); });
}

}  // namespace metamer::spectral_ref
