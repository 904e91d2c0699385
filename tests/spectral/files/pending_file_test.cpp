// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/pending_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "metamer/spectral/interruption.h"
#include "metamer/spectral/pending_folder.h"
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

TEST(PendingFileTest, KeepsTheModeAndFollowsLinks) {
  const TemporaryFolder folder;
  namespace fs = std::filesystem;
  fs::create_directory(folder / "there");
  writeWholeFile(folder / "there" / "real.cube", "old");
  fs::permissions(folder / "there" / "real.cube", fs::perms(0640));
  fs::create_symlink("there/real.cube", folder / "link.cube");
  fs::create_symlink("link.cube", folder / "link2.cube");
  writeWholeFile(folder / "link2.cube", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link2.cube"));
  EXPECT_TRUE(fs::is_symlink(folder / "link.cube"));
  EXPECT_EQ(contentsOf(folder / "there" / "real.cube"), "new");
  EXPECT_EQ(fs::status(folder / "there" / "real.cube").permissions(), fs::perms(0640));
  // A link to what is not there yet; links in a circle.
  fs::create_symlink("there/later.cube", folder / "early.cube");
  writeWholeFile(folder / "early.cube", "x");
  EXPECT_EQ(contentsOf(folder / "there" / "later.cube"), "x");
  fs::create_symlink("b.cube", folder / "a.cube");
  fs::create_symlink("a.cube", folder / "b.cube");
  EXPECT_NE(errorOf([&] { PendingFile file(folder / "a.cube"); }).find("circle"), std::string::npos);
}

TEST(PendingFileTest, DevicesAndPipesAreWrittenInto) {
  const TemporaryFolder folder;
  const auto pipe = folder / "pipe.cube";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(isStream(pipe));
  std::string read;
  std::thread reader([&] { read = contentsOf(pipe); });
  writeWholeFile(pipe, std::string(200000, 'x'));
  reader.join();
  EXPECT_EQ(read, std::string(200000, 'x'));
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
  writeWholeFile("/dev/null", "x");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_FALSE(isStream(folder / "new.cube"));
  EXPECT_NE(errorOf([&] { PendingFile file("/dev/no_such_device"); }).find("no device"), std::string::npos);
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_NE(errorOf([&] { writeWholeFile("/dev/full", "x"); }).find("/dev/full: output: cannot be written"),
              std::string::npos);
  }
}

TEST(PendingFileTest, TheLongestNameIsNoFailure) {
  const TemporaryFolder folder;
  const std::string name = std::string(250, 'n') + ".cube";
  writeWholeFile(folder / name, "x");
  EXPECT_EQ(contentsOf(folder / name), "x");
  EXPECT_NE(errorOf([&] { PendingFile file(folder / ("n" + name)); }).find("too long"), std::string::npos);
}

// A program of its own: signals end it.
TEST(InterruptionTest, ASignalRemovesWhatIsUnfinished) {
  const TemporaryFolder folder;
  const auto run = [&](int signal, bool isHeld) {
    EXPECT_EXIT(
        {
          std::signal(signal, SIG_DFL);  // what started the tests may ignore it, as nohup does
          endCleanlyBySignals("program");
          const PendingFolder made(folder / "show" / "day" / "luts");
          PendingFile first(folder / "show" / "day" / "luts" / "a.cube");
          PendingFile second(folder / "b.cube");
          second.write("new");
          if (isHeld) {
            const SignalsWait wait;
            std::raise(signal);
            second.commit();
          } else {
            std::raise(signal);
          }
          std::_Exit(0);
        },
        testing::KilledBySignal(signal), isHeld ? "files that are complete: 1\n" : "; nothing was written\n");
  };
  writeWholeFile(folder / "b.cube", "old");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    run(signal, false);
    EXPECT_EQ(contentsOf(folder / "b.cube"), "old");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
  }
  run(SIGTERM, true);
  EXPECT_EQ(contentsOf(folder / "b.cube"), "new");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

// Threads go on while a signal is handled: what they finish is counted, or not there.
TEST(InterruptionTest, WhatOtherThreadsFinishIsTold) {
  for (int round = 0; round < 5; ++round) {
    const TemporaryFolder folder;
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    const pid_t child = fork();
    if (child == 0) {
      dup2(pipe[1], STDERR_FILENO);
      endCleanlyBySignals("program");
      std::atomic<int> next = 0;
      std::vector<std::thread> threads;
      for (int i = 0; i < 3; ++i) {
        threads.emplace_back([&] {
          while (true) {
            writeWholeFile(folder / (std::to_string(++next) + ".cube"), "x");
          }
        });
      }
      while (next < 30 + 7 * round) {
      }
      std::raise(SIGTERM);
      std::this_thread::sleep_for(std::chrono::seconds(60));  // where another thread ends the program
      std::_Exit(1);
    }
    close(pipe[1]);
    std::string said;
    std::array<char, 200> piece{};
    for (ssize_t count = 1; count > 0;) {
      count = read(pipe[0], piece.data(), piece.size());
      said.append(piece.data(), static_cast<std::size_t>(std::max<ssize_t>(0, count)));
    }
    close(pipe[0]);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
    const auto left = std::distance(std::filesystem::directory_iterator(folder.path()), {});
    EXPECT_EQ(said, "program: stopped by SIGTERM; files that are complete: " + std::to_string(left) + "\n");
  }
}

TEST(PendingFolderTest, GoesWithWhatItMadeUnlessItIsKept) {
  const TemporaryFolder folder;
  namespace fs = std::filesystem;
  {
    const PendingFolder made(folder / "a" / "b");
  }
  EXPECT_TRUE(folder.isEmpty());
  fs::create_directory(folder / "a");
  {
    const PendingFolder made(folder / "a" / "b" / "c");
    writeWholeFile(folder / "a" / "b" / "file", "x");
  }
  EXPECT_FALSE(fs::exists(folder / "a" / "b" / "c"));
  EXPECT_TRUE(fs::exists(folder / "a" / "b" / "file"));
  PendingFolder(folder / "d" / "e").keep();
  EXPECT_TRUE(fs::is_directory(folder / "d" / "e"));
  EXPECT_NE(errorOf([&] { PendingFolder made(folder / "a" / "b" / "file"); }).find("folder: cannot be made: "),
            std::string::npos);
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
