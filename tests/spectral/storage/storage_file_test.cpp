// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/storage_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "metamer/spectral/input_error.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

TEST(StorageFile, GivesTheFloatsBack) {
  StoredSet set{StorageForm::Lines, true, {}};
  set.entries.push_back(
      {"a \"quoted\", name", {StorageForm::Lines, true, 1, {0.1F, 1.0F / 3, 1e-30F, 3e30F, 546, 0.2F}}});
  set.entries.push_back({"none", {StorageForm::Lines, true, 0, {0, 1, 2, 3}}});
  const std::filesystem::path file = testing::TempDir() + "metamer_stored.json";
  std::ofstream(file) << storageText(set);
  const StoredSet back = readStorage(file);
  std::filesystem::remove(file);
  EXPECT_EQ(back.form, set.form);
  EXPECT_TRUE(back.isLight);
  ASSERT_EQ(back.entries.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(back.entries[k].name, set.entries[k].name);
    EXPECT_EQ(back.entries[k].spectrum.numbers, set.entries[k].spectrum.numbers);
    EXPECT_EQ(back.entries[k].spectrum.lines, set.entries[k].spectrum.lines);
  }
  EXPECT_EQ(storageText(back), storageText(set));
}

}  // namespace
}  // namespace metamer::spectral
