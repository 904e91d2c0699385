// SPDX-License-Identifier: Apache-2.0
#include "scene_file/scene_texture.h"

#include <tbb/parallel_for.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "metamer/sip/scene_uplift.h"
#include "metamer/sip/tabulated_uplift.h"
#include "metamer/spectral/chromatic_adaptation.h"
#include "metamer/spectral/formatted.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/srgb_curve.h"
#include "metamer/spectral/storage.h"
#include "metamer/spectral/text.h"
#include "scene_file/scene_pixels.h"

namespace metamer::spectral_ref {
namespace {

using Eigen::Index;
using spectral::SpectralQuantity;

constexpr int kUsualNumbers = 20;
/// Outside 0 ... 1 beyond rounding.
constexpr double kSlack = 1e-4;

/// The spectra of a picture's rows.
struct RowSpectra {
  virtual ~RowSpectra() = default;
  virtual const std::vector<double>& wavelengthsNm() const = 0;
  /// @return  wavelengths x pixels
  virtual Eigen::MatrixXd row(int y) const = 0;
};

/// As the file has them.
class OwnSpectra : public RowSpectra {
 public:
  OwnSpectra(const Pixels& pixels, const std::vector<std::pair<double, int>>& channels) : m_pixels(pixels) {
    for (const auto& [nm, channel] : channels) {
      m_wavelengthsNm.push_back(nm);
      m_channels.push_back(channel);
    }
  }
  const std::vector<double>& wavelengthsNm() const override { return m_wavelengthsNm; }
  Eigen::MatrixXd row(int y) const override {
    const Eigen::Map<const Eigen::MatrixXf> values(
        m_pixels.values.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(m_pixels.width) *
                                     static_cast<std::size_t>(m_pixels.channels),
        m_pixels.channels, m_pixels.width);
    return values(m_channels, Eigen::all).cast<double>();
  }

 private:
  const Pixels& m_pixels;
  std::vector<double> m_wavelengthsNm;
  std::vector<Index> m_channels;
};

/// Of colours.
class UpliftedSpectra : public RowSpectra {
 public:
  UpliftedSpectra(const Pixels& pixels, std::unique_ptr<const spectral::Uplift> uplift, const Eigen::Matrix3d& toRec709)
      : m_pixels(pixels), m_uplift(std::move(uplift)), m_toRec709(toRec709) {
    const auto named = [&](const char* name, int otherwise) {
      const auto found = std::find_if(pixels.names.begin(), pixels.names.end(),
                                      [&](const std::string& own) { return spectral::lowerCase(own) == name; });
      return found != pixels.names.end() ? static_cast<int>(found - pixels.names.begin()) : otherwise;
    };
    // A picture of one or two channels is grey, the second of two its alpha.
    const bool isGrey = pixels.channels < 3;
    m_channels = {named("r", 0), isGrey ? 0 : named("g", 1), isGrey ? 0 : named("b", 2)};
  }
  const std::vector<double>& wavelengthsNm() const override { return m_uplift->wavelengthsNm(); }
  Eigen::MatrixXd row(int y) const override {
    Eigen::Matrix3Xd colours(3, m_pixels.width);
    for (int x = 0; x < m_pixels.width; ++x) {
      const float* pixel =
          m_pixels.values.data() +
          (static_cast<std::size_t>(y) * static_cast<std::size_t>(m_pixels.width) + static_cast<std::size_t>(x)) *
              static_cast<std::size_t>(m_pixels.channels);
      for (Index k = 0; k < 3; ++k) {
        const double value = pixel[m_channels[static_cast<std::size_t>(k)]];
        colours(k, x) = m_pixels.isFloat ? value : spectral::linearFromSrgb(value);
      }
    }
    colours = (m_toRec709 * colours).eval();
    Eigen::MatrixXd spectra(static_cast<Index>(wavelengthsNm().size()), m_pixels.width);
    m_uplift->spectra({colours.data(), static_cast<std::size_t>(colours.size())},
                      {spectra.data(), static_cast<std::size_t>(spectra.size())});
    return spectra;
  }

 private:
  const Pixels& m_pixels;
  std::unique_ptr<const spectral::Uplift> m_uplift;
  Eigen::Matrix3d m_toRec709;
  std::array<int, 3> m_channels{};
};

/// Samples of the domain from reflectances at wavelengths.
Eigen::MatrixXd samplesFrom(const std::vector<double>& wavelengthsNm) {
  Eigen::MatrixXd matrix(spectral::kDomainSize, static_cast<Index>(wavelengthsNm.size()));
  for (std::size_t k = 0; k < wavelengthsNm.size(); ++k) {
    std::vector<double> hat(wavelengthsNm.size(), 0.0);
    hat[k] = 1.0;
    matrix.col(static_cast<Index>(k)) =
        spectral::Spectrum("hat", SpectralQuantity::Reflectance, wavelengthsNm, std::move(hat)).onDomain();
  }
  return matrix;
}

/// Where the hats of a storage form stand: the numbers of the straight line, which hats hold exactly.
std::vector<double> nodesOf(const spectral::HatBasis& basis) {
  const Eigen::VectorXd nodes =
      basis.numbersFromSamples *
      Eigen::VectorXd::LinSpaced(spectral::kDomainSize, spectral::kDomainStartNm, spectral::kDomainEndNm);
  return {nodes.begin(), nodes.end()};
}

std::unique_ptr<RowSpectra> spectraOf(const YamlMap& section, const Pixels& pixels,
                                      const spectral::DataLibrary& library) {
  const auto channels = spectralChannels(pixels, SpectralQuantity::Reflectance);
  if (!channels.empty()) {
    for (const char* key : {"uplift", "space"}) {
      if (const auto other = section.find(key)) {
        throw other->error("", "the picture has spectra of its own; leave it out");
      }
    }
    return std::make_unique<OwnSpectra>(pixels, channels);
  }
  const auto method = section.find("uplift");
  const std::string name = method ? method->text() : "natural";
  auto uplift = lookUp(method.value_or(section), [&] { return sip::makeUplift(name, library); });
  if (sip::isSceneUplift(name)) {
    uplift = sip::tabulated(std::move(uplift), library.colourSpace("ACES2065-1").linear);
  }
  const spectral::RgbSpace rec709 = library.colourSpace("Rec.709").linear;
  const auto space = section.find("space");
  const spectral::RgbSpace own =
      space ? lookUp(*space, [&] { return library.colourSpace(space->text()).linear; }) : rec709;
  const Eigen::Matrix3d toRec709 = spectral::adaptRgb(spectral::ChromaticAdaptation::Bradford, own, rec709);
  return std::make_unique<UpliftedSpectra>(pixels, std::move(uplift), toRec709);
}

}  // namespace

Material readTexturedDiffuse(const YamlValue& value, Texture place, SceneSpectra& spectra, Scene& scene) {
  const YamlMap section(value, {"picture", "uplift", "space", "numbers"});
  const YamlValue file = section.require("picture", "is missing; name a picture file");
  if (place.wrap == Texture::Wrap::Mesh && place.corners.empty()) {
    throw file.error("the mesh has no texture coordinates; give some to every face, within -1000 ... 1000");
  }
  const auto numbers = section.find("numbers");
  const int count = numbers ? numbers->integer(spectral::kFewestStored, spectral::kMostStored) : kUsualNumbers;
  const Pixels pixels = readPixels(file, spectra.folder());
  const std::unique_ptr<const RowSpectra> rows = spectraOf(section, pixels, spectra.library());

  const spectral::HatBasis basis = spectral::SpectrumStorage(spectra.library()).hatBasis(count);
  const Eigen::MatrixXd numbersFromValues = basis.numbersFromSamples * samplesFrom(rows->wavelengthsNm());
  ReflectancePicture& picture = place.picture;
  picture.width = pixels.width;
  picture.height = pixels.height;
  picture.nodesNm = nodesOf(basis);
  const std::size_t rowSize = static_cast<std::size_t>(pixels.width) * static_cast<std::size_t>(count);
  picture.values.resize(rowSize * static_cast<std::size_t>(pixels.height));
  std::vector<Eigen::VectorXd> sums(static_cast<std::size_t>(pixels.height));
  std::vector<Index> outside(static_cast<std::size_t>(pixels.height));
  tbb::parallel_for(0, pixels.height, [&](int y) {
    const Eigen::MatrixXd found = rows->row(y);
    const Eigen::ArrayXXd kept = (numbersFromValues * found).array().max(0.0).min(1.0);
    const auto at = static_cast<std::size_t>(y);
    std::transform(
        kept.data(), kept.data() + kept.size(), picture.values.begin() + static_cast<std::ptrdiff_t>(at * rowSize),
        [](double number) { return static_cast<std::uint16_t>(std::lround(ReflectancePicture::kLargest * number)); });
    sums[at] = kept.rowwise().sum();
    for (Index x = 0; x < found.cols(); ++x) {
      outside[at] += found.col(x).minCoeff() < -kSlack || found.col(x).maxCoeff() > 1 + kSlack ? 1 : 0;
    }
  });
  const double pixelCount = static_cast<double>(pixels.width) * pixels.height;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(count);
  double cut = 0;
  for (std::size_t y = 0; y < sums.size(); ++y) {
    mean += sums[y];
    cut += static_cast<double>(outside[y]);
  }
  if (cut > 0) {
    scene.warnings.push_back(
        file.text() + spectral::formatted(": %.2g %% of the pixels have spectra that leave 0 to 1, which no surface "
                                          "has: cut; scale the picture, or take another uplift",
                                          100 * cut / pixelCount));
  }
  Material material;
  material.kind = Material::Kind::Diffuse;
  material.colour = spectra.add(spectral::DomainSamples(basis.samplesFromNumbers * mean / pixelCount));
  material.texture = static_cast<std::uint32_t>(scene.textures.size());
  scene.textures.push_back(std::move(place));
  return material;
}

}  // namespace metamer::spectral_ref
