// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/renderer.h"

#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <vector>

#include "integrator/state_bytes.h"
#include "integrator/tile_tracer.h"
#include "lights/light_spectrum.h"

namespace metamer::spectral_ref {
namespace {

constexpr std::uint64_t kMostSamplesAPass = GatheredResponses::kMostPaths;
/// Of the bytes of a checkpoint; changes with anything that changes a bit of a picture.
constexpr std::uint64_t kStateVersion = 0x6d6574610000000aU;

std::vector<Tile> tilesOf(int width, int height) {
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += kTileSide) {
    for (int x = 0; x < width; x += kTileSide) {
      tiles.push_back({x, y, std::min(x + kTileSide, width), std::min(y + kTileSide, height)});
    }
  }
  return tiles;
}

std::unique_ptr<TileTracer> tracerFor(const TracerContext& context) {
  switch (context.prepared.scene.integrator.wavelengths) {
    case 1:
      return makeTileTracer<1>(context);
    case 8:
      return makeTileTracer<8>(context);
    case 16:
      return makeTileTracer<16>(context);
    default:
      assert(context.prepared.scene.integrator.wavelengths == 4);
      return makeTileTracer<4>(context);
  }
}

Replicates replicatesFor(const RenderOptions& options) {
  return {options.restir == Restir::Off ? 1 : kSamplesTogether};
}

}  // namespace

struct Renderer::State {
  State(const Scene& scene, const RenderOptions& renderOptions, std::uint64_t firstSample, int threads)
      : options(renderOptions),
        prepared(scene, renderOptions),
        sensor(scene.film),
        film(FilmFormat::of(scene.film, replicatesFor(options), prepared.brightness)),
        tiles(tilesOf(scene.film.width, scene.film.height)),
        arena(threads > 0 ? std::min(threads, tbb::info::default_concurrency()) : tbb::task_arena::automatic),
        first(firstSample),
        guide(options.guiding
                  ? std::make_unique<WavelengthGuide>(scene.film.width, scene.film.height, scene.integrator.wavelengths,
                                                      worthOfLights(scene), sensor.channels())
                  : nullptr),
        tracer(tracerFor({prepared, sensor, film, guide.get(), options})) {
    cursor = epochStart();
    forTiles([&](const Tile& tile) { tracer->prepare(tile); });
  }

  /// First sample that the film's first one depends on.
  std::uint64_t epochStart() const { return tracer->resamples() ? first - first % kSamplesTogether : first; }
  std::uint64_t next() const { return std::max(cursor, first); }

  template <typename Work>
  void forTiles(const Work& work) {
    arena.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, tiles.size(), 1),
          [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t i = range.begin(); i < range.end(); ++i) {
              work(tiles[i]);
            }
          },
          tbb::simple_partitioner());
    });
  }

  /// The end of a pass of at most `count` samples: not across the film's first one.
  std::uint64_t passEnd(std::uint64_t count) const {
    std::uint64_t end = cursor + count;
    if (cursor < first) {
      end = std::min(end, first);
    }
    return tracer->resamples() ? cursor + 1 : end;
  }

  /// Densities follow from scene and seed alone, so checkpoints and parts of a render need not carry them.
  void learnWavelengths() {
    if (guide && !guide->isReady()) {
      forTiles([&](const Tile& tile) { tracer->learn(tile); });
      arena.execute([&] { guide->build(); });
    }
  }

  void pass(std::uint64_t end) {
    const bool isKept = cursor >= first;
    if (tracer->resamples()) {
      assert(end == cursor + 1);
    }
    forTiles([&](const Tile& tile) { tracer->trace(tile, cursor, end, isKept); });
    cursor = end;
    film.setRanges({{first, next()}});
    film.refused = refusedBefore + sensor.refused();
  }

  RenderOptions options;
  PreparedScene prepared;
  FilmSensor sensor;
  Film film;
  std::vector<Tile> tiles;
  tbb::task_arena arena;
  std::uint64_t first;
  std::uint64_t cursor = 0;  ///< next sample to take; those before `first` fill reservoirs alone
  std::uint64_t refusedBefore = 0;
  std::unique_ptr<WavelengthGuide> guide;
  std::unique_ptr<TileTracer> tracer;
  double secondsASample = 0;
};

Renderer::Renderer(const Scene& scene, const RenderOptions& options, std::uint64_t firstSample, int threads)
    : m_state(std::make_unique<State>(scene, options, firstSample, threads)) {}

Renderer::~Renderer() = default;

void Renderer::render(std::uint64_t end, double seconds) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const auto elapsed = [&start] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  m_state->learnWavelengths();
  double left = seconds - elapsed();
  double least = 0;
  while (m_state->next() < end && left > least) {
    // As many samples a pass as fill the time left, once their price is known.
    std::uint64_t count = 1;
    if (m_state->secondsASample > 0) {
      const double fitting = std::round(left / m_state->secondsASample);
      count = static_cast<std::uint64_t>(std::clamp(fitting, 1.0, static_cast<double>(kMostSamplesAPass)));
    }
    const double before = elapsed();
    count = m_state->passEnd(std::min(count, end - std::min(end, m_state->cursor))) - m_state->cursor;
    m_state->pass(m_state->cursor + count);
    const double after = elapsed();
    m_state->secondsASample = (after - before) / static_cast<double>(count);
    left = seconds - after;
    // Samples of small passes take longer: none is begun for less time than half of one takes.
    least = 0.5 * m_state->secondsASample;
  }
}

std::uint64_t Renderer::nextSample() const {
  return m_state->next();
}

std::optional<WavelengthDensity> Renderer::wavelengthDensity(int x, int y) const {
  const WavelengthGuide* guide = m_state->guide.get();
  if (guide == nullptr || !guide->isReady()) {
    return std::nullopt;
  }
  const std::size_t block = guide->blockOf(x, y);
  const auto histogram = guide->histogram(block);
  return WavelengthDensity{guide->density(block), {histogram.begin(), histogram.end()}, guide->hasOwn(block)};
}

const Film& Renderer::film() const {
  return m_state->film;
}

void Renderer::writeState(const ByteSink& sink) const {
  StateWriter writer(sink);
  writer.put(kStateVersion);
  writer.put(m_state->prepared.scene.fingerprint);
  writer.put(m_state->options.seed);
  writer.put(m_state->options.guiding);
  writer.put(m_state->options.restir);
  writer.put(m_state->options.lightRule);
  writer.put(m_state->first);
  writer.put(m_state->cursor);
  writer.put(m_state->film.refused);
  const FilmSums& sums = m_state->film.sums();
  writer.putAll(sums.lows());
  for (const std::vector<std::int64_t>& carries : sums.carries()) {
    writer.putAll(carries);
  }
  m_state->tracer->save(writer, m_state->cursor);
}

void Renderer::restore(const ByteSource& state, const std::string& where) {
  StateReader reader(state, where);
  if (reader.get<std::uint64_t>() != kStateVersion) {
    throw reader.damaged();
  }
  const auto fingerprint = reader.get<std::uint64_t>();
  const auto other = [&](const char* what) {
    return spectral::InputError(where, what, "",
                                "differs from what the checkpoint was made with; delete it to start again");
  };
  if (fingerprint != m_state->prepared.scene.fingerprint) {
    throw other("scene");
  }
  RenderOptions options;
  options.seed = reader.get<std::uint32_t>();
  options.guiding = reader.get<bool>();
  options.restir = reader.get<Restir>();
  options.lightRule = reader.get<LightRule>();
  if (!(options == m_state->options)) {
    throw other("seed, guiding or restir");
  }
  if (reader.get<std::uint64_t>() != m_state->first) {
    throw other("first sample");
  }
  const auto cursor = reader.get<std::uint64_t>();
  const auto refused = reader.get<std::uint64_t>();
  FilmSums& sums = m_state->film.sums();
  reader.getAll(sums.lows());
  for (std::vector<std::int64_t>& carries : sums.carries()) {
    reader.getAllOrNone(carries, sums.sumsASegment());
  }
  m_state->tracer->restore(reader, cursor);
  reader.finish();
  m_state->cursor = cursor;
  m_state->refusedBefore = refused;
  m_state->film.refused = refused;
  m_state->film.setRanges({{m_state->first, m_state->next()}});
}

}  // namespace metamer::spectral_ref
