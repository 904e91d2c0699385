// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "metamer/spectral/uplift.h"

// The methods behind makeUplift, a source each.
namespace metamer::spectral {

std::unique_ptr<Uplift> makeSmits(const DataLibrary& library, const std::optional<UpliftWeights>& weights);
std::unique_ptr<Uplift> makeMallett(const DataLibrary& library, const std::optional<UpliftWeights>& weights);
std::unique_ptr<Uplift> makeOtsu(const DataLibrary& library, const std::optional<UpliftWeights>& weights);
std::unique_ptr<Uplift> makeJakob(const DataLibrary& library, const std::optional<UpliftWeights>& weights);
std::unique_ptr<Uplift> makeJakobTable(const DataLibrary& library, const std::optional<UpliftWeights>& weights);
std::unique_ptr<Uplift> makeMeng(const DataLibrary& library, const std::optional<UpliftWeights>& weights);

}  // namespace metamer::spectral
