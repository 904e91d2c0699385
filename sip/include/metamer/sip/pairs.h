// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/spectral_transform.h"
#include "metamer/spectral/data_library.h"

namespace metamer::sip {

/// A colour whose spectrum is known.
struct Pair {
  std::string name;
  spectral::DomainSamples reflectance;
};

/// What one pair looks like under one light.
struct PairColour {
  std::string light;    ///< as named
  Eigen::Vector3d xyz;  ///< CIE 1931 2 degree; the perfect reflector under this light has Y = 1
};

/// Reads a recipe's `scene.set`: a set of measured reflectances (a NAME of data/, or a file that readSpectralFile
/// takes; FILE:COLUMN is one of its curves), or a table of colours, a pair's under several lights in as many rows:
///
///     pair,light,X,Y,Z          or   pair,light,L*,a*,b*
///     coat,D65,0.213,0.127,0.023
///     coat,A,0.310,0.169,0.009
///
/// X, Y, Z with Y = 1 for the perfect reflector; L*, a*, b* beside the light's own white. A pair of such a table has
/// the spectrum of reflectanceOf().
/// @throws spectral::InputError naming file, row or pair, value and remedy: a broken row, a colour that no reflectance
///         has (the nearest is named), more than kMostPairs, none
std::vector<Pair> readPairs(const std::string& nameOrFile, const spectral::DataLibrary& library,
                            const std::filesystem::path& folder = {});

/// Whether a file is such a table of colours. False for a file that is not there.
/// @throws spectral::InputError where its heading begins like one and goes on otherwise
bool isTableOfColours(const std::filesystem::path& file);

/// The smoothest reflectance within 0 ... brightest that has some colours under as many lights, to 1e-9 in X, Y and Z;
/// on 81 bands, linear between them.
/// @param where      for messages: a file, a command's option
/// @param colours    at least one, of lights that `library` knows
/// @param brightest  kFluorescentBrightest for what fluoresces
/// @throws spectral::InputError where there is none, with the nearest that there is
Pair reflectanceOf(const std::string& name, const std::vector<PairColour>& colours,
                   const spectral::DataLibrary& library, const std::string& where,
                   const std::filesystem::path& folder = {}, double brightest = 1.0);

/// More than any day-glo paint gives back of what arrives in a band.
inline constexpr double kFluorescentBrightest = 4.0;

/// One pair of a transform's scene, as it comes out.
struct CheckedPair {
  std::string name;
  Eigen::Vector3d rgb = Eigen::Vector3d::Zero();           ///< under the input light, in the working space
  Eigen::Vector2d chromaticity = Eigen::Vector2d::Zero();  ///< x, y of that under the working white
  bool isDark = false;                 ///< black under the input light: left out, and nothing below has a meaning
  double errorBefore = 0;              ///< CIEDE2000 from the truth without pairs, of the scene below
  double error = 0;                    ///< with them
  double gain = 0;                     ///< CIEDE2000 out per CIEDE2000 in, worst direction
  std::string nearest;                 ///< the pair next to it in chromaticity; "white" counts
  double distance = 0;                 ///< to that: CIEDE2000 at equal brightness
  std::vector<std::string> conflicts;  ///< pairs that ask for another spectrum too near to it, "white" among them: none
                                       ///< is exact
  double brightest = 0;                ///< largest reflectance; above 1 it is no reflectance's
};

/// Every pair of a specification whose scene is of pairs, in their order.
/// @throws spectral::InputError as SpectralTransform; where the scene is another kind
std::vector<CheckedPair> checkPairs(const TransformSpec& spec);

/// What a user should know of a specification's pairs, a line each: those in conflict, black, too bright. None for
/// other scenes.
std::vector<std::string> notesOfPairs(const TransformSpec& spec);

}  // namespace metamer::sip
