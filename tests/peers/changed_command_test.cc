// A run is not continued with another version of the files that its estimators' commands name.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "experiments/study/command_files.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "tests/peers/process_entry.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

std::string MakeIdentity(const std::string& command, int seed = 1) {
  ProcessEntryName();
  Study study = ParseStudy(fmt::format("seed: {}\ndata: {{scene: uniform_volume}}\nestimators:\n"
                                       "  - {{name: process, label: mine, options: {{command: \"{}\"}}}}\n",
                                       seed, command),
                           "study.yaml");
  study.estimators.front().command_place.clear();
  return MakePlan(study).identity;
}

TEST(CommandFiles, ArePartOfTheIdentityOfARun) {
  const TempFolder folder;
  const std::string script = folder.Write("a.sh", "one"), command = "sh " + script;
  const std::string before = MakeIdentity(command), of_other_seed = MakeIdentity(command, 2);
  EXPECT_EQ(FindChangedCommandFile(before, before), std::nullopt);
  EXPECT_EQ(FindChangedCommandFile(before, of_other_seed), std::nullopt) << "that is another study";
  folder.Write("a.sh", "two");
  EXPECT_EQ(FindChangedCommandFile(before, MakeIdentity(command)), "file " + script + " of estimator mine");
  folder.Write("a.sh", "one");
  EXPECT_EQ(MakeIdentity(command), before);
  EXPECT_EQ(MakeIdentity("no_such_program --fast").find("# file"), std::string::npos);
}

}  // namespace
}  // namespace rcme
