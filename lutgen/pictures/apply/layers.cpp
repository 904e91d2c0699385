// SPDX-License-Identifier: Apache-2.0
#include "apply/layers.h"

#include <algorithm>
#include <optional>
#include <set>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/text.h"

namespace metamer::lutgen {
namespace {

using spectral::InputError;
using spectral::lowerCase;

/// Names that say "this is the picture".
const std::set<std::string>& pictureWords() {
  static const std::set<std::string> words = {"rgba",  "rgb",    "beauty", "combined",  "color", "colour",
                                              "image", "master", "main",   "composite", "final", "default"};
  return words;
}

/// Names, or beginnings of names, of what no light is in.
bool isData(const std::string& name) {
  static const std::vector<std::string> words = {
      "ao",     "ambientocclusion", "occlusion", "n",     "normal", "p",     "position",
      "point",  "pworld",           "crypto",    "depth", "z",      "uv",    "st",
      "motion", "velocity",         "vector",    "id",    "mask",   "matte", "object",
      "albedo", "material",         "variance"};
  const std::string lower = lowerCase(name.substr(name.rfind('.') + 1));
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return lower == word || (word.size() > 2 && lower.rfind(word, 0) == 0);
  });
}

std::string lastOf(const std::string& name) {
  return name.substr(name.rfind('.') + 1);
}

/// 0, 1, 2 for red, green, blue, 3 for alpha; -1 for others.
int roleOf(const std::string& channel) {
  static const std::array<std::array<std::string_view, 2>, 4> names = {
      {{"r", "red"}, {"g", "green"}, {"b", "blue"}, {"a", "alpha"}}};
  const std::string lower = lowerCase(channel);
  for (std::size_t role = 0; role < names.size(); ++role) {
    if (lower == names[role][0] || lower == names[role][1]) {
      return static_cast<int>(role);
    }
  }
  return -1;
}

/// The name of a part without its view: "rgba.left" is "rgba".
std::string withoutView(const std::string& name, const std::string& view) {
  if (view.empty()) {
    return name;
  }
  if (name == view) {
    return "";
  }
  for (const char mark : {'.', '_', ' ', '-'}) {
    const std::string suffix = mark + view;
    const std::string prefix = view + mark;
    if (name.size() > suffix.size() && name.compare(name.size() - suffix.size(), suffix.size(), suffix) == 0) {
      return name.substr(0, name.size() - suffix.size());
    }
    if (name.rfind(prefix, 0) == 0) {
      return name.substr(prefix.size());
    }
  }
  return name;
}

struct Candidate {
  ColourLayer layer;  ///< its name as the file has it, views and all
  std::string name;   ///< without views
  bool isBare = false;
  std::string fault;  ///< why it cannot be transformed; empty: it can
};

/// All layers with red, green and blue.
class Layers {
 public:
  Layers(const std::vector<PartFacts>& parts, const std::string& file) : m_parts(parts), m_file(file) {
    for (std::size_t part = 0; part < parts.size(); ++part) {
      add(static_cast<int>(part));
    }
  }

  std::vector<ColourLayer> byChannels(const std::vector<std::string>& names) const {
    if (names.size() != 3) {
      throw InputError("--channels", "names", spectral::joined(names), "write three, of red, green and blue: R,G,B");
    }
    std::vector<ColourLayer> found;
    for (std::size_t p = 0; p < m_parts.size(); ++p) {
      ColourLayer layer{spectral::joined(names), static_cast<int>(p), {-1, -1, -1}, -1};
      for (std::size_t c = 0; c < m_parts[p].channels.size(); ++c) {
        for (std::size_t role = 0; role < 3; ++role) {
          if (m_parts[p].channels[c].name == names[role]) {
            layer.channels[role] = static_cast<int>(c);
          }
        }
      }
      if (std::all_of(layer.channels.begin(), layer.channels.end(), [](int channel) { return channel >= 0; })) {
        refuseFault(faultOf(layer), layer.name);
        found.push_back(layer);
      }
    }
    if (found.empty()) {
      throw InputError(m_file, "channels", spectral::joined(names), "are not in one part; " + whatIsThere());
    }
    if (found.size() > 1) {
      throw InputError(m_file, "channels", spectral::joined(names), "are in several parts; name one: --layer");
    }
    return found;
  }

  std::vector<ColourLayer> byNames(const std::vector<std::string>& names) const {
    std::vector<ColourLayer> found;
    for (const std::string& name : names) {
      const auto size = found.size();
      for (const Candidate& candidate : m_candidates) {
        if (matches(candidate, name)) {
          refuseFault(candidate.fault, name);
          found.push_back(candidate.layer);
        }
      }
      if (found.size() == size) {
        throw InputError(m_file, "layer", name, "is not there, or has no red, green and blue; " + whatIsThere());
      }
    }
    return found;
  }

  std::vector<ColourLayer> unmistakable() const {
    if (m_candidates.empty()) {
      const bool allDeep =
          std::all_of(m_parts.begin(), m_parts.end(), [](const PartFacts& part) { return part.isDeep; });
      if (allDeep) {
        throw InputError(m_file, "pixels", "deep", "cannot be transformed; flatten the picture first");
      }
      throw InputError(m_file, "channels", std::to_string(m_parts[0].channels.size()),
                       "a colour transform needs red, green and blue: convert the picture to RGB, or name three with "
                       "--channels; it has " +
                           channelsThere());
    }
    if (m_parts.size() == 1) {
      std::vector<ColourLayer> bare = thatAre([](const Candidate& c) { return c.isBare; });
      if (!bare.empty()) {
        return bare;
      }
    }
    const auto isPicture = [](const Candidate& c) { return pictureWords().count(lowerCase(lastOf(c.name))) != 0; };
    if (const auto found = oneName(isPicture); !found.empty()) {
      return found;
    }
    const auto isPlain = [](const Candidate& c) { return c.isBare && !isData(c.name); };
    if (std::none_of(m_candidates.begin(), m_candidates.end(), isPicture)) {
      if (const auto found = oneName(isPlain); !found.empty()) {
        return found;
      }
    }
    throw InputError(m_file, "layers", "",
                     "which one holds the picture is not sure: say --layer NAME; " + whatIsThere());
  }

 private:
  void add(int partIndex) {
    const PartFacts& part = m_parts[static_cast<std::size_t>(partIndex)];
    if (part.isDeep) {
      return;
    }
    // Channels of a layer stand anywhere in the part.
    std::vector<std::string> prefixes;
    for (const ChannelFacts& channel : part.channels) {
      const std::string prefix = prefixOf(channel.name);
      if (std::find(prefixes.begin(), prefixes.end(), prefix) == prefixes.end()) {
        prefixes.push_back(prefix);
      }
    }
    for (const std::string& prefix : prefixes) {
      ColourLayer layer{"", partIndex, {-1, -1, -1}, -1};
      for (std::size_t c = 0; c < part.channels.size(); ++c) {
        const std::string& name = part.channels[c].name;
        if (prefixOf(name) != prefix) {
          continue;
        }
        const int role = roleOf(lastOf(name));
        if (role >= 0) {
          int& place = role == 3 ? layer.alpha : layer.channels[static_cast<std::size_t>(role)];
          place = place < 0 ? static_cast<int>(c) : place;
        }
      }
      if (std::any_of(layer.channels.begin(), layer.channels.end(), [](int channel) { return channel < 0; })) {
        continue;
      }
      addCandidate(layer, prefix);
    }
  }

  void addCandidate(ColourLayer layer, const std::string& prefix) {
    const PartFacts& part = m_parts[static_cast<std::size_t>(layer.part)];
    Candidate candidate;
    // The views of one part are prefixes: R is of the first, right.R of the other.
    std::string own = prefix;
    for (const std::string& view : part.views) {
      own = withoutView(own, view);
    }
    const std::string partName = m_parts.size() > 1 ? part.name : "";
    const std::string bareName = m_parts.size() > 1 ? withoutView(part.name, part.view) : "";
    candidate.isBare = own.empty() || own == bareName || own == partName;
    candidate.name = candidate.isBare ? bareName : bareName.empty() ? own : bareName + "." + own;
    layer.name = prefix.empty() || prefix == partName ? partName : partName.empty() ? prefix : partName + "." + prefix;
    candidate.fault = faultOf(layer);
    candidate.layer = layer;
    m_candidates.push_back(candidate);
  }

  static std::string prefixOf(const std::string& channel) {
    const std::size_t dot = channel.rfind('.');
    return dot == std::string::npos ? "" : channel.substr(0, dot);
  }

  std::string faultOf(const ColourLayer& layer) const {
    const PartFacts& part = m_parts[static_cast<std::size_t>(layer.part)];
    for (const int index : layer.channels) {
      const ChannelFacts& channel = part.channels[static_cast<std::size_t>(index)];
      if (part.isDeep) {
        return "is deep; flatten the picture first";
      }
      if (!channel.isColourType) {
        return "holds whole numbers (" + channel.name + " is uint32), no colours; name another";
      }
      if (channel.isSubsampled) {
        return "has subsampled colours (" + channel.name + "); write the picture at full resolution";
      }
    }
    return "";
  }

  void refuseFault(const std::string& fault, const std::string& name) const {
    if (!fault.empty()) {
      throw InputError(m_file, "layer", name, fault);
    }
  }

  bool matches(const Candidate& candidate, const std::string& name) const {
    if (candidate.layer.name == name || candidate.name == name ||
        (m_parts.size() > 1 && m_parts[static_cast<std::size_t>(candidate.layer.part)].name == name)) {
      return true;
    }
    // What other programs call the channels without a prefix.
    const bool isNamed = std::any_of(m_candidates.begin(), m_candidates.end(), [&](const Candidate& other) {
      return other.layer.name == name || other.name == name;
    });
    return !isNamed && candidate.isBare && candidate.name.empty() && (name == "rgba" || name == "rgb");
  }

  template <typename Condition>
  std::vector<ColourLayer> thatAre(const Condition& condition) const {
    std::vector<ColourLayer> found;
    for (const Candidate& candidate : m_candidates) {
      if (condition(candidate)) {
        refuseFault(candidate.fault, candidate.layer.name.empty() ? "R, G, B" : candidate.layer.name);
        found.push_back(candidate.layer);
      }
    }
    return found;
  }

  /// Those that meet the condition, where all have one name.
  template <typename Condition>
  std::vector<ColourLayer> oneName(const Condition& condition) const {
    std::optional<std::string> name;
    for (const Candidate& candidate : m_candidates) {
      if (condition(candidate)) {
        if (name && *name != candidate.name) {
          return {};
        }
        name = candidate.name;
      }
    }
    return thatAre(condition);
  }

  std::string whatIsThere() const {
    std::vector<std::string> names;
    for (const Candidate& candidate : m_candidates) {
      names.push_back(candidate.layer.name.empty() ? "rgba (R, G, B)" : candidate.layer.name);
    }
    return names.empty() ? "there is " + channelsThere()
                         : "there is " + spectral::shortened(spectral::joined(names), 160);
  }

  std::string channelsThere() const {
    std::vector<std::string> names;
    for (const PartFacts& part : m_parts) {
      for (const ChannelFacts& channel : part.channels) {
        names.push_back(channel.name);
      }
    }
    return spectral::shortened(spectral::joined(names), 120);
  }

  const std::vector<PartFacts>& m_parts;
  const std::string& m_file;
  std::vector<Candidate> m_candidates;
};

}  // namespace

std::vector<ColourLayer> chooseLayers(const std::vector<PartFacts>& parts, const LayerRequest& request,
                                      const std::string& file) {
  const Layers layers(parts, file);
  if (!request.channels.empty()) {
    return layers.byChannels(request.channels);
  }
  return request.layers.empty() ? layers.unmistakable() : layers.byNames(request.layers);
}

}  // namespace metamer::lutgen
