// `rcme audit` as a user runs it.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <thread>

#include "tests/test_support/run_program.h"
#include "tests/test_support/temp_folder.h"
#include "tests/test_support/without_python.h"

namespace rcme {
namespace {

using testing::HasSubstr;

std::string Contents(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

// Before hours of work a user reads how to have fewer.
TEST(Audit, ALongOneSaysWhatBoundsIt) {
  const TempFolder folder;
  const ProgramResult result = RunRcme({"audit", SourceFolder() + "/studies/failure_vs_outliers.yaml",
                                        "--threads", "1", "--max-time", "1s", "--out", folder.Path("audit")});
  EXPECT_EQ(result.exit_code, 75) << result.err;
  EXPECT_THAT(result.err, HasSubstr("To bound it: --max-time 30m"));
  EXPECT_THAT(result.err, HasSubstr("--set FACTOR=LEVEL"));
}

TEST(Audit, PrintsTheTableAndWritesPageDataAndFigures) {
  const TempFolder folder;
  const std::string out = folder.Path("a/b");  // made, with its parents
  const ProgramResult result =
      RunRcme({"audit", "--only", "sampson.dof_1,sampson.dof_3,sampson.full_rank", "--out", out});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("sampson.dof_1 "));
  EXPECT_THAT(result.err, HasSubstr("at most"));
  const auto json = nlohmann::json::parse(Contents(out + "/audit.json"));
  ASSERT_EQ(json["claims"].size(), 3);
  for (const auto& claim : json["claims"]) {
    EXPECT_EQ(claim["verdict"], claim["id"] == "sampson.dof_1" ? "holds" : "does not hold") << claim["id"];
  }
  EXPECT_THAT(Contents(out + "/audit.md"), HasSubstr("![sampson](audit_sampson.png)"));
  EXPECT_GT(std::filesystem::file_size(out + "/audit_sampson.png"), 10'000);
  EXPECT_THAT(Contents(out + "/audit.html"), HasSubstr("<h2>Findings</h2>"));
}

TEST(Audit, GivesTheSameBytesForAnyNumberOfThreads) {
  const WithoutPython without_figures;
  const TempFolder folder;
  std::string first;
  for (const char* threads : {"1", "2"}) {
    const std::string out = folder.Path(threads);
    RunRcme({"audit", "--only", "sigma_p.rank,mu.rank_aware.separation", "--threads", threads, "--out", out});
    const std::string json = Contents(out + "/audit.json");
    ASSERT_FALSE(json.empty());
    if (first.empty()) first = json;
    EXPECT_EQ(json, first);
  }
}

std::string PartPath(const TempFolder& folder, int number, int count) {
  return folder.Path(fmt::format("{}_of_{}.json", number, count));
}

// A round of a shard of these options; the first, or that of a file.
void RunAuditShard(const TempFolder& folder, const std::vector<std::string>& options, int number, int count,
                   const std::string& round = "") {
  std::vector<std::string> command = {"audit"};
  command.insert(command.end(), options.begin(), options.end());
  command.insert(command.end(),
                 {"--shard", fmt::format("{}/{}", number, count), "--out", PartPath(folder, number, count)});
  if (!round.empty()) command.insert(command.end(), {"--round", round});
  const ProgramResult result = RunRcme(command);
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

ProgramResult MergeAudit(const std::vector<std::string>& options, const std::vector<std::string>& parts,
                         const std::string& out, const std::string& round = "") {
  std::vector<std::string> command = {"audit"};
  command.insert(command.end(), options.begin(), options.end());
  command.emplace_back("--merge");
  command.insert(command.end(), parts.begin(), parts.end());
  command.insert(command.end(), {"--out", out});
  if (!round.empty()) command.insert(command.end(), {"--round", round});
  return RunRcme(command);
}

TEST(Audit, InShardsGivesTheSameBytes) {
  const WithoutPython without_figures;
  const TempFolder folder;
  std::ofstream(folder.Path("study.yaml"))
      << "name: mine\ndata: {scene: uniform_volume, num_matches: 20, sigma_px: 0.1}\n"
         "factors: {outlier_ratio: [0, 0.3, 0.95]}\nestimators: [{name: standard}]\n";
  struct Divided {
    std::vector<std::string> options;
    std::vector<int> counts;
  };
  // More shards than there are claims; on a study a number that divides no batch.
  const std::vector<Divided> audits = {{{"--only", "sampson.full_rank,mu.rank_aware.separation"}, {3}},
                                       {{folder.Path("study.yaml"), "--only",
                                         "inlier.true_pose.rank_aware,sigma_f.eight_point", "--seed", "3"},
                                        {3}}};
  for (const auto& [options, counts] : audits) {
    std::vector<std::string> command = {"audit", "--out", folder.Path("whole")};
    command.insert(command.begin() + 1, options.begin(), options.end());
    const ProgramResult whole = RunRcme(command);
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
    for (const int count : counts) {
      const std::string round = folder.Path("round.json");
      std::vector<std::string> parts;
      for (int number = count; number >= 1; --number) {
        RunAuditShard(folder, options, number, count);
        parts.push_back(PartPath(folder, number, count));
      }
      ProgramResult merged;
      for (int k = 0; k < 15; ++k) {
        merged = MergeAudit(options, parts, folder.Path("merged"), round);
        if (merged.exit_code != 75) break;
        for (int number = 1; number <= count; ++number) RunAuditShard(folder, options, number, count, round);
      }
      EXPECT_EQ(merged.exit_code, 0) << merged.err;
      EXPECT_EQ(merged.out, whole.out);
      for (const char* file : {"/audit.json", "/audit.md"}) {
        EXPECT_EQ(Contents(folder.Path("merged") + file), Contents(folder.Path("whole") + file)) << count;
      }
      for (const std::string& part : parts) std::filesystem::remove(part);
    }
  }
}

TEST(Audit, ThatLacksShardsNamesThemAndWritesNothing) {
  const TempFolder folder;
  const std::vector<std::string> options = {"--only", "sampson"};
  RunAuditShard(folder, options, 2, 3);
  const std::vector<std::string> parts = {PartPath(folder, 2, 3)};
  const ProgramResult lacking = MergeAudit(options, parts, folder.Path("out"));
  EXPECT_EQ(lacking.exit_code, 75);
  EXPECT_EQ(lacking.out, "1,3\n");
  EXPECT_THAT(lacking.err, HasSubstr("of the shards 1,3 of 3; no result was written"));
  const ProgramResult seed = MergeAudit({"--only", "sampson", "--seed", "2"}, parts, folder.Path("out"));
  EXPECT_EQ(seed.exit_code, 2);
  EXPECT_THAT(seed.err, HasSubstr("'seed: 1' there, 'seed: 2' here"));
  EXPECT_FALSE(std::filesystem::exists(folder.Path("out")));
}

// SIGTERM in the midst of it keeps what is done; SIGKILL leaves a part as it was, or none.
TEST(Audit, AShardThatIsStoppedOrKilledGoesOn) {
  const TempFolder folder;
  const std::vector<std::string> options = {"--only", "sigma_p,inlier", "--threads", "1"};
  const std::string path = PartPath(folder, 1, 2);
  const auto without_times = [&] {
    // And without the checksums, which are of the times too.
    const std::regex times("\"(seconds\": [0-9.]+|checksum\": \"[0-9a-f]{8}\")");
    return std::regex_replace(Contents(path), times, "");
  };
  RunAuditShard(folder, options, 1, 2);
  const std::string whole = without_times();
  std::filesystem::remove(path);
  std::vector<std::string> command = {"audit", "--shard", "1/2", "--out", path};
  command.insert(command.end(), options.begin(), options.end());
  for (const int signal : {SIGTERM, SIGKILL, SIGTERM}) {
    RunningProgram program(RcmeCommand(command));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    program.Send(signal);
    program.Wait();
  }
  std::vector<std::string> limited = command;
  limited.insert(limited.end(), {"--max-time", "0.2s"});
  const int limited_code = RunRcme(limited).exit_code;
  EXPECT_TRUE(limited_code == 75 || limited_code == 0) << limited_code;  // the machine may be fast
  RunAuditShard(folder, options, 1, 2);
  EXPECT_TRUE(without_times() == whole);
}

TEST(Audit, OnAStudySpeaksOfItsConditions) {
  const TempFolder folder;
  std::ofstream(folder.Path("study.yaml"))
      << "name: mine\ndata: {scene: uniform_volume, num_matches: 20, sigma_px: 0.1}\n"
         "factors: {outlier_ratio: [0, 0.95]}\nestimators: [{name: standard}]\n";
  const std::string out = folder.Path("out");
  const ProgramResult result =
      RunRcme({"audit", folder.Path("study.yaml"), "--only", "inlier.true_pose.rank_aware,sigma_f", "--set",
               "sigma_px=0.05", "--out", out});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("outlier_ratio = 0.95"));
  EXPECT_THAT(result.out, HasSubstr("fewer than 8 true matches"));
  const auto json = nlohmann::json::parse(Contents(out + "/audit.json"));
  EXPECT_EQ(json["study"], "mine");
  EXPECT_EQ(json["default_conditions"]["sigma_px"], "0.05");
  ASSERT_EQ(json["claims"].size(), 4);
  EXPECT_EQ(json["claims"][0]["evidence"][1]["not_possible"], "fewer than 8 true matches");
  EXPECT_EQ(json["claims"][3]["id"], "inlier.true_pose.rank_aware");
  EXPECT_NE(json["claims"][3]["verdict"], "does not hold");
  EXPECT_THAT(Contents(out + "/audit.md"), HasSubstr("# Claim audit on study mine"));
  EXPECT_GT(std::filesystem::file_size(out + "/audit_inlier.png"), 10'000);
}

TEST(Audit, OfRealPairsOrWithStudyOptionsAloneIsRefused) {
  const TempFolder folder;  // without pairs: refused before they are looked for
  std::ofstream(folder.Path("study.yaml"))
      << "name: real\ndata: {scene: match_files, folder: " << folder.Path("pairs")
      << "}\nestimators: [{name: standard}]\n";
  for (const char* command : {"audit", "map"}) {
    const ProgramResult real = RunRcme({command, folder.Path("study.yaml"), "--out", folder.Path("x")});
    EXPECT_EQ(real.exit_code, 2) << command;
    EXPECT_THAT(real.err, HasSubstr("study.yaml: scene: match_files cannot be")) << command;
    const ProgramResult set = RunRcme({command, "--set", "sigma_px=1", "--out", folder.Path("x")});
    EXPECT_EQ(set.exit_code, 2) << command;
    EXPECT_THAT(set.err, HasSubstr("--set")) << command;
  }
  EXPECT_FALSE(std::filesystem::exists(folder.Path("x")));
}

TEST(Audit, WrongArgumentsAreNamed) {
  const TempFolder folder;
  const ProgramResult unknown = RunRcme({"audit", "--only", "sigma_q", "--out", folder.Path("x")});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("'sigma_q' is not allowed"));
  EXPECT_FALSE(std::filesystem::exists(folder.Path("x")));

  std::ofstream(folder.Path("file")) << "not a folder";
  const ProgramResult file = RunRcme({"audit", "--only", "sigma_p.rank", "--out", folder.Path("file")});
  EXPECT_EQ(file.exit_code, 2);
  EXPECT_THAT(file.err, HasSubstr("cannot be made a folder"));

  const ProgramResult round = RunRcme({"audit", "--round", folder.Path("r"), "--out", folder.Path("x")});
  EXPECT_EQ(round.exit_code, 2);
  EXPECT_THAT(round.err, HasSubstr("--round needs --shard or --merge"));
  EXPECT_EQ(RunRcme({"audit", "--budget", "huge", "--out", folder.Path("x")}).exit_code, 2);
  EXPECT_EQ(RunRcme({"audit"}).exit_code, 2);
}

}  // namespace
}  // namespace rcme
