// SPDX-License-Identifier: Apache-2.0
#include "report/findings.h"

#include <algorithm>

#include "metamer/spectral/formatted.h"

namespace metamer::lutgen {
namespace {

using spectral::formatted;

// CIEDE2000 that a trained eye sees with two patches side by side, and that everybody sees.
constexpr double kSeenBeside = 1.0;
constexpr double kSeenByAll = 3.0;

// Of the 255 steps of an 8-bit display: rounding alone makes half of one.
constexpr double kWithinRounding = 0.5;
constexpr double kHardlyCodes = 2.0;

std::string onPhotographs(const BakedForm& form) {
  const double codes = form.certificate.pixels.photographCodes;
  const char* verdict = codes <= kWithinRounding ? "you will not see it"
                        : codes <= kHardlyCodes  ? "you will hardly see it"
                                                 : "you may see it";
  return formatted(
      "On photographs %s: 99 of 100 pixels are within %.1f of a display's 255 steps of what the spectral engine gives.",
      verdict, codes);
}

std::string inNeon(const BakedForm& form) {
  const auto& error = form.certificate.error;
  const char* verdict = error.p99 <= kSeenBeside && error.max <= kSeenByAll ? "you will not either"
                        : error.p99 <= kSeenByAll                           ? "you may"
                                                                            : "you will";
  return formatted(" In neon, lasers and deep gels %s: 99 of 100 such colours are within %.2f, the worst is %.2f off.",
                   verdict, error.p99, error.max);
}

/// Each set one vote.
struct Truth {
  double engine = 0;
  double plain = 0;
};
Truth againstTruth(const std::vector<sip::HeldOutSet>& sets) {
  Truth truth;
  for (const sip::HeldOutSet& set : sets) {
    truth.engine += set.engine / static_cast<double>(sets.size());
    truth.plain += set.adaptation / static_cast<double>(sets.size());
  }
  return truth;
}

}  // namespace

std::vector<std::string> findings(const std::vector<BakedForm>& forms, const std::vector<SurfaceGroup>& groups,
                                  const std::vector<ShownPicture>& pictures) {
  std::vector<std::string> result;
  for (const BakedForm& form : forms) {
    if (form.certificate.pixels.count > 0) {
      result.push_back(form.label + ": " + onPhotographs(form) + inNeon(form));
    } else {
      result.push_back(form.label + ":" + inNeon(form));
    }
  }
  const ocio::Certificate& full = forms.front().certificate;
  if (full.representation == ocio::Representation::Identity) {
    result.emplace_back("Both sides are the same: the transform does nothing.");
  }
  if (!full.surfaces.empty()) {
    const Truth truth = againstTruth(full.surfaces);
    result.push_back(
        formatted("Against the truth: on measured surfaces that it had not seen, the transform is %.1f off on average; "
                  "plain adaptation, which a white balance is, %.1f. Cloth, paint and skin of one colour can differ in "
                  "spectrum, and no transform of pixels can tell them apart.",
                  truth.engine, truth.plain));
  }
  for (const SurfaceGroup& group : groups) {
    if (group.title != "Chart") {
      const GroupMeans means = meansOf(group);
      result.push_back(formatted("%s: %.1f from the truth on average, plain adaptation %.1f.", group.title.c_str(),
                                 means.engine, means.plain));
    }
  }
  for (const BakedForm& form : forms) {
    for (const std::string& warning : form.certificate.warnings()) {
      const std::string sentence = form.label + ": " + warning + ".";
      if (std::find(result.begin(), result.end(), sentence) == result.end()) {
        result.push_back(sentence);
      }
    }
  }
  if (full.folds > 0) {
    result.push_back(formatted("%.2g %% of colours change places with a neighbour: gradients there may turn back.",
                               100 * full.folds));
  }
  for (const std::string& text : full.notes) {
    result.push_back("Note: " + text);
  }
  if (pictures.empty()) {
    result.emplace_back("No pictures are shown.");
  }
  return result;
}

std::string noiseWords(const std::vector<SurfaceGroup>& groups, const ocio::Certificate& certificate) {
  GroupMeans means;
  const KnownSurface* most = nullptr;
  double count = 0;
  for (const SurfaceGroup& group : groups) {
    for (const KnownSurface& surface : group.surfaces) {
      means.noise += surface.noise;
      means.plainNoise += surface.plainNoise;
      count += 1;
      most = most == nullptr || surface.noise > most->noise ? &surface : most;
    }
  }
  return formatted(
      "Noise of one size in red, green and blue comes out %.2f times as large on these surfaces (%.2f at most, "
      "%s); plain adaptation makes it %.2f times as large. Of all colours, neon included, the largest gain in "
      "any direction is %.2f. On noisy photographs 99 of 100 pixels of the .ctf are within %.1f of a display's "
      "255 steps of the engine.",
      means.noise / count, most->noise, most->name.c_str(), means.plainNoise / count, certificate.gain,
      certificate.pixels.noisyCodes);
}

std::string pictureWords(const ShownPicture& picture, const std::vector<BakedForm>& forms, const std::string& view) {
  std::string words =
      picture.title + ", pixels taken as " + picture.pixels + "; seen " +
      (picture.isFilm ? "through " + view + "'s view, which rolls highlights off as film does."
                      : "as an sRGB screen shows them, clipped where they are brighter than its white.");
  for (std::size_t k = 0; k < forms.size(); ++k) {
    words += formatted(" %s: 99 of 100 pixels within %.2f of the engine.", forms[k].label.c_str(), picture.p99[k]);
  }
  return words;
}

}  // namespace metamer::lutgen
