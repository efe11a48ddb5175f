#include "experiments/gate/gate_terms.h"

#include <gtest/gtest.h>

#include "tests/test_support/expect_input_error.h"
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

TEST(RequireSameTerms, SaysWhatIsOther) {
  const GateTerms terms = MakeGateTerms(MakeGateTests({"failure"}, {"failure=0.01"}), "old", {});
  ASSERT_EQ(terms.builds.size(), 1U);
  EXPECT_NO_THROW(RequireSameTerms(terms, terms.AsStoppingRule(), "trials.sqlite"));

  const GateTerms of_other_margin = MakeGateTerms(MakeGateTests({"failure"}, {"failure=0.05"}), "old", {});
  EXPECT_TRUE(
      ThrowsInputError([&] { RequireSameTerms(of_other_margin, terms.AsStoppingRule(), "trials.sqlite"); },
                       {"trials.sqlite", "failure=0.01", "failure=0.05", "another --out"}));
  GateTerms of_other_build = terms;
  of_other_build.builds[0].back() = terms.builds[0].back() == '0' ? '1' : '0';
  EXPECT_TRUE(
      ThrowsInputError([&] { RequireSameTerms(of_other_build, terms.AsStoppingRule(), "trials.sqlite"); },
                       {"trials.sqlite", "another build of rcme"}));
  EXPECT_TRUE(
      ThrowsInputError([&] { RequireSameTerms(terms, "ci=0.01", "trials.sqlite"); }, {"known margins"}));
}

}  // namespace
}  // namespace rcme
