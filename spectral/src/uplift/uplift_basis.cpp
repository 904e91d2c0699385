// SPDX-License-Identifier: Apache-2.0
#include "uplift/uplift_basis.h"

#include <algorithm>
#include <cmath>

#include "files/json_text.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/spectral_integral.h"

namespace metamer::spectral {
namespace {

std::vector<double> numbersOf(const nlohmann::json& list, const std::string& where, const std::string& field) {
  if (!list.is_array() || list.empty()) {
    throw InputError(where, field, valueText(list), "must be a list of numbers");
  }
  std::vector<double> numbers;
  for (const nlohmann::json& item : list) {
    if (!item.is_number()) {
      throw InputError(where, field, valueText(item), "must be a number");
    }
    numbers.push_back(item.get<double>());
  }
  return numbers;
}

}  // namespace

Eigen::VectorXd UpliftBasis::curve(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw InputError(where, "curves", name, "is missing; use the data folder of this release");
  }
  return curves.col(found - names.begin());
}

UpliftBasis readUpliftBasis(const DataLibrary& library, const std::string& name) {
  // Tables stand in the data folder under the paths that their manifest gives.
  const std::filesystem::path file =
      library.skinPriorFile().parent_path() / pathOf(library.provenance("uplifts", name).file);
  UpliftBasis basis;
  basis.where = utf8(file);
  const nlohmann::json document = parseJson(readTextFile(file), basis.where);
  basis.wavelengthsNm = numbersOf(member(document, "wavelengths_nm"), basis.where, "wavelengths_nm");
  if (!std::is_sorted(basis.wavelengthsNm.begin(), basis.wavelengthsNm.end(), std::less_equal<>())) {
    throw InputError(basis.where, "wavelengths_nm", "", "must rise");
  }
  for (const nlohmann::json& row : member(document, "selector")) {
    basis.selector.push_back(numbersOf(row, basis.where, "selector"));
  }
  const nlohmann::json& curves = member(document, "curves");
  const auto size = static_cast<Eigen::Index>(basis.wavelengthsNm.size());
  basis.curves.resize(size, static_cast<Eigen::Index>(curves.size()));
  for (const auto& [key, list] : curves.items()) {
    const std::vector<double> values = numbersOf(list, basis.where, key);
    if (values.size() != basis.wavelengthsNm.size()) {
      throw InputError(basis.where, key, std::to_string(values.size()), "must be one a wavelength");
    }
    basis.curves.col(static_cast<Eigen::Index>(basis.names.size())) =
        Eigen::Map<const Eigen::VectorXd>(values.data(), size);
    basis.names.push_back(key);
  }
  return basis;
}

UpliftWeights exactUpliftWeights(const DataLibrary& library, const std::vector<double>& wavelengthsNm) {
  const SeenLight seen = seenLight(library.illuminant("D65"), {}, library.observer("CIE 1931 2"));
  const Eigen::Matrix<double, kDomainSize, 3> lit = seen.light.asDiagonal() * seen.curves;
  UpliftWeights weights = UpliftWeights::Zero(static_cast<Eigen::Index>(wavelengthsNm.size()), 3);
  for (int i = 0; i < kDomainSize; ++i) {
    const double nm = std::clamp(kDomainStartNm + static_cast<double>(i), wavelengthsNm.front(), wavelengthsNm.back());
    const auto above = std::lower_bound(wavelengthsNm.begin() + 1, wavelengthsNm.end() - 1, nm);
    const auto k = above - wavelengthsNm.begin();
    const double share = (nm - *(above - 1)) / (*above - *(above - 1));
    weights.row(k - 1) += (1 - share) * lit.row(i);
    weights.row(k) += share * lit.row(i);
  }
  return weights / weights.col(1).sum();
}

UpliftWeights upliftWeightsOr(const std::optional<UpliftWeights>& given, const DataLibrary& library,
                              const std::vector<double>& wavelengthsNm) {
  if (!given) {
    return exactUpliftWeights(library, wavelengthsNm);
  }
  if (given->rows() != static_cast<Eigen::Index>(wavelengthsNm.size())) {
    throw InputError("", "weights", std::to_string(given->rows()),
                     "must be one row a wavelength, " + std::to_string(wavelengthsNm.size()));
  }
  if (!given->allFinite() || !(given->colwise().sum().minCoeff() > 0)) {
    throw InputError("", "weights", "", "must be finite, and see light in X, Y and Z");
  }
  return *given;
}

Eigen::Matrix3d upliftXyzFromRgb(const DataLibrary& library, const UpliftWeights& weights) {
  const RgbSpace space = library.colourSpace("Rec.709").linear;
  const Eigen::Vector3d gain = weights.colwise().sum().transpose().cwiseQuotient(space.whiteXyz());
  return gain.asDiagonal() * space.xyzFromRgb();
}

}  // namespace metamer::spectral
