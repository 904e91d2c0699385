// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>

#include "build_identity.h"
#include "commands.h"
#include "exr_channels.h"
#include "guide_dump.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/interruption.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral_ref/checkpoint.h"
#include "metamer/spectral_ref/exr_film.h"
#include "metamer/spectral_ref/picture_error.h"
#include "metamer/spectral_ref/renderer.h"
#include "metamer/spectral_ref/scene_reader.h"
#include "progress.h"

namespace metamer::spectral_ref {
namespace {

using spectral::InputError;
using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kDefaultSamples = 64;
/// Between two looks at the clock, the error and the signal.
constexpr double kSecondsAStep = 0.25;
/// Of each replicate two.
constexpr std::uint64_t kFewestToMeasure = 2 * kReplicates;

struct RenderArguments {
  std::string scene;
  std::string output;
  std::uint64_t samplesPerPixel = 0;
  double seconds = 0;
  double targetError = 0;
  std::string range;
  std::string guiding = "off";
  std::string restir = "off";
  std::string lightRule = "place";
  std::uint32_t seed = 0;
  int threads = 0;
  bool resume = false;
  std::string progress = "auto";
  double checkpointSeconds = 30;
  std::string guideDump;
  std::vector<std::string> guidePixels;
};

volatile std::sig_atomic_t stopSignal = 0;  // NOLINT: a signal handler can reach nothing else
extern "C" void onSignal(int signal) {
  stopSignal = signal;
}

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Two whole numbers with a separator between.
template <typename Number>
std::optional<std::array<Number, 2>> parsePair(const std::string& text, char separator) {
  std::array<Number, 2> pair{};
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, pair[0]);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != separator) {
    return std::nullopt;
  }
  const auto second = std::from_chars(first.ptr + 1, end, pair[1]);
  return second.ec == std::errc() && second.ptr == end ? std::optional(pair) : std::nullopt;
}

std::array<int, 2> parsePixel(const std::string& text, const FilmSettings& film) {
  const auto pixel = parsePair<int>(text, ',');
  if (!pixel || (*pixel)[0] < 0 || (*pixel)[1] < 0 || (*pixel)[0] >= film.width || (*pixel)[1] >= film.height) {
    throw CLI::ValidationError("--guide-pixel", "'" + text + "' must be X,Y within the picture of " +
                                                    std::to_string(film.width) + " x " + std::to_string(film.height));
  }
  return *pixel;
}

class RenderJob {
 public:
  explicit RenderJob(const RenderArguments& arguments)
      : m_arguments(arguments),
        m_checkpoint(checkOutput(arguments)),
        m_library(spectral::DataLibrary::openDefault(spectral::readExrChannels)),
        m_scene(readScene(spectral::pathOf(arguments.scene), m_library)) {
    for (const std::string& warning : m_scene.warnings) {
      warn(warning);
    }
    if (!arguments.range.empty()) {
      m_range = parseRange("--samples", arguments.range);
    } else if (arguments.samplesPerPixel > 0) {
      m_range[1] = arguments.samplesPerPixel;
    } else if (arguments.seconds > 0 || arguments.targetError > 0) {
      m_range[1] = kMostSamples;
    } else {
      m_range[1] = kDefaultSamples;
    }
    for (const std::string& text : arguments.guidePixels) {
      m_guidePixels.push_back(parsePixel(text, m_scene.film));
    }
    if (!arguments.guideDump.empty() && arguments.guiding != "on") {
      throw CLI::ValidationError("--guide-dump", "needs --guiding on");
    }
  }

  void run() {
    if (isThere()) {
      warn(m_arguments.output + ": samples " + m_arguments.range + " are there already");
      return;
    }
    prepare();
    std::signal(SIGINT, onSignal);
    std::signal(SIGTERM, onSignal);
    const bool isFinished = renderUntilDone();
    if (!isFinished) {
      const bool isSaved = saveCheckpoint();
      warn("stopped after " + std::to_string(m_renderer->nextSample() - m_range[0]) + " samples; " +
           (isSaved ? "go on with --resume" : "nothing is saved: no checkpoint could be written"));
      spectral::endBySignal(stopSignal);
    }
    spectral::endCleanlyBySignals("spectral_ref");
    if (!m_arguments.guideDump.empty()) {
      m_renderer->render(m_range[1], 0);  // learns, where a resumed render had nothing left to do
      writeGuideDump(*m_renderer, m_guidePixels, spectral::pathOf(m_arguments.guideDump));
    }
    const Film& film = m_renderer->film();
    writeExr(film, notes(), spectral::pathOf(m_arguments.output), !m_arguments.range.empty(),
             m_arguments.restir != "off");
    if (film.refused > 0) {
      warn(m_arguments.output + ": " + std::to_string(film.refused) +
           " samples were no finite number and are left out; the picture is too dark by their share");
    }
    if (film.samples() == m_range[1] - m_range[0]) {
      std::error_code none;
      std::filesystem::remove(m_checkpoint, none);
    } else {
      saveCheckpoint();  // more may be asked for later
    }
  }

 private:
  /// Says before hours of work what could not be written after them. @return the checkpoint's file
  static std::filesystem::path checkOutput(const RenderArguments& arguments) {
    requireExr(arguments.output);
    spectral::requireWritable(spectral::pathOf(arguments.output));
    spectral::requireWritable(spectral::pathOf(arguments.guideDump));
    return spectral::pathOf(arguments.output + ".checkpoint");
  }

  /// Whether a part that was asked for is rendered already: a task of a farm may be run again.
  /// @throws InputError where the file is something else
  bool isThere() const {
    std::error_code none;
    const std::filesystem::path file = spectral::pathOf(m_arguments.output);
    if (!m_arguments.resume || m_arguments.range.empty() || !std::filesystem::exists(file, none)) {
      return false;
    }
    const auto [film, notes] = readExrState(file);
    if (notes != this->notes() || film.ranges() != SampleRanges{m_range}) {
      throw InputError(m_arguments.output, "samples", rangesText(film.ranges()),
                       "are of another scene, build, options or range; delete the file, or name another");
    }
    return true;
  }

  /// The renderer, with what a checkpoint holds.
  void prepare() {
    RenderOptions options;
    options.seed = m_arguments.seed;
    options.guiding = m_arguments.guiding == "on";
    options.restir = m_arguments.restir == "hero"    ? Restir::Hero
                     : m_arguments.restir == "lanes" ? Restir::Lanes
                                                     : Restir::Off;
    options.lightRule = m_arguments.lightRule == "power" ? LightRule::Power : LightRule::Place;
    m_renderer = std::make_unique<Renderer>(m_scene, options, m_range[0], m_arguments.threads);
    std::error_code none;
    if (m_arguments.resume && std::filesystem::exists(m_checkpoint, none)) {
      readCheckpoint(m_checkpoint,
                     [this](const ByteSource& state) { m_renderer->restore(state, spectral::utf8(m_checkpoint)); });
      if (m_renderer->nextSample() > m_range[1]) {
        throw InputError(spectral::utf8(m_checkpoint), "samples", std::to_string(m_renderer->nextSample()),
                         "are more than asked for (" + std::to_string(m_range[1]) + "); ask for more or delete it");
      }
    }
  }

  /// @return false where a signal stopped it
  bool renderUntilDone() {
    const Clock::time_point start = Clock::now();
    const std::uint64_t begun = m_renderer->nextSample();
    Clock::time_point saved = start;
    Clock::time_point measured = start;
    std::optional<double> error;
    std::uint64_t expectedEnd = m_arguments.targetError > 0 ? std::max(begun, kFewestToMeasure) : m_range[1];
    const Eigen::Matrix3d toXyz = xyzFromColour(m_scene.film);
    Progress progress(progressFormNamed(m_arguments.progress));
    while (m_renderer->nextSample() < m_range[1]) {
      double step = kSecondsAStep;
      if (m_arguments.seconds > 0) {
        step = std::min(step, m_arguments.seconds - secondsSince(start));
        if (step <= 0) {
          break;
        }
      }
      m_renderer->render(std::min(m_range[1], expectedEnd), step);
      const double elapsed = secondsSince(start);
      const auto done = static_cast<double>(m_renderer->nextSample() - begun);
      // The error is measured ever more rarely, at most a tenth of the time goes into it; but also where the last one
      // lets expect that the render is done, so that it stops then.
      const bool isMeasured = secondsSince(measured) > 10.0 * m_secondsToMeasure;
      if ((progress.isDue() || m_arguments.targetError > 0) &&
          (isMeasured || m_renderer->nextSample() >= expectedEnd) && m_renderer->film().samples() >= kFewestToMeasure) {
        const Clock::time_point before = Clock::now();
        error = pictureError(m_renderer->film(), toXyz);
        measured = Clock::now();
        m_secondsToMeasure = secondsSince(before);
        if (m_arguments.targetError > 0 && *error <= m_arguments.targetError) {
          break;
        }
        expectedEnd = samplesFor(*error);
      }
      showProgress(progress, elapsed, done, static_cast<double>(m_range[1] - begun), error);
      if (stopSignal != 0) {
        return false;
      }
      if (secondsSince(saved) > m_arguments.checkpointSeconds) {
        saveCheckpoint();
        saved = Clock::now();
      }
    }
    return true;
  }

  /// Samples at which the target error is to be expected: noise falls with their root. The step is no shorter than a
  /// fiftieth, for the error is an estimate itself.
  std::uint64_t samplesFor(double error) const {
    if (!(m_arguments.targetError > 0)) {
      return m_range[1];
    }
    const auto taken = static_cast<double>(m_renderer->nextSample());
    const double ratio = std::isfinite(error) ? error / m_arguments.targetError : std::sqrt(2.0);
    const double wanted = std::ceil(taken * ratio * ratio);
    // A few samples may say far too many: then it is looked at again before.
    const double most = std::min(4.0 * taken, static_cast<double>(m_range[1]));
    const double next = std::min(std::max(wanted, std::ceil(1.02 * taken)), most);
    return static_cast<std::uint64_t>(next);
  }

  void showProgress(Progress& progress, double elapsed, double done, double wanted, std::optional<double> error) const {
    double share = done / wanted;
    if (m_arguments.seconds > 0) {
      share = std::max(share, elapsed / m_arguments.seconds);
    }
    if (m_arguments.targetError > 0 && error && *error > 0) {
      // Noise falls with the root of the samples.
      share = std::max(share, std::min(1.0, std::pow(m_arguments.targetError / *error, 2.0)));
    }
    progress.show(share, m_renderer->film().samples(), error, share > 0 ? elapsed * (1.0 - share) / share : NAN);
  }

  /// A checkpoint that cannot be written does not end the render: it is said once.
  bool saveCheckpoint() {
    try {
      writeCheckpoint([this](const ByteSink& sink) { m_renderer->writeState(sink); }, m_checkpoint);
      return true;
    } catch (const std::exception& error) {
      if (!m_hasWarned) {
        warn(std::string(error.what()) + " (the render goes on without checkpoints)");
      }
      m_hasWarned = true;
      return false;
    }
  }

  FilmNotes notes() const {
    char fingerprint[17];
    std::snprintf(fingerprint, sizeof fingerprint, "%016llx", static_cast<unsigned long long>(m_scene.fingerprint));
    return {{"scene", fingerprint},
            {"seed", std::to_string(m_arguments.seed)},
            {"wavelengths", std::to_string(m_scene.integrator.wavelengths)},
            {"guiding", m_arguments.guiding},
            {"restir", m_arguments.restir},
            {"lights", m_arguments.lightRule},
            {"version", METAMER_VERSION},
            {"build", METAMER_BUILD_IDENTITY}};
  }

  RenderArguments m_arguments;
  std::filesystem::path m_checkpoint;
  spectral::DataLibrary m_library;
  Scene m_scene;
  std::array<std::uint64_t, 2> m_range{};
  std::vector<std::array<int, 2>> m_guidePixels;
  std::unique_ptr<Renderer> m_renderer;
  double m_secondsToMeasure = 0;
  bool m_hasWarned = false;
};

}  // namespace

std::array<std::uint64_t, 2> parseRange(const std::string& flag, const std::string& text) {
  const auto range = parsePair<std::uint64_t>(text, ':');
  if (!range || (*range)[0] >= (*range)[1] || (*range)[1] > kMostSamples) {
    throw CLI::ValidationError(flag, "'" + text + "' must be FIRST:END, such as 0:64");
  }
  return *range;
}

void requireExr(const std::string& file) {
  const std::string extension = spectral::utf8(spectral::pathOf(file).extension());
  if (extension != ".exr") {
    throw InputError(file, "extension", extension, "must be .exr");
  }
}

void addRender(CLI::App& application) {
  CLI::App* command = application.add_subcommand("render", "Render a scene file to a multichannel OpenEXR picture");
  const auto arguments = std::make_shared<RenderArguments>();
  command->add_option("SCENE", arguments->scene, "Scene file (YAML)")->required();
  command->add_option("-o,--output", arguments->output, "Picture to write, .exr")->required();
  auto* samples = command->add_option("--spp", arguments->samplesPerPixel, "Samples a pixel; 64 by default")
                      ->check(CLI::Range(std::uint64_t{1}, kMostSamples));
  auto* seconds =
      command->add_option("--seconds", arguments->seconds, "Render for about this long")->check(CLI::Range(0.001, 1e9));
  auto* error = command
                    ->add_option("--target-error", arguments->targetError,
                                 "Render until noise is this CIEDE2000 on average over the picture")
                    ->check(CLI::Range(1e-6, 100.0));
  auto* range = command->add_option("--samples", arguments->range,
                                    "Samples FIRST:END alone, with exact sums in the file, for spectral_ref merge");
  samples->excludes(range);
  seconds->excludes(range);
  error->excludes(range);
  command->add_option("--guiding", arguments->guiding, "Learn which wavelengths matter, pixel by pixel")
      ->check(CLI::IsMember({"on", "off"}));
  command->add_option("--restir", arguments->restir, "Resample direct light, by the hero wavelength or all lanes")
      ->check(CLI::IsMember({"off", "hero", "lanes"}));
  command
      ->add_option("--lights", arguments->lightRule,
                   "Choose lights by what they may give a point, or by power alone, to compare with")
      ->check(CLI::IsMember({"place", "power"}));
  command->add_option("--seed", arguments->seed, "Another seed, other noise; 0 by default");
  command->add_option("--threads", arguments->threads, "Threads; all by default. Changes no bit of the picture")
      ->check(CLI::Range(1, 4096));
  command->add_flag(
      "--resume", arguments->resume,
      "Go on from OUTPUT.checkpoint where there is one; with --samples, nothing to do where OUTPUT has them");
  command
      ->add_option("--progress", arguments->progress,
                   "auto: a line on a terminal, else as lines; lines: one every half minute, for a log; openjd: as "
                   "engines of Open Job Description read it; off")
      ->check(CLI::IsMember({"auto", "lines", "openjd", "off"}));
  command->add_option("--checkpoint", arguments->checkpointSeconds, "Seconds between checkpoints; 30 by default")
      ->check(CLI::Range(0.0, 1e9));
  auto* dump = command->add_option("--guide-dump", arguments->guideDump,
                                   "Also write what guiding has learnt about --guide-pixel, as JSON");
  auto* pixels = command->add_option("--guide-pixel", arguments->guidePixels, "X,Y from the top left (repeatable)");
  dump->needs(pixels);
  pixels->needs(dump);
  command->callback([arguments] { RenderJob(*arguments).run(); });
}

}  // namespace metamer::spectral_ref
