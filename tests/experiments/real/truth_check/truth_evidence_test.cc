// The check of a truth on simulated pairs, whose truth is known: how often right ones are in doubt, and how
// often wrong ones.
#include "experiments/real/truth_check/truth_evidence.h"

#include <gtest/gtest.h>

#include "estimator/estimator_registry.h"
#include "experiments/data/make_data.h"
#include "stats/constants.h"

namespace rcme {
namespace {

RelativePose Turned(const RelativePose& pose, double angle_deg, std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 91});
  const Eigen::Vector3d axis(rng.Normal(), rng.Normal(), rng.Normal());
  Vector5d move = Vector5d::Zero();
  move.head<3>() = angle_deg * kRadPerDeg * axis.normalized();
  return Retract(pose, move);
}

struct Verdicts {
  int in_doubt = 0, holds = 0, silent = 0;
};

// Of `n` pairs whose truths are turned by so much.
Verdicts Check(const Settings& settings, double turned_deg, int n, const FailureBounds& bounds = {},
               const std::optional<TruthSd>& sd = std::nullopt) {
  static const std::unique_ptr<MotionEstimator> estimator = MakeEstimator("rcme_calibrated");
  const std::shared_ptr<const SimulatedData> data = MakeSimulatedData(settings);
  Verdicts verdicts;
  for (std::uint32_t trial = 0; trial < static_cast<std::uint32_t>(n); ++trial) {
    const TrialData pair = data->Make({1, 0, trial, 0});
    const GivenTruth truth{Turned(*pair.truth.cam2_from_cam1_true, turned_deg, trial), sd};
    const TruthVerdict verdict = WeighTruth(pair.problem, truth, bounds, *estimator, 1).verdict;
    verdicts.in_doubt += verdict == TruthVerdict::kInDoubt;
    verdicts.holds += verdict == TruthVerdict::kHolds;
    verdicts.silent += verdict == TruthVerdict::kSilent;
  }
  return verdicts;
}

Settings Family(const std::string& scene, const std::string& wrong_share, const Settings& more = {}) {
  Settings settings = {{"scene", scene}, {"num_matches", "500"}, {"outlier_ratio", wrong_share}};
  settings.insert(settings.end(), more.begin(), more.end());
  return settings;
}

// Volumes, rooms, planes, far points, an object that moves, texture that repeats itself, matches that are
// nearly all wrong. 8 x 30 pairs without a doubt: at a rate of 1 % there would be one with probability .91.
TEST(WeighTruth, ARightTruthIsNotInDoubt) {
  const std::vector<Settings> families = {
      Family("uniform_volume", "0.3"),
      Family("room", "0.6"),
      Family("plane", "0.3"),
      Family("two_planes", "0.3"),
      Family("far_points", "0.3"),
      Family("room", "0.7", {{"outliers", "moving_object"}, {"object_size_m", "1"}}),
      Family("lattice", "0.6", {{"outliers", "repeated_texture"}}),
      Family("room", "0.95")};
  int num_in_doubt = 0;
  for (const Settings& family : families) num_in_doubt += Check(family, 0.0, 30).in_doubt;
  EXPECT_EQ(num_in_doubt, 0);
}

TEST(WeighTruth, AWrongTruthIsInDoubt) {
  for (const char* scene : {"uniform_volume", "plane", "two_planes", "far_points"}) {
    EXPECT_GE(Check(Family(scene, "0.3"), 10.0, 20).in_doubt, 17) << scene;
    EXPECT_GE(Check(Family(scene, "0.3"), 30.0, 20).in_doubt, 18) << scene;
  }
}

// The inverse of the motion explains more matches than chance does, but another motion still more. Without
// that comparison it holds for 13 of 20 pairs of either scene.
TEST(WeighTruth, AnInverseTruthDoesNotHold) {
  const std::unique_ptr<MotionEstimator> estimator = MakeEstimator("rcme_calibrated");
  for (const Settings& scene :
       {Settings{{"scene", "image_region"}, {"region", "half"}},
        Settings{{"scene", "image_clusters"}, {"num_clusters", "3"}, {"cluster_spread_px", "60"}}}) {
    Settings settings = scene;
    for (const auto& [key, value] :
         Settings{{"motion", "orbit"}, {"orbit_deg", "10"}, {"num_matches", "150"}, {"outlier_ratio", "0.3"}})
      settings.emplace_back(key, value);
    const std::shared_ptr<const SimulatedData> data = MakeSimulatedData(settings);
    int num_holds = 0;
    for (std::uint32_t trial = 0; trial < 20; ++trial) {
      const TrialData pair = data->Make({1, 0, trial, 0});
      const RelativePose truth = *pair.truth.cam2_from_cam1_true;
      const GivenTruth inverse{{truth.R.transpose(), -(truth.R.transpose() * truth.t)}, {}};
      num_holds += WeighTruth(pair.problem, inverse, {}, *estimator, 1).verdict == TruthVerdict::kHolds;
    }
    EXPECT_LE(num_holds, 2) << scene[0].second;
  }
}

// Within the bounds no motion is a failure: nothing is in doubt. What a file states narrows the reach.
TEST(WeighTruth, HowFarOffATruthHasToBeDependsOnWhatIsKnownOfIt) {
  const Settings room = Family("uniform_volume", "0.3");
  EXPECT_EQ(Check(room, 2.5, 20).in_doubt, 0);
  const TruthSd sd{Eigen::Vector3d::Constant(0.05 * kRadPerDeg), Eigen::Vector3d::Constant(0.01)};
  EXPECT_GE(Check(room, 3.0, 20, {0.5, 2.0}, sd).in_doubt, 17);
  EXPECT_EQ(Check(room, 0.0, 20, {0.5, 2.0}, sd).in_doubt, 0);
}

TEST(WeighTruth, MatchesThatSayNothingAreSilent) {
  const Verdicts verdicts = Check(Family("room", "0.98", {{"num_matches", "60"}}), 30.0, 20);
  EXPECT_EQ(verdicts.in_doubt, 0);
  EXPECT_GE(verdicts.silent, 18);
}

// Matches of two motions, each of one or the other by the toss of a coin: McNemar's test rejects at .01 in
// at most that share. Of 400 pairs more than 11 have probability .001.
TEST(CompareWithTruth, ItsTestKeepsItsLevelWhereBothMotionsExplainAsMuch) {
  const std::shared_ptr<const SimulatedData> data = MakeSimulatedData(Family("uniform_volume", "0"));
  int num_rejected = 0, num_blocks_rejected = 0;
  for (std::uint32_t trial = 0; trial < 400; ++trial) {
    const TrialData pair = data->Make({1, 0, trial, 0});
    const RelativePose truth = *pair.truth.cam2_from_cam1_true, other = Turned(truth, 25.0, trial);
    const Eigen::Matrix3d back = other.R * truth.R.transpose();
    MotionProblem problem = pair.problem;
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 92});
    for (Correspondence& match : problem.matches) {
      if (rng.Uniform() < 0.5) continue;
      // X2' = R' R^-1 X2 has the motion (R', R' R^-1 t).
      const Eigen::Vector3d ray = back * problem.camera2.Ray(match.x2_px);
      if (ray.z() > 0.0) match.x2_px = problem.camera2.Project(ray);
    }
    const TruthContest contest =
        CompareWithTruth(problem, {truth, TruthSd{}}, {3.0, 15.0}, {other.R, back * truth.t});
    num_rejected += contest.p_matches <= kTruthDoubtLevel;
    num_blocks_rejected += contest.p_blocks <= kTruthDoubtLevel;
  }
  EXPECT_LE(num_rejected, 11);
  EXPECT_LE(num_blocks_rejected, 11);
}

// A second motion of most matches, all in one half of the image: the matches would reject the truth, the
// blocks and those that stand up for it do not.
TEST(CompareWithTruth, APatchIsNotTheImage) {
  const TrialData pair = MakeSimulatedData(Family("uniform_volume", "0"))->Make({1, 0, 0, 0});
  const RelativePose truth = *pair.truth.cam2_from_cam1_true;
  const Eigen::Matrix3d turn = RotationFromVector({0.0, 0.2, 0.0});
  MotionProblem problem = pair.problem;
  std::erase_if(problem.matches, [&, i = 0](const Correspondence& match) mutable {
    return match.x1_px.x() < 0.5 * problem.camera1.width && ++i % 3 != 0;
  });
  for (Correspondence& match : problem.matches) {
    if (match.x1_px.x() < 0.5 * problem.camera1.width) continue;
    match.x2_px = problem.camera2.Project(turn * problem.camera2.Ray(match.x2_px));
  }
  const TruthContest contest =
      CompareWithTruth(problem, {truth}, {3.0, 15.0}, {turn * truth.R, turn * truth.t});
  EXPECT_LE(contest.p_matches, 1e-6);
  EXPECT_GT(contest.p_blocks, kTruthDoubtLevel);
  EXPECT_LE(contest.p_above_chance, 1e-6);
  EXPECT_LE(contest.p_least_block, kTruthDoubtLevel);
  EXPECT_FALSE(contest.SpeaksAgainstTruth(kTruthDoubtLevel));
}

TEST(IsInWhiteSquare, HalvesShareNoSquareOfTheImage) {
  MotionProblem problem;
  problem.camera1 = problem.camera2 = {500.0, 500.0, 119.5, 59.5, 240, 120};
  for (const double x_px : {-0.5, 5.0, 19.4, 19.6, 239.0})
    problem.matches.push_back({{x_px, 3.0}, {x_px, 3.0}});
  EXPECT_EQ(IsInWhiteSquare(problem), (std::vector<bool>{true, true, true, false, false}));
}

TEST(JudgeTruth, AFrontEndThatHoldsOutweighsOthersAndSilenceSaysNothing) {
  const auto judge = [](std::vector<TruthVerdict> said) {
    std::vector<FrontEndEvidence> front_ends;
    for (const TruthVerdict verdict : said) {
      front_ends.emplace_back().verdict = verdict;
      front_ends.back().p_value = verdict == TruthVerdict::kInDoubt ? 1e-4 : 1.0;
    }
    return JudgeTruth(front_ends);
  };
  using enum TruthVerdict;
  EXPECT_EQ(judge({}).verdict, kSilent);
  EXPECT_EQ(judge({kSilent, kSilent}).verdict, kSilent);
  EXPECT_EQ(judge({kInDoubt, kSilent}).verdict, kInDoubt);
  EXPECT_DOUBLE_EQ(judge({kInDoubt, kSilent}).p_value, 2e-4);  // Bonferroni
  EXPECT_EQ(judge({kHolds, kInDoubt}).verdict, kHolds);
  EXPECT_EQ(judge({kInDoubt, kHolds}).verdict, kHolds);
  EXPECT_EQ(judge({kInDoubt, kInDoubt}).verdict, kInDoubt);
}

}  // namespace
}  // namespace rcme
