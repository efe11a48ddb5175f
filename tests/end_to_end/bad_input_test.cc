// What the program answers to input that is wrong: exit code 2, a sentence on standard error that names the
// thing, and nothing lost or left behind.
#include "tests/end_to_end/bad_input.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/test_support/gzip.h"
#include "tests/test_support/match_text.h"

namespace rcme {
namespace {

TEST_F(BadInput, MissingFiles) {
  EXPECT_TRUE(IsRefused(RunRcme({"estimate", folder_.Path("none.csv")}), {"none.csv", "no such match file"}));
  EXPECT_TRUE(
      IsRefused(RunRcme({"summarize", folder_.Path("none.sqlite")}), {"none.sqlite", "no such result file"}));
  EXPECT_TRUE(IsRefused(RunRcme({"replay", folder_.Path("none.sqlite"), "--condition", "0", "--trial", "0"}),
                        {"none.sqlite", "no such result file"}));
  EXPECT_TRUE(
      IsRefused(RunRcme({"run", folder_.Path("none.yaml"), "--out", out_}), {"none.yaml", "no such study"}));
  EXPECT_TRUE(IsRefused(RunRcme({"match", folder_.Path("1.png"), folder_.Path("2.png"), "--K1", "1", "1", "0",
                                 "0", "--out", folder_.Path("m.csv")}),
                        {"1.png", "no such image"}));
  EXPECT_EQ(folder_.NumEntries(), 1) << "something was left behind";
}

TEST_F(BadInput, TruncatedGzip) {
  const std::string whole = Gzip(MatchHeader() + MatchRows(100));
  EXPECT_TRUE(
      IsRefused(Estimate("cut.csv.gz", whole.substr(0, whole.size() / 2)), {"cut.csv.gz", "truncated gzip"}));
}

TEST_F(BadInput, NumbersThatAreNone) {
  for (const std::string word : {"nan", "inf", "-inf", "1e999"}) {
    EXPECT_TRUE(IsRefused(Estimate("m.csv", MatchHeader() + MatchRows(20) + "1,2," + word + ",4\n"),
                          {"m.csv:25: x2: '" + word + "' is not a finite number"}));
  }
  EXPECT_TRUE(IsRefused(Estimate("m.csv", MatchHeader() + MatchRows(20) + "1e308,1e308,1e308,1e308\n"),
                        {"m.csv:25: x1: '1e308' is not a finite number in [-1000000, 1000000] px"}));
}

TEST_F(BadInput, SingularK) {
  std::string header = MatchHeader();
  header.replace(header.find("600 600"), 7, "600 0");
  EXPECT_TRUE(
      IsRefused(Estimate("m.csv", header + MatchRows(20)), {"m.csv:3: K1_fx_fy_cx_cy: K is singular"}));
}

TEST_F(BadInput, TooFewMatches) {
  for (const std::string estimator : {"standard", "prcme", "rcme"}) {
    const std::string path = folder_.Write("m.csv", MatchHeader() + MatchRows(7));
    const ProgramResult result = RunRcme({"estimate", path, "--estimator", estimator, "--format=json"});
    EXPECT_TRUE(IsRefused(result, {"m.csv", "7 distinct matches of 7; at least 8"}));
    EXPECT_NE(result.out.find("\"status\": \"too_few_matches\""), std::string::npos) << result.out;
  }
  EXPECT_TRUE(IsRefused(Estimate("m.csv", MatchHeader()), {"m.csv", "0 distinct matches"}));
}

TEST_F(BadInput, DuplicateMatchesOnly) {
  std::string rows;
  for (int i = 0; i < 100; ++i) rows += MatchRows(1);
  EXPECT_TRUE(IsRefused(Estimate("m.csv", MatchHeader() + rows), {"m.csv", "1 distinct matches of 100"}));
}

TEST_F(BadInput, AllPointsOnOneLine) {
  std::string rows;
  for (int i = 0; i < 60; ++i)
    rows += fmt::format("{},{},{},{}\n", 10 + 9 * i, 20 + 5 * i, 600 - 7 * i, 30 + 4 * i);
  EXPECT_TRUE(IsRefused(Estimate("m.csv", MatchHeader() + rows), {"m.csv", "on one line"}));
}

TEST_F(BadInput, EmptyAndBinaryFiles) {
  EXPECT_TRUE(IsRefused(Estimate("m.csv", ""), {"m.csv: is empty"}));
  std::string bytes;
  for (unsigned i = 0; i < 100'000; ++i) bytes += static_cast<char>((i * i) >> 3);
  EXPECT_TRUE(IsRefused(Estimate("m.csv", bytes), {"m.csv"}));
  EXPECT_TRUE(IsRefused(RunRcme({"run", folder_.Write("bytes.yaml", bytes), "--out", out_}), {"bytes.yaml"}));
  EXPECT_TRUE(
      IsRefused(RunRcme({"summarize", folder_.Path("m.csv")}), {"m.csv", "is not an rcme result file"}));
}

TEST_F(BadInput, UnknownStudyKey) {
  const std::string bad = folder_.Write("bad.yaml", SmallStudyYaml() + "trails: 5\n");
  EXPECT_TRUE(
      IsRefused(RunRcme({"run", bad, "--out", out_}), {"bad.yaml:10:", "'trails'", "known keys", "trials"}));
  EXPECT_FALSE(std::filesystem::exists(out_)) << "a result file was made for a file that is not a study";
}

// What somebody writes who has read a list of names.
TEST_F(BadInput, AnEstimatorFileIsNoEstimator) {
  const std::string bad = folder_.Write("bad.yaml", SmallStudyYaml() + "  - {name: rcme_tuned}\n");
  EXPECT_TRUE(IsRefused(RunRcme({"run", bad, "--out", out_}),
                        {"bad.yaml:10:", "'rcme_tuned' is an estimator file", "write {file: rcme_tuned}"}));
}

TEST_F(BadInput, StudiesThatCannotBePlannedNameTheirFile) {
  const std::string bad =
      folder_.Write("bad.yaml", "data: {scene: match_files, folder: " + folder_.Path("none") +
                                    "}\nestimators: [{name: rcme}]\n");
  EXPECT_TRUE(IsRefused(RunRcme({"run", bad, "--out", out_}),
                        {"bad.yaml", "folder", "is not a folder", "--set folder=PAIRS"}));
  EXPECT_TRUE(IsRefused(RunRcme({"run", folder_.path(), "--out", out_}), {folder_.path(), "is a folder"}));
  EXPECT_TRUE(
      IsRefused(RunRcme({"run", "/dev/zero", "--out", out_}), {"/dev/zero: is a device, not a study"}));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(BadInput, CommandLine) {
  EXPECT_TRUE(IsRefused(RunRcme({}), {"subcommand", "--help"}));
  EXPECT_TRUE(IsRefused(RunRcme({"frobnicate"}), {"frobnicate"}));
  EXPECT_TRUE(IsRefused(RunRcme({"frobnicate", "--help"}), {"there is no command 'frobnicate'"}));
  EXPECT_EQ(RunRcme({"frobnicate", "--help"}).err, RunRcme({"frobnicate"}).err);
  EXPECT_TRUE(IsRefused(RunRcme({"run"}), {"study"}));
  EXPECT_TRUE(IsRefused(RunRcme({"run", "--frobnicate"}), {"not expected: --frobnicate"}));
  EXPECT_TRUE(IsRefused(RunRcme({"summarize", folder_.path()}), {"is a folder, not a result file"}));
  EXPECT_TRUE(IsRefused(RunRcme({"run", study_}), {"--out"}));
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--frobnicate"}), {"--frobnicate"}));
  EXPECT_TRUE(IsRefused(RunRcme({"list", "moons"}), {"moons", "estimators", "scenes"}));
  EXPECT_TRUE(IsRefused(RunRcme({"summarize", out_, "--format", "xml"}), {"--format", "xml", "csv"}));
  for (const std::string value : {"0", "-3", "1e3", "99999999999999999999", "many"}) {
    EXPECT_TRUE(IsRefused(Run({"--out", out_, "--trials", value}), {"--trials", value}));
  }
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--seed", "-1"}), {"--seed", "-1"}));
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--threads", "-1"}), {"--threads", "-1"}));
  EXPECT_TRUE(IsRefused(RunRcme({"estimate", study_, "--estimator", "magsac"}),
                        {"'magsac'", "standard, prcme, rcme"}));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(BadInput, NumbersOnTheCommandLine) {
  const auto refuses = [](const std::vector<std::string>& arguments, const std::string& what) {
    return IsRefused(RunRcme(arguments), {what});
  };
  const std::string whole = "' is not allowed; give a whole number in [0, ";
  EXPECT_TRUE(refuses({"run", study_, "--out", out_, "--seed", "99999999999999999999"},
                      "--seed: '99999999999999999999" + whole));
  EXPECT_TRUE(refuses({"run", study_, "--out", out_, "--until", ""}, "--until: '' is not allowed; give ci="));
  EXPECT_TRUE(refuses({"run", study_, "--out", out_, "--until", "ci=2"}, "--until: 'ci=2' is not allowed"));
  EXPECT_TRUE(refuses({"run", study_, "--out", out_, "--until", "ci=0.1", "--max-trials", "99"},
                      "--max-trials: '99' is not allowed; give a whole number in [100, 2000000000]"));
  folder_.Write("pairs.csv", MatchHeader() + MatchRows(20));
  const std::string pairs =
      folder_.Write("pairs.yaml", "data: {scene: match_files, folder: .}\nestimators: [{name: standard}]\n");
  EXPECT_TRUE(refuses({"run", pairs, "--out", out_, "--until", "ci=0.1"},
                      "--until: the trials of match files repeat the same pairs"));
  for (const std::string command : {"show", "replay"}) {
    EXPECT_TRUE(refuses({command, study_, "--condition", "", "--trial", "0"}, "--condition: '" + whole));
    EXPECT_TRUE(refuses({command, study_, "--condition", "-1", "--trial", "0"}, "--condition: '-1" + whole));
    EXPECT_TRUE(refuses({command, study_, "--condition", "0", "--trial", ""}, "--trial: '" + whole));
  }
  EXPECT_TRUE(refuses({"estimate", study_, "--sigma", "0"},
                      "--sigma: '0' is not allowed; give a number in [1e-09, 1000]"));
  EXPECT_TRUE(refuses({"match", "1.png", "2.png", "--K1", "1", "1", "0", "0", "-o", out_, "--ratio", "nan"},
                      "--ratio: 'nan' is not allowed; give a number in [0.01, 1]"));
  EXPECT_TRUE(refuses({"match", "1.png", "2.png", "--K1", "1", "1", "inf", "0", "-o", out_},
                      "--K1: 'inf' is not allowed; give a number"));
  for (const std::string command : {"audit", "map"}) {
    EXPECT_TRUE(refuses({command, "--out", out_, "--seed", "-1"}, "--seed: '-1" + whole));
    EXPECT_TRUE(refuses({command, "--out", out_, "--threads", "1025"}, "--threads: '1025" + whole + "1024]"));
  }
  EXPECT_TRUE(refuses({"map", "--out", out_, "--trials", "0"}, "--trials: '0' is not allowed"));
  EXPECT_TRUE(refuses({"tune", study_, "--threads", ""}, "--threads: '" + whole + "1024]"));
  EXPECT_FALSE(std::filesystem::exists(out_));

  ASSERT_EQ(Run({"--out", out_, "--seed", "010"}).exit_code, 0);
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--seed", "8"}), {"'seed: 10' there, 'seed: 8' here"}));
}

// Escape sequences and bytes that are not UTF-8 neither reach the terminal nor a result file.
TEST_F(BadInput, ForeignText) {
  for (const std::string text : {"\x1B[31m.csv", "caf\xE9.csv", "\xC2\x9B"}) {
    const ProgramResult result = RunRcme({"estimate", text});
    EXPECT_TRUE(IsRefused(result, {"argument 2: '\\x", "give UTF-8 without control characters"}) ||
                IsRefused(result, {"argument 2: 'caf\\xE9.csv'"}));
    EXPECT_EQ(result.err.find_first_of("\x1B\xE9\x9B"), std::string::npos) << result.err;
  }
  const ProgramResult scene = Estimate("m.csv", "# scene: a\x1B]0;b\n" + MatchHeader());
  EXPECT_TRUE(IsRefused(scene, {"m.csv:1: scene: 'a\\x1B]0;b' is not allowed"}));
  const ProgramResult word = Estimate("m.csv", MatchHeader() + std::string(50'000, '\a') + "\n");
  EXPECT_TRUE(IsRefused(Estimate("m.csv", MatchHeader() + "1,2,\x1B[31m,4\n"), {"m.csv:5: x2: '\\x1B[31m'"}));
  EXPECT_LT(word.err.size(), 5000u);
}

TEST_F(BadInput, ImagesWithoutMatches) {
  const std::string grey = "P5 64 64 255\n" + std::string(64 * 64, '\x80');
  const std::string image = folder_.Write("grey.pgm", grey), out = folder_.Path("m.csv");
  const ProgramResult result = RunRcme({"match", image, image, "--K1", "60", "60", "32", "32", "--out", out});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "no match was kept -> " + out + "\n");
}

TEST_F(BadInput, ComparisonsThatCannotBeMade) {
  const auto compare = [&](const std::string& out, const std::string& yaml, const std::string& what) {
    const std::string study = folder_.Write("compared.yaml", yaml);
    EXPECT_EQ(RunRcme({"run", study, "--out", out, "--threads", "1"}).exit_code, 0);
    return IsRefused(RunRcme({"compare", out}), {out + ": " + what});
  };
  std::string yaml = SmallStudyYaml();
  EXPECT_TRUE(compare(folder_.Path("one.sqlite"), yaml.substr(0, yaml.rfind("  - {")),
                      "study 'small' has one estimator, 'standard'; a comparison needs two"));
  yaml.replace(yaml.find("sigma_px: 0.5"), 13, "sigma_px: 0.5, outlier_count: bernoulli, tilted_to: 0.4");
  yaml.replace(yaml.find("[0.0, 0.3]"), 10, "[0.1, 0.3]");
  EXPECT_TRUE(compare(folder_.Path("tilted.sqlite"), yaml, "trials are weighted (tilted_to)"));
}

TEST_F(BadInput, Set) {
  const auto refuses = [&](const std::string& text, const std::vector<std::string>& fragments) {
    return IsRefused(Run({"--out", out_, "--set", text}), fragments);
  };
  EXPECT_TRUE(refuses("garbage", {"--set", "'garbage'", "key=value"}));
  EXPECT_TRUE(refuses("=1", {"--set", "'=1'", "key=value"}));
  EXPECT_TRUE(refuses("garbage=1", {"'garbage'", "known keys", "noise", "sigma_px"}));
  EXPECT_TRUE(
      refuses("scene=match_files", {"'num_matches'", "for scene match_files", "known keys: scene, folder"}));
  EXPECT_TRUE(refuses("noise=", {"noise: ''", "give a name"}));
  EXPECT_TRUE(refuses("ours.garbage=1", {"no option 'garbage'", "its options: solver, num_iterations"}));
  EXPECT_TRUE(refuses("theirs.mu=1", {"theirs"}));
  EXPECT_TRUE(refuses("sigma_px=nan", {"sigma_px", "'nan'", "a number in"}));
  EXPECT_TRUE(refuses("outlier_ratio=2", {"outlier_ratio", "'2'", "a number in [0, 1]"}));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(BadInput, TuneBlock) {
  const auto refuses = [&](const std::string& mu, const std::vector<std::string>& fragments) {
    const std::string block = "tune:\n  estimator: ours\n  options:\n    mu: " + mu + "\n";
    const std::string bad = folder_.Write("bad.yaml", SmallStudyYaml() + block);
    return IsRefused(RunRcme({"run", bad, "--out", out_}), fragments);
  };
  EXPECT_TRUE(refuses("[3, .nan]", {"bad.yaml:13: mu: '.nan'", "a number in [-1000, 1000] or auto"}));
  EXPECT_TRUE(refuses("{from: 3, to: 1, step: 1}", {"bad.yaml:13:", "from: '3'", "<= to"}));
  EXPECT_TRUE(refuses("{from: 0, to: 1, step: 0}", {"bad.yaml:13:", "step: '0'", "a number > 0"}));
  EXPECT_TRUE(refuses("{from: 0, to: 1, step: -1}", {"bad.yaml:13:", "step: '-1'", "a number > 0"}));
  EXPECT_TRUE(refuses("{from: 0, to: 1, step: 1e-300}", {"bad.yaml:13:", "step", "more than 20000 levels"}));
  EXPECT_TRUE(refuses("{from: 0, to: 1, pace: 1}", {"bad.yaml:13:", "'pace'", "from, step, to"}));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

// Both commands that take an estimator file, with a file that is not an estimator file.
TEST_F(BadInput, EstimatorFiles) {
  const std::string matches = folder_.Write("m.csv", MatchHeader() + MatchRows(50));
  const auto refuses = [&](const std::string& file, const std::vector<std::string>& fragments) {
    const testing::AssertionResult is_refused =
        IsRefused(Run({"--out", out_, "--add-estimator", file}), fragments);
    return is_refused ? IsRefused(RunRcme({"estimate", matches, "--estimator-file", file}), fragments)
                      : is_refused;
  };
  EXPECT_TRUE(refuses(folder_.Path("none.yaml"), {"none.yaml", "no such estimator file"}));
  EXPECT_TRUE(refuses(folder_.path(), {folder_.path(), "is a folder"}));
  EXPECT_TRUE(refuses("", {"''", "the path of an estimator file"}));
  EXPECT_TRUE(refuses("/dev/zero", {"/dev/zero: is a device, not an estimator file"}));
  const std::string huge = "name: rcme\n#" + std::string(5'000'000, 'x');
  EXPECT_TRUE(
      refuses(folder_.Write("huge.yaml", huge), {"huge.yaml", "larger than an estimator file can be"}));
  EXPECT_TRUE(refuses(folder_.Write("broken.yaml", "name: [rcme\n"), {"broken.yaml:", "not valid YAML"}));
  EXPECT_TRUE(refuses(folder_.Write("text.yaml", "rcme\n"), {"text.yaml:1: estimator", "a map"}));
  EXPECT_TRUE(refuses(study_, {"small.yaml:2:", "unknown key 'seed'", "label, name, options"}));
  EXPECT_TRUE(refuses(folder_.Write("nan.yaml", "name: rcme\noptions: {mu: nan}\n"),
                      {"nan.yaml:2: mu: 'nan'", "a number in [-1000, 1000] or auto"}));
  EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(BadInput, EstimatorFilesThatClash) {
  const std::string file = folder_.Write("tuned.yaml", "name: rcme\nlabel: ours\n");
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--add-estimator", file}),
                        {"--add-estimator", "tuned.yaml", "'ours' already", "another label", "{file: "}));
  const std::string other = folder_.Write("other.yaml", "name: prcme\n");
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--add-estimator", other, "--add-estimator", other}),
                        {"other.yaml", "'prcme' already"}));
  EXPECT_FALSE(std::filesystem::exists(out_));
  EXPECT_TRUE(IsRefused(RunRcme({"estimate", study_, "--estimator", "rcme", "--estimator-file", file}),
                        {"--estimator-file", "--estimator"}));
  EXPECT_TRUE(IsRefused(
      RunRcme({"estimate", study_, "--estimator-file", file, "--set", "selection=predictive_likelihood"}),
      {"selection", "needs reading: rank_aware"}));
  ASSERT_EQ(Run({"--out", out_}).exit_code, 0);
  EXPECT_TRUE(IsRefused(RunRcme({"show", out_, "--condition", "0", "--trial", "0", "--add-estimator", other}),
                        {"run.sqlite", "--add-estimator", "study file"}));
}

TEST_F(BadInput, Replay) {
  ASSERT_EQ(Run({"--out", out_}).exit_code, 0);
  EXPECT_TRUE(IsRefused(RunRcme({"replay", out_, "--condition", "2", "--trial", "0"}),
                        {"--condition", "2", "conditions 0 to 1"}));
  EXPECT_TRUE(IsRefused(RunRcme({"replay", out_, "--condition", "0", "--trial", "-1"}), {"--trial", "-1"}));
  EXPECT_TRUE(IsRefused(RunRcme({"replay", out_, "--condition", "0"}), {"--trial"}));
}

TEST(Help, IsThereForEveryCommand) {
  for (const std::vector<std::string>& command : {std::vector<std::string>{},
                                                  {"run"},
                                                  {"summarize"},
                                                  {"compare"},
                                                  {"report"},
                                                  {"check"},
                                                  {"merge"},
                                                  {"replay"},
                                                  {"show"},
                                                  {"estimate"},
                                                  {"match"},
                                                  {"check-estimator"},
                                                  {"list"}}) {
    std::vector<std::string> arguments = command;
    arguments.push_back("--help");
    const ProgramResult result = RunRcme(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.out.find("Usage"), std::string::npos) << result.out;
    EXPECT_EQ(result.err, "");
  }
  EXPECT_EQ(RunRcme({"--version"}).exit_code, 0);
}

}  // namespace
}  // namespace rcme
