// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <pugixml.hpp>
#include <string_view>

#include "files/sampled_rows.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/spectral_files.h"
#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

constexpr std::size_t kMostSamples = 1'000'000;

/// A name without its namespace prefix, in lower case: files in the field disagree about both.
std::string localName(const pugi::xml_node& node) {
  const std::string_view name = node.name();
  const std::size_t colon = name.find(':');
  return lowerCase(colon == std::string_view::npos ? name : name.substr(colon + 1));
}

pugi::xml_node childNamed(const pugi::xml_node& parent, std::string_view name) {
  for (const pugi::xml_node& child : parent.children()) {
    if (localName(child) == name) {
      return child;
    }
  }
  return {};
}

/// The quantities of TM-27 that a caller who asks for `quantity` can use.
bool isQuantity(const std::string& stated, SpectralQuantity quantity) {
  const auto isOneOf = [&](const auto& names) { return std::find(names.begin(), names.end(), stated) != names.end(); };
  if (stated == "other") {
    return true;
  }
  switch (quantity) {
    case SpectralQuantity::SpectralPowerDistribution:
      return isOneOf(
          std::array<std::string_view, 6>{"flux", "intensity", "irradiance", "radiance", "exitance", "relative"});
    case SpectralQuantity::Sensitivity:
      return stated == "relative";
    case SpectralQuantity::Reflectance:
      return isOneOf(std::array<std::string_view, 2>{"reflectance", "r-values"});
    case SpectralQuantity::Transmittance:
      return isOneOf(std::array<std::string_view, 2>{"transmittance", "t-values"});
  }
  return false;
}

void checkQuantity(const pugi::xml_node& distribution, const std::string& where, SpectralQuantity quantity) {
  const std::string stated(trimmed(childNamed(distribution, "spectralquantity").child_value()));
  if (stated.empty()) {
    throw InputError(where, "SpectralQuantity", "", "is missing; TM-27 asks for it");
  }
  if (!isQuantity(lowerCase(stated), quantity)) {
    throw InputError(where, "SpectralQuantity", stated, "a " + quantityName(quantity) + " is needed here");
  }
}

SampledRows readDistribution(const pugi::xml_node& distribution, const std::string& where, std::string name) {
  SampledRows rows;
  rows.where = where;
  rows.names.push_back(std::move(name));
  rows.columns.resize(1);
  for (const pugi::xml_node& sample : distribution.children()) {
    if (localName(sample) != "spectraldata") {
      continue;
    }
    if (rows.wavelengthsNm.size() == kMostSamples) {
      throw InputError(where, "SpectralData", "", "more than one million; resample to a wider interval");
    }
    const std::string sampleWhere = where + ": sample " + std::to_string(rows.wavelengthsNm.size() + 1);
    rows.wavelengthsNm.push_back(requiredNumber(sample.attribute("wavelength").value(), sampleWhere, "wavelength"));
    rows.columns[0].push_back(requiredNumber(sample.child_value(), sampleWhere, "value"));
  }
  rows.rowWhere = [where](std::size_t row) { return where + ": sample " + std::to_string(row + 1); };
  return rows;
}

}  // namespace

std::vector<Spectrum> readSpdx(const std::string& text, const std::string& where, SpectralQuantity quantity) {
  const std::string_view utf8 = checkedUtf8(text, where);
  pugi::xml_document document;
  const pugi::xml_parse_result result =
      document.load_buffer(utf8.data(), utf8.size(), pugi::parse_default | pugi::parse_doctype, pugi::encoding_utf8);
  if (!result) {
    throw InputError(where, "XML", "",
                     std::string(result.description()) + " at byte " + std::to_string(result.offset + 1));
  }
  for (const pugi::xml_node& node : document.children()) {
    if (node.type() == pugi::node_doctype) {
      throw InputError(where, "XML", "DOCTYPE", "document types are not read; remove it");
    }
  }
  const pugi::xml_node root = document.document_element();
  if (localName(root) != "iestm2714") {
    throw InputError(where, "root element", root.name(), "must be IESTM2714 (IES TM-27-14)");
  }

  const pugi::xml_node header = childNamed(root, "header");
  std::string name(trimmed(childNamed(header, "description").child_value()));
  if (name.empty()) {
    name = stemOf(where);
  }
  std::vector<Spectrum> spectra;
  for (const pugi::xml_node& distribution : root.children()) {
    if (localName(distribution) != "spectraldistribution") {
      continue;
    }
    checkQuantity(distribution, where, quantity);
    const std::string numbered = spectra.empty() ? name : name + " " + std::to_string(spectra.size() + 1);
    for (Spectrum& spectrum :
         spectraFromRows(readDistribution(distribution, where, numbered), quantity, StatedScale::NotStated)) {
      spectra.push_back(std::move(spectrum));
    }
  }
  if (spectra.empty()) {
    throw InputError(where, "SpectralDistribution", "", "is missing");
  }
  return spectra;
}

}  // namespace metamer::spectral
