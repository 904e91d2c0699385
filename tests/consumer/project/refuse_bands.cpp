// SPDX-License-Identifier: Apache-2.0
// The installed library, built without assertions, refuses what is out of range and goes on.
#include <cstdio>
#include <exception>

#include "metamer/sip/recipe.h"
#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/input_error.h"

namespace {

bool isRefused(const metamer::sip::TransformSpec& spec, int bands) {
  try {
    const metamer::sip::SpectralTransform transform(spec, bands);
    std::printf("%4d bands: taken\n", bands);
    return false;
  } catch (const metamer::spectral::InputError& error) {
    std::printf("%4d bands: %s\n", bands, error.what());
    return true;
  }
}

int refuseBands() {
  const auto library = metamer::spectral::DataLibrary::open(METAMER_DATA_FOLDER);
  const auto spec =
      metamer::sip::resolve(metamer::sip::parseRecipe("metamer: 1\ninput: {illuminant: D65}\noutput: {illuminant: A}\n",
                                                      "the consumer's recipe"),
                            library);
  for (const int bands : {1, 15, 402, 500, 1000}) {
    if (!isRefused(spec, bands)) {
      return 1;
    }
  }
  return isRefused(spec, 16) || isRefused(spec, 401) ? 1 : 0;
}

}  // namespace

int main() {
  try {
    return refuseBands();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
