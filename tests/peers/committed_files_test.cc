// The studies and estimator files of the project, in the program that has all its estimators.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "experiments/study/estimator_file.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"
#include "tests/peers/peer_entries.h"
#include "tests/test_support/paths.h"

namespace rcme {
namespace {

bool IsKnown(const std::string& name) {
  return std::ranges::count(PeerEntries(), name, &EstimatorEntry::name) > 0;
}

// Where CMake did not find PoseLib, its file is refused as any other of an unknown estimator.
TEST(EstimatorFile, EveryFileOfTheProjectIsValid) {
  ASSERT_TRUE(IsKnown("opencv_usac"));
  int num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SourceFolder() + "/experiments/estimators")) {
    const std::string path = entry.path().string();
    if (entry.path().stem() == "poselib" && !IsKnown("poselib")) {
      EXPECT_THROW(LoadEstimatorFile(path), InputError);
    } else {
      EXPECT_NO_THROW(LoadEstimatorFile(path)) << path;
    }
    ++num_files;
  }
  EXPECT_GE(num_files, 4);
}

TEST(ToYaml, RoundTripOfTheCommittedStudies) {
  ASSERT_TRUE(IsKnown("opencv_usac"));
  int num_studies = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SourceFolder() + "/experiments/studies")) {
    if (entry.path().extension() != ".yaml") continue;
    const Study study = LoadStudy(entry.path().string());
    const std::string text = ToYaml(study);
    EXPECT_EQ(ToYaml(ParseStudy(text, "again.yaml")), text) << entry.path();
    EXPECT_FALSE(study.description.empty()) << entry.path();
    ++num_studies;
  }
  EXPECT_GE(num_studies, 20);
}

}  // namespace
}  // namespace rcme
