// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/near_names.h"

#include <algorithm>
#include <numeric>

#include "metamer/spectral/text.h"

namespace metamer::spectral {
namespace {

/// Longer text is no misspelt name; the bound keeps the quadratic distance small for hostile input.
constexpr std::size_t kLongestGiven = 100;

/// Levenshtein distance.
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substituted, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

struct Candidate {
  std::size_t distance;
  std::size_t order;
};

}  // namespace

std::vector<std::string> nearNames(const std::string& given, const std::vector<std::string>& known, std::size_t most) {
  const std::string wanted = lowerCase(given.substr(0, kLongestGiven));
  // A third of the letters wrong is still a misspelling; more is another word.
  const std::size_t nearEnough = std::max<std::size_t>(1, wanted.size() / 3);
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const std::string name = lowerCase(known[i]);
    const std::size_t distance = editDistance(wanted, name);
    const bool contained = !wanted.empty() && (name.find(wanted) != std::string::npos ||
                                               (!name.empty() && wanted.find(name) != std::string::npos));
    if (distance <= nearEnough) {
      candidates.push_back({distance, i});
    } else if (contained) {
      candidates.push_back({distance + kLongestGiven, i});
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.distance < b.distance; });
  std::vector<std::string> names;
  for (const Candidate& candidate : candidates) {
    if (names.size() == most) {
      break;
    }
    names.push_back(known[candidate.order]);
  }
  return names;
}

std::string unknownNameRemedy(const std::string& given, const std::vector<std::string>& known,
                              const std::string& listCommand) {
  std::string remedy = "unknown";
  const std::vector<std::string> names = nearNames(given, known);
  for (std::size_t i = 0; i < names.size(); ++i) {
    remedy += (i == 0 ? "; near names: " : ", ") + names[i];
  }
  if (!listCommand.empty()) {
    remedy += "; all names: " + listCommand;
  }
  return remedy;
}

}  // namespace metamer::spectral
