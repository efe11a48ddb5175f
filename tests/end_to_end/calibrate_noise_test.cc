// From the pairs of a camera to its noise file, and from that to estimates, validations and studies.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "tests/end_to_end/bad_input.h"
#include "tests/test_support/match_text.h"

namespace rcme {
namespace {

class CalibrateNoiseProgram : public testing::Test {
 protected:
  CalibrateNoiseProgram() {
    RunRcme({"export", folder_.Write("study.yaml", SmallStudyYaml()), "--set", "outlier_ratio=0", "--set",
             "num_matches=200", "--out", folder_.Path("problems")});
  }

  ProgramResult Call(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"calibrate-noise", pairs_, "--out", file_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }

  TempFolder folder_;
  std::string pairs_ = folder_.Path("problems/matches"), file_ = folder_.Path("noise.yaml");
};

TEST_F(CalibrateNoiseProgram, WritesAFileThatOthersTake) {
  const ProgramResult table = Call({});
  ASSERT_EQ(table.exit_code, 0) << table.err;
  for (const char* part : {"noise sigma", "displacement field", "camera faults, all together", "of 6 pairs"})
    EXPECT_NE(table.out.find(part), std::string::npos) << part << " is not in\n" << table.out;
  const std::string written = ReadBytes(file_);
  EXPECT_NE(written.find("rcme_camera_noise: 1"), std::string::npos);
  EXPECT_NE(Call({"--format", "json"}).out.find("rcme noise calibration 1"), std::string::npos);
  EXPECT_NE(Call({"--format", "csv"}).out.find("\nsigma_px,0."), std::string::npos);
  EXPECT_EQ(ReadBytes(file_), written);

  const ProgramResult plain = RunRcme({"estimate", pairs_}),
                      estimate = RunRcme({"estimate", pairs_, "--noise", file_});
  ASSERT_EQ(estimate.exit_code, 0) << estimate.err;
  EXPECT_EQ(std::ranges::count(estimate.out, '\n'), std::ranges::count(plain.out, '\n'));
  const ProgramResult validation =
      RunRcme({"validate", pairs_, "--noise", file_, "--twins", "1", "--no-advice"});
  ASSERT_EQ(validation.exit_code, 0) << validation.err;
  EXPECT_NE(validation.out.find("spatial_halves"), std::string::npos);
  const std::string study = folder_.Write(
      "drawn.yaml",
      "data: {scene: uniform_volume, num_matches: 60, noise: from_file, noise_file: noise.yaml}\n"
      "estimators: [{name: standard, options: {num_iterations: 20}}]\ntrials: 2\n");
  const ProgramResult run = RunRcme({"run", study, "--out", folder_.Path("run.sqlite")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

// The table says as much of a fault as the file keeps for the covariances.
TEST_F(CalibrateNoiseProgram, SaysWhatIsLeftOfAFault) {
  const ProgramResult table = Call({});
  ASSERT_EQ(table.exit_code, 0) << table.err;
  const std::string written = ReadBytes(file_);
  std::smatch fault;
  ASSERT_TRUE(std::regex_search(written, fault, std::regex("focal_length: \\{.*uncertainty: ([^}]+)\\}")))
      << written;
  const std::string remaining_uncertainty = fmt::format("+-{:.2g} % is left", 100.0 * std::stod(fault[1]));
  EXPECT_NE(table.out.find(remaining_uncertainty), std::string::npos)
      << remaining_uncertainty << " is not in\n"
      << table.out;
}

TEST_F(CalibrateNoiseProgram, RefusesWhatItCannotUse) {
  const std::string other = folder_.Write("other.yaml", "a: 1\n");
  for (const char* command : {"estimate", "validate"}) {
    EXPECT_TRUE(IsRefused(RunRcme({command, pairs_, "--noise", other}), {"other.yaml", "no noise file"}));
    EXPECT_TRUE(IsRefused(RunRcme({command, pairs_, "--noise", folder_.Path("none.yaml")}), {"none.yaml"}));
  }
  TempFolder few;
  for (const char* name : {"a.csv", "b.csv"}) few.Write(name, MatchHeader() + MatchRows(60));
  EXPECT_TRUE(
      IsRefused(RunRcme({"calibrate-noise", few.path(), "--out", file_}), {"2 of 2 pairs", "takes 5"}));
  EXPECT_TRUE(IsRefused(Call({"--scene", "none"}), {"--scene", "none"}));
  EXPECT_TRUE(IsRefused(Call({"--sigma", "nan"}), {"--sigma"}));
  EXPECT_FALSE(std::filesystem::exists(file_));
  const std::string own =
      pairs_ + "/" + std::filesystem::directory_iterator(pairs_)->path().filename().string();
  const std::string before = ReadBytes(own);
  EXPECT_TRUE(
      IsRefused(RunRcme({"calibrate-noise", pairs_, "--out", own}), {"--out", "is the input itself"}));
  EXPECT_EQ(ReadBytes(own), before);
}

}  // namespace
}  // namespace rcme
