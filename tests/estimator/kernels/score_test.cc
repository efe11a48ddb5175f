// Scans against the scalar tests of point_consistency.h, and the printed one against 50 digits, on every
// instruction set.
//
// The singular set of the printed test: the 4x4 covariance Q of the constraint's gradient, whose eigenvalues
// span many decades (a motion that is known, a point far outside the images: 1e12 and more), and the Schur
// complement that follows lose eps times their condition; g -> 0 takes the digits of g itself. There the
// closed form of the kernel is the better one: against 50 digits its d2 is off by at most 5e-6 at coordinates
// of 1e6 px where the scalar test is off by 0.16, and by 4e-3 against 0.07 at a covariance of zero. Elsewhere
// (10,000 matches under random motions and under samples' own) the kernel stays below 7e-10 and the scalar
// test below 9e-10.
#include "estimator/kernels/score.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <functional>
#include <limits>

#include "estimator/point_consistency.h"
#include "estimator/ransac_loop.h"
#include "estimator/reference_search.h"
#include "estimator/sample_consistency.h"
#include "estimator/solvers/eight_point.h"
#include "stats/constants.h"
#include "tests/test_support/every_target.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

class ScoreTest : public OnEveryTarget {};

// Matches with noise, a third of them wrong, and a motion with a covariance like that of thirty matches.
struct ScoredProblem {
  MotionProblem problem;
  RelativePose pose;
  Matrix5d pose_cov;

  UncertainFundamental Scalar() const {
    return UncertainFundamental::From(pose, pose_cov, problem.camera1, problem.camera2).value();
  }
};

ScoredProblem MakeScoredProblem(int num_matches, std::uint32_t trial, double spread_rad = 0.01) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2630});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = num_matches});
  AddNoise(0.5, rng, &random.problem);
  for (int i = 0; i < num_matches; i += 3) {
    random.problem.matches[static_cast<size_t>(i)].x2_px << rng.Uniform(0.0, 799.0), rng.Uniform(0.0, 599.0);
  }
  Matrix5d root;
  for (double& x : root.reshaped()) x = spread_rad * rng.Normal();
  return {random.problem, random.pose_true, root * root.transpose()};
}

// One match as an oracle sees it.
struct Expected {
  double d2, spread, tolerance;  // spread: det Sigma_delta / sigma^8 or s2 / sigma^2; tolerance: relative
};

// Rounding of g over g.
double LossOfConstraint(const Eigen::Matrix3d& F, const Correspondence& match) {
  const Eigen::Vector3d x1 = match.x1_px.homogeneous(), x2 = match.x2_px.homogeneous();
  return kEpsilon * x2.cwiseAbs().dot(F.cwiseAbs() * x1.cwiseAbs()) / std::abs(x2.dot(F * x1));
}

using Wide = boost::multiprecision::cpp_bin_float_50;

// g = x2' F x1 and its gradient j.
Wide WideConstraint(const double* F, const std::array<Wide, 4>& x, std::array<Wide, 4>* j) {
  *j = {F[0] * x[2] + F[3] * x[3] + F[6], F[1] * x[2] + F[4] * x[3] + F[7], F[0] * x[0] + F[1] * x[1] + F[2],
        F[3] * x[0] + F[4] * x[1] + F[5]};
  return x[2] * (*j)[2] + x[3] * (*j)[3] + F[6] * x[0] + F[7] * x[1] + F[8];
}

// cov(j, g) = [[Q, a], [a', D]] at a match, unit noise, with j and g themselves.
struct WideSpread {
  std::array<Wide, 4> j, a{};
  std::array<std::array<Wide, 4>, 4> Q{};
  Wide g, D, n2;

  WideSpread(const WhitenedModel& model, const std::array<Wide, 4>& x) {
    g = WideConstraint(model.F, x, &j);
    const double* F = model.F;
    const double H[4][4] = {{0, 0, F[0], F[3]}, {0, 0, F[1], F[4]}, {F[0], F[1], 0, 0}, {F[3], F[4], 0, 0}};
    for (size_t i = 0; i < 4; ++i) n2 += j[i] * j[i];
    D = n2;
    for (size_t r = 0; r < 4; ++r) {
      for (size_t c = 0; c < 4; ++c) {
        a[r] += H[r][c] * j[c];
        for (size_t k = 0; k < 4; ++k) Q[r][c] += Wide(H[r][k]) * H[c][k];
      }
    }
    for (const auto& dF : model.dF) AddDerivative(dF, x);
  }
  void AddDerivative(const double* dF, const std::array<Wide, 4>& x) {
    std::array<Wide, 4> j_k;
    const Wide g_k = WideConstraint(dF, x, &j_k);
    D += g_k * g_k;
    for (size_t r = 0; r < 4; ++r) {
      a[r] += g_k * j_k[r];
      for (size_t c = 0; c < 4; ++c) Q[r][c] += j_k[r] * j_k[c];
    }
  }
  // Of Q scaled to a unit diagonal.
  double Condition() const {
    Eigen::Matrix4d scaled;
    for (size_t r = 0; r < 4; ++r) {
      for (size_t c = 0; c < 4; ++c) {
        scaled(static_cast<int>(r), static_cast<int>(c)) =
            static_cast<double>(Wide(Q[r][c] / sqrt(Wide(Q[r][r] * Q[c][c]))));
      }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> eigen(scaled);
    return eigen.eigenvalues()(3) / std::max(eigen.eigenvalues()(0), kEpsilon);
  }
};

// The printed test by its definition: S = n2^2 P Sigma_delta P of point_consistency.cc, eliminated with 50
// digits, d2 = g^2 j'S^-1 j, det Sigma_delta = det S / n2^8. The tolerance is what double precision must
// lose: of Q, and of the difference D - a'Q^-1 a, which d2 divides by.
Expected PrintedByDefinition(const WhitenedModel& model, const MatchBlocks& matches, int match) {
  const MatchBlock& block = matches[match / kBlockSize];
  const int lane = match % kBlockSize;
  const WideSpread w(model, {block.x1[lane], block.y1[lane], block.x2[lane], block.y2[lane]});
  Wide S[4][4], y[4], form = 0, determinant = 1;
  for (size_t r = 0; r < 4; ++r) {
    y[r] = w.j[r];
    for (size_t c = 0; c < 4; ++c) {
      S[r][c] = w.g * w.g * w.Q[r][c] - w.g * (w.a[r] * w.j[c] + w.j[r] * w.a[c]) + w.D * w.j[r] * w.j[c];
    }
  }
  for (size_t k = 0; k < 4; ++k) {
    determinant *= S[k][k] / (w.n2 * w.n2);
    form += y[k] * y[k] / S[k][k];
    for (size_t r = k + 1; r < 4; ++r) {
      const Wide factor = S[r][k] / S[k][k];
      y[r] -= factor * y[k];
      for (size_t c = k; c < 4; ++c) S[r][c] -= factor * S[k][c];
    }
  }
  const double loss = kEpsilon * w.Condition() * (1.0 + static_cast<double>(Wide(w.D * form)));
  return {static_cast<double>(Wide(w.g * w.g * form)), static_cast<double>(determinant),
          1e-11 + 100.0 * loss};
}

// Tells whether and with what spread a scan takes a match, threshold by threshold.
using ScanOnce = std::function<void(double threshold, InlierScan*)>;

// At the threshold just above a match's d2 it is an inlier, just below it is not; at an infinite threshold
// all are, with the right spreads.
void ExpectScan(const MatchBlocks& matches, const ScanOnce& scan_once,
                const std::vector<Expected>& expected) {
  InlierScan scan(matches);
  for (size_t i = 0; i < expected.size(); ++i) {
    const auto [d2, spread, tolerance] = expected[i];
    if (tolerance > 1e-3) continue;
    for (const bool is_above : {true, false}) {
      scan_once(d2 * (is_above ? 1.0 + tolerance : 1.0 - tolerance), &scan);
      EXPECT_EQ(scan.inliers[i / 8] >> (i % 8) & 1, is_above) << "match " << i << ", tolerance " << tolerance;
    }
  }
  scan_once(kInfinity, &scan);
  ASSERT_EQ(scan.inliers, matches.All());
  ASSERT_EQ(scan.num_inliers, static_cast<int>(expected.size()));
  for (size_t i = 0; i < expected.size(); ++i) {
    if (std::isnan(expected[i].spread)) continue;
    EXPECT_LE(std::abs(scan.spreads[i] / expected[i].spread - 1.0), 10.0 * expected[i].tolerance) << i;
  }
}

template <typename PointTest>
std::vector<Expected> ComputeExpected(const ScoredProblem& c, const PointTest& test) {
  const UncertainFundamental model = c.Scalar();
  std::vector<Expected> expected;
  for (const Correspondence& match : c.problem.matches) {
    PointResidual residual;
    const double d2 = test.Distance(match, &residual);
    const double spread = std::is_same_v<PointTest, RankAwareTest>
                              ? std::exp(residual.log_det_cov) / (c.problem.sigma_px * c.problem.sigma_px)
                              : std::nan("");
    expected.push_back({d2, spread, 1e-11 + 100.0 * LossOfConstraint(model.F, match)});
  }
  return expected;
}

// By definition; and away from the singular set the scalar test says the same.
std::vector<Expected> ExpectedAsPrinted(const ScoredProblem& c) {
  const MatchBlocks matches(c.problem);
  const WhitenedModel model = WhitenedModel::From(matches, c.pose, c.pose_cov).value();
  const AsPrintedTest test(c.Scalar(), c.problem.sigma_px);
  std::vector<Expected> expected;
  for (int i = 0; i < matches.num_matches(); ++i) {
    const Correspondence& match = c.problem.matches[static_cast<size_t>(i)];
    const Expected e = PrintedByDefinition(model, matches, i);
    expected.push_back(e);
    expected.back().tolerance += 100.0 * LossOfConstraint(c.Scalar().F, match);
    if (e.tolerance > 1e-9) continue;
    PointResidual residual;
    EXPECT_NEAR(test.Distance(match, &residual) / e.d2, 1.0, 1e-9) << i;
    EXPECT_NEAR(residual.log_det_cov - 8.0 * std::log(c.problem.sigma_px), std::log(e.spread), 1e-9) << i;
  }
  return expected;
}

void ExpectKnownPose(const ScoredProblem& c) {
  const MatchBlocks matches(c.problem);
  double F[9];
  WriteRowMajor(matches.FundamentalFromEssential(EssentialFromPose(c.pose)), F);
  ExpectScan(
      matches, [&](double threshold, InlierScan* scan) { ScanKnownPose(matches, F, threshold, scan); },
      ComputeExpected(c, KnownPoseTest(c.Scalar().F, c.problem.sigma_px)));
}
void ExpectAsPrinted(const ScoredProblem& c) {
  const MatchBlocks matches(c.problem);
  const WhitenedModel model = WhitenedModel::From(matches, c.pose, c.pose_cov).value();
  ExpectScan(
      matches, [&](double threshold, InlierScan* scan) { ScanAsPrinted(matches, model, threshold, scan); },
      ExpectedAsPrinted(c));
}
void ExpectRankAware(const ScoredProblem& c) {
  const MatchBlocks matches(c.problem);
  const WhitenedModel model = WhitenedModel::From(matches, c.pose, c.pose_cov).value();
  const VariancePolynomial variance(model.dF);
  ExpectScan(
      matches,
      [&](double threshold, InlierScan* scan) { ScanRankAware(matches, model.F, variance, threshold, scan); },
      ComputeExpected(c, RankAwareTest(c.Scalar(), c.problem.sigma_px)));
}

TEST_F(ScoreTest, ScansAreTheScalarTestsForAnyNumberOfMatches) {
  Run([] {
    for (int n = 1; n <= 17; ++n) {
      SCOPED_TRACE(n);
      const ScoredProblem c = MakeScoredProblem(n, static_cast<std::uint32_t>(n));
      ExpectKnownPose(c);
      ExpectAsPrinted(c);
      ExpectRankAware(c);
    }
  });
}

TEST_F(ScoreTest, TolerancesAreBelow1e9AwayFromTheSingularSet) {
  // Else the tests above would test little: nearly all matches are held to 1e-9.
  int num_sharp = 0, num = 0;
  for (std::uint32_t trial = 1; trial <= 17; ++trial) {
    const ScoredProblem c = MakeScoredProblem(17, trial);
    for (const Expected& e : ExpectedAsPrinted(c)) {
      num_sharp += e.tolerance < 1e-9 ? 1 : 0;
      ++num;
    }
  }
  EXPECT_GT(num_sharp, 9 * num / 10) << "of " << num;
}

TEST_F(ScoreTest, ScansTakeHugeCoordinates) {
  Run([] {
    ScoredProblem c = MakeScoredProblem(12, 100);
    RandomStream rng({.seed = 1, .purpose = 2631});
    for (size_t i = 0; i < 12; i += 2) {
      c.problem.matches[i].x1_px *= 1e6 / 300.0 * rng.Uniform();
      if (i % 4 == 0) c.problem.matches[i].x2_px *= -1e6 / 300.0 * rng.Uniform();
    }
    ExpectKnownPose(c);
    ExpectAsPrinted(c);
    ExpectRankAware(c);
  });
}

TEST_F(ScoreTest, ACovarianceOfZeroLeavesTheKnownPose) {
  Run([] {
    const ScoredProblem c = MakeScoredProblem(13, 101, 0.0);
    ExpectRankAware(c);
    // Q is regular only by the point's own noise; H has rank 4 where F's upper left 2x2 is regular.
    ExpectAsPrinted(c);
    const MatchBlocks matches(c.problem);
    const WhitenedModel model = WhitenedModel::From(matches, c.pose, c.pose_cov).value();
    InlierScan known(matches), aware(matches);
    ScanKnownPose(matches, model.F, 3.84, &known);
    ScanRankAware(matches, model.F, VariancePolynomial(model.dF), 3.84, &aware);
    EXPECT_EQ(known.inliers, aware.inliers);
    EXPECT_GT(aware.num_inliers, 4);
    EXPECT_LT(aware.num_inliers, 13);
    for (int i = 0; i < aware.num_inliers; ++i) EXPECT_EQ(aware.spreads[static_cast<size_t>(i)], 1.0);
  });
}

TEST_F(ScoreTest, AnInvalidCovarianceGivesNoModel) {
  const ScoredProblem c = MakeScoredProblem(8, 102);
  const MatchBlocks matches(c.problem);
  Matrix5d bad = c.pose_cov;
  bad(2, 2) = std::nan("");
  EXPECT_FALSE(WhitenedModel::From(matches, c.pose, bad));
  EXPECT_FALSE(WhitenedModel::From(matches, c.pose, -c.pose_cov));
}

TEST_F(ScoreTest, EntropiesAreSummarisedAsOneByOne) {
  RandomStream rng({.seed = 1, .purpose = 2632});
  const ScoredProblem c = MakeScoredProblem(8, 103);
  for (const int count : {0, 1, 2, 3, 7, 8, 9, 511, 512, 513, 519, 520, 521, 2000}) {
    std::vector<double> spreads(static_cast<size_t>(count + 8),
                                std::nan(""));  // what lies beyond is not read
    for (int i = 0; i < count; ++i) spreads[static_cast<size_t>(i)] = std::exp(3.0 * rng.Normal() - 40.0);
    InlierScore expected;
    const double offset = -1.25;
    for (int i = 0; i < count; ++i) {
      expected.AddInlier(0.5 * std::log(spreads[static_cast<size_t>(i)]) + offset);
    }
    Run([&] {
      InlierScan scan{MatchBlocks(c.problem)};
      scan.spreads = spreads;
      scan.num_inliers = count;
      const InlierScore score = SummarizeEntropies(scan, offset);
      EXPECT_EQ(score.num_inliers, count);
      EXPECT_NEAR(score.mean_entropy, expected.mean_entropy, 1e-13 * std::abs(expected.mean_entropy))
          << count;
      const double tolerance = count < 2 ? 1e-24 : 1e-11 * expected.sum_squares;
      EXPECT_NEAR(score.sum_squares, expected.sum_squares, tolerance) << count;
    });
  }
}

TEST_F(ScoreTest, NegativeLogLikelihoodIsTheScalarSum) {
  for (const int n : {1, 2, 7, 8, 9, 17, 100}) {
    const ScoredProblem c = MakeScoredProblem(n, 200 + static_cast<std::uint32_t>(n));
    const RankAwareTest test(c.Scalar(), c.problem.sigma_px);
    for (const double outlier_cost : {1.5, 7.0, 1e4}) {  // below log(2 pi) / 2 + ..., in between, never
      Thresholds thresholds;
      thresholds.outlier_cost = outlier_cost;
      const double expected = ScoreInliers(c.problem, test, thresholds).negative_log_likelihood;
      ASSERT_GT(expected, 0.0);
      Run([&] {
        const MatchBlocks matches(c.problem);
        const WhitenedModel model = WhitenedModel::From(matches, c.pose, c.pose_cov).value();
        EXPECT_NEAR(NegativeLogLikelihood(matches, model.F, VariancePolynomial(model.dF), outlier_cost),
                    expected, 1e-11 * expected);
      });
    }
  }
}

// Whether every point of each sample passes the printed test; unset where a distance is within 1e-6 of it.
std::vector<std::optional<bool>> ScalarVerdicts(const MotionProblem& problem,
                                                const std::array<Sample, kBlockSize>& samples,
                                                double threshold) {
  std::vector<std::optional<bool>> verdicts;
  for (const Sample& sample : samples) {
    Hypothesis<EightPoint> hypothesis = InstantiateModel<EightPoint>(problem, {sample}).value();
    PropagateCovariance(problem, &hypothesis);
    const AsPrintedTest test(
        UncertainFundamental::From(hypothesis.pose, hypothesis.pose_cov, problem.camera1, problem.camera2)
            .value(),
        problem.sigma_px);
    const bool above = EverySamplePointFits(problem, hypothesis, test, threshold * (1.0 + 1e-6));
    const bool below = EverySamplePointFits(problem, hypothesis, test, threshold * (1.0 - 1e-6));
    verdicts.push_back(above == below ? std::optional(above) : std::nullopt);
  }
  return verdicts;
}

TEST_F(ScoreTest, SamplesAreConsistentWhereEveryPointFits) {
  Run([] {
    RandomStream rng({.seed = 1, .purpose = 2633});
    int num_consistent = 0, num_inconsistent = 0, num_ties = 0;
    for (std::uint32_t trial = 0; trial < 40; ++trial) {
      const ScoredProblem c = MakeScoredProblem(40, 300 + trial);
      std::array<Sample, kBlockSize> samples{};
      for (Sample& sample : samples) {
        sample = DrawSample(8, 26, rng);  // of the matches that are right
        for (int& index : sample) index = 3 * (index / 2) + 1 + index % 2;
      }
      HypothesisBlock block;
      InstantiateModels(MatchBlocks(c.problem), samples, RequestedOutputs::kCovariance, &block);
      for (const double threshold : {2.0, 7.815, 50.0}) {
        const auto expected = ScalarVerdicts(c.problem, samples, threshold);
        const unsigned bits = FindConsistentSamples(block, threshold);
        for (size_t lane = 0; lane < samples.size(); ++lane) {
          if (!expected[lane]) {
            ++num_ties;
            continue;
          }
          EXPECT_EQ((bits >> lane & 1) != 0, *expected[lane]) << "trial " << trial << ", lane " << lane;
          ++(*expected[lane] ? num_consistent : num_inconsistent);
        }
      }
    }
    EXPECT_GT(num_consistent, 50);
    EXPECT_GT(num_inconsistent, 50);
    EXPECT_LE(num_ties, 2);
  });
}

}  // namespace
}  // namespace rcme
