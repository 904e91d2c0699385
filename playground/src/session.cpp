// SPDX-License-Identifier: Apache-2.0
#include "session.h"

#include <utility>

#include "metamer/sip/recipe.h"
#include "metamer/spectral/input_error.h"

namespace metamer::playground {
namespace {

/// CIEDE2000 that hardly any two colours differ by. Who allows as much asks for a draft.
constexpr double kDraft = 100.0;

}  // namespace

void Session::setRecipe(const std::string& yaml) {
  sip::TransformSpec spec = resolve(sip::parseRecipe(yaml, "recipe"), m_library);
  sip::SpectralTransform transform(spec, sip::kDefaultBandCount, &m_scenes);
  m_current.emplace(Current{std::move(spec), std::move(transform)});
}

const Session::Current& Session::current() const {
  if (!m_current) {
    throw spectral::InputError("playground", "recipe", "", "none was set yet");
  }
  return *m_current;
}

Session::Current& Session::current() {
  return const_cast<Current&>(std::as_const(*this).current());
}

const sip::TransformSpec& Session::spec() const {
  return current().spec;
}

const sip::SpectralTransform& Session::transform() const {
  return current().transform;
}

sip::SpectralTransform Session::transformIn(const spectral::RgbSpace& space) {
  sip::TransformSpec spec = current().spec;
  spec.space = space;
  return sip::SpectralTransform(spec, sip::kDefaultBandCount, &m_scenes);
}

const sip::HomogeneousMap& Session::map(double tolerance) {
  Current& now = current();
  if (!now.map || now.tolerance != tolerance) {
    const bool isDraft = tolerance >= kDraft;
    now.map = buildHomogeneousMap(now.transform, tolerance, sip::inOrder, isDraft ? &m_draftMemory : &m_memory,
                                  isDraft ? sip::HomogeneousMap::kMaximumDepth : 0);
    now.tolerance = tolerance;
  }
  return *now.map;
}

}  // namespace metamer::playground
