// Loops of images against all loops there are, and what motions around them close to: by hand and by Monte
// Carlo over simulated networks.
#include "experiments/real/truth_free/closure.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <bit>
#include <deque>
#include <map>

#include "estimator/robust_covariance/clustered_covariance.h"
#include "experiments/real/truth_free/loops.h"
#include "tests/test_support/fit_all_matches.h"
#include "tests/test_support/numeric_jacobian.h"

namespace rcme {
namespace {

NamedPair Pair(const std::string& image1, const std::string& image2) { return {"", image1, image2, {}}; }

// From image to image along a loop; the last is the first again.
std::vector<std::string> ImagesAlong(const Loop& loop, const std::vector<NamedPair>& pairs) {
  std::vector<std::string> images;
  for (const auto& [pair, is_forward] : loop) {
    const std::string &from = is_forward ? pairs[pair].image1 : pairs[pair].image2,
                      &to = is_forward ? pairs[pair].image2 : pairs[pair].image1;
    if (images.empty()) images.push_back(from);
    EXPECT_EQ(images.back(), from);
    images.push_back(to);
  }
  return images;
}

TEST(FindLoops, ByHand) {
  const std::vector<NamedPair> pairs = {Pair("1", "2"), Pair("2", "3"), Pair("3", "1"), Pair("3", "4"),
                                        Pair("5", "4"), Pair("5", "6"), Pair("3", "6"), Pair("2", "1"),
                                        Pair("", ""),   Pair("", "2"),  Pair("6", "7"), Pair("7", "7")};
  const std::vector<Loop> loops = FindLoops(pairs);  // 1 2 3 and 3 4 5 6
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_EQ(loops[0].size(), 3u);
  EXPECT_EQ(loops[1].size(), 4u);
  for (const Loop& loop : loops) {
    const std::vector<std::string> images = ImagesAlong(loop, pairs);
    EXPECT_EQ(images.front(), images.back());
    EXPECT_EQ(std::set<std::string>(images.begin(), images.end()).size(), loop.size());
  }
  EXPECT_EQ(FindLoops(pairs, 3).size(), 1u);
  std::vector<NamedPair> ring;
  for (int i = 0; i < 7; ++i) ring.push_back(Pair(std::to_string(i), std::to_string((i + 1) % 7)));
  EXPECT_TRUE(FindLoops(ring).empty());
  ring.push_back(Pair("0", "2"));
  EXPECT_EQ(FindLoops(ring).size(), 2u);  // of three and of six
}

// Lengths of a shortest basis of the loops of at most six images, from all of these: sets of pairs as bits.
std::vector<size_t> LengthsByBruteForce(const std::vector<NamedPair>& pairs, int num_images) {
  std::set<std::uint64_t> all;
  const auto walk = [&](const auto& self, int first, int at, std::uint64_t visited,
                        std::uint64_t taken) -> void {
    for (size_t i = 0; i < pairs.size(); ++i) {
      const int a = std::stoi(pairs[i].image1), b = std::stoi(pairs[i].image2);
      if ((taken >> i & 1) || (a != at && b != at)) continue;
      const int to = a == at ? b : a;
      const std::uint64_t with = taken | std::uint64_t{1} << i;
      if (to == first && std::popcount(with) >= 3) all.insert(with);
      if ((visited >> to & 1) || to < first || std::popcount(with) >= 6) continue;
      self(self, first, to, visited | std::uint64_t{1} << to, with);
    }
  };
  for (int image = 0; image < num_images; ++image) walk(walk, image, image, std::uint64_t{1} << image, 0);
  std::vector<std::uint64_t> ordered(all.begin(), all.end());
  std::ranges::stable_sort(ordered, {}, [](std::uint64_t loop) { return std::popcount(loop); });
  const auto highest = [](std::uint64_t loop) { return 63 - std::countl_zero(loop); };
  std::map<int, std::uint64_t> with_highest;
  std::vector<size_t> lengths;
  for (std::uint64_t rest : ordered) {
    const auto length = static_cast<size_t>(std::popcount(rest));
    while (rest && with_highest.contains(highest(rest))) rest ^= with_highest[highest(rest)];
    if (!rest) continue;
    with_highest[highest(rest)] = rest;
    lengths.push_back(length);
  }
  return lengths;
}

TEST(FindLoops, IsAShortestBasis) {
  RandomStream rng({.seed = 1, .purpose = 98});
  for (int network = 0; network < 60; ++network) {
    const int num_images = 4 + static_cast<int>(rng.IntegerBelow(9));
    const double share = rng.Uniform(0.1, 0.6);
    std::vector<NamedPair> pairs;
    for (int a = 0; a < num_images; ++a) {
      for (int b = a + 1; b < num_images; ++b) {
        if (rng.Uniform() >= share || pairs.size() == 60) continue;
        const bool is_turned = rng.Uniform() < 0.5;
        pairs.push_back(Pair(std::to_string(is_turned ? b : a), std::to_string(is_turned ? a : b)));
      }
    }
    std::vector<size_t> lengths;
    for (const Loop& loop : FindLoops(pairs)) lengths.push_back(loop.size());
    EXPECT_EQ(lengths, LengthsByBruteForce(pairs, num_images)) << "network " << network;
  }
}

// Images around a cloud of points, whose key points have one error each; pairs of every image with the next
// and of the last with the first, each fitted with intrinsics whose focal length is off.
struct Network {
  std::deque<NamedPair> pairs;
  std::deque<MotionEstimate> answers;
  std::vector<AnsweredStep> loop;
};
Network MakeNetwork(int num_images, double focal_error, std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 70});
  const Camera camera{600.0, 600.0, 319.5, 239.5, 640, 480};
  Camera assumed = camera;
  assumed.fx = assumed.fy = camera.fx * (1.0 + focal_error);
  const std::vector<Eigen::Vector3d> turns = {{0, 0, 0},
                                              {0.02, 0.05, -0.03},
                                              {-0.03, 0.09, 0.02},
                                              {0.05, -0.04, 0.05}},
                                     moves = {{0, 0, 0}, {0.5, 0.1, 0.0}, {0.9, -0.2, 0.2}, {0.3, -0.5, 0.1}};
  const auto n = static_cast<size_t>(num_images);
  std::vector<std::vector<Eigen::Vector2d>> points;
  while (points.size() < 150) {
    const double z = rng.Uniform(3.0, 9.0);
    const Eigen::Vector3d X(z * rng.Uniform(-0.5, 0.5), z * rng.Uniform(-0.4, 0.4), z);
    points.emplace_back();
    for (size_t image = 0; image < n; ++image) {
      const double dx = rng.Normal(), dy = rng.Normal();
      points.back().push_back(camera.Project(RotationFromVector(turns[image]) * X + moves[image]) +
                              0.3 * Eigen::Vector2d(dx, dy));
    }
  }
  Network network;
  for (size_t i = 0; i < n; ++i) {
    // The last pair of three goes the other way.
    const bool is_forward = !(n == 3 && i == 2);
    const size_t a = is_forward ? i : (i + 1) % n, b = is_forward ? (i + 1) % n : i;
    NamedPair pair{"", std::to_string(a), std::to_string(b), {{}, assumed, assumed, 0.3}};
    for (const auto& x : points) pair.problem.matches.push_back({x[a], x[b]});
    const Eigen::Matrix3d R = RotationFromVector(turns[b]) * RotationFromVector(turns[a]).transpose();
    network.answers.push_back(FitAllMatches(pair.problem, {R, (moves[b] - R * moves[a]).normalized()}));
    network.pairs.push_back(std::move(pair));
    network.loop.push_back({&network.pairs.back(), &network.answers.back(), is_forward});
  }
  return network;
}

// dc = R_ab' w_ab + R_ac' (w_bc - w_ac) of a triple whose last pair goes from a to c; exact motions close.
TEST(RotationClosure, MovesWithTheRotationsAsByHand) {
  MotionEstimate ab, bc, ac;
  ab.cam2_from_cam1.R = RotationFromVector({0.1, -0.3, 0.2});
  bc.cam2_from_cam1.R = RotationFromVector({-0.2, 0.1, 0.3});
  ac.cam2_from_cam1.R = bc.cam2_from_cam1.R * ab.cam2_from_cam1.R;
  const std::vector<AnsweredStep> loop = {{nullptr, &ab}, {nullptr, &bc}, {nullptr, &ac, false}};
  EXPECT_LT(RotationClosure(loop).norm(), 1e-12);
  const Eigen::Matrix3d to_ab = ab.cam2_from_cam1.R.transpose(), to_bc = ac.cam2_from_cam1.R.transpose();
  const Eigen::Vector3d w(1e-6, -2e-6, 3e-6);
  for (const auto& [moved, M] :
       {std::pair<MotionEstimate*, Eigen::Matrix3d>{&ab, to_ab}, {&bc, to_bc}, {&ac, -to_bc}}) {
    const Eigen::Matrix3d R = moved->cam2_from_cam1.R;
    moved->cam2_from_cam1.R = RotationFromVector(w) * R;
    EXPECT_LT((Eigen::Vector3d(RotationClosure(loop)) - M * w).norm(), 1e-10);
    moved->cam2_from_cam1.R = R;
  }
}

TEST(DirectionClosure, IsZeroOfThreeExactMotions) {
  const Eigen::Vector3d t_b(0.5, 0.1, 0.0), t_c(0.9, -0.2, 0.2);
  const Eigen::Matrix3d R_b = RotationFromVector({0.02, 0.5, -0.03}),
                        R_c = RotationFromVector({-0.3, 0.09, 0.2});
  MotionEstimate ab, cb, ca;  // two of the pairs against the way
  ab.cam2_from_cam1 = {R_b, t_b.normalized()};
  const Eigen::Matrix3d R_cb = R_b * R_c.transpose();
  cb.cam2_from_cam1 = {R_cb, (t_b - R_cb * t_c).normalized()};
  ca.cam2_from_cam1 = {R_c.transpose(), (-R_c.transpose() * t_c).normalized()};
  const std::vector<AnsweredStep> loop = {{nullptr, &ab}, {nullptr, &cb, false}, {nullptr, &ca}};
  EXPECT_LT(std::abs(DirectionClosure(loop)(0)), 1e-12);
  ca.cam2_from_cam1.t = RotationFromVector({0.1, 0.2, 0.0}) * ca.cam2_from_cam1.t;
  EXPECT_GT(std::abs(DirectionClosure(loop)(0)), 1e-3);
}

// Mean of the normalised closures of 150 networks over their degrees of freedom. Its standard error is
// sqrt(2 / dof / 150): four of it.
double MeanClosure(int num_images, LoopErrorOf error_of, double focal_error, bool hides_shared = false) {
  constexpr int kTrials = 150;
  double sum = 0.0;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    Network network = MakeNetwork(num_images, focal_error, trial);
    if (hides_shared) {  // the last pair's key points look like others
      for (Correspondence& match : network.pairs.back().problem.matches)
        match.x1_px.x() += 1e-9, match.x2_px.x() += 1e-9;
    }
    const LoopError none = LoopError::Zero(error_of(network.loop).size());
    const std::optional<double> closure = NormalizedClosure(network.loop, error_of, none);
    EXPECT_TRUE(closure.has_value());
    sum += closure.value_or(0.0) / static_cast<double>(none.size());
  }
  return sum / kTrials;
}

TEST(NormalizedClosure, HasOneVarianceWhereKeyPointsAreShared) {
  const double of_three = MeanClosure(3, RotationClosure, 0.0),
               of_four = MeanClosure(4, RotationClosure, 0.0);
  EXPECT_NEAR(of_three, 1.0, 4.0 * 0.067);
  EXPECT_NEAR(of_four, 1.0, 4.0 * 0.067);
  EXPECT_NEAR(MeanClosure(3, DirectionClosure, 0.0), 1.0, 4.0 * 0.115);
  EXPECT_LT(MeanClosure(3, RotationClosure, 0.0, true), 0.95 * of_three);
}

// One focal length 4 % too long in all pairs: what halves of a pair share, a ring of four images shows.
TEST(NormalizedClosure, FindsAnErrorThatAllPairsShare) {
  EXPECT_GT(MeanClosure(4, RotationClosure, 0.04), 1.0 + 8.0 * 0.067);
}

// What the loop itself closes to is no error, and a third of it leaves two thirds: the form is quadratic.
TEST(NormalizedClosure, IsAboutWhatIsExpected) {
  const Network network = MakeNetwork(4, 0.04, 1);
  const LoopError closes_to = RotationClosure(network.loop);
  const auto about = [&](double share) {
    return *NormalizedClosure(network.loop, RotationClosure, LoopError(share * closes_to));
  };
  ASSERT_GT(about(0.0), 0.1);
  EXPECT_NEAR(about(1.0), 0.0, 1e-12);
  EXPECT_NEAR(about(1.0 / 3.0), 4.0 / 9.0 * about(0.0), 1e-9 * about(0.0));
}

// Sigma = L_0 (L_i^-1 V_c L_i^-T) L_0' of the header written out, of three pairs of 12 matches each, where a
// match has a leverage of 5 / 12: G_k by differences of the rotations alone, the moves G A^-1 J' r / (1 - h).
TEST(NormalizedClosure, IsThatOfTheHeader) {
  Network network = MakeNetwork(3, 0.0, 4);
  for (size_t i = 0; i < 3; ++i) {
    network.pairs[i].problem.matches.resize(12);
    network.answers[i].inliers.resize(12);
  }
  Eigen::Matrix3d sigma0 = Eigen::Matrix3d::Zero(), of_single = sigma0, of_shared = sigma0;
  std::vector<Eigen::Vector3d> sums(12, Eigen::Vector3d::Zero());  // every point is seen by all three pairs
  for (size_t k = 0; k < 3; ++k) {
    const RelativePose pose = network.answers[k].cam2_from_cam1;
    Eigen::Matrix<double, 3, 5> G;
    for (Eigen::Index j = 0; j < 5; ++j) {
      const auto closure_at = [&](double by) {
        network.answers[k].cam2_from_cam1 = Retract(pose, by * Vector5d::Unit(j));
        return Eigen::Vector3d(RotationClosure(network.loop));
      };
      G.col(j) = (closure_at(1e-5) - closure_at(-1e-5)) / 2e-5;
    }
    network.answers[k].cam2_from_cam1 = pose;
    sigma0 += G * network.answers[k].pose_cov * G.transpose();
    const MatchScores scores = ScoreFitted(network.pairs[k].problem, network.answers[k].inliers, pose);
    const Matrix5d inverse = scores.information.inverse();
    for (size_t i = 0; i < 12; ++i) {
      const double kept = std::max(1.0 - scores.rows[i].dot(inverse * scores.rows[i]), 0.05);
      const Eigen::Vector3d move = G * inverse * scores.rows[i] * (scores.residuals[i] / kept);
      of_single += move * move.transpose();
      sums[i] += move;
    }
  }
  for (const Eigen::Vector3d& sum : sums) of_shared += sum * sum.transpose();
  const Eigen::Matrix3d L0 = sigma0.llt().matrixL(), Li = of_single.llt().matrixL();
  const Eigen::Matrix3d sigma = L0 * (Li.inverse() * of_shared * Li.inverse().transpose()) * L0.transpose();
  const Eigen::Vector3d c = RotationClosure(network.loop);
  const double expected = c.dot(sigma.inverse() * c);
  EXPECT_NEAR(*NormalizedClosure(network.loop, RotationClosure, LoopError(Eigen::Vector3d::Zero())), expected,
              1e-4 * expected);
}

// Answers to the pairs of a network whose twins are the pairs again: these close to what is their truth.
std::vector<PairAnswers> NetworkAnswers(const Network& network) {
  std::vector<PairAnswers> answers;
  for (size_t i = 0; i < network.pairs.size(); ++i) {
    const Answered answered{network.pairs[i], network.answers[i]};
    answers.push_back({answered, {answered, answered}});
  }
  return answers;
}
std::vector<Loop> MakeLoops(const Network& network) {
  Loop loop;
  for (size_t i = 0; i < network.loop.size(); ++i) loop.push_back({i, network.loop[i].is_forward});
  return {loop};
}

TEST(ComputeClosures, AreOfTwinsAboutTheirOwnTruth) {
  const Network network = MakeNetwork(3, 0.0, 2);
  for (const LoopErrorOf error_of : {RotationClosure, DirectionClosure}) {
    const std::vector<UnitValues> closures =
        ComputeClosures(NetworkAnswers(network), MakeLoops(network), error_of);
    ASSERT_EQ(closures.size(), 1u);
    const LoopError none = LoopError::Zero(error_of(network.loop).size());
    ASSERT_EQ(closures[0].observed.size(), 1u);
    EXPECT_EQ(closures[0].observed[0], *NormalizedClosure(network.loop, error_of, none));
    ASSERT_EQ(closures[0].null.size(), 2u);
    for (const double closure : closures[0].null) EXPECT_NEAR(closure, 0.0, 1e-12);
  }
}

TEST(ComputeClosures, AreOfLoopsThatAreAnswered) {
  const Network three = MakeNetwork(3, 0.0, 2), four = MakeNetwork(4, 0.0, 2);
  EXPECT_EQ(ComputeClosures(NetworkAnswers(four), MakeLoops(four), RotationClosure).size(), 1u);
  EXPECT_EQ(ComputeClosures(NetworkAnswers(four), MakeLoops(four), DirectionClosure).size(), 0u);
  std::vector<PairAnswers> answers = NetworkAnswers(three);
  answers[1].twins[0].estimate.status = MotionStatus::kNoCandidate;
  EXPECT_EQ(ComputeClosures(answers, MakeLoops(three), RotationClosure)[0].null.size(), 1u);
  answers[1].whole.estimate.status = MotionStatus::kNoCandidate;
  EXPECT_EQ(ComputeClosures(answers, MakeLoops(three), RotationClosure).size(), 0u);
}

}  // namespace
}  // namespace rcme
