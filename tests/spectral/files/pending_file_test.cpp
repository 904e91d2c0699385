// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/pending_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "spectral/fixture.h"
#include "spectral/temporary_folder.h"

namespace metamer::spectral {
namespace {

TEST(PendingFileTest, AppearsOnCommitAlone) {
  const TemporaryFolder folder;
  const auto target = folder / "out.cube";
  {
    PendingFile file(target);
    file.write("text");
    EXPECT_EQ(file.path().extension(), ".cube");
    EXPECT_FALSE(std::filesystem::exists(target));
    file.commit();
  }
  EXPECT_EQ(contentsOf(target), "text");
  { PendingFile(target).write("half"); }
  EXPECT_EQ(contentsOf(target), "text");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(PendingFileTest, RefusesPlacesThatCannotBeWritten) {
  const TemporaryFolder folder;
  EXPECT_NE(errorOf([&] { PendingFile file(folder / "no/such/out.cube"); }).find("cannot be written"),
            std::string::npos);
  EXPECT_NE(errorOf([&] { PendingFile file(folder.path()); }).find("is a folder"), std::string::npos);
  if (geteuid() != 0) {
    std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_read);
    EXPECT_NE(errorOf([&] { PendingFile file(folder / "out.cube"); }).find("cannot be written"), std::string::npos);
  }
}

// /dev/full takes no byte: what a full disk does.
TEST(PendingFileTest, AFullDiskLeavesNothingBehind) {
  if (!std::filesystem::exists("/dev/full")) {
    GTEST_SKIP();
  }
  const TemporaryFolder folder;
  {
    PendingFile file(folder / "out.cube");
    std::filesystem::remove(file.path());
    std::filesystem::create_symlink("/dev/full", file.path());
    EXPECT_NE(errorOf([&] { file.write(std::string(100000, 'x')); }).find("make room"), std::string::npos);
  }
  EXPECT_TRUE(folder.isEmpty());
}

}  // namespace
}  // namespace metamer::spectral
