// SPDX-License-Identifier: Apache-2.0
#include "skin/skin_chart.h"

#include <OpenImageIO/imagebuf.h>

#include <algorithm>
#include <cmath>

#include "apply/picture_clues.h"
#include "metamer/ocio/display_curve.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/spectral_picture.h"
#include "picture.h"

namespace metamer::lutgen {
namespace {

using spectral::formatted;

std::string nameOf(std::size_t index) {
  return "skin " + std::to_string(index);
}

}  // namespace

std::vector<skin::SkinParameters> drawnSkins(const skin::SkinPrior& prior, int count, std::uint32_t seed,
                                             int& columns) {
  columns = std::max(1, static_cast<int>(std::ceil(std::sqrt(1.5 * count))));
  return sampleSkins(prior, count, seed);
}

std::vector<skin::SkinParameters> griddedSkins(const skin::SkinPrior& prior, int columns, int rows) {
  constexpr double kDeviations = 2.5;
  std::vector<skin::SkinParameters> skins;
  const auto along = [&](Eigen::Index which, int step, int steps) {
    const double place = steps == 1 ? 0 : 2.0 * step / (steps - 1) - 1;
    return prior.mean[which] + kDeviations * place * prior.standardDeviation[which];
  };
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      skin::SkinCoordinates at = prior.mean;
      at[0] = along(0, column, columns);
      at[1] = along(1, row, rows);
      skins.push_back(skin::skinOf(at.cwiseMax(skin::lowestCoordinates())));
    }
  }
  return skins;
}

SkinChart skinChart(const skin::SkinColours& colours, std::vector<skin::SkinParameters> skins, int columns) {
  SkinChart chart{columns, std::move(skins), {}, {}};
  for (const skin::SkinParameters& skin : chart.skins) {
    chart.spectra.push_back(colours.albedo(skin));
    chart.rgb.push_back(colours.view().rgbWeights() * chart.spectra.back());
  }
  return chart;
}

std::string skinSpectraCsv(const SkinChart& chart) {
  std::string text = "wavelength_nm";
  for (std::size_t i = 0; i < chart.skins.size(); ++i) {
    text += "," + nameOf(i);
  }
  const std::vector<double> wavelengths = skin::skinWavelengths();
  for (std::size_t band = 0; band < wavelengths.size(); ++band) {
    text += formatted("\n%g", wavelengths[band]);
    for (const skin::SkinSpectrum& spectrum : chart.spectra) {
      text += formatted(",%.9g", spectrum[static_cast<Eigen::Index>(band)]);
    }
  }
  return text + "\n";
}

std::string skinColoursCsv(const SkinChart& chart, const spectral::RgbSpace& space) {
  std::string text = "patch,R,G,B,L*,a*,b*,melanin,blood,thickness_um,melanin_type,deoxygenation\n";
  for (std::size_t i = 0; i < chart.skins.size(); ++i) {
    const Eigen::Vector3d& rgb = chart.rgb[i];
    const Eigen::Vector3d lab = spectral::lab(space.xyzFromRgb() * rgb, space.whiteXyz());
    const skin::SkinParameters& skin = chart.skins[i];
    text += nameOf(i) + formatted(",%.9g,%.9g,%.9g,%.6g,%.6g,%.6g", rgb[0], rgb[1], rgb[2], lab[0], lab[1], lab[2]) +
            formatted(",%.9g,%.9g,%.9g,%.9g,%.9g\n", skin.melanin, skin.blood, skin.thicknessUm, skin.eumelanin,
                      skin.deoxyhaemoglobin);
  }
  return text;
}

void writeSkinChart(const SkinChart& chart, const spectral::RgbSpace& space, int patchPixels, bool isSpectral,
                    const std::filesystem::path& file) {
  std::vector<std::string> names = {"R", "G", "B"};
  if (isSpectral) {
    for (const double nm : skin::skinWavelengths()) {
      names.push_back(spectral::channelOfWavelength(nm, spectral::SpectralQuantity::Reflectance));
    }
  }
  OIIO::ImageSpec spec(chart.columns * patchPixels, chart.rows() * patchPixels, static_cast<int>(names.size()),
                       OIIO::TypeDesc::FLOAT);
  spec.channelnames = names;
  const bool isExr = formatOf(file) == "openexr";
  if (isExr) {
    const auto xy = chromaticitiesOf(space);
    spec.attribute("compression", "zip");
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), xy.data());
  }
  if (isSpectral) {
    spec.attribute("spectralLayoutVersion", "1.0");
  }
  const auto curve = ocio::displayCurveNamed("sRGB");
  const bool isEncoded = isSrgbFormat(formatOf(file));
  OIIO::ImageBuf pixels(spec);
  std::vector<float> values(names.size());
  for (int y = 0; y < spec.height; ++y) {
    for (int x = 0; x < spec.width; ++x) {
      const std::size_t index = static_cast<std::size_t>(y / patchPixels * chart.columns + x / patchPixels);
      std::fill(values.begin(), values.end(), 0.0F);
      if (index < chart.skins.size()) {
        std::transform(chart.rgb[index].begin(), chart.rgb[index].end(), values.begin(), [&](double light) {
          return static_cast<float>(isEncoded ? curve->encoded(std::clamp(light, 0.0, 1.0)) : light);
        });
        if (isSpectral) {
          std::transform(chart.spectra[index].begin(), chart.spectra[index].end(), values.begin() + 3,
                         [](double share) { return static_cast<float>(share); });
        }
      }
      pixels.setpixel(x, y, values.data());
    }
  }
  writePixels(pixels, file, isEncoded ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT, "chart");
}

}  // namespace metamer::lutgen
