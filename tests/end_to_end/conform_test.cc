// rcme conform: the file it writes, what takes it, the same bytes for threads and shards, and its exit codes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "estimator/conform/conform_file.h"
#include "tests/end_to_end/bad_input.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/result_formats.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using testing::Not;

class Conform : public BadInput {
 protected:
  ProgramResult RunConform(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"conform", study_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
  // Of 200 answers of `standard`.
  std::string Make() {
    const ProgramResult made = RunConform({"--estimator", "standard", "--trials", "100", "--out", file_});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return made.out;
  }

  std::string file_ = folder_.Path("mine.conform.json");
};

TEST_F(Conform, WritesAFileAndSaysWhatItPromises) {
  const std::string text = Make();
  EXPECT_THAT(text, HasSubstr("conformed"));
  EXPECT_THAT(text, HasSubstr("contains the truth with probability at least 95 %"));
  EXPECT_THAT(ReadBytes(file_), HasSubstr("\"format\": \"rcme conform 3\""));
  EXPECT_EQ(folder_.NumEntries(), 2);  // the study and the file: no checkpoint is left
  ExpectFormatsAgree({"conform", study_, "--estimator", "standard", "--trials", "100", "--out", file_}, 0,
                     "regions");
}

// A tenth of the problems is refused. The first problem of a draw is refused as often as any: in
// a binomial number of 40 draws (above 20 in 1e-6), where the first refused one would be in all.
TEST_F(Conform, TheFirstProblemOfADrawIsRefusedAsOftenAsAny) {
  folder_.Write("small.yaml",
                "name: draws\ntrials: 50\nconditions: {number: 40, ranges: {outlier_ratio: [0.1, 0.5], "
                "sigma_px: [0.3, 1.5]}}\ndata: {scene: uniform_volume, num_matches: 60}\n"
                "estimators: [{name: standard}]\n");
  EXPECT_EQ(RunConform({"--estimator", "standard", "--out", file_}).exit_code, 0);
  const ConformRule rule = ReadConformFile(file_).rule;
  const double refused = static_cast<double>(rule.origin.num_refusals) / (40.0 * 50.0);
  EXPECT_GT(refused, 0.05);
  EXPECT_LT(refused, 0.2);
  EXPECT_EQ(rule.origin.num_groups, 40);
  EXPECT_LE(rule.origin.num_refused_groups, 20);
}

TEST_F(Conform, GivesTheSameBytesForThreadsAndShards) {
  Make();
  const std::string bytes = ReadBytes(file_), other = folder_.Path("other.json");
  const std::vector<std::string> same = {"--estimator", "standard", "--trials", "100"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), same.begin(), same.end());
    return RunConform(more);
  };
  EXPECT_EQ(with({"--threads", "1", "--out", other}).exit_code, 0);
  EXPECT_EQ(ReadBytes(other), bytes);
  const std::string first = folder_.Path("1.part"), second = folder_.Path("2.part");
  EXPECT_EQ(with({"--shard", "1/2", "--out", first}).exit_code, 0);
  EXPECT_EQ(with({"--merge", first, "--out", other}).exit_code, 75);
  EXPECT_EQ(with({"--shard", "2/2", "--out", second}).exit_code, 0);
  const ProgramResult merged = with({"--out", other, "--merge", first, second});
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(ReadBytes(other), bytes);
}

TEST_F(Conform, NoticesAShiftAndNothingElse) {
  Make();
  const ProgramResult same = RunConform({"--check", file_, "--trials", "50", "--seed", "77"});
  EXPECT_EQ(same.exit_code, 0) << same.out << same.err;
  EXPECT_THAT(same.out, HasSubstr("No shift is seen"));
  const ProgramResult noisy = RunConform(
      {"--check", file_, "--trials", "50", "--seed", "77", "--set", "sigma_px=1.5", "--format", "json"});
  EXPECT_EQ(noisy.exit_code, 1) << noisy.out << noisy.err;
  EXPECT_THAT(noisy.out, HasSubstr("\"format\": \"rcme conform report 1\""));
  EXPECT_THAT(noisy.out, Not(HasSubstr("\"noticed_after\": null")));
}

// What nothing visible shows, the truth does: the first line says so.
TEST_F(Conform, SaysThatAPromiseIsBroken) {
  study_ = folder_.Write("clean.yaml",
                         "name: clean\nseed: 5\ntrials: 40\ndata: {scene: uniform_volume, num_matches: 60}\n"
                         "estimators: [{name: standard}]\n");
  Make();
  const std::vector<std::string> check = {"--check", file_, "--trials", "50", "--seed", "77"};
  const ProgramResult same = RunConform(check);
  EXPECT_EQ(same.out.rfind("No promise is refuted", 0), 0U) << same.out;
  std::vector<std::string> arguments = check;
  arguments.insert(arguments.end(), {"--set", "focal_error=0.05"});
  const ProgramResult broken = RunConform(arguments);
  EXPECT_EQ(broken.exit_code, 1) << broken.out << broken.err;
  EXPECT_EQ(broken.out.rfind("The promise of the regions does not hold on these problems: coverage ", 0), 0U)
      << broken.out;
  arguments.insert(arguments.end(), {"--format", "json"});
  EXPECT_THAT(RunConform(arguments).out, HasSubstr("\"coverage_p_value\""));
}

TEST_F(Conform, SaysWhereAFileIsCutOff) {
  Make();
  const std::string cut = folder_.Write("cut.json", ReadBytes(file_).substr(0, 1000));
  EXPECT_TRUE(IsRefused(RunConform({"--check", cut, "--seed", "9"}), {"cut off at byte 1000"}));
}

// A study, rcme estimate and an estimator file take it.
TEST_F(Conform, TheFileIsAnEstimator) {
  Make();
  const std::string study =
      folder_.Write("with.yaml",
                    "name: with\nseed: 9\ntrials: 20\ndata: {scene: uniform_volume, num_matches: 60}\n"
                    "estimators:\n  - {conform: mine.conform.json, label: kept}\n  - {name: standard}\n");
  const std::string run = folder_.Path("with.sqlite");
  const ProgramResult ran = RunRcme({"run", study, "--out", run});
  EXPECT_EQ(ran.exit_code, 0) << ran.err;
  const ProgramResult reliability = RunRcme({"reliability", run});
  EXPECT_THAT(reliability.out, HasSubstr("kept"));
  const std::string matches = folder_.Write("m.csv", MatchHeader() + MatchRows(60));
  const ProgramResult estimate = RunRcme({"estimate", matches, "--conform", file_, "--format=json"});
  EXPECT_THAT(estimate.out, HasSubstr("\"format\": \"rcme estimate 2\"")) << estimate.err;
  folder_.Write("mine.conform.json", ReadBytes(file_) + " ");
  EXPECT_TRUE(IsRefused(RunRcme({"replay", run, "--condition", "0", "--trial", "0"}), {"has changed since"}));
}

TEST_F(Conform, RefusesWhatMakesNoSense) {
  Make();
  EXPECT_TRUE(IsRefused(RunRcme({"conform"}), {"a study is missing"}));
  EXPECT_TRUE(IsRefused(RunConform({"--estimator", "standard"}), {"--out is missing"}));
  EXPECT_TRUE(IsRefused(RunConform({"--out", file_}), {"choose one with --estimator"}));
  EXPECT_TRUE(IsRefused(RunConform({"--estimator", "nobody", "--out", file_}), {"nobody"}));
  EXPECT_TRUE(
      IsRefused(RunConform({"--check", file_, "--estimator", "standard"}), {"leave --estimator out"}));
  EXPECT_TRUE(IsRefused(RunConform({"--check", study_}), {"is no JSON"}));
  EXPECT_TRUE(IsRefused(RunConform({"--check", file_}), {"these very problems in 2 of 2 conditions"}));
  EXPECT_TRUE(IsRefused(RunConform({"--check", file_, "--seed", "9", "--out", file_}), {"would replace"}));
  EXPECT_TRUE(IsRefused(RunConform({"--estimator", "ours", "--seed", "9", "--models", file_, "--out", out_}),
                        {"is of estimator standard"}));
  EXPECT_TRUE(
      IsRefused(RunConform({"--level", "1", "--estimator", "standard", "--out", file_}), {"--level"}));
  EXPECT_TRUE(IsRefused(
      RunRcme({"estimate", folder_.Write("m.csv", MatchHeader() + MatchRows(60)), "--conform", study_}),
      {"is no JSON"}));
}

// A part of the old problems is not new.
TEST_F(Conform, RefusesAnyProblemOfTheCalibration) {
  Make();
  EXPECT_TRUE(IsRefused(RunConform({"--check", file_, "--set", "outlier_ratio=0.3"}),
                        {"these very problems in 1 of 1 conditions", "another --seed"}));
  EXPECT_EQ(RunConform({"--check", file_, "--set", "outlier_ratio=0.2", "--trials", "10"}).exit_code, 0);
}

// Another seed does not make other problems of real pairs, nor does another folder.
TEST_F(Conform, RefusesAnyPairOfTheCalibration) {
  const std::string pairs = folder_.Path("pairs");
  std::filesystem::create_directory(pairs);
  for (std::uint64_t k = 1; k <= 40; ++k)
    folder_.Write(fmt::format("pairs/{}.csv", k), MatchHeader() + TruePoseHeader() + MatchRows(40, k));
  const auto study_of = [&](const std::string& name, const std::string& folder) {
    return folder_.Write(name, "name: pairs\ndata: {scene: match_files, folder: '" + folder +
                                   "', sigma_px: 0.5}\nestimators: [{name: standard}]\n");
  };
  study_ = study_of("pairs.yaml", pairs);
  ASSERT_EQ(RunConform({"--out", file_}).exit_code, 0);
  std::filesystem::create_directory(folder_.Path("one"));
  std::filesystem::copy_file(pairs + "/7.csv", folder_.Path("one/renamed.csv"));
  study_ = study_of("one.yaml", folder_.Path("one"));
  EXPECT_TRUE(IsRefused(RunConform({"--check", file_, "--seed", "9"}),
                        {"these very problems in 1 of 1 pairs", "give other pairs"}));
}

// A draw that cannot be simulated is no answer.
TEST_F(Conform, SaysWhereAPopulationHasNoAnswers) {
  study_ = folder_.Write("p.yaml",
                         "name: p\nseed: 1\ntrials: 4\n"
                         "data: {scene: street, motion: vehicle, cameras: kitti, num_matches: 20}\n"
                         "conditions: {design: random, number: 1, ranges: {parallax_deg: [50, 60]}}\n"
                         "estimators: [{name: standard, options: {num_iterations: 20}}]\n");
  EXPECT_TRUE(IsRefused(RunConform({"--out", file_}), {"no answer has a truth to compare with"}));
}

// A file of somebody else may name a command.
TEST_F(Conform, RunsNoCommandThatNobodyAllowed) {
  Make();
  const std::string marker = folder_.Path("it_ran");
  ConformRule rule = ReadConformFile(file_).rule;
  rule.estimator = "process";
  rule.options = {{"command", "touch " + marker}};
  const std::string theirs = folder_.Write("theirs.json", ConformFileText(rule, {}));
  const std::string matches = folder_.Write("m.csv", MatchHeader() + MatchRows(60));
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"estimate", matches, "--conform", theirs},
        std::vector<std::string>{"estimate", matches, "--estimator", "conform", "--set", "file=" + theirs},
        std::vector<std::string>{"conform", study_, "--check", theirs},
        std::vector<std::string>{"run",
                                 folder_.Write("s.yaml",
                                               "name: s\ntrials: 2\ndata: {scene: uniform_volume}\n"
                                               "estimators:\n  - {conform: theirs.json}\n"),
                                 "--out", out_},
        // As a level of a factor, and as one that is tuned.
        std::vector<std::string>{"run",
                                 folder_.Write("f.yaml",
                                               "name: f\ntrials: 2\ndata: {scene: uniform_volume}\n"
                                               "factors: {conform.file: [theirs.json, none]}\n"
                                               "estimators:\n  - {name: conform}\n"),
                                 "--out", out_},
        std::vector<std::string>{
            "tune",
            folder_.Write("t.yaml",
                          "name: t\ntrials: 2\ndata: {scene: uniform_volume}\n"
                          "estimators:\n  - {name: conform}\n"
                          "tune: {estimator: conform, target: failure, at_most: .5, options: "
                          "{file: [theirs.json, none]}}\n"),
            "--out", folder_.Path("tuned.yaml")}}) {
    const ProgramResult result = RunRcme(arguments);
    EXPECT_TRUE(IsRefused(result, {"touch", "--allow-process"}) || IsRefused(result, {"may bring one"}))
        << arguments[0] << result.err;
    EXPECT_FALSE(std::filesystem::exists(marker)) << arguments[0];
  }
}

}  // namespace
}  // namespace rcme
