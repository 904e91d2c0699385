// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral_ref/exr_film.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "film/check_sum.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/library_words.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/picture_file.h"
#include "metamer/spectral/spectral_picture.h"

namespace metamer::spectral_ref {
namespace {

using spectral::InputError;

constexpr const char* kStateAttribute = "metamer:state";
constexpr const char* kSumAttribute = "metamer:checksum";
constexpr const char* kNotePrefix = "metamer:";
constexpr int kWordsASum = 4;

OIIO::ImageSpec pictureSpec(const Film& film, const FilmNotes& notes, bool withReplicates) {
  const FilmFormat& format = film.format();
  std::vector<std::string> names = {"R", "G", "B", "Y", "variance.Y", "samples"};
  for (std::size_t g = 0; g < kReplicates && withReplicates; ++g) {
    names.push_back("replicate." + std::to_string(g) + ".Y");
  }
  for (int b = 0; b < format.bins.count; ++b) {
    names.push_back(
        spectral::channelOfWavelength(format.bins.centreNm(b), spectral::SpectralQuantity::SpectralPowerDistribution));
  }
  OIIO::ImageSpec spec(format.width, format.height, static_cast<int>(names.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = names;
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // else the clock's: the same render gives the same file
  spec.attribute("spectralLayoutVersion", "1.0");
  // The layout's own word for spectral radiance, which its readers compare: the values are per nm.
  spec.attribute("emissiveUnits", "W.m^-2.sr^-1");
  if (format.chromaticities) {
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), format.chromaticities->data());
  }
  const bool isPhotometric = format.colourScale != 1.0;
  spec.attribute("metamer:units", isPhotometric ? "Y in cd.m^-2" : "Y = 1 for a radiance of 1 W.m^-2.sr^-1.nm^-1");
  spec.attribute("metamer:space", format.space);
  spec.attribute("metamer:observer", format.observer);
  spec.attribute("metamer:samples", rangesText(film.ranges()));
  spec.attribute("metamer:refused", std::to_string(film.refused));
  for (const auto& [name, value] : notes) {
    spec.attribute(kNotePrefix + name, value);
  }
  return spec;
}

nlohmann::json stateJson(const Film& film, const FilmNotes& notes) {
  const FilmFormat& format = film.format();
  nlohmann::json json = {{"version", 2},
                         {"bins", {format.bins.fromNm, format.bins.stepNm, format.bins.count}},
                         {"colourScale", format.colourScale},
                         {"space", format.space},
                         {"observer", format.observer},
                         {"blockLength", format.replicates.blockLength},
                         {"unitExponent", format.unitExponent},
                         {"refused", film.refused},
                         {"ranges", film.ranges()},
                         {"notes", notes}};
  if (format.chromaticities) {
    json["chromaticities"] = *format.chromaticities;
  }
  for (int i = 0; i < 9; ++i) {
    json["colourFromResponse"].push_back(format.colourFromResponse(i / 3, i % 3));
  }
  return json;
}

/// A row's sums, as a file has them.
void sumsOfRow(const Film& film, int y, std::vector<ExactSum>& row) {
  const auto width = static_cast<std::size_t>(film.format().width);
  row.clear();
  for (std::size_t pixel = static_cast<std::size_t>(y) * width; pixel < (static_cast<std::size_t>(y) + 1) * width;
       ++pixel) {
    for (std::size_t channel = 0; channel < film.channels(); ++channel) {
      row.push_back(film.sums().sum(pixel, channel));
    }
  }
}

/// Over all that a merge takes from a part: its description and its sums.
std::string checkSumOf(const Film& film, const FilmNotes& notes) {
  CheckSum sum;
  std::vector<ExactSum> row;
  for (int y = 0; y < film.format().height; ++y) {
    sumsOfRow(film, y, row);
    sum.add(row.data(), row.size() * sizeof(ExactSum));
  }
  const std::string description = stateJson(film, notes).dump();
  sum.add(description.data(), description.size());
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(sum.value()));
  return text;
}

/// The exact sums as words, least first: 32 bits fit a channel of OpenEXR.
OIIO::ImageSpec stateSpec(const Film& film, const FilmNotes& notes) {
  const FilmFormat& format = film.format();
  const int channels = static_cast<int>(film.channels()) * kWordsASum;
  OIIO::ImageSpec spec(format.width, format.height, channels, OIIO::TypeDesc::UINT32);
  spec.channelnames.clear();
  for (int c = 0; c < channels; ++c) {
    // Names sort as numbers do.
    char name[32];
    std::snprintf(name, sizeof name, "w%06d", c);
    spec.channelnames.emplace_back(name);
  }
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "");  // else the clock's: the same render gives the same file
  spec.attribute(kStateAttribute, stateJson(film, notes).dump());
  spec.attribute(kSumAttribute, checkSumOf(film, notes));
  return spec;
}

void pixelValues(const Film& film, std::size_t pixel, bool withReplicates, float*& out) {
  const Eigen::Vector3d colour = film.colour(pixel);
  for (int c = 0; c < 3; ++c) {
    *out++ = static_cast<float>(colour[c]);
  }
  const Estimate luminance = film.luminance(pixel);
  *out++ = static_cast<float>(luminance.mean);
  *out++ = static_cast<float>(luminance.variance);
  *out++ = static_cast<float>(film.samples());
  for (std::size_t g = 0; g < kReplicates && withReplicates; ++g) {
    *out++ = static_cast<float>(film.sums().value(pixel, Film::kLuminance + g) * film.format().colourScale /
                                static_cast<double>(film.replicateCounts()[g]));
  }
  for (int b = 0; b < film.format().bins.count; ++b) {
    *out++ = static_cast<float>(film.radiance(pixel, b));
  }
}

static_assert(sizeof(ExactSum) == kWordsASum * sizeof(std::uint32_t));

/// Of sumsOfRow().
void takeRow(const std::vector<ExactSum>& row, int y, Film& film) {
  const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(film.format().width);
  for (std::size_t i = 0; i < row.size(); ++i) {
    film.sums().set(first + i / film.channels(), i % film.channels(), row[i]);
  }
}

/// A film from the description in a file; none where it does not fit. @throws nlohmann::json::exception
std::optional<std::pair<Film, FilmNotes>> filmFromJson(const nlohmann::json& json, const OIIO::ImageSpec& spec) {
  FilmFormat format;
  format.width = spec.width;
  format.height = spec.height;
  format.bins = {json.at("bins").at(0), json.at("bins").at(1), json.at("bins").at(2)};
  format.colourScale = json.at("colourScale");
  format.space = json.at("space");
  format.observer = json.at("observer");
  if (json.contains("chromaticities")) {
    format.chromaticities = json.at("chromaticities").get<std::array<float, 8>>();
  }
  format.replicates.blockLength = std::max<std::uint64_t>(1, json.at("blockLength").get<std::uint64_t>());
  format.unitExponent = json.at("unitExponent");
  for (int i = 0; i < 9; ++i) {
    format.colourFromResponse(i / 3, i % 3) = json.at("colourFromResponse").at(static_cast<std::size_t>(i));
  }
  const std::size_t channels = Film::kFirstBin + static_cast<std::size_t>(std::max(0, format.bins.count));
  if (channels * kWordsASum != static_cast<std::size_t>(spec.nchannels)) {
    return std::nullopt;
  }
  Film film(format);
  film.refused = json.at("refused");
  film.setRanges(json.at("ranges").get<SampleRanges>());
  return std::pair(std::move(film), json.at("notes").get<FilmNotes>());
}

}  // namespace

std::string rangesText(const SampleRanges& ranges) {
  std::string text;
  for (const auto& [begin, end] : ranges) {
    text += (text.empty() ? "" : " ") + std::to_string(begin) + ":" + std::to_string(end);
  }
  return text;
}

void writeExr(const Film& film, const FilmNotes& notes, const std::filesystem::path& file, bool withState,
              bool withReplicates) {
  if (file.extension() != ".exr") {
    throw InputError(spectral::utf8(file), "extension", spectral::utf8(file.extension()), "must be .exr");
  }
  spectral::PendingFile pending(file);
  const auto failure = [&file](const std::string& reason) {
    return InputError(spectral::utf8(file), "output", "",
                      "cannot be written: " + reason + "; nothing is left behind, make room and try again");
  };
  std::vector<OIIO::ImageSpec> specs = {pictureSpec(film, notes, withReplicates)};
  if (withState) {
    specs.front().attribute("oiio:subimagename", "picture");
    specs.push_back(stateSpec(film, notes));
    specs.back().attribute("oiio:subimagename", "state");
  }
  const auto output = OIIO::ImageOutput::create("openexr");
  const std::string path = spectral::utf8(pending.path());
  if (!output || !output->open(path, static_cast<int>(specs.size()), specs.data())) {
    throw failure(output ? output->geterror() : OIIO::geterror());
  }
  const auto width = static_cast<std::size_t>(film.format().width);
  std::vector<float> row(width * static_cast<std::size_t>(specs.front().nchannels));
  for (int y = 0; y < film.format().height; ++y) {
    float* out = row.data();
    for (std::size_t x = 0; x < width; ++x) {
      pixelValues(film, static_cast<std::size_t>(y) * width + x, withReplicates, out);
    }
    if (!output->write_scanline(y, 0, OIIO::TypeDesc::FLOAT, row.data())) {
      throw failure(output->geterror());
    }
  }
  if (withState) {
    if (!output->open(path, specs.back(), OIIO::ImageOutput::AppendSubimage)) {
      throw failure(output->geterror());
    }
    std::vector<ExactSum> sums;
    for (int y = 0; y < film.format().height; ++y) {
      sumsOfRow(film, y, sums);
      if (!output->write_scanline(y, 0, OIIO::TypeDesc::UINT32, sums.data())) {
        throw failure(output->geterror());
      }
    }
  }
  if (!output->close()) {
    throw failure(output->geterror());
  }
  pending.commit();
}

std::pair<Film, FilmNotes> readExrState(const std::filesystem::path& file) {
  const std::string where = spectral::utf8(file);
  spectral::requirePictureFile(where);
  const auto input = OIIO::ImageInput::open(where);
  if (!input) {
    const std::string reason = OIIO::geterror();
    throw InputError(where, "", "", "cannot be read: " + spectral::pictureReason(reason));
  }
  const char* remedy = "has no exact sums; render it with --samples";
  OIIO::ImageSpec spec;
  for (int part = 0; input->seek_subimage(part, 0); ++part) {
    spec = input->spec();
    const std::string text = spec.get_string_attribute(kStateAttribute);
    if (text.empty()) {
      continue;
    }
    const InputError damaged(where, "state", "", "is damaged or of another release; render it again");
    try {
      auto read = filmFromJson(nlohmann::json::parse(text), spec);
      if (!read) {
        throw damaged;
      }
      auto& [film, notes] = *read;
      std::vector<ExactSum> row(static_cast<std::size_t>(spec.width) * film.channels());
      for (int y = 0; y < spec.height; ++y) {
        if (!input->read_scanline(y, 0, OIIO::TypeDesc::UINT32, row.data())) {
          throw InputError(where, "state", "", "is damaged, render it again: " + input->geterror());
        }
        takeRow(row, y, film);
      }
      if (spec.get_string_attribute(kSumAttribute) != checkSumOf(film, notes)) {
        throw damaged;
      }
      return {std::move(film), std::move(notes)};
    } catch (const nlohmann::json::exception&) {
      throw damaged;
    }
  }
  throw InputError(where, "", "", remedy);
}

void mergeFilm(Film& film, const Film& other, const std::string& where) {
  if (!(film.format() == other.format())) {
    throw InputError(where, "film", "", "differs from the first file's (size, bins, space, replicates or unit)");
  }
  SampleRanges ranges = film.ranges();
  if (!uniteRanges(ranges, other.ranges())) {
    throw InputError(where, "samples", rangesText(other.ranges()),
                     "overlap those merged before (" + rangesText(film.ranges()) + "); leave a file out");
  }
  film.sums().add(other.sums());
  film.refused += other.refused;
  film.setRanges(ranges);
}

}  // namespace metamer::spectral_ref
