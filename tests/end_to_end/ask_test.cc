// `rcme ask` and `rcme failures` as a user runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/test_support/result_formats.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

using testing::HasSubstr;

class AskProgram : public testing::Test {
 protected:
  ProgramResult Ask(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        "ask",     "--focal",   "500",     "--noise",  "0.5",
        "--wrong", "0.2",       "--scene", "corridor", "--matches",
        "80",      "--threads", "1",       "--out",    folder_.Path("asked")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
  TempFolder folder_;
};

TEST_F(AskProgram, AnswersWithStudyAndResultFile) {
  const ProgramResult result = Ask({"--image", "640x480", "--trials", "12"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const std::string part :
       {"640 x 480 px, f 500 px, noise 0.5 px; corridor; 20 % wrong (uniform) of 80\nmatches", "Estimator",
        "Next best", "Taken as exact", "Accept if", "Inlier threshold", "Covariance", "Time", "Trials",
        "Success: an error of", "rcme report ", "rcme solve "})
    EXPECT_THAT(result.out, HasSubstr(part));
  EXPECT_TRUE(std::filesystem::exists(folder_.Path("asked/study.yaml")));
  const ProgramResult again = RunRcme({"run", folder_.Path("asked/study.yaml"), "--trials", "12", "--threads",
                                       "1", "--out", folder_.Path("asked/run.sqlite")});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("12 were there already")) << "it is the study that was run";
  const auto json =
      nlohmann::json::parse(Ask({"--image", "640x480", "--trials", "12", "--format", "json"}).out);
  EXPECT_EQ(json["format"], "rcme answer 1");
  EXPECT_EQ(json["trials"], 12);
  ExpectSameRows(Ask({"--image", "640x480", "--trials", "12", "--format", "csv"}).out, json["rows"]);
}

// Two words for the size and percent for a share are the same question, whose trials are there.
TEST_F(AskProgram, TheSameQuestionInOtherWordsGoesOn) {
  ASSERT_EQ(Ask({"--image", "640x480", "--trials", "21"}).exit_code, 0);
  const std::string study = ReadBytes(folder_.Path("asked/study.yaml"));
  const ProgramResult same =
      RunRcme({"ask", "--image", "640", "480", "--focal", "500", "--noise", ".5", "--wrong", "20%", "--scene",
               "corridor", "--matches", "80", "--at-most", "5%", "--out", folder_.Path("asked")});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_THAT(same.err, HasSubstr("21 of 21 trials are there already"));
  EXPECT_EQ(ReadBytes(folder_.Path("asked/study.yaml")), study);
  EXPECT_THAT(same.err, HasSubstr("The answer is of the 21 trials that " + folder_.Path("asked/run.sqlite") +
                                  " holds; --trials N takes more"));
  const ProgramResult fewer = Ask({"--image", "640x480", "--trials", "10"});
  EXPECT_THAT(fewer.err, HasSubstr("The answer is of all 21 trials that "));
  EXPECT_EQ(Ask({"--image", "640x480", "--trials", "21"}).exit_code, 0);
  const ProgramResult other = Ask({"--image", "640x481", "--trials", "21"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("holds the results of another study"));
  EXPECT_EQ(ReadBytes(folder_.Path("asked/study.yaml")), study) << "it is still that of run.sqlite";
}

// Two questions without --out go side by side; the first, asked again, goes on.
TEST_F(AskProgram, EachQuestionHasAFolderOfItsOwn) {
  const auto ask = [&](const std::string& more) {
    return RunShell("cd '" + folder_.Path("") +
                    "' && \"$RCME\" ask --image 640x480 --focal 500 --noise 0.5 --wrong " +
                    "0.2 --scene corridor --matches 80 --threads 1 --trials 3 " + more);
  };
  const auto count_folders = [&] {
    return std::ranges::count_if(
        std::filesystem::directory_iterator(folder_.Path("")), [](const auto& entry) {
          return entry.path().filename().string().starts_with("answer_corridor_f500_wrong20_") &&
                 std::filesystem::exists(entry.path() / "run.sqlite");
        });
  };
  EXPECT_EQ(ask("").exit_code, 0);
  EXPECT_EQ(ask("--focal-error 2%").exit_code, 0);
  EXPECT_EQ(count_folders(), 2);
  const ProgramResult again = ask("");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, HasSubstr("3 of 3 trials are there already"));
  EXPECT_EQ(count_folders(), 2);
}

TEST_F(AskProgram, AFocalErrorIsThatOfTheStudy) {
  const ProgramResult result = Ask({"--image", "640x480", "--trials", "3", "--focal-error", "0.02"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("(assumed 2 % too great)"));
  EXPECT_THAT(ReadBytes(folder_.Path("asked/study.yaml")), HasSubstr("  focal_error: 0.02\n"));
  const std::string study = folder_.Path("asked/study.yaml"), out = folder_.Path("other.sqlite");
  for (const std::string value : {"-0.91", "9.1"}) {
    EXPECT_EQ(Ask({"--image", "640x480", "--focal-error", value}).exit_code, 2) << value;
    EXPECT_THAT(RunRcme({"run", study, "--set", "focal_error=" + value, "--out", out}).err,
                HasSubstr("[-0.9, 9]"))
        << "the range of the option is that of the key";
  }
  EXPECT_THAT(Ask({"--image", "640x480", "--focal-error", "9.1"}).err, HasSubstr("[-0.9, 9]"));
}

TEST_F(AskProgram, WithoutATerminalItNamesWhatIsMissing) {
  const ProgramResult result = Ask({});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("--image: missing"));
  EXPECT_FALSE(std::filesystem::exists(folder_.Path("asked")));
}

TEST_F(AskProgram, RefusesWhatIsNoCamera) {
  const ProgramResult result = Ask({"--image", "640"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("give WIDTHxHEIGHT"));
  EXPECT_THAT(Ask({"--image", "640x480", "--at-most", "500%"}).err,
              HasSubstr("--at-most: '500%' is not allowed; give a number in [1e-06, 0.5]"));
  EXPECT_THAT(Ask({"--image", "640x480", "--outliers", "repeated_texture"}).err,
              HasSubstr("with --scene corridor, in which nothing is repeated; give --scene lattice"));
  EXPECT_THAT(RunRcme({"ask", "--image", "640x480", "--focal", "4.2", "--noise", "0.5", "--wrong", "0.2",
                       "--scene", "corridor", "--out", folder_.Path("asked")})
                  .err,
              HasSubstr("give the focal length in px"));
  EXPECT_FALSE(std::filesystem::exists(folder_.Path("asked")));
}

// As all other messages do.
TEST(WrongOptions, ArePrecededByTheProgram) {
  EXPECT_THAT(RunRcme({"failures"}).err, testing::StartsWith("rcme: run is required"));
  EXPECT_THAT(RunRcme({"ask", "--trials", "no"}).err, testing::StartsWith("rcme: --trials: "));
  EXPECT_THAT(RunRcme({"ask", "--nonsense"}).err,
              testing::StartsWith("rcme: the following arguments were not expected: --nonsense"));
}

// Every failure that the list has is a failure of the replay, and the program of one of them is written.
TEST(Failures, AreThoseOfReplay) {
  TempFolder folder;
  const std::string study = folder.Write("small.yaml", SmallStudyYaml()), run = folder.Path("run.sqlite");
  ASSERT_EQ(RunRcme({"run", study, "--set", "sigma_px=8", "--threads", "1", "--out", run}).exit_code, 0);
  const auto json = nlohmann::json::parse(RunRcme({"failures", run, "--format", "json", "--limit", "2"}).out);
  ASSERT_EQ(json["rows"].size(), 2u);
  for (const auto& row : json["rows"]) {
    const std::string label = row["estimator"], cpp = folder.Path("trial.cc");
    const ProgramResult replay =
        RunRcme({"replay", run, "--condition", std::to_string(row["condition"].get<int>()), "--trial",
                 std::to_string(row["trial"].get<int>()), "--emit-cpp", cpp, "--estimator", label});
    EXPECT_EQ(replay.exit_code, 0) << replay.err;
    EXPECT_THAT(replay.out, HasSubstr("\n" + label + ": "));
    EXPECT_THAT(replay.out, HasSubstr("(failure)"));
    EXPECT_THAT(ReadBytes(cpp), HasSubstr("rcme::MakeEstimator("));
  }
  const ProgramResult beyond = RunRcme({"replay", run, "--condition", "0", "--trial", "9999"});
  EXPECT_EQ(beyond.exit_code, 0);
  EXPECT_THAT(beyond.err, HasSubstr("no trial 9999 of condition 0 is in the file"));
}

}  // namespace
}  // namespace rcme
