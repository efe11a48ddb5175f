#include "experiments/data/match_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/data/make_data.h"
#include "experiments/data/match_file.h"
#include "experiments/real/truth_free/pair_set.h"
#include "experiments/statistics/truth_quality.h"
#include "experiments/study/run_description.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/gzip.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/paths.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

const std::string kRealFolder = SourceFolder() + "/../shared/real/dev";

// A folder with two scenes: a (two pairs, one packed) and b (one pair).
class MatchFolderTest : public testing::Test {
 protected:
  MatchFolderTest() {
    const std::string rest = MatchHeader() + TruePoseHeader();
    folder_.Write("a_001.csv", "# scene: a\n" + rest + MatchRows(12, 1));
    folder_.Write("a_000.csv.gz", Gzip("# scene: a\n" + rest + MatchRows(11, 2)));
    folder_.Write("b_000.csv", "# scene: b\n" + MatchHeader() + MatchRows(13, 3));
    folder_.Write("notes.txt", "no match file");
  }
  Study FolderStudy() const {
    return ParseStudy("data: {scene: match_files, folder: '" + folder_.path() +
                          "', sigma_px: 0.7}\nestimators: [{name: standard}]\ntrials: 3\n",
                      "folder.yaml");
  }

  TempFolder folder_;
};

// What summaries print of it.
TEST_F(MatchFolderTest, HowGoodTheTruthIsCountsAndIsSaid) {
  const std::string unknown = Describe(MakePlan(FolderStudy())).identity;
  EXPECT_THAT(DescribeTruthQuality(unknown), testing::HasSubstr("3 of 3 pairs do not say"));
  const std::string rest = MatchHeader() + TruePoseHeader() + "# truth_sd: 0.01 0.01 0.01 1e-3 1e-3 1e-3\n";
  folder_.Write("a_001.csv", "# scene: a\n" + rest + MatchRows(12, 1));
  const StudyPlan plan = MakePlan(FolderStudy());
  EXPECT_THAT(DescribeTruthQuality(Describe(plan).identity), testing::HasSubstr("2 of 3 pairs do not say"));
  EXPECT_NE(Describe(plan).identity, unknown);
  EXPECT_FALSE(plan.conditions[0].source->Make({1, 0, 0, 0}).truth.sd.has_value());
  EXPECT_TRUE(plan.conditions[0].source->Make({1, 0, 1, 0}).truth.sd.has_value());
  EXPECT_EQ(DescribeTruthQuality("a simulation"), "");
  EXPECT_THAT(DescribeTruthQuality("# condition 0: 2 files, digest 00ff, truth_sd in 2\n"),
              testing::HasSubstr("all 2 pairs state"));
}

TEST_F(MatchFolderTest, EachMatchsOwnSigmaIsPassedOnAndPartOfTheIdentity) {
  const std::string text = "# scene: c\n" + MatchHeader() + "x1,y1,x2,y2,sigma_px\n";
  folder_.Write("c_000.csv", text + "1,2,3,4,1\n5,6,7,8,2\n9,1,2,3,4\n");
  const StudyPlan plan = MakePlan(FolderStudy());
  EXPECT_TRUE(plan.conditions[0].source->Make({1, 0, 0, 0}).problem.noise_scale.empty());
  EXPECT_EQ(plan.conditions[2].source->Make({1, 0, 0, 0}).problem.noise_scale,
            (std::vector<double>{0.5, 1.0, 2.0}));
  const std::vector<PairSet> sets = PairSetsOfFolder(folder_.path(), 0.7);
  EXPECT_EQ(sets[2].pairs[0].problem.noise_scale, (std::vector<double>{0.5, 1.0, 2.0}));
  folder_.Write("c_000.csv", text + "1,2,3,4,1\n5,6,7,8,2\n9,1,2,3,3\n");
  EXPECT_NE(Describe(MakePlan(FolderStudy())).identity, Describe(plan).identity);
}

TEST_F(MatchFolderTest, ScoresArePassedOnAndPartOfTheIdentity) {
  const std::string text = "# scene: c\n# better_score: lower\n" + MatchHeader() + "x1,y1,x2,y2,score\n";
  folder_.Write("c_000.csv", text + "1,2,3,4,0.5\n5,6,7,8,0.25\n");
  const StudyPlan plan = MakePlan(FolderStudy());
  EXPECT_TRUE(plan.conditions[0].source->Make({1, 0, 0, 0}).problem.match_quality.empty());
  EXPECT_EQ(plan.conditions[2].source->Make({1, 0, 0, 0}).problem.match_quality,
            (std::vector<double>{-0.5, -0.25}));
  folder_.Write("c_000.csv", text + "1,2,3,4,0.5\n5,6,7,8,0.75\n");
  EXPECT_NE(Describe(MakePlan(FolderStudy())).identity, Describe(plan).identity);
}

// A study without sigma_px takes the noise of each file, and the usual one where a file states none.
TEST_F(MatchFolderTest, TheNoiseOfAFileIsThatOfAStudyWithoutOne) {
  const auto sigmas_of = [](const Study& study) {
    const StudyPlan plan = MakePlan(study);
    const auto sigma_of = [&](std::uint32_t trial) {
      return plan.conditions[0].source->Make({1, 0, trial, 0}).problem.sigma_px;
    };
    return std::vector<double>{sigma_of(0), sigma_of(1)};
  };
  Study study = FolderStudy();
  std::erase_if(study.data, [](const auto& setting) { return setting.first == "sigma_px"; });
  EXPECT_EQ(sigmas_of(study), (std::vector<double>{0.5, 0.5}));
  const std::string before = Describe(MakePlan(study)).identity;
  const std::string rest = MatchHeader() + TruePoseHeader() + MatchRows(12, 1);
  folder_.Write("a_001.csv", "# scene: a\n# sigma_px: 2\n" + rest);
  EXPECT_EQ(sigmas_of(study), (std::vector<double>{0.5, 2.0}));
  EXPECT_EQ(sigmas_of(FolderStudy()), (std::vector<double>{0.7, 0.7}));
  EXPECT_NE(Describe(MakePlan(study)).identity, before);
  EXPECT_EQ(ResolveSettings(study.data), ResolveSettings(ResolveSettings(study.data)));
  Override(&study, "sigma_px", "0.7");
  EXPECT_EQ(sigmas_of(study), (std::vector<double>{0.7, 0.7}));
}

TEST_F(MatchFolderTest, ValidationAssumesOneNoiseForAScene) {
  EXPECT_EQ(PairSetsOfFolder(folder_.path(), {})[0].pairs[0].problem.sigma_px, 0.5);
  const std::string rest = MatchHeader() + TruePoseHeader() + MatchRows(12, 1);
  folder_.Write("a_001.csv", "# scene: a\n# sigma_px: 2\n" + rest);
  EXPECT_TRUE(
      ThrowsInputError([&] { PairSetsOfFolder(folder_.path(), {}); },
                       {"a_001.csv: sigma_px: 2 px differs from none in ", "a_000.csv.gz", "--sigma"}));
  EXPECT_EQ(PairSetsOfFolder(folder_.path(), 0.7)[0].pairs[1].problem.sigma_px, 0.7);
  folder_.Write("a_000.csv.gz", Gzip("# scene: a\n# sigma_px: 2\n" + rest));
  EXPECT_EQ(PairSetsOfFolder(folder_.path(), {})[0].pairs[0].problem.sigma_px, 2.0);
}

// One pair states its error, one has a truth and a baseline; one has no truth.
TEST_F(MatchFolderTest, AStudyMayGiveTheTruthAnError) {
  const std::string known = MatchHeader() + TruePoseHeader();
  const std::string stated = "# truth_sd: 0.01 0.01 0.01 1e-3 1e-3 1e-3\n";
  folder_.Write("a_000.csv.gz", Gzip("# scene: a\n" + known + stated + MatchRows(12, 1)));
  folder_.Write("a_001.csv", "# scene: a\n" + known + "# baseline: 0.5 m\n" + MatchRows(12, 2));
  Study study = FolderStudy();
  study.data.emplace_back("truth_rotation_sd_deg", "0.03");
  study.data.emplace_back("truth_position_sd", "0.012");
  const StudyPlan plan = MakePlan(study);
  const auto sd_of = [&](std::uint32_t trial) {
    return plan.conditions[0].source->Make({1, 0, trial, 0}).truth.sd.value();
  };
  EXPECT_NEAR(sd_of(0).translation.x(), 1e-3, 1e-12);
  EXPECT_NEAR(sd_of(1).rotation_rad.x(), std::sqrt(2.0) * 0.03 * std::numbers::pi / 180.0, 1e-12);
  EXPECT_NEAR(sd_of(1).translation.x(), SdOfMotion({0.03, 0.012}, 0.5).translation.x(), 1e-12);
  EXPECT_THAT(
      DescribeTruthQuality("# condition 0: 2 files, digest 00ff, truth_sd in 1, truth_sd assumed in 1\n"),
      testing::HasSubstr("the study's assumption for 1 of 2 pairs"));

  folder_.Write("a_001.csv", "# scene: a\n" + known + MatchRows(12, 2));
  EXPECT_TRUE(ThrowsInputError([&] { MakePlan(study); }, {"a_001.csv", "baseline", "truth_position_sd"}));
}

TEST_F(MatchFolderTest, GroupsByScene) {
  const StudyPlan plan = MakePlan(FolderStudy());
  EXPECT_EQ(plan.factor_names, std::vector<std::string>{"pair_scene"});
  ASSERT_EQ(plan.conditions.size(), 2u);
  EXPECT_EQ(plan.conditions[0].levels, std::vector<std::string>{"a"});
  EXPECT_EQ(plan.conditions[1].levels, std::vector<std::string>{"b"});
  EXPECT_EQ(plan.conditions[0].num_trials, 6);  // three passes over two pairs
  EXPECT_EQ(plan.conditions[1].num_trials, 3);
  EXPECT_EQ(plan.NumTrials(), 9);
}

TEST_F(MatchFolderTest, TrialsWalkThroughThePairsInTheOrderOfNames) {
  const StudyPlan plan = MakePlan(FolderStudy());
  const auto made = [&](size_t condition, std::uint32_t trial) {
    return plan.conditions[condition].source->Make({1, static_cast<std::uint32_t>(condition), trial, 0});
  };
  EXPECT_EQ(made(0, 0).origin, "a_000.csv.gz");
  EXPECT_EQ(made(0, 0).problem.matches.size(), 11u);
  EXPECT_EQ(made(0, 1).origin, "a_001.csv");
  EXPECT_EQ(made(0, 2).origin, "a_000.csv.gz");
  EXPECT_EQ(made(0, 0).problem.sigma_px, 0.7);
  EXPECT_TRUE(made(0, 0).truth.cam2_from_cam1_true.has_value());
  EXPECT_TRUE(made(0, 0).truth.is_direction_known);
  EXPECT_TRUE(made(0, 0).truth.is_inlier_true.empty());
  EXPECT_FALSE(made(1, 0).truth.cam2_from_cam1_true.has_value());
}

TEST_F(MatchFolderTest, WeakDirectionsOfTheIndex) {
  folder_.Write("INDEX.csv", "pair_id,scene,t_gt_weak,note\na_000,a,1,x\na_001,a,0,y\nb_000,b\n");
  const StudyPlan plan = MakePlan(FolderStudy());
  EXPECT_EQ(plan.conditions.size(), 2u) << "the index was read as a match file";
  EXPECT_FALSE(plan.conditions[0].source->Make({1, 0, 0, 0}).truth.is_direction_known);
  EXPECT_TRUE(plan.conditions[0].source->Make({1, 0, 1, 0}).truth.is_direction_known);
  EXPECT_TRUE(plan.conditions[1].source->Make({1, 1, 0, 0}).truth.is_direction_known);
  folder_.Write("INDEX.csv", "pair_id,t_gt_weak\r\na_000,0\r\na_001,1\r\n");  // Windows line ends
  const StudyPlan again = MakePlan(FolderStudy());
  EXPECT_TRUE(again.conditions[0].source->Make({1, 0, 0, 0}).truth.is_direction_known);
  EXPECT_FALSE(again.conditions[0].source->Make({1, 0, 1, 0}).truth.is_direction_known);
}

TEST_F(MatchFolderTest, TheIndexMayStandAboveTheFolder) {
  const TempFolder above;
  above.Write("INDEX.csv", "pair_id,t_gt_weak\np,1\n");
  std::filesystem::create_directory(above.Path("pairs"));
  above.Write("pairs/p.csv", MatchHeader() + TruePoseHeader() + MatchRows(10));
  for (const std::string name : {"pairs", "pairs/", "pairs/.", "pairs/../pairs"}) {
    const auto sources = LoadMatchFolder({above.Path(name), 0.5});
    EXPECT_FALSE(sources.at(0).second->Make({1, 0, 0, 0}).truth.is_direction_known) << name;
  }
}

TEST_F(MatchFolderTest, AnIndexWithoutTheColumnsSaysNothing) {
  folder_.Write("INDEX.csv", "name,weak\na_000,1\n");
  EXPECT_TRUE(MakePlan(FolderStudy()).conditions[0].source->Make({1, 0, 0, 0}).truth.is_direction_known);
}

TEST_F(MatchFolderTest, IdentityFollowsTheData) {
  const std::string before = MakePlan(FolderStudy()).identity;
  EXPECT_EQ(MakePlan(FolderStudy()).identity, before);
  const std::string text = ReadBytes(folder_.Path("b_000.csv"));
  std::string changed = text;
  const size_t last_digit = changed.find_last_of("0123456789");
  changed[last_digit] = changed[last_digit] == '1' ? '2' : '1';  // the last digit of the last coordinate
  folder_.Write("b_000.csv", changed);
  EXPECT_NE(MakePlan(FolderStudy()).identity, before);
  folder_.Write("b_000.csv", text + "# a comment changes nothing\n");
  EXPECT_EQ(MakePlan(FolderStudy()).identity, before);
  folder_.Write("b_001.csv", text);
  EXPECT_NE(MakePlan(FolderStudy()).identity, before);
}

TEST_F(MatchFolderTest, APairHasTheSameNameInEveryFolder) {
  const std::vector<std::uint64_t> names = MakePlan(FolderStudy()).conditions[0].source->ProblemNames();
  ASSERT_EQ(names.size(), 2u);
  EXPECT_NE(names[0], names[1]);
  const TempFolder other;
  other.Write("renamed.csv", "# scene: z\n" + MatchHeader() + MatchRows(12, 1));
  EXPECT_THAT(LoadMatchFolder({.folder = other.path()})[0].second->ProblemNames(),
              testing::ElementsAre(names[1]));
}

TEST_F(MatchFolderTest, IdentityDoesNotFollowThePath) {
  const TempFolder other;
  std::filesystem::copy(folder_.path(), other.Path("moved"));
  Study moved = FolderStudy();
  Override(&moved, "folder", other.Path("moved"));
  EXPECT_EQ(MakePlan(moved).identity, MakePlan(FolderStudy()).identity);
}

TEST_F(MatchFolderTest, IdentityFollowsTheTruth) {
  const std::string before = MakePlan(FolderStudy()).identity;
  folder_.Write("INDEX.csv", "pair_id,t_gt_weak\na_000,1\n");
  EXPECT_NE(MakePlan(FolderStudy()).identity, before) << "scores change, so the study does";
  std::filesystem::remove(folder_.Path("INDEX.csv"));
  folder_.Write("b_000.csv", "# scene: b\n" + MatchHeader() + TruePoseHeader() + MatchRows(13, 3));
  EXPECT_NE(MakePlan(FolderStudy()).identity, before);
}

TEST_F(MatchFolderTest, Errors) {
  const auto load = [](const std::string& path) { LoadMatchFolder({path, 0.5}); };
  EXPECT_TRUE(ThrowsInputError([&] { load(folder_.Path("none")); }, {"folder", "none", "is not a folder"}));
  EXPECT_TRUE(ThrowsInputError([&] { load(folder_.Path("a_001.csv")); }, {"folder", "is not a folder"}));
  const TempFolder empty;
  EXPECT_TRUE(ThrowsInputError([&] { load(empty.path()); }, {empty.path(), "holds no *.csv"}));
  folder_.Write("c_000.csv", MatchHeader() + "1,2,3,nan\n");
  EXPECT_TRUE(ThrowsInputError([&] { load(folder_.path()); }, {"c_000.csv:5: y2", "'nan'"}));
}

TEST_F(MatchFolderTest, APairInTwoFilesIsRefused) {
  folder_.Write("b_000.csv.gz", Gzip("# scene: b\n" + MatchHeader() + MatchRows(13, 3)));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        LoadMatchFolder({folder_.path(), 0.5});
      },
      {"holds the pair b_000 twice, as b_000.csv and b_000.csv.gz; keep one of them"}));
}

TEST_F(MatchFolderTest, MoreTrialsThanCanBeCounted) {
  Study study = FolderStudy();
  study.trials = 2'000'000'000;
  EXPECT_TRUE(ThrowsInputError([&] { MakePlan(study); }, {"trials", "2000000000 passes over 2 pairs"}));
}

TEST(RealPairs, AreAllRead) {
  if (!std::filesystem::is_directory(kRealFolder))
    GTEST_SKIP() << "the real pairs are not beside the project";
  int num_files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kRealFolder)) {
    const MatchFile file = ReadMatchFile(entry.path().string());
    ++num_files;
    EXPECT_GE(file.matches.size(), 8u) << file.path;
    EXPECT_NE(file.scene, "unnamed") << file.path;
    ASSERT_TRUE(file.cam2_from_cam1_true.has_value()) << file.path;
    const RelativePose& pose = *file.cam2_from_cam1_true;
    EXPECT_LT((pose.R * pose.R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9) << file.path;
    EXPECT_NEAR(pose.R.determinant(), 1.0, 1e-9) << file.path;
    EXPECT_NEAR(pose.t.norm(), 1.0, 1e-12) << file.path;
    for (const Correspondence& match : file.matches) {
      // Undistorted points may lie outside the image, but not far.
      EXPECT_LT(match.x1_px.cwiseAbs().maxCoeff(), 2.0 * file.camera1.width) << file.path;
      EXPECT_LT(match.x2_px.cwiseAbs().maxCoeff(), 2.0 * file.camera2.width) << file.path;
    }
  }
  EXPECT_EQ(num_files, 148);
}

TEST(RealPairs, WeakDirectionsAreThoseOfTheIndex) {
  if (!std::filesystem::is_directory(kRealFolder))
    GTEST_SKIP() << "the real pairs are not beside the project";
  int num_pairs = 0, num_weak = 0;
  for (const auto& [scene, source] : LoadMatchFolder({kRealFolder, 0.5})) {
    for (std::uint32_t trial = 0; trial < static_cast<std::uint32_t>(source->NumTrials(1));
         ++trial, ++num_pairs) {
      num_weak += source->Make({1, 0, trial, 0}).truth.is_direction_known ? 0 : 1;
    }
  }
  EXPECT_EQ(num_pairs, 148);
  EXPECT_EQ(num_weak, 11);  // six of tum_fr1_rpy, five of tum_fr1_xyz
}

}  // namespace
}  // namespace rcme
