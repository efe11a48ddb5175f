#include "experiments/study/estimator_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/study/study_file.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/paths.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

std::string TunedFileYaml() {
  return "# comments\n"
         "name: rcme\n"
         "label: rcme_tuned\n"
         "options:\n"
         "  reading: rank_aware\n"
         "  mu: 5.25\n"
         "  lambda: 0.6\n"
         "provenance: {study: tune_mu_lambda, seed: 1, verified: \"3 of 400: 0.0075 [0.0015, 0.0218]\"}\n";
}

std::string EditedFile(const std::string& from, const std::string& to) {
  std::string yaml = TunedFileYaml();
  const size_t at = yaml.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return yaml.replace(at, from.size(), to);
}

testing::AssertionResult RefusesFile(const std::string& yaml, std::vector<std::string> fragments) {
  fragments.push_back("bad.yaml:");
  return ThrowsInputError([&] { ParseEstimatorFile(yaml, "bad.yaml"); }, fragments);
}

void ExpectSame(const EstimatorSpec& a, const EstimatorSpec& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.label, b.label);
  EXPECT_EQ(a.options, b.options);
}

TEST(ParseEstimatorFile, ReadsEveryPart) {
  const EstimatorSpec spec = ParseEstimatorFile(TunedFileYaml(), "tuned.yaml");
  EXPECT_EQ(spec.name, "rcme");
  EXPECT_EQ(spec.label, "rcme_tuned");
  EXPECT_EQ(ReadOption(spec, "reading"), "rank_aware");
  EXPECT_EQ(ReadOption(spec, "mu"), "5.25");
  EXPECT_EQ(ReadOption(spec, "lambda"), "0.6");
  EXPECT_EQ(ReadOption(spec, "num_iterations"), "200");
}

TEST(ParseEstimatorFile, FillsInWhatIsLeftOut) {
  const EstimatorSpec spec = ParseEstimatorFile("name: prcme\n", "short.yaml");
  EXPECT_EQ(spec.label, "prcme");
  EXPECT_EQ(ReadOption(spec, "mu"), "auto");
}

TEST(ParseEstimatorFileErrors, NameLineKeyAndWhatIsAllowed) {
  EXPECT_TRUE(RefusesFile(EditedFile("label:", "lable:"),
                          {":3:", "'lable'", "label, name, options, process, provenance"}));
  EXPECT_TRUE(RefusesFile(EditedFile("label: rcme_tuned", "name: rcme"), {":3:", "'name'", "twice"}));
  EXPECT_TRUE(
      RefusesFile(EditedFile("label: rcme_tuned", "label: [a]"), {":3:", "label", "one value is needed"}));
  EXPECT_TRUE(RefusesFile(EditedFile("name: rcme", "name: magsac"), {"'magsac'", "standard, prcme, rcme"}));
  EXPECT_TRUE(RefusesFile(EditedFile("name: rcme\n", ""), {"estimator: key 'name' is missing"}));
  EXPECT_TRUE(RefusesFile(EditedFile("mu: 5.25", "mus: 5.25"),
                          {":6:", "estimator rcme has no option 'mus'", "its options", "lambda"}));
  EXPECT_TRUE(RefusesFile(EditedFile("mu: 5.25", "mu: .nan"),
                          {":6:", "mu", "'.nan'", "a number in [-1000, 1000] or auto"}));
  EXPECT_TRUE(RefusesFile("name: standard\noptions:\n  mu: 1\n",
                          {":3:", "estimator standard has no option 'mu'", "its options", "lambda"}));
  EXPECT_TRUE(RefusesFile(EditedFile("lambda: 0.6", "mu: 1"), {":7:", "'mu'", "twice"}));
  EXPECT_TRUE(RefusesFile(EditedFile("seed: 1", "seed: [1]"), {":8:", "seed", "one value is needed"}));
  EXPECT_TRUE(RefusesFile("name: rcme\nprovenance: tuned\n", {":2:", "provenance", "a map"}));
  EXPECT_TRUE(RefusesFile("name: rcme\noptions: {selection: predictive_likelihood}\n",
                          {":1:", "selection", "needs reading: rank_aware"}));
  // One step only: a file names no other file.
  EXPECT_TRUE(RefusesFile("file: other.yaml\n", {":1:", "'file'", "known keys"}));
}

TEST(ParseEstimatorFileErrors, WhatIsNoEstimator) {
  EXPECT_TRUE(RefusesFile("", {":1:", "estimator", "a map"}));
  EXPECT_TRUE(RefusesFile("- {name: rcme}\n", {":1:", "estimator", "a map"}));
  EXPECT_TRUE(RefusesFile(SmallStudyYaml(), {":2:", "unknown key 'seed'"}));
  EXPECT_TRUE(RefusesFile("name: [rcme\n", {"not valid YAML"}));
  EXPECT_TRUE(RefusesFile("name: rcme\n---\nname: rcme\n", {"more than one YAML document"}));
  EXPECT_TRUE(RefusesFile("options: " + std::string(100'000, '['), {"deeper than 20 levels"}));
  EXPECT_TRUE(
      RefusesFile("name: rcme\n#" + std::string(2'000'000, 'x'), {"larger than an estimator file can be"}));
}

TEST(LoadEstimatorFile, RefusesWhatIsNoFile) {
  const TempFolder folder;
  const auto refuses = [](const std::string& path, const std::vector<std::string>& fragments) {
    return ThrowsInputError([&] { LoadEstimatorFile(path); }, fragments);
  };
  EXPECT_TRUE(refuses(folder.Path("none.yaml"), {"none.yaml", "no such estimator file"}));
  EXPECT_TRUE(refuses(folder.path(), {folder.path(), "is a folder"}));
  EXPECT_TRUE(refuses(folder.Path(std::string(5000, 'n')), {"no such estimator file"}));
  EXPECT_TRUE(refuses("", {"''", "the path of an estimator file"}));
  if (std::filesystem::exists("/dev/zero")) {  // endless
    EXPECT_TRUE(refuses("/dev/zero", {"/dev/zero: is a device, not an estimator file"}));
  }
  const std::string path = folder.Write("bad.yaml", EditedFile("lambda: 0.6", "lambda: 2"));
  EXPECT_TRUE(refuses(path, {path + ":7: lambda", "'2'", "a number in [0, 1]"}));
}

TEST(EstimatorFileText, RoundTrip) {
  const EstimatorSpec spec = ParseEstimatorFile(TunedFileYaml(), "tuned.yaml");
  const std::string text = EstimatorFileText(spec, {{"study", "tune_mu_lambda"}, {"seed", "1"}});
  ExpectSame(ParseEstimatorFile(text, "again.yaml"), spec);
  EXPECT_TRUE(text.starts_with("# "));
  // How to use it, every option with its value, and where it comes from.
  for (const char* part : {"{file: tuned.yaml}", "--add-estimator tuned.yaml", "--estimator-file tuned.yaml",
                           "  mu: 5.25\n", "  kappa: 0.5\n", "  study: tune_mu_lambda\n", "  seed: 1\n"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " is missing in: " << text;
  }
  ExpectSame(ParseEstimatorFile(EstimatorFileText(spec, {}), "again.yaml"), spec);
}

TEST(EstimatorFileText, RoundTripOfAwkwardText) {
  EstimatorSpec spec = ParseEstimatorFile(TunedFileYaml(), "tuned.yaml");
  const std::vector<std::string> texts = {
      "a: b; \"c\" #d \xC3\xA4 - e", "~", "", " x", "1.0", "{a: b}", "---"};
  Provenance provenance;
  for (const std::string& text : texts) provenance.emplace_back("key " + text, text + "\n- two lines");
  for (const std::string& text : texts) {
    spec.label = text.empty() ? "null" : text;
    ExpectSame(ParseEstimatorFile(EstimatorFileText(spec, provenance), "again.yaml"), spec);
  }
}

// A study in a folder, with these entries as its list of estimators, beside a tuned file.
class EstimatorFileInStudy : public testing::Test {
 protected:
  std::string Yaml(const std::string& entries) const {
    return "data: {scene: uniform_volume}\nestimators:\n" + entries;
  }
  Study Load(const std::string& entries) const {
    return LoadStudy(folder_.Write("study.yaml", Yaml(entries)));
  }
  testing::AssertionResult RefusesStudy(const std::string& entries,
                                        std::vector<std::string> fragments) const {
    fragments.push_back(folder_.Path("study.yaml:"));
    return ThrowsInputError([&] { Load(entries); }, fragments);
  }

  const TempFolder folder_;
  const std::string file_ = folder_.Write("tuned.yaml", TunedFileYaml());
  const EstimatorSpec tuned_ = ParseEstimatorFile(TunedFileYaml(), "tuned.yaml");
};

TEST_F(EstimatorFileInStudy, IsReadFromTheStudysFolder) {
  const Study study =
      Load("  - {name: standard}\n  - {file: tuned.yaml}\n  - {file: tuned.yaml, label: other}\n");
  ASSERT_EQ(study.estimators.size(), 3u);
  ExpectSame(study.estimators[1], tuned_);
  EstimatorSpec other = tuned_;
  other.label = "other";
  ExpectSame(study.estimators[2], other);
  ExpectSame(Load("  - {file: " + file_ + "}\n").estimators[0], tuned_);  // an absolute path
}

TEST_F(EstimatorFileInStudy, IsWrittenOutWithTheStudy) {
  const std::string text = ToYaml(Load("  - {file: tuned.yaml}\n"));
  EXPECT_EQ(text.find("file"), std::string::npos) << text;
  EXPECT_NE(text.find("mu: 5.25"), std::string::npos) << text;
  std::filesystem::remove(file_);
  ExpectSame(ParseStudy(text, "again.yaml").estimators[0], tuned_);
}

TEST_F(EstimatorFileInStudy, ItsContentMayBePasted) {
  const Study study = Load(
      "  - {name: rcme, label: rcme_tuned, options: {reading: rank_aware, mu: 5.25, lambda: 0.6}, "
      "provenance: {study: tune_mu_lambda, seed: 1}}\n");
  ExpectSame(study.estimators[0], tuned_);
  EXPECT_EQ(ToYaml(study), ToYaml(Load("  - {file: tuned.yaml}\n"))) << "the provenance changes the study";
  EXPECT_TRUE(RefusesStudy("  - {name: rcme, provenance: tuned}\n", {":3:", "provenance", "a map"}));
}

TEST_F(EstimatorFileInStudy, Errors) {
  EXPECT_TRUE(RefusesStudy("  - {file: none.yaml}\n", {":3:", "none.yaml", "no such estimator file"}));
  EXPECT_TRUE(RefusesStudy("  - {file: ''}\n", {":3:", "file", "is a folder"}));
  EXPECT_TRUE(RefusesStudy("  - {file: [tuned.yaml]}\n", {":3:", "file", "one value is needed"}));
  EXPECT_TRUE(RefusesStudy("  - {file: study.yaml}\n", {":3:", "study.yaml:1:", "unknown key 'data'"}));
  EXPECT_TRUE(RefusesStudy("  - {file: tuned.yaml, options: {mu: 1}}\n",
                           {":3:", "unknown key 'options'", "file, label"}));
  EXPECT_TRUE(RefusesStudy("  - {file: tuned.yaml}\n  - {file: tuned.yaml}\n",
                           {":4:", "label 'rcme_tuned'", "twice"}));
  folder_.Write("tuned.yaml", EditedFile("lambda: 0.6", "lambda: 2"));
  EXPECT_TRUE(RefusesStudy("  - {name: standard}\n  - {file: tuned.yaml}\n",
                           {"study.yaml:4:", "tuned.yaml:7: lambda", "'2'", "a number in [0, 1]"}));
}

// Those that come with the project.
}  // namespace
}  // namespace rcme
