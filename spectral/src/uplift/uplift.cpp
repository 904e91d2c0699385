// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/uplift.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "metamer/spectral/argument_checks.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"
#include "uplift/methods.h"

namespace metamer::spectral {

const std::vector<std::string>& upliftMethodNames() {
  static const std::vector<std::string> names = {"smits", "mallett", "jakob", "jakob table", "otsu", "meng"};
  return names;
}

UpliftMethod upliftMethodNamed(const std::string& name) {
  const std::vector<std::string>& names = upliftMethodNames();
  const auto found = std::find(names.begin(), names.end(), lowerCase(trimmed(name)));
  if (found == names.end()) {
    throw InputError("", "uplift", name, "must be one of: " + joined(names));
  }
  return static_cast<UpliftMethod>(found - names.begin());
}

void Uplift::spectra(std::span<const double> rgb, std::span<double> spectra) const {
  const std::size_t size = m_wavelengthsNm.size();
  const std::size_t colours = rgb.size() / 3;
  requireAsMany("rgb", static_cast<std::int64_t>(rgb.size()), "three a colour", static_cast<std::int64_t>(3 * colours));
  requireAsMany("spectra", static_cast<std::int64_t>(spectra.size()), "colours times wavelengths",
                static_cast<std::int64_t>(colours * size));
  const auto isFinite = [&](std::size_t i) {
    return std::isfinite(rgb[3 * i]) && std::isfinite(rgb[3 * i + 1]) && std::isfinite(rgb[3 * i + 2]);
  };
  for (std::size_t i = 0; i < colours;) {
    std::size_t end = i;
    while (end < colours && isFinite(end)) {
      ++end;
    }
    if (end > i) {
      spectraOf(rgb.subspan(3 * i, 3 * (end - i)), spectra.data() + i * size);
      i = end;
    } else {
      std::fill_n(spectra.data() + i * size, size, std::numeric_limits<double>::quiet_NaN());
      ++i;
    }
  }
}

void Uplift::spectraOf(std::span<const double> rgb, double* spectra) const {
  for (std::size_t i = 0; i < rgb.size() / 3; ++i) {
    spectrumOf({rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]}, spectra + i * m_wavelengthsNm.size());
  }
}

std::unique_ptr<Uplift> makeUplift(UpliftMethod method, const DataLibrary& library,
                                   const std::optional<UpliftWeights>& weights) {
  switch (method) {
    case UpliftMethod::Smits:
      return makeSmits(library, weights);
    case UpliftMethod::Mallett:
      return makeMallett(library, weights);
    case UpliftMethod::Jakob:
      return makeJakob(library, weights);
    case UpliftMethod::JakobTable:
      return makeJakobTable(library, weights);
    case UpliftMethod::Otsu:
      return makeOtsu(library, weights);
    case UpliftMethod::Meng:
      break;
  }
  return makeMeng(library, weights);
}

}  // namespace metamer::spectral
