// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "apply/any_picture.h"
#include "apply/layers.h"
#include "apply/transform.h"
#include "exr/exr_file.h"

namespace metamer::lutgen {

/// How pictures are read and written.
struct PictureRequest {
  LayerRequest layers;
  std::string pictureSpace;  ///< stated; empty: what the file says
  std::string outputSpace;   ///< empty: the picture's own
  std::string type;          ///< oiiotool's names; empty: as it is
  std::string compression;   ///< empty: as it is
  std::int64_t mostPixels = std::int64_t{1} << 31;
};

/// Applies a transform to pictures, one at a time or several on several threads.
class Relighter {
 public:
  /// @param name  of the pictures, in notes
  /// @throws spectral::InputError where the request has no meaning
  Relighter(std::string name, PictureRequest request, const spectral::DataLibrary& library,
            const ocio::ConfigSource& config);

  /// Refuses what can be refused by the headers alone: unreadable, no unmistakable layer, an output that cannot hold
  /// it. @return bytes that a picture takes in memory, about
  /// @throws spectral::InputError
  std::uint64_t check(const std::filesystem::path& input, const std::filesystem::path& output) const;

  /// Before the first picture.
  void use(const AppliedTransform& transform);

  /// @param threads  within the picture, above 0
  /// @throws spectral::InputError
  void relight(const std::filesystem::path& input, const std::filesystem::path& output, int threads);

  /// Sorted, each once.
  std::set<std::string> notes() const;
  /// What the pixels of the pictures are, in words.
  std::string pixelsText() const;

 private:
  struct Spaces {
    std::optional<PictureSpace> from;  ///< empty: not known
    std::optional<PictureSpace> to;    ///< where it differs
  };

  void note(const std::string& text);
  Spaces spacesOf(const SpaceClues& clues, const std::string& outputFormat);
  void relightExr(const std::string& bytes, const std::filesystem::path& input, const std::filesystem::path& output,
                  int threads);
  void relightAny(const std::filesystem::path& input, const std::filesystem::path& output, int threads);

  std::string m_name;
  PictureRequest m_request;
  std::optional<SampleType> m_type;
  std::optional<PictureSpace> m_stated;
  std::optional<PictureSpace> m_output;
  const spectral::DataLibrary& m_library;
  const AppliedTransform* m_transform = nullptr;
  mutable std::mutex m_mutex;
  std::set<std::string> m_notes;
  std::string m_pixelsText;
};

}  // namespace metamer::lutgen
