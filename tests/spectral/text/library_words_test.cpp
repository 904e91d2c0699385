// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/library_words.h"

#include <gtest/gtest.h>

namespace metamer::spectral {
namespace {

TEST(LibraryWordsTest, PicturesAreSaidOnceAndWithARemedy) {
  const std::string remedy = "; it is damaged, cut short or none: write it again";
  EXPECT_EQ(pictureReason("Could not read header"), "Could not read header" + remedy);
  EXPECT_EQ(pictureReason("Could not open file: Bad header.\nCould not open file: Bad header."), "Bad header" + remedy);
  EXPECT_EQ(pictureReason("Subsampled channels are not supported."),
            "Subsampled channels are not supported; write it in another way");
  EXPECT_EQ(pictureReason(""), remedy.substr(2));
  EXPECT_EQ(pictureReason("OpenImageIO could not find a format reader for \"a.xyz\"."),
            "is no picture of a format that is read; write .exr, .png, .tif, .dpx or .jpg");
  EXPECT_LE(pictureReason(std::string(4000, 'x')).size(), 180U);
}

TEST(LibraryWordsTest, ColourHasTheReasonAlone) {
  EXPECT_EQ(colourReason(
                "Error: Loading the OCIO profile '/home/me/a.ocio' failed. yaml-cpp: error at line 9, column 1: end of "
                "map not found"),
            "line 9, column 1: end of map not found");
  EXPECT_EQ(
      colourReason(
          "The specified transform file '/a/b.cube' could not be loaded.\nAll formats have been tried. (Enable debug "
          "log for errors from all formats.) The formats for the file's extension gave the errors:\n\n    "
          "'iridas_cube' failed with: Error parsing Iridas .cube file (/a/b.cube).  LUT type (1D/3D) unspecified.    "
          "'resolve_cube' failed with: Error parsing Resolve .cube file (/a/b.cube).  Lut type unspecified."),
      "LUT type (1D/3D) unspecified");
  EXPECT_EQ(
      colourReason(
          "The specified transform file '/a/b.clf' could not be loaded. All formats have been tried. (Enable debug log "
          "for errors from all formats.) The format for the file's extension gave the error: 'Academy/ASC Common LUT "
          "Format' failed with: Error parsing CTF/CLF file (/a/b.clf). Error is: CTF/CLF parsing error: no element "
          "found. At line (1)"),
      "no element found. At line (1)");
  EXPECT_EQ(
      colourReason(
          "The specified transform file '/a/b.xyz' could not be loaded.\nAll formats have been tried. (Enable debug "
          "log for errors from all formats.)"),
      "is no file of a kind that OpenColorIO reads; export it again");
  EXPECT_NE(colourReason("Cycle detected while collecting context variables.").find("circle"), std::string::npos);
  EXPECT_EQ(colourReason("Singular Matrix can't be inverted."), "Singular Matrix can't be inverted");
}

}  // namespace
}  // namespace metamer::spectral
