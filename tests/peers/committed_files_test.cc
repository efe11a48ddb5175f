// The studies and estimator files of the project, in the program that has all its estimators.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "experiments/study/estimator_file.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"
#include "tests/peers/peer_entries.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/paths.h"

namespace rcme {
namespace {

bool IsKnown(const std::string& name) {
  return std::ranges::count(PeerEntries(), name, &EstimatorEntry::name) > 0;
}

// Where CMake did not find PoseLib, its files are refused as any other of an unknown estimator.
TEST(EstimatorFile, EveryFileOfTheProjectIsValid) {
  ASSERT_TRUE(IsKnown("opencv_usac"));
  int num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SourceFolder() + "/estimator_files")) {
    const std::string path = entry.path().string();
    const std::string stem = entry.path().stem().string();
    const bool needs_gravity = stem == "poselib_gravity";  // PoseLib 3
    if (stem.starts_with("poselib") && !IsKnown(needs_gravity ? stem : "poselib")) {
      EXPECT_THROW(LoadEstimatorFile(path), InputError);
    } else {
      EXPECT_NO_THROW(LoadEstimatorFile(path)) << path;
    }
    ++num_files;
  }
  EXPECT_GE(num_files, 4);
}

std::vector<std::string> StudiesIn(const std::string& folder) {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(SourceFolder() + folder)) {
    if (entry.path().extension() == ".yaml") paths.push_back(entry.path().string());
  }
  return paths;
}

void ExpectRoundTrip(const std::string& path) {
  Study study = LoadStudy(path);
  const std::string text = ToYaml(study);
  EXPECT_EQ(ToYaml(ParseStudy(text, "again.yaml")), text) << path;
  EXPECT_FALSE(study.description.empty()) << path;
  ASSERT_TRUE(study.ademp) << path;
  for (const auto& [key, part] : Parts(*study.ademp)) EXPECT_FALSE(part->empty()) << path << ": " << key;
}

TEST(ToYaml, RoundTripOfTheCommittedStudies) {
  ASSERT_TRUE(IsKnown("opencv_usac"));
  for (const auto& [folder, num_at_least] :
       {std::pair("/studies", 20u), std::pair("/studies/calibrated", 16u)}) {
    const std::vector<std::string> studies = StudiesIn(folder);
    for (const std::string& path : studies) ExpectRoundTrip(path);
    EXPECT_GE(studies.size(), num_at_least);
  }
}

// These have PoseLib's estimator in them: without it nothing but that is wrong with them.
TEST(ToYaml, RoundTripOfTheCommittedStudiesWithPoseLib) {
  std::vector<std::string> studies = StudiesIn("/studies/equal_time");
  EXPECT_GE(studies.size(), 16u);
  std::ranges::copy(StudiesIn("/studies/with_poselib"), std::back_inserter(studies));
  for (const std::string& path : studies) {
    if (IsKnown("poselib")) {
      ExpectRoundTrip(path);
    } else {
      EXPECT_TRUE(ThrowsInputError([&] { LoadStudy(path); }, {"unknown estimator 'poselib'"})) << path;
    }
  }
  if (!IsKnown("poselib")) GTEST_SKIP() << "PoseLib was not found by CMake: read up to its estimator alone";
}

}  // namespace
}  // namespace rcme
