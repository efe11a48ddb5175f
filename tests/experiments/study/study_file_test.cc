#include "experiments/study/study_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "experiments/study/study_plan.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/paths.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// The small study with one piece of text in place of another.
std::string Edited(const std::string& from, const std::string& to) {
  std::string yaml = SmallStudyYaml();
  const size_t at = yaml.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return yaml.replace(at, from.size(), to);
}

std::string Without(const std::string& key) {
  std::string kept;
  bool is_kept = true;
  std::istringstream lines(SmallStudyYaml());
  for (std::string line; std::getline(lines, line);) {
    if (line[0] != ' ') is_kept = !line.starts_with(key + ":");
    if (is_kept) kept += line + "\n";
  }
  return kept;
}

testing::AssertionResult Refuses(const std::string& yaml, std::vector<std::string> fragments) {
  fragments.push_back("bad.yaml:");
  return ThrowsInputError([&] { ParseStudy(yaml, "bad.yaml"); }, fragments);
}

std::string Setting(const Study& study, const std::string& key) {
  std::string found = "(none)";
  for (const auto& [name, value] : study.data) {
    if (name == key) found = value;
  }
  return found;
}

TEST(ParseStudy, ReadsEveryPart) {
  const Study study = ParseStudy(
      "name: all\n"
      "description: a sentence\n"
      "seed: 18\n"
      "trials: 7\n"
      "data: {scene: uniform_volume, num_matches: 60}\n"
      "factors: {sigma_px: [0.5, 1], outlier_ratio: [0.0, 0.25, 0.5]}\n"
      "estimators:\n"
      "  - {name: standard}\n"
      "  - {name: rcme, label: ours, options: {mu: -2, reading: rank_aware}}\n"
      "failure: {max_rotation_error_deg: 1.5}\n",
      "all.yaml");
  EXPECT_EQ(study.name, "all");
  EXPECT_EQ(study.description, "a sentence");
  EXPECT_EQ(study.seed, 18u);
  EXPECT_EQ(study.trials, 7);
  EXPECT_EQ(Setting(study, "scene"), "uniform_volume");
  EXPECT_EQ(Setting(study, "num_matches"), "60");
  ASSERT_EQ(study.factors.size(), 2u);
  EXPECT_EQ(study.factors[0].key, "sigma_px");
  EXPECT_EQ(study.factors[1].levels, (std::vector<std::string>{"0", "0.25", "0.5"}));
  ASSERT_EQ(study.estimators.size(), 2u);
  EXPECT_EQ(study.estimators[0].label, "standard");
  EXPECT_EQ(ReadOption(study.estimators[0], "num_iterations"), "200");
  EXPECT_EQ(study.estimators[1].name, "rcme");
  EXPECT_EQ(study.estimators[1].label, "ours");
  EXPECT_EQ(ReadOption(study.estimators[1], "mu"), "-2");
  EXPECT_EQ(ReadOption(study.estimators[1], "reading"), "rank_aware");
  EXPECT_EQ(study.failure.max_rotation_error_deg, 1.5);
  EXPECT_EQ(study.failure.max_direction_error_deg, 15.0);
}

TEST(ParseStudy, FillsInWhatIsLeftOut) {
  const Study study =
      ParseStudy("data: {scene: uniform_volume}\nestimators: [{name: prcme}]\n", "folder/short.yaml");
  EXPECT_EQ(study.name, "short");
  EXPECT_EQ(study.seed, 1u);
  EXPECT_EQ(study.trials, 100);
  EXPECT_TRUE(study.factors.empty());
  EXPECT_EQ(study.failure.max_rotation_error_deg, 3.0);
  EXPECT_EQ(ReadOption(study.estimators[0], "mu"), "auto");
}

TEST(ToYaml, RoundTrip) {
  const std::string text = ToYaml(SmallStudy());
  EXPECT_EQ(ToYaml(ParseStudy(text, "again.yaml")), text);
  // Every parameter is written out, so that a later change of a default does not change a stored study.
  for (const char* key : {"max_depth_m: ", "kappa: ", "max_direction_error_deg: 15"}) {
    EXPECT_NE(text.find(key), std::string::npos) << key;
  }
}

TEST(ToYaml, RoundTripOfAwkwardText) {
  Study study = SmallStudy();
  study.name = "a: b, \"c\" #d \xC3\xA4 - e";
  study.description = "1.0\n- e";
  study.estimators[0].label = "~";
  study.estimators[1].label = " x;\"y\" ";
  const std::string text = ToYaml(study);
  const Study again = ParseStudy(text, "again.yaml");
  EXPECT_EQ(again.name, study.name);
  EXPECT_EQ(again.description, study.description);
  EXPECT_EQ(again.estimators[0].label, study.estimators[0].label);
  EXPECT_EQ(again.estimators[1].label, study.estimators[1].label);
  EXPECT_EQ(ToYaml(again), text);
}

TEST(ParseStudyErrors, UnknownKeys) {
  EXPECT_TRUE(Refuses(Edited("seed: 3", "sead: 3"), {":2:", "'sead'", "known keys", "seed", "trials"}));
  EXPECT_TRUE(Refuses(Edited("num_matches:", "matches:"), {":4:", "'matches'", "known keys", "num_matches"}));
  EXPECT_TRUE(Refuses(Edited("outlier_ratio:", "outlier_rate:"),
                      {":6:", "'outlier_rate'", "known keys", "outlier_ratio"}));
  EXPECT_TRUE(Refuses(Edited("label: ours", "alias: ours"),
                      {":9:", "'alias'", "known keys", "file, label, name, options, process, provenance"}));
  EXPECT_TRUE(Refuses(Edited("reading: rank_aware", "readings: x"),
                      {":9:", "no option 'readings'", "its options", "num_iterations"}));
  EXPECT_TRUE(Refuses(SmallStudyYaml() + "failure:\n  max_error: 3\n",
                      {":11:", "'max_error'", "max_rotation_error_deg, max_direction_error_deg"}));
}

TEST(ParseStudyErrors, RepeatedKeys) {
  EXPECT_TRUE(Refuses(SmallStudyYaml() + "seed: 4\n", {":10:", "'seed'", "twice"}));
  EXPECT_TRUE(Refuses(Edited("sigma_px: 0.5", "num_matches: 70"), {":4:", "'num_matches'", "twice"}));
  EXPECT_TRUE(
      Refuses(Edited("estimators:", "  outlier_ratio: [0.5]\nestimators:"), {":7:", "'outlier_ratio'"}));
  EXPECT_TRUE(
      Refuses(Edited("reading: rank_aware", "num_iterations: 3"), {":9:", "'num_iterations'", "twice"}));
  EXPECT_TRUE(Refuses(Edited("label: ours", "name: rcme"), {":9:", "'name'", "twice"}));
}

TEST(ParseStudyErrors, WrongTypes) {
  EXPECT_TRUE(Refuses(Edited("seed: 3", "seed: [3]"), {":2:", "seed", "one value is needed"}));
  EXPECT_TRUE(Refuses(Edited("seed: 3", "seed: {a: 3}"), {":2:", "seed", "one value is needed"}));
  EXPECT_TRUE(Refuses(Edited("name: small", "name: [a, b]"), {":1:", "name", "one value is needed"}));
  EXPECT_TRUE(
      Refuses(Edited("sigma_px: 0.5", "sigma_px: [1, 2]"), {":4:", "sigma_px", "one value is needed"}));
  EXPECT_TRUE(Refuses(Edited("[0.0, 0.3]", "0.3"), {":6:", "outlier_ratio", "a list", "is needed"}));
  EXPECT_TRUE(Refuses(Edited("[0.0, 0.3]", "{a: 0.3}"), {":6:", "outlier_ratio", "a list", "is needed"}));
  EXPECT_TRUE(Refuses(Edited("[0.0, 0.3]", "[[0.0], 0.3]"), {":6:", "outlier_ratio", "one value is needed"}));
  EXPECT_TRUE(Refuses(Without("data") + "data: [1]\n", {":9:", "data", "a map"}));
  EXPECT_TRUE(Refuses(Without("estimators") + "estimators: {name: rcme}\n", {":7:", "estimators", "a list"}));
  EXPECT_TRUE(Refuses(Without("estimators") + "estimators: [rcme]\n", {":7:", "estimators", "no map"}));
  EXPECT_TRUE(Refuses(SmallStudyYaml() + "failure: 3\n", {":10:", "failure", "a map"}));
  EXPECT_TRUE(Refuses("- a\n- b\n", {":1:", "study", "a map"}));
  EXPECT_TRUE(Refuses("", {":1:", "study", "a map"}));
  EXPECT_TRUE(Refuses("just text", {":1:", "study", "a map"}));
}

TEST(ParseStudyErrors, ValuesThatAreNotAllowed) {
  EXPECT_TRUE(
      Refuses(Edited("trials: 6", "trials: 0"), {":3:", "trials", "'0'", "whole number in [1, 2000000000]"}));
  EXPECT_TRUE(Refuses(Edited("trials: 6", "trials: -4"), {":3:", "trials", "'-4'", "whole number"}));
  EXPECT_TRUE(Refuses(Edited("trials: 6", "trials: 1e3"), {":3:", "trials", "'1e3'", "whole number"}));
  EXPECT_TRUE(
      Refuses(Edited("trials: 6", "trials: 99999999999999999999"), {":3:", "trials", "whole number"}));
  EXPECT_TRUE(Refuses(Edited("seed: 3", "seed: -1"), {":2:", "seed", "'-1'", "whole number in [0, "}));
  EXPECT_TRUE(Refuses(Edited("sigma_px: 0.5", "sigma_px: -1"),
                      {":4:", "sigma_px", "'-1'", "a number in [1e-09, 1000]"}));
  for (const char* text : {".nan", "nan", ".inf", "inf", "1e999", "ten", "0x10", "''"}) {
    EXPECT_TRUE(Refuses(Edited("sigma_px: 0.5", fmt::format("sigma_px: {}", text)),
                        {":4:", "sigma_px", "a number in [1e-09, 1000]"}));
  }
  EXPECT_TRUE(Refuses(Edited("num_matches: 60", "num_matches: 0"),
                      {":4:", "num_matches", "'0'", "whole number in [1, "}));
  EXPECT_TRUE(Refuses(Edited("num_matches: 60", "num_matches: 6.5"),
                      {":4:", "num_matches", "'6.5'", "whole number"}));
  EXPECT_TRUE(
      Refuses(Edited("[0.0, 0.3]", "[0.0, 1.5]"), {":6:", "outlier_ratio", "'1.5'", "a number in [0, 1]"}));
  EXPECT_TRUE(
      Refuses(Edited("[0.0, 0.3]", "[0.0, .nan]"), {":6:", "outlier_ratio", "'.nan'", "a number in [0, 1]"}));
  EXPECT_TRUE(Refuses(Edited("num_iterations: 20}", "num_iterations: 0}"),
                      {":8:", "num_iterations", "'0'", "whole number in [1, 1000000]"}));
  EXPECT_TRUE(
      Refuses(Edited("rank_aware", "printed"), {":9:", "reading", "'printed'", "as_printed, rank_aware"}));
  EXPECT_TRUE(Refuses(SmallStudyYaml() + "failure: {max_rotation_error_deg: -3}\n",
                      {":10:", "max_rotation_error_deg", "'-3'", "a number in [0, 180]"}));
  EXPECT_TRUE(Refuses(SmallStudyYaml() + "failure:\n  max_rotation_error_deg: .nan\n",
                      {":11:", "max_rotation_error_deg", "a number in [0, 180]"}));
}

// They are cells of tables, lines of legends and columns of CSV files.
TEST(ParseStudyErrors, NamesOfMoreThanOneLine) {
  for (const std::string text :
       {"\"a\\nb\"", "\"a\\tb\"", "\"a\\rb\"", "\"a\\eb\"", "\"a\\u202Eb\"", "\"a\\u2028b\""}) {
    EXPECT_TRUE(Refuses(Edited("name: small", "name: " + text), {"bad.yaml:1: name", "is not allowed"}))
        << text;
    EXPECT_TRUE(Refuses(Edited("label: ours", "label: " + text), {"bad.yaml:9: label", "is not allowed"}))
        << text;
    EXPECT_TRUE(
        Refuses(Edited("[0.0, 0.3]", "[0.0, " + text + "]"), {"bad.yaml:6: outlier_ratio", "is not allowed"}))
        << text;
  }
  EXPECT_EQ(ParseStudy(Edited("label: ours", "label: =_1+1"), "small.yaml").estimators[1].label, "=_1+1");
  EXPECT_TRUE(Refuses(Edited("label: ours", "label: \"a b,c\""),
                      {"bad.yaml:9: label: 'a b,c' is not allowed", "without a comma"}));
}

TEST(ParseStudyErrors, OptionsThatContradictEachOther) {
  EXPECT_TRUE(Refuses(Edited("reading: rank_aware", "selection: predictive_likelihood"),
                      {":9:", "selection", "needs reading: rank_aware"}));
}

TEST(ParseStudyErrors, EmptyAndRepeated) {
  EXPECT_TRUE(Refuses(Edited("[0.0, 0.3]", "[]"), {":6:", "outlier_ratio", "at least one level"}));
  EXPECT_TRUE(Refuses(Edited("[0.0, 0.3]", "[0.3, 0.3]"), {":6:", "outlier_ratio", "'0.3'", "twice"}));
  EXPECT_TRUE(Refuses(Without("estimators") + "estimators: []\n", {":7:", "estimators", "at least one"}));
  EXPECT_TRUE(Refuses(Edited("label: ours", "label: standard"), {":9:", "label 'standard'", "twice"}));
  EXPECT_TRUE(Refuses(Edited("name: rcme, label: ours", "label: ours"), {":9:", "'name' is missing"}));
}

TEST(ParseStudyErrors, UnknownNames) {
  EXPECT_TRUE(Refuses(Edited("uniform_volume", "moon"),
                      {":4:", "'moon'", "give one of", "uniform_volume", "match_files"}));
  EXPECT_TRUE(
      Refuses(Edited("name: rcme", "name: magsac"), {":9:", "'magsac'", "known", "standard, prcme, rcme"}));
}

TEST(ParseStudyErrors, MissingParts) {
  EXPECT_TRUE(Refuses(Without("data"), {"'data' is missing"}));
  EXPECT_TRUE(Refuses(Without("estimators"), {"'estimators' is missing"}));
  EXPECT_TRUE(Refuses(Edited("scene: uniform_volume, ", ""), {":4:", "'scene' is missing"}));
  EXPECT_TRUE(Refuses(Edited("outlier_ratio: [0.0, 0.3]", "scene: [uniform_volume, match_files]"),
                      {":6:", "scene", "match_files"}));
}

TEST(ParseStudyErrors, BrokenYaml) {
  EXPECT_TRUE(Refuses(Edited("[0.0, 0.3]", "[0.0, 0.3"), {"not valid YAML"}));
  EXPECT_TRUE(Refuses(Edited("seed: 3", "seed: 3: 4"), {":2:", "not valid YAML"}));
  EXPECT_TRUE(Refuses(Edited("seed: 3", "\tseed: 3"), {"not valid YAML"}));
  EXPECT_TRUE(Refuses(SmallStudyYaml() + "---\n" + SmallStudyYaml(), {"more than one YAML document"}));
}

TEST(ParseStudyErrors, HostileYaml) {
  EXPECT_TRUE(Refuses("data: " + std::string(100'000, '['), {":1:", "deeper than 20 levels"}));
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 30; ++i) {
    bomb += fmt::format("a{0}: &a{0} [*a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}, *a{1}]\n", i, i - 1);
  }
  EXPECT_TRUE(Refuses(bomb, {":5:", "too many values; at most 20000 are allowed"}));
  EXPECT_TRUE(Refuses("data: &d {scene: *d}\n", {":1:", "an alias (*) inside of what it stands for"}));
}

TEST(ParseStudyErrors, TooLarge) {
  EXPECT_TRUE(Refuses(SmallStudyYaml() + "#" + std::string(2'000'000, 'x'), {"larger than a study can be"}));
  std::string levels;
  for (int i = 1; i <= 21'000; ++i) levels += fmt::format("{},", i);
  EXPECT_TRUE(Refuses(Edited("outlier_ratio: [0.0, 0.3]", "num_matches: [" + levels + "]"),
                      {":6:", "too many values; at most 20000 are allowed"}));
}

TEST(ParseStudyErrors, TooManyCombinations) {
  std::string levels;
  for (int i = 1; i <= 400; ++i) levels += fmt::format("{},", i);
  EXPECT_TRUE(Refuses(
      Edited("outlier_ratio: [0.0, 0.3]", "num_matches: [" + levels + "]\n  focal_px: [" + levels + "]"),
      {":6:", "more than 100000 combinations"}));
}

// Equal numbers are one level, however they are written.
TEST(ParseStudyErrors, OneLevelWrittenTwice) {
  EXPECT_TRUE(
      Refuses(Edited("[0.0, 0.3]", "[0.3, 0.0, 0.30]"), {":6:", "outlier_ratio", "'0.30'", "stands twice"}));
  EXPECT_TRUE(Refuses(Edited("[0.0, 0.3]", "[-0, 0]"), {":6:", "'0'", "stands twice"}));
}

// The base of a design of one factor at a time is found among the levels, also in the study that a run
// stores.
TEST(ToYaml, RoundTripOfADesignWhoseNumbersAreNotInTheirShortestForm) {
  std::string yaml = Edited("sigma_px: 0.5}", "outlier_ratio: 0.10}\ndesign: one_at_a_time");
  yaml.replace(yaml.find("[0.0, 0.3]"), 10, "[0.1, 0.30, 5e-1]");
  const Study study = ParseStudy(yaml, "small.yaml");
  const std::vector<std::vector<std::string>> rows = {{"0.1"}, {"0.3"}, {"0.5"}};
  EXPECT_EQ(DesignRows(study), rows);
  EXPECT_EQ(DesignRows(ParseStudy(ToYaml(study), "stored.yaml")), rows);
}

// A factor would replace the value in `data`, except in a one-at-a-time design.
TEST(LoadStudy, RefusesAFactorThatIsAlsoInData) {
  const TempFolder folder;
  const auto write = [&](const std::string& value, const std::string& more = "") {
    return folder.Write("both.yaml", "data:\n  scene: uniform_volume\n  outlier_ratio: " + value +
                                         "\nfactors:\n  outlier_ratio: [0.3, 0.4]\n" +
                                         "estimators: [{name: standard}]\n" + more);
  };
  EXPECT_TRUE(ThrowsInputError([&] { LoadStudy(write("0.1")); },
                               {"both.yaml:5: factors: outlier_ratio is also in data (",
                                "both.yaml:3), where "
                                "'0.1' would have no effect"}));
  EXPECT_NO_THROW(LoadStudy(write("0.3", "design: one_at_a_time\n")));
  const Study study = LoadStudy(write("0.2"));  // the default, which ToYaml writes
  EXPECT_NO_THROW(LoadStudy(folder.Write("written.yaml", ToYaml(study))));
}

TEST(LoadStudy, SaysHowAnEstimatorIsNamed) {
  const auto refuses = [](const std::string& entry, const std::vector<std::string>& fragments) {
    return Refuses("data: {scene: uniform_volume}\nestimators:\n  - " + entry + "\n", fragments);
  };
  EXPECT_TRUE(refuses("rcme_calibrated", {"bad.yaml:3", "write {name: rcme_calibrated}"}));
  EXPECT_TRUE(refuses("rcme_calibratd", {"bad.yaml:3", "did you mean 'rcme_calibrated'?"}));
}

TEST(LoadStudy, KnowsAMatchFile) {
  const TempFolder folder;
  const std::string row = "1,2,3,4\n";
  for (const std::string& text : {MatchHeader() + "x1,y1,x2,y2\n" + row, MatchHeader() + row,
                                  "1 2 3 4\n" + row, std::string("\x1f\x8b\x08")}) {
    const std::string path = folder.Write("matches.csv", text);
    EXPECT_TRUE(ThrowsInputError([&] { LoadStudy(path); },
                                 {"is a match file, not a study; `rcme estimate " + path + "`"}));
  }
}

TEST(LoadStudy, RefusesWhatIsNoFile) {
  const TempFolder folder;
  EXPECT_TRUE(
      ThrowsInputError([&] { LoadStudy(folder.Path("none.yaml")); }, {"none.yaml", "no such study file"}));
  EXPECT_TRUE(ThrowsInputError([&] { LoadStudy(folder.path()); }, {folder.path(), "is a folder"}));
  if (std::filesystem::exists("/dev/zero")) {  // endless
    EXPECT_TRUE(ThrowsInputError([] { LoadStudy("/dev/zero"); }, {"/dev/zero", "is a device"}));
  }
  const std::string path = folder.Write("bad.yaml", Edited("seed: 3", "seed: x"));
  EXPECT_TRUE(ThrowsInputError([&] { LoadStudy(path); }, {path + ":2: seed"}));
  EXPECT_EQ(ToYaml(LoadStudy(folder.Write("small.yaml", SmallStudyYaml()))), ToYaml(SmallStudy()));
}

TEST(Override, DataKey) {
  Study study = SmallStudy();
  Override(&study, "sigma_px", "1.25");
  EXPECT_EQ(Setting(study, "sigma_px"), "1.25");
  Override(&study, "baseline_m", "3");  // a key that the study does not mention
  EXPECT_EQ(Setting(study, "baseline_m"), "3");
  EXPECT_EQ(study.factors.size(), 1u);
}

TEST(Override, FactorBecomesOneLevel) {
  Study study = SmallStudy();
  Override(&study, "outlier_ratio", "0.1");
  EXPECT_TRUE(study.factors.empty());
  EXPECT_EQ(Setting(study, "outlier_ratio"), "0.1");
  EXPECT_EQ(MakePlan(study).conditions.size(), 1u);
}

TEST(Override, OptionOfAllOrOne) {
  Study study = SmallStudy();
  Override(&study, "num_iterations", "33");
  EXPECT_EQ(ReadOption(study.estimators[0], "num_iterations"), "33");
  EXPECT_EQ(ReadOption(study.estimators[1], "num_iterations"), "33");
  Override(&study, "ours.num_iterations", "44");
  EXPECT_EQ(ReadOption(study.estimators[0], "num_iterations"), "33");
  EXPECT_EQ(ReadOption(study.estimators[1], "num_iterations"), "44");
}

TEST(Override, FailureBound) {
  Study study = SmallStudy();
  Override(&study, "max_direction_error_deg", "5");
  EXPECT_EQ(study.failure.max_direction_error_deg, 5.0);
}

// Of rcme_calibrated `sigma` is an option, a word; whoever writes a number means the noise.
TEST(Override, ANumberForSigmaIsTheNoise) {
  Study study = ParseStudy(SmallStudyYaml() + "  - {name: rcme_calibrated}\n", "s.yaml");
  EXPECT_TRUE(ThrowsInputError([&] { Override(&study, "sigma", "1"); },
                               {"sigma: '1'", "estimated, assumed", "(the noise is sigma_px)"}));
  Override(&study, "sigma", "assumed");
  EXPECT_EQ(ReadOption(study.estimators[2], "sigma"), "assumed");
}

TEST(Override, Errors) {
  const auto refuses = [](const std::string& key, const std::string& value,
                          const std::vector<std::string>& fragments) {
    Study study = SmallStudy();
    return ThrowsInputError([&] { Override(&study, key, value); }, fragments);
  };
  EXPECT_TRUE(refuses("sigma", "1", {"'sigma'", "known keys", "sigma_px"}));
  EXPECT_TRUE(refuses("sigma_px", "0", {"sigma_px", "'0'", "a number in [1e-09, 1000]"}));
  EXPECT_TRUE(refuses("sigma_px", "nan", {"sigma_px", "'nan'"}));
  EXPECT_TRUE(refuses("sigma_px", "", {"sigma_px", "''"}));
  EXPECT_TRUE(refuses("num_matches", "1e999", {"num_matches", "whole number"}));
  EXPECT_TRUE(refuses("ours.mu", "x", {"mu", "'x'", "or auto"}));
  EXPECT_TRUE(refuses("theirs.mu", "1", {"--set", "no estimator 'theirs'", "standard, ours"}));
  EXPECT_TRUE(refuses("ours.mus", "1",
                      {"estimator rcme has no option 'mus'", "its options: solver, num_iterations"}));
  EXPECT_TRUE(
      refuses("standard.mu", "1", {"estimator standard has no option 'mu'", "its options", "lambda"}));
  EXPECT_TRUE(refuses("mus", "1", {"'mus'", "options of the estimators: solver, num_iterations", "mu,"}));
  EXPECT_TRUE(refuses("kappa", "2", {"kappa", "'2'", "a number in [0, 1]"}));
  EXPECT_TRUE(refuses("max_rotation_error_deg", "181", {"max_rotation_error_deg", "a number in [0, 180]"}));
  EXPECT_TRUE(refuses("scene", "moon", {"'moon'", "give one of"}));
  Study study = SmallStudy();
  Override(&study, "reading", "as_printed");
  EXPECT_TRUE(ThrowsInputError([&] { Override(&study, "ours.selection", "predictive_likelihood"); },
                               {"selection", "needs reading: rank_aware"}));
}

}  // namespace
}  // namespace rcme
