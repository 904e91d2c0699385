// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <optional>

#include "commands.h"
#include "fluorescence.h"
#include "library.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/storage_file.h"
#include "metamer/spectral/text.h"
#include "positive_number.h"
#include "run.h"
#include "storage_judge.h"

namespace metamer::lutgen {
namespace {

using spectral::DomainSamples;
using spectral::InputError;
using spectral::SpectralQuantity;
using spectral::StorageForm;
using spectral::StoredSet;

/// What --tolerance tries of each form, the fewest first.
constexpr std::array<int, 15> kCounts = {4, 5, 6, 7, 8, 10, 12, 14, 16, 18, 20, 24, 28, 32, 40};

struct PackOptions {
  std::vector<std::string> inputs;
  std::string output;
  std::string use = "reflectance";
  std::string form;
  std::vector<std::string> lights = {"A", "FL11", "HP1", "LED-RGB1"};
  int numbers = 20;
  std::optional<double> tolerance;
};

struct Originals {
  std::vector<std::string> names;
  std::vector<DomainSamples> samples;
};

Originals originalsOf(const PackOptions& options, const spectral::DataLibrary& library) {
  Originals found;
  const auto add = [&found](const spectral::Spectrum& spectrum) {
    found.names.push_back(spectrum.name());
    found.samples.push_back(spectrum.onDomain());
  };
  for (const std::string& input : options.inputs) {
    if (options.use == "reflectance") {
      for (const spectral::Spectrum& sample : library.reflectances(input).samples) {
        add(sample);
      }
      continue;
    }
    for (const std::string& name : input == "all" ? library.illuminantNames() : std::vector<std::string>{input}) {
      add(library.illuminant(name));
    }
  }
  return found;
}

/// Spectra as stored, and what that costs.
struct Packed {
  StoredSet set;
  StorageError error;

  std::size_t bytes() const {
    std::size_t most = 0;
    for (const StoredSet::Entry& entry : set.entries) {
      most = std::max(most, entry.spectrum.bytes());
    }
    return most;
  }
};

class Packer {
 public:
  explicit Packer(const PackOptions& options)
      : m_options(options),
        m_library(openLibrary()),
        m_isLight(options.use == "light"),
        m_originals(originalsOf(options, m_library)),
        m_storage(m_library),
        m_judge(m_library, m_isLight ? std::vector<std::string>() : options.lights) {}

  Packed packed(StorageForm form, int count) const {
    Packed packed{{form, m_isLight, {}}, {}};
    std::vector<DomainSamples> back;
    const auto quantity = m_isLight ? SpectralQuantity::SpectralPowerDistribution : SpectralQuantity::Reflectance;
    for (std::size_t k = 0; k < m_originals.samples.size(); ++k) {
      const std::string& name = m_originals.names[k];
      try {
        packed.set.entries.push_back({name, m_storage.pack(m_originals.samples[k], quantity, form, count)});
        back.push_back(m_storage.unpacked(packed.set.entries.back().spectrum));
      } catch (const InputError& error) {
        throw InputError(name, "", "", error.what());
      }
    }
    packed.error = m_isLight ? m_judge.ofLights(m_originals.names, m_originals.samples, back)
                             : m_judge.ofReflectances(m_originals.names, m_originals.samples, back);
    return packed;
  }

  /// Of all forms, or the one asked for, the fewest bytes that hold the tolerance.
  Packed cheapest(double tolerance) const {
    std::optional<Packed> best;
    std::optional<Packed> nearest;
    for (const StorageForm form : forms()) {
      for (const int count : kCounts) {
        const std::size_t bytes = static_cast<std::size_t>(count) * (form == StorageForm::Bytes ? 1 : sizeof(float));
        if (best && bytes >= best->bytes()) {
          break;
        }
        Packed tried = packed(form, count);
        const double error = errorOf(tried);
        if (!nearest || error < errorOf(*nearest)) {
          nearest = tried;
        }
        if (error <= tolerance) {
          best = std::move(tried);
          break;
        }
      }
    }
    if (!best) {
      throw InputError("--tolerance", "difference", spectral::shortestNumber(tolerance),
                       spectral::formatted("is held by no form of at most %d numbers; the nearest is %s, %.3g",
                                           kCounts.back(), nameOf(nearest->set.form).c_str(), errorOf(*nearest)));
    }
    return *best;
  }

  StorageForm form() const {
    if (!m_options.form.empty()) {
      return spectral::storageFormNamed(m_options.form);
    }
    return m_isLight ? StorageForm::Lines : StorageForm::Cosines;
  }

  static const std::string& nameOf(StorageForm form) {
    return spectral::storageFormNames()[static_cast<std::size_t>(form)];
  }

 private:
  double errorOf(const Packed& tried) const { return m_isLight ? tried.error.worst : tried.error.mean; }

  std::vector<StorageForm> forms() const {
    if (!m_options.form.empty()) {
      return {form()};
    }
    if (m_isLight) {
      return {StorageForm::Hats, StorageForm::Cosines, StorageForm::Lines};
    }
    std::vector<StorageForm> all = {StorageForm::Cosines, StorageForm::Hats};
    const bool isBounded = std::all_of(m_originals.samples.begin(), m_originals.samples.end(),
                                       [](const DomainSamples& samples) { return samples.maxCoeff() <= 1; });
    if (isBounded) {
      all.insert(all.begin(), StorageForm::Bytes);
      all.push_back(StorageForm::Moments);
    }
    return all;
  }

  const PackOptions& m_options;
  const spectral::DataLibrary m_library;
  bool m_isLight;
  Originals m_originals;
  spectral::SpectrumStorage m_storage;
  StorageJudge m_judge;
};

void pack(const PackOptions& options) {
  const Packer packer(options);
  const Packed packed =
      options.tolerance ? packer.cheapest(*options.tolerance) : packer.packed(packer.form(), options.numbers);
  spectral::writeWholeFile(spectral::pathOf(options.output), spectral::storageText(packed.set));
  const std::string how = options.use == "light" ? "the ColorChecker under them" : spectral::joined(options.lights);
  const std::size_t count = packed.set.entries.size();
  summarise(spectral::formatted(
      "%s: %zu %s, %s, at most %zu bytes each; %s: CIEDE2000 mean %.4f, worst spectrum %.4f (%s), largest %.3f (%s)",
      options.output.c_str(), count, count == 1 ? "spectrum" : "spectra", Packer::nameOf(packed.set.form).c_str(),
      packed.bytes(), how.c_str(), packed.error.mean, packed.error.worst, packed.error.worstName.c_str(),
      packed.error.largest, packed.error.largestWhere.c_str()));
}

bool isStored(const std::string& file) {
  constexpr std::string_view kStored = ".json";
  return file.size() >= kStored.size() && spectral::lowerCase(file.substr(file.size() - kStored.size())) == kStored;
}

void show(const std::string& file, const std::vector<std::string>& lights) {
  if (!isStored(file)) {
    showFluorescence(file, lights);
    return;
  }
  const StoredSet set = spectral::readStorage(spectral::pathOf(file));
  for (const StoredSet::Entry& entry : set.entries) {
    const auto& spectrum = entry.spectrum;
    words() << entry.name << '\t' << spectrum.numbers.size() << " numbers, " << spectrum.bytes() << " bytes";
    const std::size_t first =
        spectrum.numbers.size() - std::min(spectrum.numbers.size(), 2 * static_cast<std::size_t>(spectrum.lines));
    for (std::size_t k = first; k + 1 < spectrum.numbers.size(); k += 2) {
      words() << (k == first ? "; lines at " : ", ")
              << spectral::formatted("%g", static_cast<double>(spectrum.numbers[k]));
    }
    words() << '\n';
  }
  summarise(spectral::formatted("%s: %zu %s in %s", file.c_str(), set.entries.size(),
                                set.isLight ? "lights" : "reflectances", Packer::nameOf(set.form).c_str()));
}

/// A name as one field of a table.
std::string field(const std::string& name) {
  if (name.find_first_of(",\"\n") == std::string::npos) {
    return name;
  }
  std::string quoted = "\"";
  for (const char c : name) {
    quoted += c == '"' ? "\"\"" : std::string(1, c == '\n' ? ' ' : c);
  }
  return quoted + '"';
}

/// Samples `step` apart. A light's are means about their places, weighed as linear interpolation will use them: power
/// between them is kept, which lines would fall through.
double sampleAt(const DomainSamples& samples, int place, int step, bool isLight) {
  if (!isLight) {
    return samples[place];
  }
  double sum = 0;
  double weights = 0;
  for (int k = std::max(0, place - step + 1); k < std::min(spectral::kDomainSize, place + step); ++k) {
    const double weight = step - std::abs(k - place);
    sum += weight * samples[k];
    weights += weight;
  }
  return sum / weights;
}

void convert(const std::string& file, const std::string& output, int step) {
  const StoredSet set = spectral::readStorage(spectral::pathOf(file));
  const spectral::SpectrumStorage storage(openLibrary());
  std::string text = "wavelength_nm";
  std::vector<DomainSamples> spectra;
  for (const StoredSet::Entry& entry : set.entries) {
    text += "," + field(entry.name);
    try {
      spectra.push_back(storage.unpacked(entry.spectrum));
    } catch (const InputError& error) {
      throw InputError(file, entry.name, "", error.what());
    }
  }
  for (int k = 0; k < spectral::kDomainSize; k += step) {
    text += "\n" + std::to_string(spectral::kDomainStartNm + k);
    for (const DomainSamples& samples : spectra) {
      text += spectral::formatted(",%.7g", sampleAt(samples, k, step, set.isLight));
    }
  }
  spectral::writeWholeFile(spectral::pathOf(output), text + "\n");
  summarise(spectral::formatted("%s: %zu spectra every %d nm", output.c_str(), spectra.size(), step));
}

}  // namespace

void addSpectrum(CLI::App& application) {
  CLI::App* spectrum = application.add_subcommand(
      "spectrum", "Spectra in few numbers: pack them, show them, and back; fluorescent surfaces");
  spectrum->require_subcommand(1);

  CLI::App* command = spectrum->add_subcommand("pack", "Store spectra in few numbers, and say what that costs");
  const auto options = std::make_shared<PackOptions>();
  command->add_option("SPECTRA", options->inputs, "Sets of reflectances, or lights: names or files; lights also: all")
      ->required();
  command->add_option("-o,--output", options->output, "JSON to write")->required();
  command->add_option("--use", options->use, "reflectance or light; left out: reflectance")
      ->check(CLI::IsMember({"reflectance", "light"}));
  command->add_option("--form", options->form,
                      "One of: " + spectral::joined(spectral::storageFormNames()) +
                          "; left out: cosines, of lights lines, or what --tolerance finds");
  command->add_option("--numbers", options->numbers, "Numbers a spectrum; left out: 20")
      ->check(CLI::Range(spectral::kFewestStored, spectral::kMostStored));
  command
      ->add_option(
          "--tolerance", options->tolerance,
          "The fewest bytes whose mean CIEDE2000 is at most this: over all reflectances and lights, of each light")
      ->check(positiveNumber())
      ->excludes("--numbers");
  command->add_option("--lights", options->lights, "What reflectances are judged under; left out: A FL11 HP1 LED-RGB1");
  command->callback([options] { pack(*options); });

  CLI::App* shown = spectrum->add_subcommand("show", "What a stored file, or that of a fluorescent surface, holds");
  const auto file = std::make_shared<std::string>();
  const auto lights =
      std::make_shared<std::vector<std::string>>(std::vector<std::string>{"D65", "A", "FL11", "HP1", "LED-RGB1"});
  shown->add_option("FILE", *file, "JSON of lutgen spectrum pack, or .csv, .bfc, .exr of a fluorescent surface")
      ->required();
  shown->add_option("--lights", *lights,
                    "What a fluorescent surface is shown under; left out: D65 A FL11 HP1 LED-RGB1");
  shown->callback([file, lights] { show(*file, *lights); });

  CLI::App* fitted =
      spectrum->add_subcommand("fit", "The compact form of a fluorescent surface's matrix, and what it costs");
  const auto compact = std::make_shared<std::string>();
  fitted->add_option("MATRIX", *file, "Re-radiation matrix: .csv, .bfc, .exr")->required();
  fitted->add_option("-o,--output", *compact, "CSV to write")->required();
  fitted->add_option("--lights", *lights, "What it is judged under; left out: D65 A FL11 HP1 LED-RGB1");
  fitted->callback([file, compact, lights] { fitFluorescence(*file, *compact, *lights); });

  CLI::App* converted = spectrum->add_subcommand("convert", "A stored file as a table of spectra");
  const auto output = std::make_shared<std::string>();
  const auto step = std::make_shared<int>(1);
  converted->add_option("FILE", *file, "JSON of lutgen spectrum pack")->required();
  converted->add_option("-o,--output", *output, "CSV to write")->required();
  converted->add_option("--step", *step, "nm between rows; left out: 1. Lights keep their power")
      ->check(CLI::Range(1, 100));
  converted->callback([file, output, step] { convert(*file, *output, *step); });
}

}  // namespace metamer::lutgen
