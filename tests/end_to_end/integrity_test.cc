// rcme integrity: what it writes, the same bytes for threads and shards, its exit codes, and what it refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/end_to_end/bad_input.h"

namespace rcme {
namespace {

using testing::HasSubstr;

class Integrity : public BadInput {
 protected:
  ProgramResult RunIntegrity(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"integrity", study_, "--estimator", "standard", "--trials", "150"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
};

TEST_F(Integrity, GivesTheSameBytesForThreadsAndShards) {
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"--risk", "0.4"});
    return RunIntegrity(more);
  };
  const std::string out = folder_.Path("whole"), other = folder_.Path("other");
  const ProgramResult whole = with({"--out", out});
  EXPECT_EQ(whole.exit_code, 3) << whole.out << whole.err;  // undecided
  EXPECT_EQ(ReadBytes(out + "/integrity.txt"), whole.out);
  const std::string json = ReadBytes(out + "/integrity.json");
  EXPECT_THAT(json, HasSubstr("\"format\": \"rcme integrity 1\""));
  EXPECT_EQ(with({"--threads", "1", "--out", other}).out, whole.out);
  EXPECT_EQ(ReadBytes(other + "/integrity.json"), json);
  const std::string first = folder_.Path("1.part"), second = folder_.Path("2.part"),
                    merged = folder_.Path("merged");
  EXPECT_EQ(with({"--shard", "1/2", "--out", first}).exit_code, 0);
  EXPECT_EQ(with({"--out", merged, "--merge", first}).exit_code, 75);
  EXPECT_EQ(with({"--shard", "2/2", "--out", second}).exit_code, 0);
  const ProgramResult both = with({"--out", merged, "--merge", first, second});
  EXPECT_EQ(both.exit_code, 3) << both.err;
  EXPECT_EQ(ReadBytes(merged + "/integrity.json"), json);
  EXPECT_TRUE(IsRefused(RunIntegrity({"--risk", "0.3", "--merge", first, second}), {first}));
  // As many items as 150 trials have.
  EXPECT_TRUE(IsRefused(RunRcme({"integrity", study_, "--estimator", "standard", "--trials", "160", "--risk",
                                 "0.4", "--merge", first, second}),
                        {first, "trials of a condition: 150", "160"}));
}

// The covariance of `standard` knows nothing of wrong matches.
TEST_F(Integrity, EndsWithOneIfTheRiskIsExceeded) {
  const ProgramResult result = RunIntegrity({"--risk", "1e-3"});
  EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("exceeded"));
}

// Too few answers, or none at all, do not show that a risk is kept.
TEST_F(Integrity, EndsWithThreeIfItIsUndecided) {
  const ProgramResult few =
      RunRcme({"integrity", study_, "--estimator", "rcme_calibrated", "--trials", "2", "--risk", "1e-3"});
  EXPECT_EQ(few.exit_code, 3) << few.out << few.err;
  EXPECT_THAT(few.out, HasSubstr("undecided"));
  EXPECT_THAT(few.out, HasSubstr("at least 3688 answers, none of them misleading, are needed"));
}

TEST_F(Integrity, RefusesWhatMakesNoSense) {
  EXPECT_TRUE(IsRefused(RunRcme({"integrity"}), {"study"}));
  EXPECT_TRUE(IsRefused(RunRcme({"integrity", study_}), {"choose one with --estimator"}));
  EXPECT_TRUE(IsRefused(RunRcme({"integrity", study_, "--estimator", "nobody"}), {"nobody"}));
  EXPECT_TRUE(IsRefused(RunIntegrity({"--shard", "1/2"}), {"--out is missing"}));
  for (const char* option : {"--risk", "--rotation-limit", "--direction-limit"}) {
    for (const char* value : {"0", "nan", "1e9", "x"})
      EXPECT_TRUE(IsRefused(RunIntegrity({option, value}), {option})) << value;
  }
}

}  // namespace
}  // namespace rcme
