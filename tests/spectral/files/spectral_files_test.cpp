// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/spectral_files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

namespace fs = std::filesystem;

class SpectralFilesTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const info = testing::UnitTest::GetInstance()->current_test_info();
    m_folder = fs::path(testing::TempDir()) / (std::string("metamer_") + info->name() + std::to_string(getpid()));
    fs::create_directories(m_folder);
  }
  void TearDown() override { fs::remove_all(m_folder); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(m_folder / name, std::ios::binary) << text;
    return (m_folder / name).string();
  }

  fs::path m_folder;
};

constexpr SpectralQuantity kPower = SpectralQuantity::SpectralPowerDistribution;

TEST_F(SpectralFilesTest, TheExtensionPicksTheReader) {
  for (const char* const name : {"a.csv", "a.txt", "a.tsv", "a.CSV"}) {
    EXPECT_EQ(readSpectralFile(write(name, "400 1\n410 2\n"), kPower)[0].name(), "a");
  }
  const std::string spdx =
      "<IESTM2714><SpectralDistribution><SpectralQuantity>flux</SpectralQuantity><SpectralData "
      "wavelength='400'>1</SpectralData><SpectralData wavelength='401'>1</SpectralData></SpectralDistribution>"
      "</IESTM2714>";
  EXPECT_EQ(readSpectralFile(write("a.spdx", spdx), kPower).size(), 1U);
  const std::string json =
      R"({"spectral_data": {"index": {"main": ["a"]}, "data": {"main": {"400": [1], "401": [1]}}}})";
  EXPECT_EQ(readSpectralFile(write("a.json", json), kPower).size(), 1U);
  const std::string other = write("a.pdf", "");
  EXPECT_EQ(errorOf([&] { readSpectralFile(other, kPower); }),
            other +
                ": extension '.pdf': must be .csv, .txt, .tsv, .sp, .ti3 (or another table's, see the manual), "
                ".spdx, .json or .exr");
}

TEST_F(SpectralFilesTest, WhatIsNoFileIsRefused) {
  const std::string missing = (m_folder / "missing.csv").string();
  EXPECT_EQ(errorOf([&] { readSpectralFile(missing, kPower); }), missing + ": no such file");
  EXPECT_EQ(errorOf([&] { readTextFile(m_folder); }), m_folder.string() + ": is a folder; give a file");
  EXPECT_EQ(errorOf([] { readTextFile("/dev/null"); }), "/dev/null: is a device or pipe; give a regular file");
  const std::string loop = (m_folder / "loop.csv").string();
  fs::create_symlink("loop.csv", loop);
  EXPECT_NE(errorOf([&] { readTextFile(loop); }), "no InputError");
}

TEST_F(SpectralFilesTest, UnreadableFileIsRefused) {
  if (geteuid() == 0) {
    GTEST_SKIP() << "root reads everything";
  }
  const std::string file = write("a.csv", "400,1\n");
  fs::permissions(file, fs::perms::none);
  EXPECT_EQ(errorOf([&] { readTextFile(file); }), file + ": cannot be read; check its permissions");
}

TEST_F(SpectralFilesTest, LargeFileIsRefusedByItsSize) {
  const std::string file = write("large.csv", "");
  fs::resize_file(file, kLargestFileBytes + 1);  // sparse: takes no space
  EXPECT_EQ(errorOf([&] { readSpectralFile(file, kPower); }),
            file + ": size '67108865 bytes': more than the 67108864 that are read; resample the spectra");
}

TEST_F(SpectralFilesTest, BytesComeBackAsTheyAre) {
  const std::string bytes("a\0b\r\n\xFF", 6);
  EXPECT_EQ(readTextFile(write("bytes.txt", bytes)), bytes);
  EXPECT_EQ(readTextFile(write("empty.txt", "")), "");
}

}  // namespace
}  // namespace metamer::spectral
