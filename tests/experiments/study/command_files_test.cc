#include "experiments/study/command_files.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

TEST(HashFilesOfCommand, ChangesWithTheBytesOfTheFilesThatTheCommandNames) {
  const TempFolder folder;
  const std::string script = folder.Write("an estimator.py", "one"), model = folder.Write("model.bin", "two");
  const std::string quoted = "python3 '" + script + "' --model=" + model;
  const std::string escaped = "python3 " + folder.path() + "/an\\ estimator.py < " + model + "|cat";
  for (const std::string& command : {quoted, escaped}) {
    const std::string before = HashFilesOfCommand(command);
    EXPECT_EQ(HashFilesOfCommand(command), before);
    for (const char* name : {"an estimator.py", "model.bin"}) {
      folder.Write(name, "another");
      EXPECT_NE(HashFilesOfCommand(command), before) << name << " of " << command;
      folder.Write(name, name == std::string("model.bin") ? "two" : "one");
    }
    EXPECT_EQ(HashFilesOfCommand(command), before) << command;
  }
  EXPECT_EQ(HashFilesOfCommand("python3 " + folder.path() + " --seed=1"), HashFilesOfCommand(""))
      << "no files";
}

// Beyond one piece of a file.
TEST(HashFilesOfCommand, ReadsAFileToItsEnd) {
  const TempFolder folder;
  std::string bytes(200'000, 'x');
  const std::string path = folder.Write("large", bytes), before = HashFilesOfCommand(path);
  bytes.back() = 'y';
  folder.Write("large", bytes);
  EXPECT_NE(HashFilesOfCommand(path), before);
}

// A log grows with every run.
TEST(HashFilesOfCommand, LeavesOutWhatTheShellWrites) {
  const TempFolder folder;
  const std::string script = folder.Write("a.sh", "one"), log = folder.Write("log", "two");
  for (const char* way : {" > ", " 2>", " >> "})
    EXPECT_EQ(ListFilesOfCommand("sh " + script + way + log).size(), 1U) << way;
  EXPECT_EQ(ListFilesOfCommand("sh " + script + " 2>&1 < " + log).size(), 2U);
}

}  // namespace
}  // namespace rcme
