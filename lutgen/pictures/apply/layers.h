// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

namespace metamer::lutgen {

/// A channel, for the choice of colours.
struct ChannelFacts {
  std::string name;
  bool isColourType = true;  ///< half, float or a fraction of the full code; false for uint32 and the like
  bool isSubsampled = false;
};

/// A part (subimage) of a picture, for the choice of colours.
struct PartFacts {
  std::string name;                ///< empty: none
  std::string view;                ///< of a stereo picture
  std::vector<std::string> views;  ///< all, where one part holds them; the first is that of channels without a prefix
  bool isDeep = false;
  std::vector<ChannelFacts> channels;
};

/// What the user asks for.
struct LayerRequest {
  std::vector<std::string> layers;    ///< names; empty: what is unmistakable
  std::vector<std::string> channels;  ///< three names, in place of layers
};

/// The colours of a layer.
struct ColourLayer {
  std::string name;
  int part = 0;
  std::array<int, 3> channels{};  ///< red, green, blue
  int alpha = -1;                 ///< -1: none
};

/// Which layers are transformed: those asked for; else R, G, B without a prefix in a picture of one part; else the one
/// layer whose name says that it is the picture (rgba, beauty, Combined, ...), in each view; else the one part with R,
/// G, B without a prefix whose name is not that of data. Never AO, normals, positions by themselves.
/// @throws spectral::InputError where nothing is unmistakable: lists the layers, and says what to give
std::vector<ColourLayer> chooseLayers(const std::vector<PartFacts>& parts, const LayerRequest& request,
                                      const std::string& file);

}  // namespace metamer::lutgen
