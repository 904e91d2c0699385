// SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <string>
#include <vector>

#include "arrays.h"
#include "bindings.h"
#include "metamer/skin/skin_edit.h"
#include "metamer/skin/skin_estimator.h"
#include "metamer/skin/skin_network.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"
#include "spectrum_like.h"

using namespace nanobind::literals;

namespace metamer::python {
namespace {

using skin::SkinEstimator;
using skin::SkinParameters;
using skin::SkinPixel;

// An array of maps has nine numbers a pixel, an array of skins five.
constexpr std::size_t kMaps = 9;
constexpr std::size_t kParameters = 5;

/// Checks the last axis; the shape with another last one.
std::vector<std::size_t> shapeWith(const Doubles& array, std::size_t last, std::size_t instead, const char* what) {
  if (array.ndim() == 0 || array.shape(array.ndim() - 1) != last) {
    throw nb::value_error((std::string(what) + ": the last axis must have " + std::to_string(last)).c_str());
  }
  std::vector<std::size_t> shape(array.ndim());
  for (std::size_t i = 0; i < shape.size(); ++i) {
    shape[i] = array.shape(i);
  }
  shape.back() = instead;
  return shape;
}

SkinParameters parametersAt(const double* five) {
  return {five[0], five[1], five[2], five[3], five[4]};
}

std::vector<SkinPixel> pixelsOf(const Doubles& maps) {
  shapeWith(maps, kMaps, kMaps, "maps");
  std::vector<SkinPixel> pixels(maps.size() / kMaps);
  const double* from = maps.data();
  for (SkinPixel& pixel : pixels) {
    std::transform(from, from + 5, pixel.skin.begin(), [](double value) { return static_cast<float>(value); });
    pixel.gain = static_cast<float>(from[5]);
    std::transform(from + 6, from + 9, pixel.residual.begin(), [](double value) { return static_cast<float>(value); });
    from += kMaps;
  }
  return pixels;
}

NumpyDoubles mapsOf(const std::vector<SkinPixel>& pixels, const std::vector<std::size_t>& shape) {
  return newDoubles(shape, [&](double* to) {
    for (const SkinPixel& pixel : pixels) {
      to = std::copy(pixel.skin.begin(), pixel.skin.end(), to);
      *to++ = static_cast<double>(pixel.gain);
      to = std::copy(pixel.residual.begin(), pixel.residual.end(), to);
    }
  });
}

const skin::SkinPrior& prior() {
  static const skin::SkinPrior prior = skin::SkinPrior::read(libraryOr(nullptr));
  return prior;
}

/// The model's albedo, or the mean measured skin's.
NumpyDoubles albedo(nb::handle skins, bool repair) {
  static const skin::SkinModel model(libraryOr(nullptr));
  const Doubles array = doubles(skins);
  const std::vector<std::size_t> shape = shapeWith(array, kParameters, skin::kSkinBands, "skins");
  return newDoubles(shape, [&](double* to) {
    for (std::size_t i = 0; i < array.size(); i += kParameters) {
      skin::SkinSpectrum spectrum = model.albedo(parametersAt(array.data() + i));
      if (repair) {
        spectrum = skin::repaired(spectrum, prior());
      }
      to = std::copy(spectrum.begin(), spectrum.end(), to);
    }
  });
}

std::vector<double> wavelengthsFrom(nb::handle wavelengths) {
  const Doubles array = doubles(wavelengths);
  return {array.data(), array.data() + array.size()};
}

/// The model's albedo at any wavelengths, nothing repaired.
NumpyDoubles albedoAt(nb::handle skins, nb::handle wavelengths) {
  const skin::SkinModel model(libraryOr(nullptr), wavelengthsFrom(wavelengths));
  const Doubles array = doubles(skins);
  const std::vector<std::size_t> shape = shapeWith(array, kParameters, model.optics().wavelengthsNm().size(), "skins");
  return newDoubles(shape, [&](double* to) {
    for (std::size_t i = 0; i < array.size(); i += kParameters) {
      const Eigen::VectorXd spectrum = model.albedo(parametersAt(array.data() + i));
      to = std::copy(spectrum.begin(), spectrum.end(), to);
    }
  });
}

/// What absorbs in skin, in 1/cm where it is alone.
nb::dict absorption(nb::handle wavelengths) {
  const skin::SkinOptics optics(libraryOr(nullptr), wavelengthsFrom(wavelengths));
  const auto size = static_cast<std::size_t>(optics.baseline().size());
  const auto array = [size](const Eigen::ArrayXd& values) {
    return newDoubles({size}, [&](double* to) { std::copy(values.begin(), values.end(), to); });
  };
  nb::dict result;
  result["eumelanin"] = array(optics.eumelanin());
  result["pheomelanin"] = array(optics.pheomelanin());
  result["oxyhaemoglobin"] = array(optics.oxyhaemoglobin());
  result["deoxyhaemoglobin"] = array(optics.deoxyhaemoglobin());
  result["baseline"] = array(optics.baseline());
  result["blood_rest"] = array(optics.bloodRest());
  return result;
}

NumpyDoubles sample(int count, std::uint32_t seed) {
  const std::vector<SkinParameters> skins = skin::sampleSkins(prior(), count, seed);
  return newDoubles({skins.size(), kParameters}, [&](double* to) {
    for (const SkinParameters& one : skins) {
      for (const double value : {one.melanin, one.blood, one.thicknessUm, one.eumelanin, one.deoxyhaemoglobin}) {
        *to++ = value;
      }
    }
  });
}

void construct(SkinEstimator* self, nb::handle illuminant, nb::handle observer, const std::string& space, int threads) {
  const skin::SkinView view(lightFrom(illuminant), namedObserverFrom(observer),
                            libraryOr(nullptr).colourSpace(space).linear);
  const nb::gil_scoped_release release;
  new (self) SkinEstimator(libraryOr(nullptr), view, threads);
}

void constructNetwork(skin::SkinNetwork* self, const std::string& space, const std::string& loss) {
  if (loss != "spectral" && loss != "rgb") {
    throw spectral::InputError("", "loss", loss, "must be spectral or rgb");
  }
  new (self) skin::SkinNetwork(libraryOr(nullptr), libraryOr(nullptr).colourSpace(space).linear,
                               loss == "rgb" ? skin::SkinNetwork::Loss::Rgb : skin::SkinNetwork::Loss::Spectral);
}

/// What the decoder makes of skins.
NumpyDoubles decoded(const skin::SkinNetwork& self, nb::handle skins) {
  const Doubles array = doubles(skins);
  const auto outputs = static_cast<std::size_t>(self.decoded({}).size());
  return newDoubles(shapeWith(array, kParameters, outputs, "skins"), [&](double* to) {
    for (std::size_t i = 0; i < array.size(); i += kParameters) {
      const Eigen::VectorXd one = self.decoded(parametersAt(array.data() + i));
      to = std::copy(one.begin(), one.end(), to);
    }
  });
}

template <typename Estimator>
NumpyDoubles estimate(const Estimator& self, nb::handle rgb, int threads) {
  const Doubles array = doubles(rgb);
  const std::vector<std::size_t> shape = shapeWith(array, 3, kMaps, "rgb");
  std::vector<float> numbers(array.size());
  std::transform(array.data(), array.data() + array.size(), numbers.begin(),
                 [](double value) { return static_cast<float>(value); });
  std::vector<SkinPixel> pixels(array.size() / 3);
  {
    const nb::gil_scoped_release release;
    self.estimate(numbers, pixels, threads);
  }
  return mapsOf(pixels, shape);
}

template <typename Estimator>
NumpyDoubles colour(const Estimator& self, nb::handle maps, int threads) {
  const Doubles array = doubles(maps);
  const std::vector<std::size_t> shape = shapeWith(array, kMaps, 3, "maps");
  const std::vector<SkinPixel> pixels = pixelsOf(array);
  std::vector<float> rgb(3 * pixels.size());
  {
    const nb::gil_scoped_release release;
    self.colours().colour(pixels, rgb, threads);
  }
  return newDoubles(shape, [&](double* to) { std::copy(rgb.begin(), rgb.end(), to); });
}

NumpyDoubles spectrum(const SkinEstimator& self, nb::handle maps) {
  const Doubles array = doubles(maps);
  const std::vector<std::size_t> shape = shapeWith(array, kMaps, skin::kSkinBands, "maps");
  return newDoubles(shape, [&](double* to) {
    for (const SkinPixel& pixel : pixelsOf(array)) {
      const skin::SkinSpectrum one = self.spectrum(pixel);
      to = std::copy(one.begin(), one.end(), to);
    }
  });
}

nb::dict identification(const SkinEstimator& self) {
  const skin::SkinIdentification found = self.identification();
  nb::dict result;
  result["melanin"] = found.explained[0];
  result["blood"] = found.explained[1];
  result["thickness"] = found.explained[2];
  result["eumelanin"] = found.explained[3];
  result["deoxyhaemoglobin"] = found.explained[4];
  result["melanin_against_blood"] = found.melaninAgainstBlood;
  result["separates_blood_from_melanin"] = found.separatesBloodFromMelanin;
  return result;
}

/// Runs an edit over a copy.
template <typename Edit>
NumpyDoubles edited(nb::handle maps, const nb::object& matte, const Edit& edit) {
  const Doubles array = doubles(maps);
  std::vector<SkinPixel> pixels = pixelsOf(array);
  std::vector<float> shares;
  if (!matte.is_none()) {
    const Doubles given = doubles(matte);
    shares.resize(given.size());
    std::transform(given.data(), given.data() + given.size(), shares.begin(),
                   [](double value) { return static_cast<float>(value); });
  }
  edit(std::span<SkinPixel>(pixels), skin::Matte(shares), array);
  return mapsOf(pixels, shapeWith(array, kMaps, kMaps, "maps"));
}

using StrengthEdit = void (*)(std::span<SkinPixel>, double, skin::Matte);

void defineEdit(nb::module_& module, const char* name, const char* strength, StrengthEdit edit, const char* text) {
  module.def(
      name,
      [edit](nb::handle maps, double amount, const nb::object& matte) {
        return edited(maps, matte,
                      [&](auto pixels, skin::Matte shares, const Doubles&) { edit(pixels, amount, shares); });
      },
      "maps"_a, nb::arg(strength), "matte"_a = nb::none(),
      nb::sig(("def " + std::string(name) + "(maps: numpy.typing.ArrayLike, " + strength +
               ": float, matte: numpy.typing.ArrayLike | None = None) -> numpy.typing.NDArray[numpy.float64]")
                  .c_str()),
      text);
}

void bindEdits(nb::module_& module) {
  module.def(
      "multiply_skin",
      [](nb::handle maps, const std::string& quantity, double factor, const nb::object& matte) {
        return edited(maps, matte, [&](auto pixels, skin::Matte shares, const Doubles&) {
          skin::multiplySkin(pixels, skin::skinQuantityFromName(quantity), factor, shares);
        });
      },
      "maps"_a, "quantity"_a, "factor"_a, "matte"_a = nb::none(),
      nb::sig("def multiply_skin(maps: numpy.typing.ArrayLike, quantity: str, factor: float, matte: "
              "numpy.typing.ArrayLike | None = None) -> numpy.typing.NDArray[numpy.float64]"),
      "Maps with a quantity multiplied.");
  module.def(
      "set_skin",
      [](nb::handle maps, const std::string& quantity, double value, const nb::object& matte) {
        return edited(maps, matte, [&](auto pixels, skin::Matte shares, const Doubles&) {
          skin::setSkin(pixels, skin::skinQuantityFromName(quantity), value, shares);
        });
      },
      "maps"_a, "quantity"_a, "value"_a, "matte"_a = nb::none(),
      nb::sig("def set_skin(maps: numpy.typing.ArrayLike, quantity: str, value: float, matte: "
              "numpy.typing.ArrayLike | None = None) -> numpy.typing.NDArray[numpy.float64]"),
      "Maps with a quantity set.");
  module.def(
      "smooth_skin",
      [](nb::handle maps, const std::string& quantity, double radius, const nb::object& matte) {
        return edited(maps, matte, [&](auto pixels, skin::Matte shares, const Doubles& array) {
          if (array.ndim() != 3) {
            throw nb::value_error("maps: must be a picture, height x width x 9");
          }
          skin::smoothSkin(pixels, skin::skinQuantityFromName(quantity), static_cast<int>(array.shape(1)), radius,
                           shares);
        });
      },
      "maps"_a, "quantity"_a, "radius"_a, "matte"_a = nb::none(),
      nb::sig("def smooth_skin(maps: numpy.typing.ArrayLike, quantity: str, radius: float, matte: "
              "numpy.typing.ArrayLike | None = None) -> numpy.typing.NDArray[numpy.float64]"),
      "Maps with a quantity smoothed over the picture by a Gaussian of a standard deviation in pixels.");
  defineEdit(module, "tan_skin", "strength", &skin::tanSkin, "Tanned skin, 0 to 4.");
  defineEdit(module, "flush_skin", "strength", &skin::flushSkin, "Flushed skin, -0.9 (pale) to 4.");
  defineEdit(module, "oxygenate_skin", "strength", &skin::oxygenateSkin,
             "Skin with more oxygen in its blood, -1 to 1.");
  defineEdit(module, "thicken_skin", "factor", &skin::thickenSkin, "A thinner (below 1) or thicker epidermis.");
  defineEdit(module, "bleach_skin", "strength", &skin::bleachSkin, "Skin without melanin, as in vitiligo: 0 to 1.");
}

void bindNetwork(nb::module_& module) {
  using skin::SkinNetwork;
  nb::class_<SkinNetwork>(
      module, "SkinNetwork",
      "Colours to skins by a trained encoder-decoder, in daylight seen by CIE 1931: to compare with "
      "SkinEstimator.")
      .def("__init__", &constructNetwork, "space"_a = "Rec.709", "loss"_a = "spectral",
           "The linear space of the pixels, and what the network was trained by: 'spectral' or 'rgb'.")
      .def("estimate", &estimate<SkinNetwork>, "rgb"_a, "threads"_a = 2,
           nb::sig("def estimate(self, rgb: numpy.typing.ArrayLike, threads: int = 2) -> "
                   "numpy.typing.NDArray[numpy.float64]"),
           "Maps, as SkinEstimator's.")
      .def("colour", &colour<SkinNetwork>, "maps"_a, "threads"_a = 2,
           nb::sig("def colour(self, maps: numpy.typing.ArrayLike, threads: int = 2) -> "
                   "numpy.typing.NDArray[numpy.float64]"),
           "Linear RGB of maps.")
      .def("decode", &decoded, "skins"_a,
           nb::sig("def decode(self, skins: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]"),
           "The decoder's reflectances at 380, 390, ..., 780 nm of rows of five parameters; by 'rgb' its linear "
           "Rec.709.");
}

}  // namespace

void bindSkin(nb::module_& module) {
  module.def(
      "skin_albedo", &albedo, "skins"_a, "repair"_a = true,
      nb::sig("def skin_albedo(skins: numpy.typing.ArrayLike, repair: bool = True) -> "
              "numpy.typing.NDArray[numpy.float64]"),
      "Reflectance at 380, 390, ..., 780 nm of skins: melanin, blood, thickness in micrometres, eumelanin's share,\n"
      "the share of haemoglobin without oxygen. `repair`: with the model's mean misfit to people repaired.");
  module.def("skin_albedo_at", &albedoAt, "skins"_a, "wavelengths"_a,
             nb::sig("def skin_albedo_at(skins: numpy.typing.ArrayLike, wavelengths: numpy.typing.ArrayLike) -> "
                     "numpy.typing.NDArray[numpy.float64]"),
             "The model's albedo of skins at any wavelengths from 380 to 780 nm, nothing repaired.");
  module.def(
      "skin_absorption", &absorption, "wavelengths"_a,
      nb::sig("def skin_absorption(wavelengths: numpy.typing.ArrayLike) -> "
              "dict[str, numpy.typing.NDArray[numpy.float64]]"),
      "What absorbs in skin by name, in 1/cm, as if nothing else were there; blood_rest is bilirubin and carotene.");
  module.def("sample_skins", &sample, "count"_a, "seed"_a = 1, "Skins of people, a row of five parameters each.");
  module.def(
      "virtual_skins",
      [](int count, std::uint32_t seed) { return skin::virtualSkins(libraryOr(nullptr), count, seed); }, "count"_a,
      "seed"_a = 1, nb::sig("def virtual_skins(count: int, seed: int = 1) -> list[Spectrum]"),
      "Reflectances of people's skin.");
  nb::class_<SkinEstimator>(module, "SkinEstimator",
                            "Colours to skins: the most probable parameters, and what they leave as a residual.")
      .def("__init__", &construct, "illuminant"_a = "D65", "observer"_a = "CIE 1931 2", "space"_a = "Rec.709",
           "threads"_a = 2,
           nb::sig("def __init__(self, illuminant: metamer._types.NamedSpectrum = 'D65', observer: "
                   "metamer._types.NamedObserver = 'CIE 1931 2', space: str = 'Rec.709', threads: int = 2) -> None"),
           "The light and the observer of the albedo's capture, and the linear space of its pixels.")
      .def("estimate", &estimate<SkinEstimator>, "rgb"_a, "threads"_a = 2,
           nb::sig("def estimate(self, rgb: numpy.typing.ArrayLike, threads: int = 2) -> "
                   "numpy.typing.NDArray[numpy.float64]"),
           "Maps: the last axis has melanin, blood, thickness, eumelanin, deoxyhaemoglobin, gain, and a residual in R, "
           "G\n"
           "and B.")
      .def("colour", &colour<SkinEstimator>, "maps"_a, "threads"_a = 2,
           nb::sig("def colour(self, maps: numpy.typing.ArrayLike, threads: int = 2) -> "
                   "numpy.typing.NDArray[numpy.float64]"),
           "Linear RGB of maps.")
      .def("spectrum", &spectrum, "maps"_a,
           nb::sig("def spectrum(self, maps: numpy.typing.ArrayLike) -> numpy.typing.NDArray[numpy.float64]"),
           "Reflectances of maps at 380, 390, ..., 780 nm, which have their colours.")
      .def("identification", &identification, nb::sig("def identification(self) -> dict[str, float]"),
           "What colour tells of each parameter, as a share of the prior's variance.");
  bindNetwork(module);
  bindEdits(module);
}

}  // namespace metamer::python
