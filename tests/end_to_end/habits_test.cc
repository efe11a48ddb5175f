// What a person at a terminal is used to: names from any folder, help, suggestions, completion, manual pages.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/end_to_end/bad_input.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/paths.h"
#include "tests/test_support/run_program.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using testing::Not;

class Habits : public BadInput {
 protected:
  // In the test's own folder, where there is nothing but what a test has put there.
  ProgramResult RunHere(const std::string& line) {
    return RunShell("cd '" + folder_.path() + "' && " + line);
  }
};

TEST_F(Habits, StudiesHaveNamesInEveryFolder) {
  const ProgramResult list = RunHere("\"$RCME\" list studies");
  EXPECT_EQ(list.exit_code, 0) << list.err;
  EXPECT_THAT(list.out, HasSubstr("\nfailure_vs_outliers  "));
  const std::string run = "\"$RCME\" run no_outliers_low_noise --trials 1 --threads 1 --out ";
  EXPECT_EQ(RunHere(run + "by_name.sqlite").exit_code, 0);
  EXPECT_EQ(RunHere("\"$RCME\" run '" + SourceFolder() +
                    "/studies/no_outliers_low_noise.yaml' --trials 1 --threads 1 --out by_name.sqlite")
                .exit_code,
            0)
      << "the same study by its path";
  EXPECT_EQ(RunHere(run + "other.sqlite --set sigma_px=0.2").exit_code, 0);
  EXPECT_TRUE(IsRefused(RunHere("\"$RCME\" run no_outlier_low_noise --out x.sqlite"),
                        {"no_outlier_low_noise: no such study file (did you mean 'no_outliers_low_noise'?)",
                         "rcme list studies"}));
  EXPECT_TRUE(
      IsRefused(RunHere("\"$RCME\" run quite_another --out x.sqlite"), {"quite_another: no such study"}));
}

// A file of one's own goes before one of the same name that comes with the program.
TEST_F(Habits, OwnFilesGoFirst) {
  folder_.Write("failure_vs_outliers", SmallStudyYaml());
  const ProgramResult run = RunHere("\"$RCME\" run failure_vs_outliers --threads 1 --out run.sqlite");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("small: 2 conditions, 12 trials"));
}

TEST_F(Habits, EstimatorFilesHaveNamesInEveryFolder) {
  const ProgramResult list = RunHere("\"$RCME\" list estimator_files");
  EXPECT_EQ(list.exit_code, 0) << list.err;
  EXPECT_THAT(list.out, HasSubstr("rcme_tuned"));
  folder_.Write("pair.csv", MatchHeader() + MatchRows(60));
  const ProgramResult by_file =
      RunHere("\"$RCME\" estimate pair.csv --format json --estimator-file rcme_tuned");
  EXPECT_EQ(by_file.exit_code, 0) << by_file.err;
  const ProgramResult by_path = RunHere("\"$RCME\" estimate pair.csv --format json --estimator-file '" +
                                        SourceFolder() + "/estimator_files/rcme_tuned.yaml'");
  EXPECT_EQ(by_file.out, by_path.out);
  EXPECT_EQ(RunHere("\"$RCME\" estimate pair.csv --format json --estimator rcme_tuned").out, by_file.out);
  folder_.Write("study.yaml", SmallStudyYaml() + "  - {file: rcme_tuned, label: tuned}\n");
  EXPECT_THAT(RunHere("\"$RCME\" run study.yaml --threads 1 --out a.sqlite --add-estimator rcme_tuned").err,
              HasSubstr("4 estimators"));
  EXPECT_TRUE(IsRefused(RunHere("\"$RCME\" estimate pair.csv --estimator-file rcme_tunde"),
                        {"did you mean 'rcme_tuned'?"}));
}

// folder, calibration and file: all seen from the study, wherever the program is started.
TEST_F(Habits, PathsInAStudyAreSeenFromItsFolder) {
  std::filesystem::create_directories(folder_.Path("deep/pairs"));
  std::filesystem::create_directories(folder_.Path("elsewhere"));
  folder_.Write("deep/pairs/a.csv", MatchHeader() + TruePoseHeader() + MatchRows(60));
  folder_.Write("deep/camera.txt", MatchHeader());
  folder_.Write("deep/mine.yaml", "name: rcme\nlabel: mine\n");
  folder_.Write(
      "deep/real.yaml",
      "data: {scene: match_files, folder: pairs}\nestimators: [{name: standard}, {file: mine.yaml}]\n");
  folder_.Write("deep/own.yaml",
                "trials: 1\ndata: {scene: uniform_volume, cameras: from_file, calibration: camera.txt}\n"
                "estimators: [{name: standard}]\n");
  for (const std::string from : {"elsewhere", "deep", "."}) {
    const std::string study = from == "elsewhere" ? "../deep/" : from == "deep" ? "" : "deep/";
    for (const std::string name : {"real", "own"}) {
      std::string line = "cd " + from + " && \"$RCME\" run " + study + name;
      line += ".yaml --trials 1 --threads 1 --out '" + folder_.path() + "/" + name + from.substr(0, 1) +
              ".sqlite'";
      const ProgramResult result = RunHere(line);
      EXPECT_EQ(result.exit_code, 0) << from << " " << name << ": " << result.err;
    }
  }
  // On the command line a path is seen from where the command is given.
  EXPECT_EQ(RunHere("cd elsewhere && \"$RCME\" run ../deep/real.yaml --set folder=../deep/pairs --threads 1 "
                    "--out x.sqlite")
                .exit_code,
            0);
}

TEST_F(Habits, EveryCommandShowsExamples) {
  std::istringstream names(
      RunShell("\"$RCME\" completion bash | sed -n \"s/^    \\([a-z-]*\\))\\$/\\1/p\"").out);
  int num_commands = 0;
  for (std::string name; names >> name; ++num_commands)
    EXPECT_THAT(RunRcme({name, "--help"}).out, HasSubstr("Examples:\n")) << name;
  EXPECT_GT(num_commands, 35);
}

// The longest line of a text, but for indented lines after `end`, which are examples.
size_t LongestLine(const std::string& text, const std::string& end = "\n\n\n\n") {
  std::istringstream lines(text.substr(0, text.find(end)));
  size_t longest = 0;
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  return longest;
}

TEST_F(Habits, HelpAndListsFitATerminal) {
  for (const std::string command : {"run", "ask", "audit", "worst", "tune"})
    EXPECT_LE(LongestLine(RunRcme({command, "--help"}).out, "Examples:"), 95u) << command;
  const ProgramResult plot = RunRcme({"plot", "--help"});
  EXPECT_LE(LongestLine(plot.out.substr(plot.out.find("Kinds")), "Examples:"), 80u);
  for (const std::string list : {"options", "settings", "claims", "quantities", "scenes"})
    EXPECT_LE(LongestLine(RunRcme({"list", list}).out), 80u) << list;
  const std::string lists = RunRcme({"list"}).out;
  EXPECT_LE(LongestLine(lists), 80u);
  EXPECT_LT(std::ranges::count(lists, '\n'), 24);
  for (const std::string name : {"estimators", "settings", "studies", "estimator_files"})
    EXPECT_THAT(lists, HasSubstr("\n" + name + " "));
  EXPECT_THAT(RunRcme({"list", "--format", "json"}).out, HasSubstr("\"settings\": ["));
}

TEST_F(Habits, ASlipOfThePenIsUnderstood) {
  EXPECT_TRUE(IsRefused(RunRcme({"sumarize", "run.sqlite", "more"}), {"there is no command 'sumarize'\n"}));
  EXPECT_TRUE(IsRefused(RunRcme({"--trails", "3"}), {"not expected: --trails 3\n"}));
  EXPECT_TRUE(IsRefused(RunRcme({"sumarize", out_}), {"'sumarize' (did you mean 'summarize'?)"}));
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--trails", "3"}), {"'--trails' (did you mean '--trials'?)"}));
  EXPECT_TRUE(
      IsRefused(Run({"--out", out_, "--set", "outlier_rato=0.1"}), {"did you mean 'outlier_ratio'?"}));
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--set", "scene=corridoor"}), {"did you mean 'corridor'?"}));
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--set", "motion=foward"}), {"did you mean 'forward'?"}));
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--set", "our.mu=1"}), {"did you mean 'ours'?"}));
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--set", "refinement=robst"}), {"did you mean 'robust'?"}));
  EXPECT_TRUE(IsRefused(RunRcme({"list", "estimator"}), {"did you mean 'estimators'?"}));
  EXPECT_TRUE(IsRefused(RunRcme({"plot", "failure_rat", "x"}), {"did you mean 'failure_rate'?"}));
  EXPECT_TRUE(IsRefused(RunRcme({"estimate", study_, "--estimator", "rcme_calibratd"}),
                        {"did you mean 'rcme_calibrated'?"}));
  const std::string slip = folder_.Write("slip.yaml", "trails: 3\n" + SmallStudyYaml());
  EXPECT_TRUE(IsRefused(RunRcme({"run", slip, "--out", out_}), {"slip.yaml:1: ", "did you mean 'trials'?"}));
  EXPECT_THAT(RunRcme({"frobnicate"}).err, Not(HasSubstr("did you mean")));
}

TEST_F(Habits, WrongUsesAreNamed) {
  const std::string matches = folder_.Write("pair.csv", MatchHeader() + MatchRows(30));
  EXPECT_TRUE(IsRefused(RunRcme({"run", matches, "--out", out_}), {"is a match file", "rcme estimate "}));
  EXPECT_TRUE(IsRefused(RunRcme({"estimate", matches, "--estimator", "magsac"}),
                        {"did you mean 'opencv_magsac'?", "known: standard, ", "estimator files: "}));
  const std::string study =
      folder_.Write("bare.yaml", "data: {scene: uniform_volume}\nestimators:\n  - opencv_magsac\n");
  EXPECT_TRUE(IsRefused(RunRcme({"run", study, "--out", out_}), {"bare.yaml:3", "{file: opencv_magsac}"}));
  EXPECT_TRUE(IsRefused(RunRcme({"estimate", matches, "--seed", "1", "--seed", "2"}),
                        {"rcme: --seed is given twice; give it once\n"}));
  EXPECT_TRUE(IsRefused(RunRcme({"estimate", matches, "--estimator", "standard", "--set", "focal_sd=0.2"}),
                        {"focal_sd has no effect without covariance=robust"}));
}

// A key that another choice brings.
TEST_F(Habits, AMissingChoiceIsNamed) {
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--set", "cameras=own_intrinsics", "--set", "focal_px=700"}),
                        {"unknown key 'focal_px' (needs cameras: pinhole"}));
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--set", "folder=x"}), {"needs scene: match_files"}));
  const std::string study = folder_.Write(
      "plane.yaml", "data: {scene: uniform_volume, off_plane_share: 0.1}\nestimators: [{name: standard}]\n");
  EXPECT_TRUE(IsRefused(RunRcme({"run", study, "--out", out_}),
                        {"plane.yaml:1:", "needs scene: plane or plane_and_parallax"}));
}

TEST_F(Habits, HelpOfACommandIsItsHelp) {
  for (const std::string command : {"run", "estimate", "list"}) {
    const ProgramResult help = RunRcme({"help", command});
    EXPECT_EQ(help.exit_code, 0) << help.err;
    EXPECT_EQ(help.out, RunRcme({command, "--help"}).out);
  }
  EXPECT_EQ(RunRcme({"help"}).out, RunRcme({"--help"}).out);
  EXPECT_TRUE(IsRefused(RunRcme({"help", "estimat"}), {"did you mean 'estimate'?"}));
}

// What is there already is said at the start, before the first trial.
TEST_F(Habits, AResumedRunSaysWhatIsThere) {
  ASSERT_EQ(Run({"--out", out_}).exit_code, 0);
  EXPECT_THAT(Run({"--out", out_, "--trials", "9"}).err,
              HasSubstr("12 of 18 trials are there already, 6 are left\n"));
}

// The words that bash offers for the last one of a line.
std::vector<std::string> Completed(const std::vector<std::string>& words) {
  std::string line = "\"$RCME\" completion bash > \"$0.bash\"; bash -c '. \"$0\"; COMP_WORDS=(";
  for (const std::string& word : words) line += "\"" + word + "\" ";
  line += "); COMP_CWORD=" + std::to_string(words.size() - 1);
  line += "; _rcme; printf \"%s\\n\" \"${COMPREPLY[@]}\"' ./c.bash";
  const TempFolder folder;
  const ProgramResult result =
      RunShell("cd '" + folder.path() + "' && set -- && " + "\"$RCME\" completion bash > c.bash && " +
               "RCME=\"$RCME\" " + line.substr(line.find("bash -c")));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::vector<std::string> offered;
  std::istringstream lines(result.out);
  for (std::string each; std::getline(lines, each);) offered.push_back(each);
  return offered;
}

TEST(Completion, OffersCommandsOptionsAndNames) {
  using testing::Contains;
  using testing::ElementsAre;
  EXPECT_THAT(Completed({"rcme", "summ"}), ElementsAre("summarize"));
  EXPECT_THAT(Completed({"rcme", "run", "--thr"}), ElementsAre("--threads"));
  EXPECT_THAT(Completed({"rcme", "run", "failure_vs_par"}), ElementsAre("failure_vs_parallax"));
  EXPECT_THAT(Completed({"rcme", "estimate", "x", "--estimator", "rcme_c"}), ElementsAre("rcme_calibrated"));
  EXPECT_THAT(Completed({"rcme", "summarize", "x", "--format", "js"}), ElementsAre("json"));
  EXPECT_THAT(Completed({"rcme", "list", "est"}), ElementsAre("estimators", "estimator_files"));
  EXPECT_THAT(Completed({"rcme", "help", "ru"}), ElementsAre("run"));
  EXPECT_THAT(Completed({"rcme", "run", "c.b"}), Contains("c.bash")) << "files, too";
  EXPECT_THAT(Completed({"rcme", "plot", "heat"}), ElementsAre("heat_map"));
  EXPECT_THAT(Completed({"rcme", "plot", "heat_map", "x.csv", "--quan"}), ElementsAre("--quantities"));
  EXPECT_THAT(Completed({"rcme", "plot", "heat_map", "x.csv", "--format", "ti"}), ElementsAre("tikz"));
  EXPECT_THAT(Completed({"rcme", "run", "x", "--set", "outlier_ra"}), ElementsAre("outlier_ratio="));
  EXPECT_THAT(Completed({"rcme", "run", "x", "--set", "max_failure"}),
              ElementsAre("max_failure_probability="));
  EXPECT_THAT(Completed({"rcme", "run", "x", "--shard", "au"}), ElementsAre("auto", "auto/8"));
  EXPECT_THAT(Completed({"rcme", "failures", "x", "--estimators", "opengv"}), ElementsAre("opengv_ransac"));
  EXPECT_THAT(Completed({"rcme", "summarize", "x", "--quantities", "kappa"}), ElementsAre("kappa_flag"));
  EXPECT_THAT(Completed({"rcme", "ask", "--scene", "corr"}), ElementsAre("corridor"));
  EXPECT_THAT(Completed({"rcme", "audit", "--only", "sampson.det"}), ElementsAre("sampson.determinant"));
  EXPECT_THAT(Completed({"rcme", "solve", "x", "--over", "outlier_ra"}), ElementsAre("outlier_ratio"));
  EXPECT_THAT(Completed({"rcme", "plot", "heat_map", "x", "--quantities", "kappa"}),
              ElementsAre("kappa_flag"));
}

// Files are not offered where there is a list, but where they are allowed besides.
TEST(Completion, OffersFilesOnlyWhereTheyAreAllowed) {
  using testing::Contains;
  EXPECT_THAT(Completed({"rcme", "ask", "--scene", "c"}), Not(Contains("c.bash")));
  EXPECT_THAT(Completed({"rcme", "audit", "--only", "c"}), Not(Contains("c.bash")));
  EXPECT_THAT(Completed({"rcme", "summarize", "x", "--format", "c"}), Not(Contains("c.bash")));
  EXPECT_THAT(Completed({"rcme", "plot", "heat_map", "x", "--quantities", "c"}), Not(Contains("c.bash")));
  EXPECT_THAT(Completed({"rcme", "list", "c"}), Not(Contains("c.bash")));
  EXPECT_THAT(Completed({"rcme", "run", "x", "--add-estimator", "c"}), Contains("c.bash"));
  EXPECT_THAT(Completed({"rcme", "run", "x", "--out", "c"}), Contains("c.bash"));
}

// Labels of a run are those of its study, not the names of the program's estimators.
TEST_F(Habits, CompletionOffersTheLabelsOfTheRunOnTheLine) {
  ASSERT_EQ(Run({"--out", out_}).exit_code, 0);
  const ProgramResult labels = RunRcme({"completion", "labels", out_});
  EXPECT_THAT(labels.out, HasSubstr("ours\n"));
  EXPECT_THAT(Completed({"$RCME", "failures", out_, "--estimators", "our"}), testing::ElementsAre("ours"));
  EXPECT_THAT(Completed({"$RCME", "replay", out_, "--estimator", "our"}), testing::ElementsAre("ours"));
  EXPECT_TRUE(IsRefused(RunRcme({"completion", "labels"}), {"give the result file"}));
  EXPECT_TRUE(IsRefused(RunRcme({"completion", "bash", out_}), {"takes no file"}));
}

// The scripts that draw know their options themselves.
TEST(Completion, OffersEveryOptionOfEveryFigure) {
  std::string scripts = ReadBytes(SourceFolder() + "/plots/common/command_line.py");
  for (const std::string& kind : Completed({"rcme", "plot", ""})) {
    const std::string script = SourceFolder() + "/plots/" + kind + ".py";
    if (std::filesystem::exists(script)) scripts += ReadBytes(script);
  }
  const std::vector<std::string> offered = Completed({"rcme", "plot", "failure_rate", "--"});
  const std::regex option(R"re(add_argument\("(--[a-z-]+)")re");
  std::set<std::string> names;
  for (std::sregex_iterator found(scripts.begin(), scripts.end(), option), end; found != end; ++found)
    names.insert((*found)[1]);
  EXPECT_THAT(names, testing::IsSupersetOf({"--style", "--floor", "--names", "--page"}));
  for (const std::string& name : names) EXPECT_THAT(offered, testing::Contains(name));
}

// Each shell that is here reads its script.
TEST(Completion, EveryShellReadsItsScript) {
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    const ProgramResult script = RunRcme({"completion", shell});
    EXPECT_EQ(script.exit_code, 0) << script.err;
    EXPECT_THAT(script.out, HasSubstr("summarize"));
    EXPECT_THAT(script.out, HasSubstr("threads"));
    const ProgramResult read =
        RunShell("command -v " + shell + " > /dev/null || exit 0; \"$RCME\" completion " + shell + " | " +
                 shell + " -n /dev/stdin");
    EXPECT_EQ(read.exit_code, 0) << shell << ": " << read.err;
    EXPECT_EQ(read.err, "");
  }
}

TEST(Man, HasAPageOfEveryCommandThatGroffTakesWithoutAWarning) {
  const TempFolder folder;
  const ProgramResult made = RunRcme({"man", "--out", folder.Path("man1")});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const ProgramResult page = RunRcme({"man", "run"});
  EXPECT_EQ(page.out, ReadBytes(folder.Path("man1/rcme-run.1")));
  EXPECT_THAT(page.out, HasSubstr(".SH SYNOPSIS\n\\fBrcme\\fR \\fBrun\\fR \\fIstudy\\fR"));
  EXPECT_THAT(page.out, HasSubstr("\\fB\\-\\-threads\\fR"));
  EXPECT_THAT(ReadBytes(folder.Path("man1/rcme.1")), HasSubstr("rcme\\-summarize"));
  EXPECT_TRUE(IsRefused(RunRcme({"man", "runn"}), {"did you mean 'run'?"}));
  const ProgramResult lint =
      RunShell("command -v groff > /dev/null || exit 0; for page in '" + folder.path() +
               "'/man1/*.1; do groff -man -Tutf8 -ww -z \"$page\" || exit 1; done");
  EXPECT_EQ(lint.exit_code, 0);
  EXPECT_EQ(lint.err, "");
}

}  // namespace
}  // namespace rcme
