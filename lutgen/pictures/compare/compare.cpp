// SPDX-License-Identifier: Apache-2.0
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <memory>

#include "compare/compare_report.h"
#include "compare/heat_map.h"
#include "metamer/ocio/compared_transform.h"
#include "metamer/ocio/pixel_processor.h"
#include "metamer/ocio/working_space.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/pending_file.h"
#include "metamer/spectral/text.h"
#include "picture.h"
#include "picture_commands.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;

struct CompareArguments {
  std::string a;
  std::string b;
  std::string space;
  std::string shaper;
  std::optional<double> tolerance;
  std::string statistic = "p99";
  std::string json;
  std::string junit;
  std::string plot;
};

enum class Kind { Recipe, Look, Picture, File };

std::string extensionOf(const std::string& name) {
  return spectral::lowerCase(std::filesystem::path(name).extension().string());
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

class Comparer {
 public:
  explicit Comparer(const CompareArguments& arguments)
      : m_arguments(arguments),
        m_library(spectral::DataLibrary::openDefault()),
        m_config(ocio::ConfigSource::environment()) {}

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
      return ocio::comparedFile(name, pixels, m_library, m_config);
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
                         m_arguments.tolerance,
                         m_arguments.statistic};
    return report;
  }

  CompareReport pictures() {
    const Picture a(m_arguments.a);
    const Picture b(m_arguments.b);
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
            m_arguments.tolerance,
            m_arguments.statistic};
  }

  void plot(const CompareReport& report) const {
    HeatMapOptions options;
    options.scale =
        report.tolerance ? 2.0 * *report.tolerance : std::min(report.comparison.max, 2.0 * report.comparison.p99);
    options.scale = std::max(options.scale, 0.01);
    options.pictureWidth = m_pictureWidth;
    options.title = "CIEDE2000, " + report.nameA + " against " + report.nameB;
    writeHeatMap(m_arguments.plot, report.comparison, m_space, m_library.observer("CIE 1931 2"), options);
  }

 private:
  static std::optional<sip::Recipe> recipeOf(const std::string& name) {
    return kindOf(name) == Kind::Recipe ? std::optional(sip::readRecipe(name)) : std::nullopt;
  }

  CompareArguments m_arguments;
  spectral::DataLibrary m_library;
  ocio::ConfigSource m_config;
  spectral::RgbSpace m_space;
  int m_pictureWidth = 0;
};

void writeText(const std::string& file, const std::string& text) {
  if (!file.empty()) {
    spectral::writeWholeFile(file, text);
  }
}

void compare(const CompareArguments& arguments) {
  Comparer comparer(arguments);
  const bool pictures = kindOf(arguments.a) == Kind::Picture && kindOf(arguments.b) == Kind::Picture;
  const CompareReport report = pictures ? comparer.pictures() : comparer.transforms();
  writeText(arguments.json, jsonOf(report));
  writeText(arguments.junit, junitOf(report));
  if (!arguments.plot.empty()) {
    comparer.plot(report);
  }
  std::cout << textOf(report);
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
  command->add_option("--tolerance", arguments->tolerance, "Largest CIEDE2000 that passes")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--statistic", arguments->statistic, "What the tolerance is for: p99 by default")
      ->check(CLI::IsMember({"mean", "p99", "max"}));
  command->add_option("--json", arguments->json, "File for the figures as JSON");
  command->add_option("--junit", arguments->junit, "File for the verdict as JUnit XML");
  command->add_option("--plot", arguments->plot, "PNG of the differences over chromaticity and exposure");
  command->add_option(
      "--space", arguments->space,
      "What the pixels are, of pictures and of LUT files without a certificate; the recipe's or ACEScg");
  command->add_option("--shaper", arguments->shaper,
                      "Log curve of LUT files without a certificate; ACEScct by default, none for .ctf and .clf");
  command->callback([arguments] { compare(*arguments); });
}

}  // namespace metamer::lutgen
