#include "experiments/data/simulated_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "estimator/geometry/essential_matrix.h"
#include "experiments/data/make_data.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

const StreamName kSequenceName{1, 0, 0, 0};

std::vector<SequencePair> MakeSequence(int num_images, const Settings& more) {
  Settings settings = {{"scene", "uniform_volume"}, {"motion", "orbit"}, {"num_matches", "200"}};
  settings.insert(settings.end(), more.begin(), more.end());
  return SimulateSequence(*MakeSimulatedData(settings), kSequenceName, num_images);
}

const SequencePair& FindPair(const std::vector<SequencePair>& pairs, int image1, int image2) {
  for (const SequencePair& pair : pairs) {
    if (pair.image1 == image1 && pair.image2 == image2) return pair;
  }
  throw std::out_of_range("no such pair");
}

const RelativePose& TruePose(const SequencePair& pair) { return *pair.data.truth.cam2_from_cam1_true; }

// Images in a row and each with the first; rotations close, and the same motion is repeated.
TEST(SimulateSequence, RepeatsTheMotion) {
  const std::vector<SequencePair> pairs = MakeSequence(5, {});
  ASSERT_EQ(pairs.size(), 7u);
  const RelativePose& step = TruePose(FindPair(pairs, 0, 1));
  Eigen::Matrix3d R = step.R;
  for (int image = 2; image < 5; ++image) {
    EXPECT_LT((TruePose(FindPair(pairs, image - 1, image)).R - step.R).norm(), 1e-12);
    EXPECT_LT((TruePose(FindPair(pairs, image - 1, image)).t - step.t).norm(), 1e-12);
    R = step.R * R;
    EXPECT_LT((TruePose(FindPair(pairs, 0, image)).R - R).norm(), 1e-12);
  }
  // An orbit keeps its distance: chords of one and two steps are b and 2 b cos(a / 2), a the step's angle.
  const double half = 0.5 * RotationAngleBetween(step.R, Eigen::Matrix3d::Identity());
  const Eigen::Vector3d two_steps = step.R * step.t + step.t;
  EXPECT_NEAR(two_steps.norm(), 2.0 * std::cos(half), 1e-9);
  EXPECT_LT((TruePose(FindPair(pairs, 0, 2)).t - two_steps.normalized()).norm(), 1e-9);
}

// Without noise every match fits the true motion.
TEST(SimulateSequence, MatchesFitTheTrueMotion) {
  for (const SequencePair& pair : MakeSequence(6, {{"sigma_px", "1e-9"}, {"outlier_ratio", "0.2"}})) {
    const MotionProblem& problem = pair.data.problem;
    const Eigen::Matrix3d E = EssentialFromPose(TruePose(pair));
    EXPECT_GE(problem.matches.size(), kLeastSequencePoints);
    size_t num_right = 0;
    for (size_t i = 0; i < problem.matches.size(); ++i) {
      if (!pair.data.truth.is_inlier_true[i]) continue;
      ++num_right;
      const Eigen::Vector3d ray1 = problem.camera1.Ray(problem.matches[i].x1_px),
                            ray2 = problem.camera2.Ray(problem.matches[i].x2_px);
      EXPECT_LT(std::abs(ray2.dot(E * ray1)), 1e-7);
    }
    EXPECT_NEAR(static_cast<double>(num_right), 0.8 * static_cast<double>(problem.matches.size()), 1.0);
  }
}

// Key points of the first image, where two or more of its four pairs find them: each has one place. With an
// error drawn for every pair no two places would be equal.
TEST(SimulateSequence, AKeyPointHasOneErrorInAllItsPairs) {
  std::map<std::pair<double, double>, int> num_pairs;
  size_t num_matches = 0;
  for (const SequencePair& pair : MakeSequence(5, {{"outlier_ratio", "0"}})) {
    if (pair.image1 != 0) continue;
    for (const Correspondence& match : pair.data.problem.matches) {
      ++num_pairs[{match.x1_px.x(), match.x1_px.y()}];
      ++num_matches;
    }
  }
  EXPECT_LE(num_pairs.size(), 200u);
  EXPECT_GT(num_matches, 400u);
}

// Beside an all but noiseless sequence the errors have the standard deviation of the noise, in both images.
TEST(SimulateSequence, ErrorsAreThoseOfTheNoise) {
  const std::vector<SequencePair> exact = MakeSequence(3, {{"sigma_px", "1e-9"}, {"outlier_ratio", "0"}}),
                                  noisy = MakeSequence(3, {{"sigma_px", "0.5"}, {"outlier_ratio", "0"}});
  for (size_t k = 0; k < 3; ++k) {
    double squares1 = 0.0, squares2 = 0.0;
    const std::vector<Correspondence>&a = exact[k].data.problem.matches, &b = noisy[k].data.problem.matches;
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i) {
      squares1 += (a[i].x1_px - b[i].x1_px).squaredNorm();
      squares2 += (a[i].x2_px - b[i].x2_px).squaredNorm();
    }
    const double n = 2.0 * static_cast<double>(a.size());
    EXPECT_NEAR(squares1 / n, 0.25, 4.0 * 0.25 * std::sqrt(2.0 / n));
    EXPECT_NEAR(squares2 / n, 0.25, 4.0 * 0.25 * std::sqrt(2.0 / n));
  }
}

TEST(SimulateSequence, RefusesWhatHasNoOneErrorForAKeyPoint) {
  EXPECT_THROW(MakeSequence(3, {{"noise", "laplace"}}), InputError);
  EXPECT_THROW(MakeSequence(3, {{"rolling_shutter", "0.1"}}), InputError);
}

}  // namespace
}  // namespace rcme
