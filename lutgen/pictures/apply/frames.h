// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace metamer::lutgen {

/// A file name with a place for the frame's number: %04d, #### (a digit each; one # alone: four), or $F4.
class FramePattern {
 public:
  /// Empty where the name has no such place.
  static std::optional<FramePattern> in(const std::string& name);

  /// The file of a frame. Numbers of more digits than there is place for are written in full.
  std::string file(int frame) const;

  /// The frames that lie on the disk, rising. The place is in the file's name alone then.
  /// @throws spectral::InputError where there is none, or no such folder
  std::vector<int> framesThere() const;

 private:
  std::string m_name;
  /// Where numbers stand, and how many digits.
  struct Place {
    std::size_t begin = 0;
    std::size_t size = 0;
    int digits = 0;
  };
  std::vector<Place> m_places;
};

/// Whether the text can be nothing but frames: 1001-1100, 1-10x2, 5, 1,3,7-9.
bool looksLikeFrames(const std::string& text);

/// Frames of "1001-1100", "1-100x5" (every fifth), "1,3,7-9", each once, in the order written; numbers may be negative.
/// @throws spectral::InputError for any other text, and for more than a million
std::vector<int> framesFrom(const std::string& text);

/// Frames as a user writes them: "1001, 1003-1010".
std::string framesText(const std::vector<int>& frames);

}  // namespace metamer::lutgen
