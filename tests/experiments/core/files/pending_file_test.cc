// Files whole or not at all, and what killed processes leave.
#include "experiments/core/files/pending_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <string>

#include "experiments/core/files/file_output.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// Every test has folders of its own: a folder is looked through once a process.
class PendingFiles : public testing::Test {
 protected:
  // What a process does that says so and is killed while it waits; its id, which still runs.
  static pid_t Waiting(const std::function<void(const std::function<void()>& wait)>& action) {
    int ends[2];
    if (pipe(ends) != 0) return -1;
    const pid_t child = fork();
    if (child == 0) {
      action([&] {
        static_cast<void>(!write(ends[1], "x", 1));
        for (;;) pause();
      });
      _exit(1);
    }
    char byte = 0;
    EXPECT_EQ(read(ends[0], &byte, 1), 1);
    close(ends[0]);
    close(ends[1]);
    return child;
  }
  static void Kill(pid_t child) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  // A process of its own writes a file there, as the next command would.
  static void WriteElsewhere(const std::string& path) {
    const pid_t child = fork();
    if (child == 0) {
      WriteFileWhole(path, "whole");
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
  }

  const TempFolder folder_;
};

TEST_F(PendingFiles, TakeTheirPlaceOrLeaveNothing) {
  const std::string path = folder_.Write("table", "old");
  {
    FileInPieces file(path);
    file.Write("half");
    EXPECT_EQ(ReadBytes(path), "old");
    EXPECT_EQ(folder_.NumEntries(), 2);
  }
  EXPECT_EQ(ReadBytes(path), "old");
  EXPECT_EQ(folder_.NumEntries(), 1);
  WriteFileWhole(path, "new");
  EXPECT_EQ(ReadBytes(path), "new");
  EXPECT_EQ(folder_.NumEntries(), 1);
  EXPECT_TRUE(ThrowsInputError([&] { PendingFile(folder_.Path("none/table")); },
                               {"none/table", "cannot be written"}));
  const std::string longest = folder_.Path(std::string(255, 'n'));
  WriteFileWhole(longest, "new");
  EXPECT_EQ(ReadBytes(longest), "new");
}

TEST_F(PendingFiles, OfAKilledProcessGoWithTheNextThatWritesThere) {
  const std::string path = folder_.Path("table");
  const pid_t child = Waiting([&](const std::function<void()>& wait) {
    FileInPieces file(path);
    file.Write("half");
    wait();
  });
  WriteElsewhere(folder_.Path("other"));
  EXPECT_EQ(folder_.NumEntries(), 2) << "its owner lives";
  Kill(child);
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(folder_.NumEntries(), 2);
  WriteElsewhere(folder_.Path("other"));
  EXPECT_EQ(folder_.NumEntries(), 1);
}

TEST_F(PendingFiles, NothingElseIsTouched) {
  std::string part;
  {
    const TempFolder other;  // else this process, and all that it forks, would have looked through folder_
    const PendingFile pending(other.Path("table"));
    part = std::filesystem::path(pending.part()).filename();
  }
  const size_t host = part.find(".rcme-") + 6, after = part.rfind('-', part.rfind('-') - 1);
  folder_.Write(part.substr(0, host) + "another-host" + part.substr(after), "of another machine");
  folder_.Write("mine.part", "text");
  folder_.Write(part.substr(0, part.size() - 5), "text");  // without .part
  folder_.Write(part + ".csv", "text");
  const TempFolder elsewhere;
  const std::string precious = elsewhere.Write("precious", "text");
  std::filesystem::create_symlink(precious, folder_.Path(part + "-link"));
  std::filesystem::create_symlink(precious, folder_.Path("link" + part));
  WriteElsewhere(folder_.Path("other"));
  EXPECT_EQ(folder_.NumEntries(), 7);
  EXPECT_EQ(ReadBytes(precious), "text");
  folder_.Write("a" + part, "abandoned");
  WriteElsewhere(folder_.Path("other"));
  EXPECT_EQ(folder_.NumEntries(), 7) << "this one goes: nobody has locked it";
}

}  // namespace
}  // namespace rcme
