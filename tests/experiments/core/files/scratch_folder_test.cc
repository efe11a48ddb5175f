#include "experiments/core/files/scratch_folder.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <memory>
#include <thread>
#include <vector>

#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// Everything below happens in a place for temporary files of the test's own.
class ScratchFolderTest : public testing::Test {
 protected:
  ScratchFolderTest() { setenv("TMPDIR", place_.path().c_str(), 1); }
  ~ScratchFolderTest() override { unsetenv("TMPDIR"); }
  TempFolder place_;
};

TEST_F(ScratchFolderTest, GoesWithItsObject) {
  {
    const ScratchFolder folder;
    EXPECT_TRUE(std::filesystem::is_directory(folder.path()));
    std::ofstream(folder.path() + "/file") << "text";
    RemoveAbandonedScratchFolders();
    EXPECT_EQ(ReadBytes(folder.path() + "/file"), "text") << "its owner lives";
  }
  EXPECT_EQ(place_.NumEntries(), 0);
}

// A process that makes a folder, says so and waits for its end.
TEST_F(ScratchFolderTest, OfAKilledProcessGoesAtTheNextStart) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    const ScratchFolder folder;
    std::ofstream(folder.path() + "/file") << "text";
    static_cast<void>(!write(ends[1], "x", 1));
    for (;;) pause();
  }
  char byte = 0;
  ASSERT_EQ(read(ends[0], &byte, 1), 1);
  RemoveAbandonedScratchFolders();
  EXPECT_EQ(place_.NumEntries(), 1) << "its owner lives";
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(place_.NumEntries(), 1);
  RemoveAbandonedScratchFolders();
  EXPECT_EQ(place_.NumEntries(), 0);
}

TEST_F(ScratchFolderTest, NothingElseIsTouched) {
  std::filesystem::create_directory(place_.Path("rcme_of_somebody"));
  place_.Write("rcme_scratch_file", "a file, no folder");
  const TempFolder elsewhere;
  elsewhere.Write("precious", "text");
  std::filesystem::create_directory_symlink(elsewhere.path(), place_.Path("rcme_scratch_link"));
  RemoveAbandonedScratchFolders();
  EXPECT_EQ(place_.NumEntries(), 4) << "the three and the folder of the link";
  EXPECT_EQ(elsewhere.NumEntries(), 1);
}

// Makers and removers at once: no folder goes while its object lives.
TEST_F(ScratchFolderTest, MakersAndRemoversDoNotMeet) {
  std::vector<std::jthread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([] {
      for (int i = 0; i < 200; ++i) {
        const ScratchFolder folder;
        RemoveAbandonedScratchFolders();
        EXPECT_TRUE(std::filesystem::is_directory(folder.path()));
      }
    });
  }
  threads.clear();
  EXPECT_EQ(place_.NumEntries(), 0);
}

}  // namespace
}  // namespace rcme
