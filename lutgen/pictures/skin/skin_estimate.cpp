// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <memory>
#include <mutex>
#include <optional>

#include "apply/frame_report.h"
#include "apply/frames.h"
#include "apply/picture_clues.h"
#include "library.h"
#include "metamer/skin/skin_estimator.h"
#include "metamer/skin/skin_network.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/naming_file.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "positive_number.h"
#include "run.h"
#include "skin/skin_commands.h"
#include "skin/skin_maps.h"
#include "stage/stage_json.h"

namespace metamer::lutgen {
namespace {

namespace fs = std::filesystem;
using spectral::InputError;

struct EstimateOptions {
  std::string albedo;
  std::string output;
  std::string frames;
  std::string pictureSpace;
  std::string layer;
  std::string compression;
  std::string json;
  std::string method = "map";
  SkinCapture capture;
  std::int64_t mostPixels = std::int64_t{1} << 31;
  int threads = 0;
};

/// What was found in all frames.
struct Findings {
  std::size_t pixels = 0;
  std::size_t skins = 0;        ///< that a skin explains but for a tenth of their size
  std::size_t scaled = 0;       ///< brighter or darker than any skin
  std::size_t unusable = 0;     ///< black, negative on the whole, or no number
  std::array<double, 5> sum{};  ///< over skins

  void add(const std::vector<float>& rgb, const std::vector<skin::SkinPixel>& found) {
    constexpr double kOfSize = 0.1;
    pixels += found.size();
    for (std::size_t i = 0; i < found.size(); ++i) {
      const skin::SkinPixel& pixel = found[i];
      const auto square = [](const float* three) {
        const Eigen::Vector3d numbers = Eigen::Vector3f::Map(three).cast<double>();
        return numbers.squaredNorm();
      };
      if (pixel.gain == 0) {
        ++unusable;
      } else if (square(pixel.residual.data()) <= kOfSize * kOfSize * square(&rgb[3 * i])) {
        ++skins;
        for (std::size_t k = 0; k < 5; ++k) {
          sum[k] += static_cast<double>(pixel.skin[k]);
        }
      }
      scaled += pixel.gain != 0 && pixel.gain != 1 ? 1 : 0;
    }
  }
};

class Estimation {
 public:
  explicit Estimation(const EstimateOptions& options)
      : m_options(options), m_library(openLibrary()), m_config(ocio::ConfigSource::environment()) {
    m_capture = options.capture.orElse(kUsualCapture);
    if (!options.pictureSpace.empty()) {
      m_stated = pictureSpaceNamed(options.pictureSpace, "--picture-space", m_library, m_config);
    }
  }

  /// Reads the header of the first picture, and makes what all need.
  void begin(const fs::path& albedo, int threads) {
    AnyPicture picture(albedo, m_options.mostPixels);
    m_bytes = 6 * picture.bytes();
    m_space = spaceOf(picture, layerOf(picture, albedo), albedo);
    if (m_options.method != "map") {
      beginNetwork();
      return;
    }
    spectral::namingFile(m_capture.illuminant, [&] {
      m_estimator.emplace(m_library, skinView(m_capture, m_space->linear, m_library), threads);
    });
    const skin::SkinIdentification told = m_estimator->identification();
    if (!told.separatesBloodFromMelanin) {
      note(
          {spectral::formatted("%s do not tell blood from melanin: a colour explains %.0f %% of melanin and %.0f %% of "
                               "blood, the rest is what people have on average",
                               m_capture.text().c_str(), 100 * told.explained[0], 100 * told.explained[1])});
    }
  }

  /// That a frame takes, as the first does.
  std::uint64_t bytes() const { return m_bytes; }

  void estimate(const Frame& frame, int threads) {
    AnyPicture picture(frame.input, m_options.mostPixels);
    const ColourLayer layer = layerOf(picture, frame.input);
    if (const PictureSpace own = spaceOf(picture, layer, frame.input); own.name != m_space->name) {
      throw InputError(
          spectral::utf8(frame.input), "colour space", own.name,
          "is another than that of the frames before, " + m_space->name + "; state one: --picture-space NAME");
    }
    const std::vector<int> channels(layer.channels.begin(), layer.channels.end());
    SkinMapsHeader header{m_capture, {}};
    for (const int channel : channels) {
      header.channels.push_back(picture.spec(layer.part).channelnames[static_cast<std::size_t>(channel)]);
    }
    picture.load();
    std::vector<float> rgb = picture.values(layer.part, channels);
    changeColours(rgb, m_space->decode);
    std::vector<skin::SkinPixel> pixels(rgb.size() / 3);
    if (m_network) {
      m_network->estimate(rgb, pixels, threads);
    } else {
      m_estimator->estimate(rgb, pixels, threads);
    }
    const auto first = picture.spec(layer.part).nchannels - 3;
    picture.exchange(layer.part, channels, {kSkinChannels.begin(), kSkinChannels.end()});
    setSkinMapsHeader(picture, layer.part, header);
    picture.describe("Linear", chromaticitiesOf(m_space->linear), layer.part);
    picture.plan(frame.output, {}, nullptr, compressionFor(picture, layer.part));
    picture.put(layer.part, first, skinNumbers(pixels));
    picture.save(frame.output, threads);
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_findings.add(rgb, pixels);
  }

  void report(std::size_t frames) const {
    note({m_notes.begin(), m_notes.end()});
    const double all = static_cast<double>(std::max<std::size_t>(m_findings.pixels, 1));
    if (!m_options.json.empty()) {
      writeJson(spectral::pathOf(m_options.json), json());
    }
    summarise(spectral::formatted(
        "%s: %zu %s, %.0f %% of the pixels skin%s, %s, %s", m_options.output.c_str(), frames,
        frames == 1 ? "picture" : "frames", 100 * static_cast<double>(m_findings.skins) / all,
        m_findings.unusable > 0 ? spectral::formatted(", %zu black or no number", m_findings.unusable).c_str() : "",
        m_capture.text().c_str(), m_space->name.c_str()));
  }

 private:
  void beginNetwork() {
    if (m_capture.text() != kUsualCapture.text()) {
      throw InputError("--method", "network", m_capture.text(),
                       "is not what it was trained for, " + kUsualCapture.text() + "; use --method map");
    }
    const bool isSpectral = m_options.method == "network";
    m_network.emplace(m_library, m_space->linear,
                      isSpectral ? skin::SkinNetwork::Loss::Spectral : skin::SkinNetwork::Loss::Rgb);
  }

  ColourLayer layerOf(const AnyPicture& picture, const fs::path& file) const {
    if (hasSkinMaps(picture)) {
      throw InputError(spectral::utf8(file), "channels", "skin",
                       "are there already; give the albedo, or edit these maps");
    }
    LayerRequest request;
    if (!m_options.layer.empty()) {
      request.layers = {m_options.layer};
    }
    const std::vector<ColourLayer> layers = chooseLayers(picture.facts(), request, spectral::utf8(file));
    if (layers.size() > 1) {
      throw InputError(spectral::utf8(file), "layers", "", "are several (views); name one: --layer NAME");
    }
    return layers[0];
  }

  PictureSpace spaceOf(const AnyPicture& picture, const ColourLayer& layer, const fs::path& file) {
    if (m_stated) {
      return *m_stated;
    }
    const SpaceClues clues = cluesOf(picture, layer);
    std::string doubt;
    const auto said = pictureSpaceOf(clues, spectral::utf8(file), m_library, doubt);
    if (said) {
      if (!doubt.empty()) {
        addNote(doubt);
      }
      return *said;
    }
    const char* taken = clues.isFloat ? "Rec.709" : "sRGB";
    addNote(m_options.albedo + ": it does not say what its pixels are: taken as " + taken +
            "; --picture-space names what they are");
    return pictureSpaceNamed(taken, m_options.albedo, m_library, ocio::ConfigSource());
  }

  /// Maps must come back as they were written.
  std::string compressionFor(const AnyPicture& picture, int part) {
    static const std::set<std::string> lossy = {"pxr24", "b44", "b44a", "dwaa", "dwab"};
    const std::string own = picture.text(part, "compression");
    const std::string wanted = m_options.compression.empty() ? own : m_options.compression;
    const std::string kind = wanted.substr(0, wanted.find(':'));
    if (lossy.count(kind) == 0) {
      return m_options.compression;
    }
    if (!m_options.compression.empty()) {
      throw InputError("--compression", "name", wanted,
                       "loses bits, which maps need; write zip, zips, piz, rle or none");
    }
    addNote(m_options.albedo + ": its compression, " + kind + ", loses bits: the maps are written with zip");
    return "zip";
  }

  void addNote(const std::string& text) {
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_notes.insert(text);
  }

  Json json() const {
    Json mean;
    Json explained;
    skin::SkinIdentification told;
    if (m_estimator) {
      told = m_estimator->identification();
    }
    for (std::size_t k = 0; k < 5; ++k) {
      const std::string name = std::string(kSkinChannels[k]).substr(5);
      mean[name] =
          m_findings.skins > 0 ? Json(m_findings.sum[k] / static_cast<double>(m_findings.skins)) : Json(nullptr);
      if (m_estimator) {
        explained[name] = told.explained[k];
      }
    }
    return {{"illuminant", m_capture.illuminant},
            {"observer", m_capture.observer},
            {"space", m_space->name},
            {"pixels", m_findings.pixels},
            {"skin_pixels", m_findings.skins},
            {"beyond_the_brightness_of_skin", m_findings.scaled},
            {"black_or_no_number", m_findings.unusable},
            {"mean_of_skin", mean},
            {"explained_by_colour", explained},
            {"tells_blood_from_melanin", told.separatesBloodFromMelanin},
            {"method", m_options.method}};
  }

  const EstimateOptions& m_options;
  const spectral::DataLibrary m_library;
  const ocio::ConfigSource m_config;
  SkinCapture m_capture;
  std::uint64_t m_bytes = 0;
  std::optional<PictureSpace> m_stated;
  std::optional<PictureSpace> m_space;
  std::optional<skin::SkinEstimator> m_estimator;
  std::optional<skin::SkinNetwork> m_network;  ///< in its place
  mutable std::mutex m_mutex;
  std::set<std::string> m_notes;
  Findings m_findings;
};

void estimate(const EstimateOptions& options) {
  if (formatOf(spectral::pathOf(options.output)) != "openexr") {
    throw InputError(options.output, "format", spectral::utf8(spectral::pathOf(options.output).extension()),
                     "holds no maps of skin; write .exr");
  }
  const std::vector<Frame> frames = framesOf(options.albedo, options.output, options.frames);
  spectral::requireWritable(spectral::pathOf(options.json));
  Estimation estimation(options);
  estimation.begin(frames[0].input, skinThreads(options.threads));
  const ThreadShare share = shareThreads(options.threads, frames.size(), estimation.bytes());
  {
    FrameReport report("lutgen skin estimate", frames.size());
    forEachFrame(
        frames, share, [&](const Frame& frame) { estimation.estimate(frame, share.inFrame); },
        [&](const Frame& frame, std::size_t count) { report.done(frame, count); });
  }
  estimation.report(frames.size());
}

}  // namespace

void addSkinEstimate(CLI::App& skin) {
  CLI::App* command = skin.add_subcommand("estimate", "Maps of what skin is made of, from an albedo picture");
  const auto options = std::make_shared<EstimateOptions>();
  command->add_option("ALBEDO", options->albedo, "Albedo, any format OIIO reads; frames: face.####.exr")->required();
  command->add_option("-o,--output", options->output, "EXR to write: the maps in place of the colours")->required();
  addSkinCapture(*command, options->capture, "D65, CIE 1931 2");
  command
      ->add_option("--method", options->method,
                   "map: the most probable skin; network: a trained one's (by spectra), network-rgb (by RGB)")
      ->check(CLI::IsMember({"map", "network", "network-rgb"}));
  command->add_option("--picture-space", options->pictureSpace,
                      "What the pixels are, where the file does not say: sRGB, ACEScg, \"sRGB - Texture\" ...");
  command->add_option("--layer", options->layer, "Layer that is the albedo, of an EXR with several");
  command->add_option("--frames", options->frames, "Frames: 1001-1100, 1-100x5, 1,3,7-9; left out: all that are there");
  command->add_option("--compression", options->compression,
                      "Compression of the written file: zip, zips, piz ...; left out: as it is");
  command->add_option("--json", options->json, "JSON to write: what was found, and what colour tells");
  command->add_option("--threads", options->threads, "Threads; 0: as many as the machine has")
      ->check(CLI::Range(0, 256));
  command->add_option("--max-pixels", options->mostPixels, "Largest picture that is read; default 2147483648")
      ->check(positiveNumber());
  command->callback([options] { estimate(*options); });
}

}  // namespace metamer::lutgen
