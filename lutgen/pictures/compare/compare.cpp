// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>

#include "compare/compare_report.h"
#include "compare/heat_map.h"
#include "library.h"
#include "metamer/ocio/certificate_record.h"
#include "metamer/ocio/compared_transform.h"
#include "metamer/ocio/config_writer.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/working_space.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"
#include "picture.h"
#include "picture_commands.h"
#include "run.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

struct CompareArguments {
  std::string a;
  std::string b;
  std::string space;
  std::string shaper;
  std::string tolerance;
  std::string statistic = "p99";
  std::string json;
  std::string junit;
  std::string plot;
};

enum class Kind { Recipe, Look, Picture, File };

std::string extensionOf(const std::string& name) {
  return spectral::lowerCase(spectral::utf8(spectral::pathOf(name).extension()));
}

bool isConfig(const std::string& name) {
  const std::string extension = extensionOf(name);
  return extension == ".ocio" || extension == ".ocioz" || ocio::isBuiltInConfig(name);
}

/// Where the colon of CONFIG:LOOK stands; npos where no look is named.
std::size_t lookMark(const std::string& name) {
  const std::string scheme = "ocio://";
  const std::size_t start = ocio::isBuiltInConfig(name) ? scheme.size() : 0;
  for (std::size_t at = name.find(':', start); at != std::string::npos; at = name.find(':', at + 1)) {
    if (isConfig(name.substr(0, at))) {
      return at;
    }
  }
  return std::string::npos;
}

Kind kindOf(const std::string& name) {
  const std::string extension = extensionOf(name);
  if (lookMark(name) != std::string::npos || isConfig(name)) {
    return Kind::Look;
  }
  if (extension == ".yaml" || extension == ".yml") {
    return Kind::Recipe;
  }
  // "openexr:exr;tiff:tiff,tif;..."
  std::string known = OIIO::get_string_attribute("extension_list");
  std::replace_if(
      known.begin(), known.end(), [](char c) { return c == ':' || c == ';'; }, ',');
  const bool isPicture =
      extension.size() > 1 && ("," + known + ",").find("," + extension.substr(1) + ",") != std::string::npos;
  return isPicture ? Kind::Picture : Kind::File;
}

/// CONFIG:LOOK; without a look, the one of the recipe's name that it is compared with.
ocio::ComparedTransform lookOf(const std::string& name, const std::string& recipeName,
                               const spectral::DataLibrary& library) {
  const std::size_t mark = lookMark(name);
  if (mark == std::string::npos && recipeName.empty()) {
    throw InputError(name, "look", "", "name one: " + name + ":LOOK");
  }
  const std::string look = mark == std::string::npos ? recipeName : name.substr(mark + 1);
  return ocio::comparedLook(name.substr(0, mark), look, library);
}

constexpr const char* kByCertificate = "certificate";

/// A number of 0 or more; nothing where the certificate judges, or nobody does.
std::optional<double> numberOf(const std::string& tolerance) {
  if (tolerance.empty() || tolerance == kByCertificate) {
    return std::nullopt;
  }
  const std::optional<double> number = spectral::parseNumber(tolerance);
  if (!number || !(*number >= 0)) {
    throw CLI::ValidationError("--tolerance", "'" + tolerance + "' must be a number of 0 or more, or certificate");
  }
  return number;
}

/// The certificate of a file or look; empty where it has none.
std::filesystem::path certificateFileOf(const std::string& name, const std::string& recipeName) {
  std::filesystem::path file = spectral::pathOf(name + ".json");
  if (kindOf(name) == Kind::Look) {
    const std::size_t mark = lookMark(name);
    file = ocio::certificateOfLook(spectral::pathOf(name.substr(0, mark)),
                                   mark == std::string::npos ? recipeName : name.substr(mark + 1));
  }
  std::error_code none;
  return std::filesystem::is_regular_file(file, none) ? file : std::filesystem::path();
}

class Comparer {
 public:
  explicit Comparer(const CompareArguments& arguments)
      : m_arguments(arguments), m_library(openLibrary()), m_config(ocio::ConfigSource::environment()) {}

  CompareReport transforms() {
    const std::optional<sip::Recipe> recipeA = recipeOf(m_arguments.a);
    const std::optional<sip::Recipe> recipeB = recipeOf(m_arguments.b);
    ocio::LutPixels pixels;
    pixels.shaper = m_arguments.shaper;
    if (recipeA || recipeB) {
      pixels.space = recipeA ? recipeA->space : recipeB->space;
    }
    if (!m_arguments.space.empty()) {
      pixels.space = m_arguments.space;
    }
    const auto transformOf = [&](const std::string& name, const std::optional<sip::Recipe>& recipe,
                                 const std::optional<sip::Recipe>& other) {
      switch (kindOf(name)) {
        case Kind::Recipe:
          return ocio::comparedRecipe(*recipe, m_library, m_config);
        case Kind::Look:
          return lookOf(name, other ? other->name : "", m_library);
        case Kind::Picture:
          throw InputError(name, "comparison", "", "is a picture; a picture is compared with a picture");
        case Kind::File:
          break;
      }
      return ocio::comparedFile(spectral::pathOf(name), pixels, m_library, m_config);
    };
    const ocio::ComparedTransform a = transformOf(m_arguments.a, recipeA, recipeB);
    const ocio::ComparedTransform b = transformOf(m_arguments.b, recipeB, recipeA);
    m_space = ocio::comparisonSpace(a, b);
    CompareReport report{a.kind,
                         m_arguments.a,
                         b.kind,
                         m_arguments.b,
                         m_space.name,
                         ocio::compareTransforms(a, b, m_space, m_library),
                         numberOf(m_arguments.tolerance),
                         m_arguments.statistic};
    if (static_cast<bool>(recipeA) != static_cast<bool>(recipeB)) {
      addPromise(report, recipeA ? *recipeA : *recipeB, recipeA ? m_arguments.b : m_arguments.a);
    } else if (m_arguments.tolerance == kByCertificate) {
      throw InputError(m_arguments.b, "tolerance", kByCertificate,
                       "judges a file or look by the recipe that it was made from; compare it with one");
    }
    return report;
  }

  CompareReport pictures() {
    if (m_arguments.tolerance == kByCertificate) {
      throw InputError(m_arguments.b, "tolerance", kByCertificate, "is for transforms; give a number");
    }
    const Picture a(spectral::pathOf(m_arguments.a));
    const Picture b(spectral::pathOf(m_arguments.b));
    if (a.width() != b.width() || a.height() != b.height()) {
      throw InputError(m_arguments.b, "size", std::to_string(b.width()) + " x " + std::to_string(b.height()),
                       "is not that of " + m_arguments.a + ", " + std::to_string(a.width()) + " x " +
                           std::to_string(a.height()) + "; crop or scale one of them");
    }
    const auto linear = [&](const Picture& picture, spectral::RgbSpace& space) {
      std::vector<float> rgba = picture.rgba();
      if (m_arguments.space.empty() && picture.isSrgb()) {
        space = m_library.colourSpace("Rec.709").linear;
        decodeSrgb(rgba);
        return rgba;
      }
      const ocio::WorkingSpace working =
          ocio::findWorkingSpace(m_arguments.space.empty() ? "ACEScg" : m_arguments.space, m_library, m_config);
      space = working.engine;
      if (working.toEngine) {
        ocio::PixelProcessor(working.toEngine).apply(rgba);
      }
      return rgba;
    };
    spectral::RgbSpace spaceB;
    const std::vector<float> pixelsA = linear(a, m_space);
    const std::vector<float> pixelsB = linear(b, spaceB);
    if (spaceB.name != m_space.name) {
      throw InputError(
          m_arguments.b, "pixels", spaceB.name,
          "are not of the kind of " + m_arguments.a + ", " + m_space.name + "; say what both are: --space");
    }
    m_pictureWidth = a.width();
    return {"picture",
            m_arguments.a,
            "picture",
            m_arguments.b,
            m_space.name,
            sip::comparePixels(m_space, pixelsA, pixelsB),
            numberOf(m_arguments.tolerance),
            m_arguments.statistic};
  }

  void plot(const CompareReport& report) const {
    HeatMapOptions options;
    options.scale = ErrorScale(report.comparison.max);
    options.tolerance = report.tolerance;
    options.spaceName = report.space;
    options.pictureWidth = m_pictureWidth;
    options.title = "CIEDE2000, " + report.nameA + " against " + report.nameB;
    writeHeatMap(spectral::pathOf(m_arguments.plot), report.comparison, m_space, m_library.observer("CIE 1931 2"),
                 options);
  }

 private:
  /// @param name  of the file or look
  void addPromise(CompareReport& report, const sip::Recipe& recipe, const std::string& name) const {
    const std::filesystem::path file = certificateFileOf(name, recipe.name);
    if (file.empty()) {
      if (m_arguments.tolerance == kByCertificate) {
        throw InputError(name, "tolerance", kByCertificate,
                         "has no certificate beside it; bake it again, or give a number");
      }
      return;
    }
    report.certificate = ocio::readCertificate(file);
    report.isJudgedByCertificate = !report.tolerance;
    if (kindOf(name) == Kind::File && !report.certificate->sha256.empty() &&
        ocio::sha256(spectral::readTextFile(spectral::pathOf(name))) != report.certificate->sha256) {
      report.stale.push_back(name + " is not the file that its certificate is for");
    }
    for (const ocio::CertificateChange& change : ocio::staleParts(*report.certificate, recipe, m_library)) {
      report.stale.push_back(change.words());
    }
  }

  static std::optional<sip::Recipe> recipeOf(const std::string& name) {
    return kindOf(name) == Kind::Recipe ? std::optional(sip::readRecipe(spectral::pathOf(name))) : std::nullopt;
  }

  CompareArguments m_arguments;
  spectral::DataLibrary m_library;
  ocio::ConfigSource m_config;
  spectral::RgbSpace m_space;
  int m_pictureWidth = 0;
};

/// A file for text; none where it is not asked for.
std::unique_ptr<spectral::PendingFile> pendingFor(const std::string& file) {
  return file.empty() ? nullptr : std::make_unique<spectral::PendingFile>(spectral::pathOf(file));
}

void writeText(const std::unique_ptr<spectral::PendingFile>& file, const std::string& text) {
  if (file) {
    file->write(text);
    file->commit();
  }
}

void compare(const CompareArguments& arguments) {
  numberOf(arguments.tolerance);
  // The places first: what cannot be written is not worth the work.
  const auto json = pendingFor(arguments.json);
  const auto junit = pendingFor(arguments.junit);
  spectral::requireWritable(spectral::pathOf(arguments.plot));
  Comparer comparer(arguments);
  const bool pictures = kindOf(arguments.a) == Kind::Picture && kindOf(arguments.b) == Kind::Picture;
  const CompareReport report = pictures ? comparer.pictures() : comparer.transforms();
  writeText(json, jsonOf(report));
  writeText(junit, junitOf(report));
  if (!arguments.plot.empty()) {
    comparer.plot(report);
  }
  words() << textOf(report);
  summarise(arguments.a + " against " + arguments.b + spectral::formatted(": p99 %.3g", report.comparison.p99));
  if (!report.passes()) {
    throw CLI::RuntimeError(kExceeded);
  }
}

}  // namespace

void addCompare(CLI::App& application) {
  CLI::App* command = kCompare.addTo(application);
  const auto arguments = std::make_shared<CompareArguments>();
  const std::string what = "Recipe (.yaml), LUT file, look of a config (CONFIG.ocio:LOOK) or picture";
  command->add_option("A", arguments->a, what)->required();
  command->add_option("B", arguments->b, what)->required();
  command->add_option("--tolerance", arguments->tolerance,
                      "Largest CIEDE2000 that passes, or certificate: what the file's own promises. That by default, "
                      "where a recipe is compared with a file or look that has one");
  command->add_option("--statistic", arguments->statistic, "What the tolerance is for: p99 by default")
      ->check(CLI::IsMember({"mean", "p99", "max"}));
  command->add_option("--json", arguments->json, "File for the figures as JSON");
  command->add_option("--junit", arguments->junit, "File for the verdict as JUnit XML");
  command->add_option("--plot", arguments->plot, "PNG of the differences over chromaticity and exposure");
  command->add_option(
      "--space", arguments->space,
      "What the pixels are, of pictures and of LUT files without a certificate; the recipe's or ACEScg");
  command->add_option("--shaper", arguments->shaper,
                      "Curve of LUT files without a certificate; ACEScct by default, none for .ctf and .clf");
  command->callback([arguments] { compare(*arguments); });
}

}  // namespace metamer::lutgen
