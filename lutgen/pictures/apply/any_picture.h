// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <string>
#include <vector>

#include "apply/layers.h"
#include "exr/exr_change.h"

namespace metamer::lutgen {

/// Types of samples by oiiotool's names: "uint8", "uint10", "uint12", "uint16", "half", "float".
struct SampleType {
  OIIO::TypeDesc type;
  int bits = 0;  ///< of the full code, where fewer than the type's; else 0
};

/// @throws spectral::InputError for other names
SampleType sampleTypeNamed(const std::string& name);

/// A picture that OpenImageIO reads, samples in the types that the file has.
class AnyPicture {
 public:
  /// Reads what the file says, not yet its pixels.
  /// @throws spectral::InputError: not there, cannot be read, too large
  AnyPicture(const std::filesystem::path& file, std::int64_t mostPixels);

  std::vector<PartFacts> facts() const;
  const OIIO::ImageSpec& spec(int part) const { return m_parts[static_cast<std::size_t>(part)].before; }
  const std::string& file() const { return m_file; }
  const std::string& format() const { return m_format; }
  /// Bytes of all samples.
  std::uint64_t bytes() const;

  /// Says what is to be written, before anything is read.
  /// @param type  of the colours and their alpha, or of all channels where the format has one type for all; null: as
  /// they are
  /// @param compression  empty: as it is, where the format knows it
  /// @throws spectral::InputError where the output's format cannot hold it
  void plan(const std::filesystem::path& output, const std::vector<ColourLayer>& layers, const SampleType* type,
            const std::string& compression);

  /// Of the written parts, or of one: what they say of their pixels.
  void describe(const std::string& oiioSpace, const std::optional<std::array<float, 8>>& chromaticities,
                std::optional<int> onlyPart = {});

  /// Reads, changes and writes, whole or not at all. Pixels that are not finite stay.
  void write(const std::filesystem::path& output, const PixelFunction& pixels, int threads);

  // In steps, for what makes other channels of some: load, values, exchange, plan, put, save.

  /// Reads the pixels of all parts. @throws spectral::InputError
  void load();
  /// Samples of some channels of a part, a pixel after another.
  std::vector<float> values(int part, const std::vector<int>& channels) const;
  /// Takes channels away and adds others of floats, black, behind those that stay. What OpenEXR holds no samples of
  /// becomes float.
  void exchange(int part, const std::vector<int>& removed, const std::vector<std::string>& added);
  /// Fills float channels, side by side from `first` on. @param values  as many a pixel as there are of them
  void put(int part, int first, const std::vector<float>& values);
  /// A text of the header; empty: none.
  std::string text(int part, const std::string& attribute) const;
  void setText(int part, const std::string& attribute, const std::string& text);
  /// Writes what is loaded, as planned, whole or not at all. @throws spectral::InputError
  void save(const std::filesystem::path& output, int threads);

 private:
  struct Part {
    OIIO::ImageSpec before;
    OIIO::ImageSpec after;
    std::vector<char> samples;  ///< as `before`, then as `after`
    std::vector<ColourLayer> layers;
  };

  void read(OIIO::ImageInput& input, std::size_t index);
  void change(Part& part, const PixelFunction& pixels, int threads) const;
  void writeWhole(const std::filesystem::path& output) const;
  /// @param name  for messages
  void writeParts(OIIO::ImageOutput& output, const std::string& path, const std::string& name) const;

  std::string m_file;
  std::string m_format;
  std::vector<Part> m_parts;
};

}  // namespace metamer::lutgen
