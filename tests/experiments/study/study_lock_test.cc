#include "experiments/study/study_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/core/files/sha256.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/paths.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::string LockedStudyYaml() {
  return SmallStudyYaml() +
         "description: |\n  Two lines,\n\n  '#' and \"quotes\": all of it\n"
         "ademp: {aims: a, data: b, estimands: c, methods: d, performance: e}\n"
         "hypotheses:\n"
         "  - {quantity: failure, estimator: ours, against: standard, direction: lower, margin: 0.02}\n";
}

std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class Lock : public testing::Test {
 protected:
  // The deviations of the study with one piece of text in place of another.
  std::vector<std::string> After(const std::string& from, const std::string& to) const {
    const StudyPlan plan = MakePlan(ParseStudy(Replaced(LockedStudyYaml(), from, to), "s.yaml"));
    return DeviationsFrom(lock_, plan.study_yaml, plan.identity, "");
  }

  StudyPlan plan_ = MakePlan(ParseStudy(LockedStudyYaml(), "s.yaml"));
  StudyLock lock_ = MakeLock(plan_);
};

TEST_F(Lock, ComesBackAsItWasWritten) {
  const StudyLock read = ParseLock(ToYaml(lock_), "s.lock");
  EXPECT_EQ(read.text, lock_.text);
  EXPECT_EQ(read.sha256, Sha256(lock_.text));
  EXPECT_EQ(read.locked_at, lock_.locked_at);
  EXPECT_EQ(read.locked_at.size(), std::string("2026-01-31T12:00:00Z").size());
  EXPECT_EQ(read.program, lock_.program);
  for (const char* part : {"aims: a", "seed: 3", "trials: 6", "margin: 0.02", "num_iterations: 20"})
    EXPECT_NE(read.text.find(part), std::string::npos) << part;
  EXPECT_THAT(DeviationsFrom(read, plan_.study_yaml, plan_.identity, ""), IsEmpty());
  EXPECT_EQ(PathOfLockBeside("studies/s.yaml"), "studies/s.lock");
}

// Every character of what is locked counts.
TEST_F(Lock, AChangeOfTheTextIsRefused) {
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"margin: 0.02", "margin: 0.03"},
                                                        {"seed: 3", "seed: 4"},
                                                        {"trials: 6", "trials: 7"},
                                                        {"aims: a", "aims: b"},
                                                        {"quotes", "quote"}}) {
    EXPECT_TRUE(ThrowsInputError(
        [&, &from = from, &to = to] { ParseLock(Replaced(ToYaml(lock_), from, to), "s.lock"); },
        {"s.lock: sha256", "changed after it was made"}))
        << from;
  }
  EXPECT_TRUE(ThrowsInputError([&] { ParseLock("format: rcme lock 0\n", "s.lock"); },
                               {"s.lock: format", "'rcme lock 0'"}));
  EXPECT_TRUE(ThrowsInputError([&] { ParseLock("sha: 1\n", "s.lock"); },
                               {"s.lock:1:", "'sha: 1'", "no line of a lock"}));
}

// The text of a file of today's format never changes: published hashes are of it.
TEST(LockFile, OfFormat1IsStillRead) {
  const std::string yaml = ReadBytes(SourceFolder() + "/tests/fuzz/corpus/lock/format_1.lock");
  const StudyLock lock = ParseLock(yaml, "format_1.lock");
  EXPECT_EQ(lock.sha256, "8bcb1ddf67c34d146582dfa25571a810182dcb7acf049d84f45c660cd19b885e");  // of sha256sum
  EXPECT_EQ(lock.locked_at, "2026-11-26T05:21:43Z");
  EXPECT_EQ(lock.program, "rcme 0.1.0");
  EXPECT_THAT(lock.text, testing::StartsWith("name: locked\ndescription: \"Two lines,\\n\\n'#'"));
  EXPECT_EQ(ToYaml(lock), yaml);
  const WrittenPlan plan = ReadWrittenPlan(lock.text, "format_1.lock");
  EXPECT_EQ(plan.trials, 6);
  ASSERT_EQ(plan.hypotheses.size(), 2u);
  EXPECT_EQ(Describe(plan.hypotheses[1]), "nees_coverage of ours is at least 0.9");
  EXPECT_THAT(plan.hypotheses[0].where,
              ElementsAre(std::pair<std::string, std::string>("outlier_ratio", "0.3")));
  EXPECT_THAT(DeviationsFrom(lock, lock.text, "", ""), IsEmpty());
}

TEST_F(Lock, EachKeyStandsOnceAndSomethingIsLocked) {
  const std::string yaml = ToYaml(lock_);
  for (const std::string key : {"format", "locked_at", "program", "sha256"}) {
    const size_t begin = yaml.find(key + ": "), end = yaml.find('\n', begin) + 1;
    const std::string line = yaml.substr(begin, end - begin);
    EXPECT_TRUE(ThrowsInputError([&] { ParseLock(Replaced(yaml, line, line + line), "s.lock"); },
                                 {"s.lock:", key + " stands twice"}));
    EXPECT_TRUE(ThrowsInputError([&] { ParseLock(Replaced(yaml, line, ""), "s.lock"); }, {"s.lock: " + key}));
  }
  EXPECT_TRUE(ThrowsInputError(
      [] {
        ParseLock(ToYaml({"now", "rcme", Sha256(""), ""}), "s.lock");
      },
      {"s.lock: text is missing"}));
}

// YAML can write what a terminal takes for a command, and further lines, in plain text.
TEST_F(Lock, DeviationsAreLinesOfPlainText) {
  const StudyLock lock{"now", "rcme", "", Replaced(lock_.text, "name: small", "name: \"a\\e[2K\\nb\"")};
  const std::vector<std::string> deviations = DeviationsFrom(lock, plan_.study_yaml, plan_.identity, "");
  EXPECT_THAT(deviations, ElementsAre("name: small instead of a\\x1B[2K\\nb"));
}

TEST_F(Lock, AnAddedEstimatorHidesNoChangeOfAnother) {
  const std::string dotted = Replaced(LockedStudyYaml(), "label: ours", "label: a.b");
  const std::string locked = Replaced(dotted, "estimator: ours", "estimator: a.b");
  const std::string changed = Replaced(locked, "label: a.b, options: {num_iterations: 20",
                                       "label: a.b, options: {num_iterations: 30");
  const StudyLock lock = MakeLock(MakePlan(ParseStudy(locked, "s.yaml")));
  const StudyPlan run = MakePlan(ParseStudy(
      Replaced(changed, "  - {name: standard", "  - {name: msac, label: a}\n  - {name: standard"), "s.yaml"));
  EXPECT_THAT(
      DeviationsFrom(lock, run.study_yaml, run.identity, ""),
      ElementsAre("estimators.a.b.options.num_iterations: 30 instead of 20", "estimator a: was added"));
}

TEST_F(Lock, AKeyThatStandsTwiceIsNamed) {
  const StudyLock lock{"now", "rcme", "", lock_.text + "trials: 7\n"};
  EXPECT_THAT(DeviationsFrom(lock, plan_.study_yaml, plan_.identity, ""),
              ElementsAre("trials: stands twice"));
}

TEST_F(Lock, DeviationsAreNamed) {
  EXPECT_THAT(After("margin: 0.02", "margin: 0.05"),
              ElementsAre("hypotheses.1.margin: 0.05 instead of 0.02"));
  EXPECT_THAT(After("trials: 6", "trials: 60"), ElementsAre("trials: 60 instead of 6"));
  EXPECT_THAT(After("seed: 3", "seed: 4"), ElementsAre("seed: 4 instead of 3"));
  EXPECT_THAT(After("aims: a", "aims: another"), ElementsAre("ademp.aims: another instead of a"));
  EXPECT_THAT(After("sigma_px: 0.5", "sigma_px: 1"), ElementsAre("data.sigma_px: 1 instead of 0.5"));
  EXPECT_THAT(After("[0.0, 0.3]", "[0.0, 0.4]"),
              ElementsAre("factors.outlier_ratio: [0, 0.4] instead of [0, 0.3]"));
  EXPECT_THAT(After("num_iterations: 20}", "num_iterations: 30}"),
              ElementsAre("estimators.standard.options.num_iterations: 30 instead of 20"));
  EXPECT_THAT(After("  - {name: standard", "  - {name: msac}\n  - {name: standard"),
              ElementsAre("estimator msac: was added"));
  EXPECT_THAT(After("factors:\n  outlier_ratio: [0.0, 0.3]\n", ""),
              testing::Contains("factors.outlier_ratio: left out; the lock says [0, 0.3]"));
  EXPECT_THAT(After("seed: 3", "seed: 3\nrepeats_per_scene: 2"),
              ElementsAre("repeats_per_scene: 2, of which the lock says nothing"));
  EXPECT_THAT(DeviationsFrom(lock_, plan_.study_yaml, plan_.identity, "--until ci=0.1"),
              ElementsAre("trials: as many as a stopping rule gave (--until ci=0.1)"));
}

TEST_F(Lock, WhatItStatesIsReadWithoutTheProgramsEstimators) {
  const WrittenPlan plan = ReadWrittenPlan(Replaced(lock_.text, "name: rcme", "name: theirs"), "s.lock");
  EXPECT_EQ(plan.trials, 6);
  ASSERT_EQ(plan.hypotheses.size(), 1u);
  EXPECT_EQ(plan.hypotheses[0].bound, 0.02);
  EXPECT_TRUE(ThrowsInputError([] { ReadWrittenPlan("[1, 2]\n", "s.lock"); }, {"s.lock"}));
  EXPECT_TRUE(ThrowsInputError([] { ReadWrittenPlan("name: x\n", "s.lock"); }, {"s.lock"}));
}

TEST(JoinReasons, EachOnce) {
  EXPECT_EQ(JoinReasons("", ""), "");
  EXPECT_EQ(JoinReasons("a\nb", "b"), "a\nb");
  EXPECT_EQ(JoinReasons("a", "b"), "a\nb");
  std::string many;  // in the square of their number they would take minutes
  for (int i = 0; i < 100'000; ++i) many += std::to_string(i) + "\n";
  EXPECT_EQ(JoinReasons(many, many) + "\n", many);
}

}  // namespace
}  // namespace rcme
