// `rcme audit`, `tune`, `transfer` and `map` in shards give the bytes of one run, in any order and grouping,
// with shards that are killed, cut off by a time limit, lost and made again. (64 shards: in
// experiments_test.)
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tests/test_support/run_program.h"
#include "tests/test_support/tuned_study.h"
#include "tests/test_support/without_python.h"

namespace rcme {
namespace {

using Words = std::vector<std::string>;

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class Parts : public testing::Test {
 protected:
  // What a command does with `--out RESULT` is compared by the bytes of these files of it; "" is the file
  // itself.
  struct Work {
    Words command;
    Words files;
    bool has_rounds = false;       // two, the second with --merged
    bool has_round_files = false;  // any number, all but the first with --round
  };

  std::string Part(int number) const { return folder_.Path(fmt::format("part_{}.json", number)); }
  Words ListParts(int count) const {
    Words parts;
    for (int number = 1; number <= count; ++number) parts.push_back(Part(number));
    return parts;
  }
  Words MakeShardCommand(const Work& work, int number, int count) const {
    return work.command + Words{"--shard", fmt::format("{}/{}", number, count), "--out", Part(number)};
  }
  static void KillAfter(const Words& command, std::chrono::milliseconds time) {
    RunningProgram program(RcmeCommand(command));
    std::this_thread::sleep_for(time);
    program.Kill();
  }
  // One round of all shards, of which three are killed, one is cut off and one is lost; `merge` then names
  // that.
  void RunRound(const Work& work, int count, const Words& more, int exit_code) const {
    const auto shard = [&](int number) { return MakeShardCommand(work, number, count) + more; };
    for (const int number : {2, 3, 5}) {
      if (number <= count) KillAfter(shard(number), std::chrono::milliseconds(40 * number));
    }
    const int cut_off = RunRcme(shard(1) + Words{"--max-time", "0.01s"}).exit_code;
    EXPECT_TRUE(cut_off == 75 || cut_off == exit_code) << cut_off;
    for (int number = 1; number <= count; ++number) {
      const ProgramResult result = RunRcme(shard(number));
      EXPECT_EQ(result.exit_code, exit_code) << result.err;
    }
  }
  // The rounds after the first, until a merge lacks nothing: how many there were in all.
  int RunRoundsOfFile(const Work& work, int count) const {
    const Words merge = work.command + Words{"--out", folder_.Path("merged"), "--round", round_, "--merge"};
    for (int num_rounds = 1; num_rounds < 15; ++num_rounds) {
      const ProgramResult merged = RunRcme(merge + ListParts(count));
      if (merged.exit_code == 0) return num_rounds;
      EXPECT_EQ(merged.exit_code, 75) << merged.err;
      RunRound(work, count, {"--round", round_}, 0);
    }
    ADD_FAILURE() << "rounds without end";
    return 0;
  }
  void LoseAndMakeAgain(const Work& work, int count) const {
    const std::string lost = folder_.Path("lost");
    std::filesystem::rename(Part(4), lost);
    Words others = ListParts(count);
    others.erase(others.begin() + 3);
    const std::string out = folder_.Path("no");
    const ProgramResult merge = RunRcme(work.command + Words{"--out", out, "--merge"} + others);
    EXPECT_EQ(merge.exit_code, 75) << merge.err;
    EXPECT_EQ(merge.out, "4\n");
    EXPECT_FALSE(std::filesystem::exists(out));
    const Words round = work.has_round_files ? Words{"--round", round_} : Words{};
    const Words again = MakeShardCommand(work, 4, count) + round;
    const ProgramResult first = RunRcme(again);
    EXPECT_EQ(first.exit_code, work.has_rounds ? 75 : 0) << first.err;
    if (work.has_rounds) {
      const ProgramResult second = RunRcme(again + Words{"--merged", Part(4)} + others);
      EXPECT_EQ(second.exit_code, 0) << second.err;
    }
  }
  std::string Bytes(const Work& work, const std::string& out) const {
    std::string text;
    for (const std::string& file : work.files) text += ReadBytes(file.empty() ? out : out + "/" + file);
    return text;
  }
  void ExpectTheBytesOfOneRun(const Work& work, const std::vector<int>& counts) const {
    const std::string out = folder_.Path("whole");
    const ProgramResult one = RunRcme(work.command + Words{"--out", out});
    ASSERT_EQ(one.exit_code, 0) << one.err;
    const std::string whole = Bytes(work, out);
    ASSERT_GT(whole.size(), 100u);
    for (const int count : counts) {
      for (int number = 1; number <= count; ++number) std::filesystem::remove(Part(number));
      RunRound(work, count, {}, work.has_rounds ? 75 : 0);
      if (work.has_rounds) RunRound(work, count, Words{"--merged"} + ListParts(count), 0);
      EXPECT_TRUE(!work.has_round_files || RunRoundsOfFile(work, count) >= 2);
      if (count >= 7) LoseAndMakeAgain(work, count);
      Words parts = ListParts(count);
      std::ranges::reverse(parts);
      std::vector<Words> groupings = {parts};
      if (count == 7 && work.has_rounds) {
        const std::string half = folder_.Path("half.json");
        ASSERT_EQ(
            RunRcme(Words{"merge", "--partial", "--out", half} + Words(parts.begin(), parts.begin() + 4))
                .exit_code,
            0);
        groupings.push_back(Words(parts.begin() + 3, parts.end()) + Words{half});  // one of them twice
      }
      const std::string merged = folder_.Path("merged");
      for (const Words& grouping : groupings) {
        std::filesystem::remove_all(merged);
        const ProgramResult result = RunRcme(work.command + Words{"--out", merged, "--merge"} + grouping);
        ASSERT_EQ(result.exit_code, 0) << result.err;
        EXPECT_EQ(Bytes(work, merged), whole) << count << " shards";
        EXPECT_EQ(result.out.empty(), one.out.empty());
      }
    }
  }

  const WithoutPython without_figures_;
  TempFolder folder_;
  std::string round_ = folder_.Path("round.json");
  std::string study_ = folder_.Write("study.yaml", TunedYaml("  target: failure\n"
                                                             "  at_most: 0.3\n"
                                                             "  max_refusal: 0.9\n"
                                                             "  explore: 25\n"
                                                             "  calibrate: 47\n"
                                                             "  verify: 33\n"
                                                             "  options: {mu: [1, 2, 3, 6]}\n"));
};

TEST_F(Parts, OfATuning) { ExpectTheBytesOfOneRun({{"tune", study_, "--threads", "1"}, {""}, true}, {1, 7}); }

TEST_F(Parts, OfAnAudit) {
  ExpectTheBytesOfOneRun({{"audit", "--only", "sample_test.power,sample_test.size.joint", "--threads", "1"},
                          {"audit.json", "audit.md"},
                          false,
                          true},
                         {7});
}

TEST_F(Parts, OfATransfer) {
  ExpectTheBytesOfOneRun({{"transfer", study_, "--threads", "1"}, {"transfer.json", "transfer.txt"}}, {7});
}

TEST_F(Parts, OfAMap) {
  ExpectTheBytesOfOneRun(
      {{"map", "--trials", "3", "--threads", "1"}, {"validity_map.csv", "validity_reference.csv"}}, {7});
}

// Without a choice the first round is all there is: the figures are those of one run, and so is the message.
TEST_F(Parts, OfATuningThatCertifiesNothing) {
  const Words command = {"tune",  study_,       "--threads", "1",
                         "--set", "sigma_px=8", "--tune",    "max_refusal=0.1"};
  const std::string whole = folder_.Path("whole"), merged = folder_.Path("merged"), out = folder_.Path("out");
  const ProgramResult one = RunRcme(command + Words{"--out", out, "--figures", whole});
  EXPECT_EQ(one.exit_code, 2) << one.err;
  const Work work{command, {}, true};
  for (int number = 1; number <= 2; ++number)
    EXPECT_EQ(RunRcme(MakeShardCommand(work, number, 2)).exit_code, 75);
  const ProgramResult second = RunRcme(MakeShardCommand(work, 1, 2) + Words{"--merged"} + ListParts(2));
  EXPECT_EQ(second.exit_code, 0) << second.err;
  const ProgramResult merge =
      RunRcme(command + Words{"--out", out, "--figures", merged, "--merge"} + ListParts(2));
  EXPECT_EQ(merge.exit_code, 2);
  EXPECT_EQ(merge.out, one.out);
  EXPECT_EQ(ReadBytes(merged + "/tune.json"), ReadBytes(whole + "/tune.json"));
  EXPECT_NE(merge.err.find("no setting is certified"), std::string::npos) << merge.err;
}

TEST_F(Parts, OfAnotherStudyOptionOrCommandAreRefused) {
  const Words tune = {"tune", study_};
  ASSERT_EQ(RunRcme(tune + Words{"--shard", "1/2", "--out", Part(1)}).exit_code, 75);
  const auto is_refused = [&](const Words& command, const Words& words) {
    const ProgramResult result = RunRcme(command);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    for (const std::string& word : words) EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
  };
  const std::string out = folder_.Path("out");
  const Words merge = {"--out", out, "--merge", Part(1)};
  is_refused(tune + Words{"--seed", "5"} + merge, {Part(1), "'seed: 3' there, 'seed: 5' here"});
  is_refused(tune + Words{"--tune", "at_most=0.4"} + merge, {"at_most: 0.3' there", "at_most: 0.4' here"});
  is_refused(tune + Words{"--set", "mu=4"} + merge, {Part(1), "mu: "});
  is_refused(tune + Words{"--seed", "5", "--shard", "1/2", "--out", Part(1)}, {Part(1), "seed: 3"});
  is_refused(tune + Words{"--shard", "2/2", "--out", Part(1)}, {"another shard", "'1/2' there, '2/2' here"});
  is_refused(Words{"transfer", study_} + merge, {Part(1), "'tuning' there, 'transfer' here"});
  is_refused(Words{"map"} + merge, {Part(1), "'tuning' there, 'map' here"});
  is_refused({"merge", Part(1), "--out", out}, {"--merge", "--partial"});
  is_refused({"merge", Part(1), "--check"}, {"--merge", "--partial"});
  is_refused(tune + Words{"--shard", "1/2", "--figures", out, "--out", Part(2)}, {"--figures"});
  is_refused(tune + Words{"--merged", Part(1), "--out", Part(2)}, {"--merged", "--shard"});
  is_refused(Words{"map", "--shard", "3/2", "--out", Part(2)}, {"there is no shard 3 of 2"});
  EXPECT_FALSE(std::filesystem::exists(out));

  const ProgramResult early = RunRcme(tune + Words{"--shard", "1/2", "--out", Part(1), "--merged", Part(1)});
  EXPECT_EQ(early.exit_code, 75);
  EXPECT_NE(early.err.find("of the shards 2 of 2"), std::string::npos) << early.err;
}

}  // namespace
}  // namespace rcme
