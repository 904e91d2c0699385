// SPDX-License-Identifier: Apache-2.0
#include "metamer/ocio/bake.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "bake/bake_operators.h"
#include "bake/certified_file.h"
#include "bake/judged_recipe.h"
#include "bake/ladder.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/texture_processor.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "operators/parallel.h"

namespace metamer::ocio {
namespace {

using spectral::InputError;

/// What a tolerance may ask for by itself: beyond it a table is slow to load and gains little.
constexpr int kLargestUsual = 65;

/// Of the time that a bake takes, about, beside kPreparedShare.
constexpr double kChosenShare = 0.5;
constexpr double kCertifiedShare = 0.75;

/// A recipe on its way into a format: what it was prepared to, what judges it, and its operators.
class Baking {
 public:
  /// Chooses the operators, by tolerance where there is one.
  Baking(const sip::Recipe& recipe, const spectral::DataLibrary& library, const LutFormat& format,
         const BakeOptions& options)
      : m_format(format), m_options(options), m_judged(recipe, library, options, [&](const WorkingSpace& space) {
          requireSignal(format, options);
          return probesOf(format, space, options);
        }) {
    noteDisplay();
    choose();
    m_judged.tell(kChosenShare);
  }

  /// Puts the error of a transform of the format's pixels into the certificate.
  void certify(const PixelProcessor& processor) {
    m_judged.certify(Candidate(processor, m_operators.toPixels, m_operators.fromPixels));
  }
  void certify() {
    certify(PixelProcessor(m_operators.group));
    tellCertified();
  }
  /// Whoever waits is told on the caller's own thread.
  void tellCertified() const { m_judged.tell(kCertifiedShare); }

  /// The same of these operators on a graphics card.
  void certifyOnCards(const OCIO::ConstGroupTransformRcPtr& operators) {
    const auto candidate = [&](TextureDepth depth) {
      return Candidate(textureProcessor(operators, depth), m_operators.toPixels, m_operators.fromPixels);
    };
    m_judged.certifyOnCards(candidate(TextureDepth::Float), candidate(TextureDepth::Half));
  }

  const OCIO::GroupTransformRcPtr& group() const { return m_operators.group; }
  /// With the error of the result once certify() ran.
  Certificate& certificate() { return m_judged.certificate(); }
  const Certificate& certificate() const { return m_judged.certificate(); }

 private:
  void choose();
  /// A display's curve over the primaries of no display is right, but seldom what was meant.
  void noteDisplay();

  const LutFormat& m_format;
  const BakeOptions& m_options;
  JudgedRecipe m_judged;
  Operators m_operators;
};

void Baking::noteDisplay() {
  constexpr std::array kDisplays = {"Rec.709", "Rec.2020", "P3-D65"};
  const std::string& space = m_judged.prepared().space.engine.name;
  if (m_options.shaper && isDisplay(*m_options.shaper) &&
      std::find(kDisplays.begin(), kDisplays.end(), space) == kDisplays.end()) {
    m_judged.certificate().notes.push_back("the signals are " + space + " by the curve " + nameOf(*m_options.shaper) +
                                           "; for a timeline in Rec.709 add --space Rec.709");
  }
}

void Baking::choose() {
  const bool isIdentity = m_judged.prepared().transform.isIdentity();
  const Representation usual = holdsChain(m_format) ? Representation::ExposureInvariantChain : Representation::LogCube;
  const auto make = [&](const BakeOptions& options, Representation representation) {
    m_operators = operatorsFor(m_judged.prepared(), options, m_format, representation, m_judged.certificate());
  };
  if (!m_options.tolerance) {
    make(m_options, m_options.representation.value_or(isIdentity ? Representation::Identity : usual));
    return;
  }
  if (!(*m_options.tolerance > 0.0) || m_options.representation) {
    throw InputError(
        "", "tolerance", std::to_string(*m_options.tolerance),
        m_options.representation ? "chooses the representation itself; name one or the other" : "must be above 0");
  }
  if (isIdentity) {
    make(m_options, Representation::Identity);
    return;
  }
  BakeOptions tried = m_options;
  const int largest = m_options.size != 0 ? tableSize(m_options, usual, m_format) : kLargestUsual;
  const std::vector<Rung> rungs = rungsOf(m_format.content, holdsChain(m_format), largest);
  double share = kPreparedShare;
  m_judged.certificate().choice = climb(rungs, *m_options.tolerance, [&](const Rung& rung) {
    m_judged.tell(share);
    share += (kChosenShare - kPreparedShare) / static_cast<double>(rungs.size());
    tried.size = rung.size;
    make(tried, rung.representation);
    return m_judged.protocol().measure(
        Candidate(PixelProcessor(m_operators.group), m_operators.toPixels, m_operators.fromPixels));
  });
}

std::string textOf(const Baking& baking, const LutFormat& format, const BakeOptions& options) {
  const Certificate& certificate = baking.certificate();
  return lutText(format, baking.group(), certificate.size, descriptionOf(certificate), options.shaperSize);
}

}  // namespace

Baked bake(const sip::Recipe& recipe, const spectral::DataLibrary& library, const BakeOptions& options) {
  Baking baking(recipe, library, lutFormats().front(), options);
  baking.certify();
  return {baking.group(), std::move(baking.certificate())};
}

BakedText bakeText(const sip::Recipe& recipe, const spectral::DataLibrary& library, const std::string& formatName,
                   const BakeOptions& options) {
  const LutFormat& format = lutFormatNamed(formatName);
  Baking baking(recipe, library, format, options);
  Certificate& certificate = baking.certificate();
  certificate.format = format.name;
  inParallel([&] { baking.certify(PixelProcessor(baking.group())); },
             [&] { baking.certifyOnCards(shaderOperators(baking.group())); });
  baking.tellCertified();
  std::string text = textOf(baking, format, options);
  certificate.sha256 = sha256(text);
  return {std::move(text), std::move(certificate)};
}

Certificate bakeFile(const sip::Recipe& recipe, const spectral::DataLibrary& library, const std::filesystem::path& file,
                     const std::string& formatName, const BakeOptions& options) {
  const LutFormat& format = lutFormat(file, formatName);
  CertifiedFile lut(file);

  Baking baking(recipe, library, format, options);
  Certificate& certificate = baking.certificate();
  certificate.format = format.name;
  // Twice: what the file says of itself is known before it is written, what the certificate says after.
  baking.certify();
  const std::string text = textOf(baking, format, options);
  lut.file().write(text);
  certificate.sha256 = sha256(text);
  inParallel([&] { baking.certify(PixelProcessor::fromFile(lut.file().path())); },
             [&] { baking.certifyOnCards(shaderOperators(lut.file().path())); });
  if (options.tolerance && certificate.error.p99 > 1.01 * *options.tolerance) {
    throw InputError(spectral::utf8(file), "tolerance", std::to_string(*options.tolerance),
                     "is lost in the digits of " + format.name + "; name a format that keeps more");
  }
  lut.commit(certificate);
  return std::move(certificate);
}

std::string convertedLuts(const std::vector<std::filesystem::path>& luts, const LutFormat& format, int size,
                          int shaperSize) {
  if (luts.empty()) {
    throw InputError("", "LUT files", "0", "are none; name at least one");
  }
  BakeOptions options;
  options.size = size;
  auto group = OCIO::GroupTransform::Create();
  LutDescription description;
  for (const auto& lut : luts) {
    // Read once for its own error; then as one of the group.
    PixelProcessor::fromFile(lut);
    auto transform = OCIO::FileTransform::Create();
    transform->setSrc(spectral::utf8(std::filesystem::absolute(lut)).c_str());
    transform->setInterpolation(OCIO::INTERP_BEST);
    group->appendTransform(transform);
    description.name += (description.name.empty() ? "" : " + ") + spectral::utf8(lut.filename());
    description.lines.push_back(spectral::utf8(lut.filename()) + " sha256 " + sha256(spectral::readTextFile(lut)));
  }
  const auto resolved = OCIO::Config::CreateRaw()->getProcessor(group)->createGroupTransform();
  description.id = "metamer-" + sha256(description.name).substr(0, 16);
  return lutText(format, resolved, tableSize(options, Representation::LogCube, format), description, shaperSize);
}

}  // namespace metamer::ocio
