// SPDX-License-Identifier: Apache-2.0
// A C door to the uplifts, for bench/sections/uplifts.py.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <vector>

#include "metamer/spectral/data_library.h"
#include "metamer/spectral/uplift.h"

using namespace metamer;

namespace {

using Clock = std::chrono::steady_clock;

/// Nanoseconds a colour, the least of some rounds: what else the machine did only adds.
template <typename Work>
double nanoseconds(std::size_t colours, int rounds, const Work& work) {
  double least = 1e300;
  for (int round = 0; round < rounds; ++round) {
    const auto start = Clock::now();
    work();
    least = std::min(least, std::chrono::duration<double, std::nano>(Clock::now() - start).count());
  }
  return least / static_cast<double>(colours);
}

}  // namespace

/// Nanoseconds a whole spectrum, into a buffer that stays in the cache: who asks for spectra uses them.
/// @param colours  how many, in whole blocks: three numbers each in `rgb`
extern "C" double metamerUpliftTime(const char* method, const double* rgb, std::size_t colours, int rounds) {
  const auto uplift = spectral::makeUplift(spectral::upliftMethodNamed(method), spectral::DataLibrary::openDefault());
  constexpr std::size_t kBlock = 40;
  std::vector<double> spectra(kBlock * uplift->wavelengthsNm().size());
  return nanoseconds(colours, rounds, [&] {
    for (std::size_t i = 0; i + kBlock <= colours; i += kBlock) {
      uplift->spectra({rgb + 3 * i, 3 * kBlock}, spectra);
    }
  });
}

/// Nanoseconds a lookup of coefficients in Jakob's table; its own build in seconds comes in `buildSeconds`.
extern "C" double metamerUpliftLookupTime(const double* rgb, std::size_t colours, int rounds, double* buildSeconds) {
  const auto library = spectral::DataLibrary::openDefault();
  const auto start = Clock::now();
  const spectral::JakobTable table(library);
  *buildSeconds = std::chrono::duration<double>(Clock::now() - start).count();
  std::vector<std::array<float, 3>> pixels(colours);
  for (std::size_t i = 0; i < colours; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      pixels[i][k] = static_cast<float>(rgb[3 * i + k]);
    }
  }
  std::vector<spectral::JakobCoefficients> found(colours);
  return nanoseconds(colours, rounds, [&] {
    std::transform(pixels.begin(), pixels.end(), found.begin(),
                   [&](const std::array<float, 3>& pixel) { return table.coefficients(pixel); });
  });
}
