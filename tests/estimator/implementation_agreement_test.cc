// The fast implementation against the reference on whole estimates: same samples, verdicts, inlier sets and
// winner. What differs must be a tie within rounding, so each disagreement is replayed hypothesis by
// hypothesis and printed with its distance to the tie.
//
// RCME_AGREEMENT_TRIALS=20000 makes it the long study: as many trials for each of the variants.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <map>
#include <mutex>
#include <thread>

#include "estimator/estimator_registry.h"
#include "estimator/geometry/triangulation.h"
#include "estimator/kernels/block_matches.h"
#include "estimator/kernels/block_search.h"
#include "estimator/reference_matches.h"
#include "estimator/reference_search.h"
#include "estimator/refine_winner.h"
#include "estimator/sample_consistency.h"
#include "simulator/noise/noise_laws.h"
#include "simulator/observe.h"
#include "simulator/scene_generator.h"
#include "simulator/scene_registry.h"
#include "stats/distributions.h"
#include "stats/intervals.h"
#include "tests/test_support/make_ransac.h"

namespace rcme {
namespace {

// At most this share of the trials may differ.
constexpr double kAllowedRate = 0.001;
// False alarm of a test against it: at most 5e-5 a variant.
constexpr double kConfidence = 0.9999;

struct Variant {
  std::string label, estimator;
  Reading reading;
  MinimalSolver solver;

  RansacOptions Options() const {
    RansacOptions options;
    options.reading = reading;
    options.solver = solver;
    if (solver != MinimalSolver::kEightPoint) options.num_iterations = 16;  // 75 hypotheses, one by one
    return options;
  }
};

std::vector<Variant> VariantsOf(MinimalSolver solver) {
  return {{"standard", "standard", Reading::kAsPrinted, solver},
          {"prcme_as_printed", "prcme", Reading::kAsPrinted, solver},
          {"rcme_as_printed", "rcme", Reading::kAsPrinted, solver},
          {"prcme_rank_aware", "prcme", Reading::kRankAware, solver},
          {"rcme_rank_aware", "rcme", Reading::kRankAware, solver}};
}

// Five points have no sample test, so that rcme is prcme.
const std::vector<Variant>& Variants() {
  static const std::vector<Variant> variants = [] {
    std::vector<Variant> all = VariantsOf(MinimalSolver::kEightPoint);
    for (Variant variant : VariantsOf(MinimalSolver::kFivePoint)) {
      if (variant.estimator == "prcme") continue;
      variant.label = "five_point_" + variant.label;
      all.push_back(variant);
    }
    return all;
  }();
  return variants;
}

// All combinations of scene, outlier ratio, noise and number of matches, in turn.
MotionProblem MakeProblem(std::uint32_t trial) {
  constexpr double kOutlierRatios[] = {0.0, 0.2, 0.4, 0.6}, kSigmasPx[] = {0.1, 0.5, 1.0};
  constexpr int kNumMatches[] = {50, 150, 500};
  size_t turn = trial;
  const auto next = [&turn](size_t n) {
    const size_t index = turn % n;
    turn /= n;
    return index;
  };
  const double outlier_ratio = kOutlierRatios[next(4)], sigma_px = kSigmasPx[next(3)];
  const int num_matches = kNumMatches[next(3)];
  SceneGenerator model(SceneRegistry()[next(SceneRegistry().size())].name);
  FindParameter(model.Parameters(), "num_matches").SetFromText(std::to_string(num_matches));
  RandomStream scene_rng({1, 7, trial, 1}), noise_rng({1, 7, trial, 2}), outlier_rng({1, 7, trial, 3});
  const Scene scene = model.Generate(scene_rng);
  return {Observe(scene, *MakeGaussianNoise(sigma_px), OutlierModel(outlier_ratio), noise_rng, outlier_rng)
              .matches,
          scene.camera1, scene.camera2, sigma_px};
}

RandomStream SamplingStream(std::uint32_t trial) { return RandomStream({1, 7, trial, 4}); }

MotionEstimate Estimate(const Variant& variant, RansacOptions options, Implementation implementation,
                        const MotionProblem& problem, std::uint32_t trial) {
  options.reading = variant.reading;
  options.solver = variant.solver;
  options.num_iterations = variant.Options().num_iterations;
  options.implementation = implementation;
  RandomStream rng = SamplingStream(trial);
  return MakeRansac(variant.estimator, options)->Estimate(problem, rng);
}

double RelativeDifference(double a, double b) {
  return a == b ? 0.0 : std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

bool HaveSameCounts(const LoopCounts& a, const LoopCounts& b) {
  return a.num_hypotheses == b.num_hypotheses && a.num_degenerate_samples == b.num_degenerate_samples &&
         a.num_inconsistent_samples == b.num_inconsistent_samples &&
         a.num_poor_inlier_sets == b.num_poor_inlier_sets &&
         a.num_too_small_inlier_sets == b.num_too_small_inlier_sets && a.num_candidates == b.num_candidates;
}

// Whether both implementations find the same models in a sample.
bool AreSame(const ModelList<Hypothesis<FivePoint>, FivePoint::kMaxModels>& models, int num_models,
             const MotionProblem& problem, const MatchBlocks& matches) {
  if (models.count != num_models) return false;
  BlockSource<FivePoint> source;
  for (const Hypothesis<FivePoint>& model : models) {
    const auto other = source.FindHypothesis(problem, matches, model.id);
    if (!other) return false;
    const Vector9d &f = model.model.f, &g = other->model.f;
    if (!(std::min((f - g).norm(), (f + g).norm()) < 1e-6)) return false;
  }
  return true;
}

// Whether both implementations find the same models in all samples of a trial. Eight points always have one;
// the block solver of five points misses some solutions that nearly coincide, and the scalar one others.
bool HaveSameModels(const Variant& variant, const MotionProblem& problem, std::uint32_t trial) {
  if (variant.solver != MinimalSolver::kFivePoint) return true;
  const MatchBlocks matches(problem);
  BlockSource<FivePoint> source;
  HypothesisBlock block;
  ProposalBlock proposals;
  RandomStream rng = SamplingStream(trial);
  int num_samples = 0;
  for (size_t lane = kBlockSize; num_samples < variant.Options().num_iterations; ++lane) {
    if (lane >= kBlockSize) {
      source.FillNext(matches, RequestedOutputs::kNone, rng, &block, &proposals);
      lane = 0;
    }
    if (!proposals[lane].is_last) continue;
    ++num_samples;
    const HypothesisId& last = proposals[lane].id;
    const int num_models = block.is_model >> lane & 1 ? last.model + 1 : last.model;
    if (!AreSame(InstantiateModels<FivePoint>(problem, last.sample), num_models, problem, matches)) {
      return false;
    }
  }
  return true;
}

// What may differ. A winner of eight points that is the same sample and the same one of its four motions is
// the same to the bit. Where the solvers find different models, the winner alone is compared: it may be the
// one that was missed.
enum class Difference { kLoop, kEstimate, kEntropy, kMissedModel };

struct Differing {
  Difference kind;
  std::string what;
};
bool HaveSameWinner(const MotionEstimate& a, const MotionEstimate& b) {
  if (a.initial_pose.R == b.initial_pose.R && a.initial_pose.t == b.initial_pose.t) return true;
  return a.hypothesis.sample == b.hypothesis.sample && a.hypothesis.sample.size() == 5 &&
         LocalCoordinates(a.initial_pose, b.initial_pose).norm() < 1e-9;
}

std::optional<Differing> FindDifference(const MotionEstimate& a, const MotionEstimate& b,
                                        bool have_same_models) {
  const bool is_other_winner = !HaveSameWinner(a, b);
  if (!have_same_models) {
    if (is_other_winner) return Differing{Difference::kMissedModel, "winner"};
  } else if (!HaveSameCounts(a.counts, b.counts)) {
    return Differing{Difference::kLoop, "counts"};
  }
  if (a.num_support != b.num_support) return Differing{Difference::kLoop, "support"};
  if (is_other_winner) return Differing{Difference::kLoop, "winner"};
  if (a.status != b.status) return Differing{Difference::kEstimate, "status"};
  if (a.inliers != b.inliers) return Differing{Difference::kEstimate, "final inliers"};
  if (RelativeDifference(a.mean_entropy, b.mean_entropy) > 1e-9)
    return Differing{Difference::kEntropy, "entropy"};
  return std::nullopt;
}

// Why two implementations part, and how far from a tie: the greatest |quantity / threshold - 1|.
struct Cause {
  std::string kind;
  double margin = 0.0;
};
void KeepGreater(const std::string& kind, double margin, std::optional<Cause>* cause) {
  if (!*cause || !(margin <= (*cause)->margin)) *cause = {kind, margin};
}

template <typename PointTest>
constexpr BlockReading ReadingOf() {
  if (std::is_same_v<PointTest, KnownPoseTest>) return BlockReading::kKnownPose;
  return std::is_same_v<PointTest, RankAwareTest> ? BlockReading::kRankAware : BlockReading::kAsPrinted;
}

// One hypothesis of the reference with all that it decides.
template <typename Solver, typename PointTest>
struct Judged {
  Hypothesis<Solver> hypothesis;
  PointTest test;

  static std::optional<Judged> From(const MotionProblem& problem,
                                    std::optional<Hypothesis<Solver>> hypothesis) {
    if (!hypothesis) return std::nullopt;
    if constexpr (!PointTest::kNeedsCovariance) {
      return Judged{*hypothesis, PointTest(hypothesis->F, problem.sigma_px)};
    } else {
      PropagateCovariance(problem, &*hypothesis);
      const auto model = UncertainModelOf(problem, *hypothesis);
      if (!model) return std::nullopt;
      return Judged{*hypothesis, PointTest(*model, problem.sigma_px)};
    }
  }

  double Distance(const Correspondence& match) const {
    PointResidual residual;
    return test.Distance(match, &residual);
  }

  // Statistic of the sample test over its threshold.
  double SampleStatistic(const MotionProblem& problem, const Thresholds& thresholds) const {
    if constexpr (Solver::kSampleTestDof == 0) {
      return 0.0;
    } else if constexpr (std::is_same_v<PointTest, RankAwareTest>) {
      return JointSampleStatistic(hypothesis) / thresholds.sample;
    } else {
      double greatest = 0.0;
      for (const int i : hypothesis.id.sample) {
        greatest = std::max(greatest, Distance(problem.matches[static_cast<size_t>(i)]));
      }
      return greatest / thresholds.point;
    }
  }
};

template <typename Solver, typename PointTest>
class Replay {
 public:
  Replay(const MotionProblem& problem, const RansacOptions& options, bool tests_sample, std::uint32_t trial)
      : problem_(problem),
        matches_(problem),
        tests_{ReadingOf<PointTest>(), tests_sample, false},
        fast_rng_(SamplingStream(trial)),
        reference_rng_(SamplingStream(trial)),
        fast_(problem, matches_, options, tests_, fast_rng_),
        fast_support_(problem, matches_, options, tests_, fast_rng_),
        num_iterations_(options.num_iterations) {}

  std::optional<Cause> FindCause() {
    std::optional<Cause> cause;
    for (int j = 0; j < num_iterations_;) j += CompareNext(&cause);
    return cause;
  }

 private:
  // Returns whether that was the sample's last model.
  bool CompareNext(std::optional<Cause>* cause) {
    const Proposal fast = fast_.Next();
    if (is_first_) sample_ = DrawSample(Solver::kSampleSize, matches_.num_matches(), reference_rng_);
    if (sample_ != fast.id.sample) KeepGreater("other sample", 1.0, cause);
    is_first_ = fast.is_last;
    if (sample_ == fast.id.sample) CompareModel(fast, cause);
    return fast.is_last;
  }

  void CompareModel(const Proposal& fast, std::optional<Cause>* cause) {
    const Thresholds& thresholds = fast_.thresholds();
    const auto judged = Judged<Solver, PointTest>::From(problem_, fast_support_.FindHypothesis(fast.id));
    const bool is_fast_model = fast.verdict != SampleVerdict::kDegenerate;
    if (judged.has_value() != is_fast_model) return KeepGreater("degenerate sample", std::nan(""), cause);
    if (!judged) return;
    const double statistic = tests_.tests_sample ? judged->SampleStatistic(problem_, thresholds) : 0.0;
    if ((statistic <= 1.0) != (fast.verdict == SampleVerdict::kConsistent)) {
      return KeepGreater("sample test", std::abs(statistic - 1.0), cause);
    }
    if (statistic <= 1.0) CompareScores(*judged, fast_.Score(), cause);
  }

  void CompareScores(const Judged<Solver, PointTest>& judged, const InlierScore& fast,
                     std::optional<Cause>* cause) {
    const double threshold = fast_.thresholds().point;
    const MatchMask& support = fast_support_.FindSupport(judged.hypothesis.id);
    bool is_same_set = true;
    for (int i = 0; i < matches_.num_matches(); ++i) {
      const double d2 = judged.Distance(problem_.matches[static_cast<size_t>(i)]);
      const bool is_in_fast = support[static_cast<size_t>(i / kBlockSize)] >> (i % kBlockSize) & 1;
      if ((d2 <= threshold) == is_in_fast) continue;
      is_same_set = false;
      KeepGreater("inlier of a hypothesis", std::abs(d2 / threshold - 1.0), cause);
    }
    if (!is_same_set) return;
    const InlierScore reference =
        ScoreInliers(problem_, judged.test, fast_.thresholds(),
                     kScoresTheRest<Solver, PointTest> ? judged.hypothesis.id.sample : Sample());
    const double difference = RelativeDifference(fast.mean_entropy, reference.mean_entropy);
    if (difference > 1e-9) KeepGreater("entropy of a hypothesis", difference, cause);
  }

  const MotionProblem& problem_;
  MatchBlocks matches_;
  BlockTests tests_;
  RandomStream fast_rng_, reference_rng_;
  BlockSearch<Solver> fast_, fast_support_;
  int num_iterations_;
  Sample sample_;
  bool is_first_ = true;  // the next model is the first of a sample
};

BlockTests TestsOf(const Variant& variant) {
  const BlockReading reading = variant.estimator == "standard"          ? BlockReading::kKnownPose
                               : variant.reading == Reading::kRankAware ? BlockReading::kRankAware
                                                                        : BlockReading::kAsPrinted;
  return {reading, variant.estimator == "rcme", false};
}

// The inliers of the loop's winner in the fast implementation.
template <typename Solver>
MatchMask FindWinnersSupport(const Variant& variant, const MotionProblem& problem,
                             const HypothesisId& winner) {
  const MatchBlocks matches(problem);
  RandomStream no_samples({0, 0, 0, 0});
  return BlockSearch<Solver>(problem, matches, variant.Options(), TestsOf(variant), no_samples)
      .FindSupport(winner);
}

// How far a match is from changing sides in the fit set or in the final inliers: the least distance of its
// squared residual from its bound (over that of sigma^2 alone: a fit to five matches leaves both at zero),
// and of its leverage, its parallax and its depths from theirs.
double DistanceFromTie(const MotionProblem& problem, const RefinedMotion& motion, const Correspondence& match,
                       bool is_fitted, double significance_level, double max_leverage) {
  const auto model =
      UncertainFundamental::From(motion.cam2_from_cam1, motion.pose_cov, problem.camera1, problem.camera2);
  const MatchResidual residual = EvaluateResidual(model.value(), match);
  const double sigma2 = problem.sigma_px * problem.sigma_px;
  const double variance = sigma2 + (is_fitted ? -1.0 : 1.0) * residual.motion_variance;
  const double threshold = ChiSquareQuantile(1, 1.0 - significance_level);
  const Eigen::Vector3d ray1 = motion.cam2_from_cam1.R * problem.camera1.Ray(match.x1_px);
  const double parallax_px = (problem.camera2.Project(ray1) - match.x2_px).norm();
  const double inverse_depth =
      InverseDepth(motion.cam2_from_cam1, problem.camera1.Ray(match.x1_px), problem.camera2.Ray(match.x2_px));
  return std::min({std::abs(residual.squared_distance - threshold * variance) / (threshold * sigma2),
                   std::abs(residual.motion_variance / (max_leverage * sigma2) - 1.0),
                   std::abs(parallax_px / (6.0 * problem.sigma_px) - 1.0), std::abs(inverse_depth),
                   std::abs((ray1 + inverse_depth * motion.cam2_from_cam1.t).z())});
}

constexpr const char* kCheiralityTie = "tie of the cheirality";

// Follows FitRobustly in both implementations from the same support: as long as the sets agree, the motions
// are the same to rounding, so that the first sets that differ are the cause.
class RefinementReplay {
 public:
  explicit RefinementReplay(const MotionProblem& problem)
      : problem_(problem),
        matches_(problem),
        fast_(problem, matches_, RefinementError::kSampson),
        reference_(problem, RefinementError::kSampson) {}

  std::optional<Cause> FindCause(const MatchMask& support, const RelativePose& fast_start,
                                 const RelativePose& reference_start) const {
    std::vector<int> fitted = IndicesOf(support);
    Motions motions = Refine(fitted, {fast_start, reference_start}, Loss::kCauchy);
    if (!motions.AreSame()) return Cause{"robust fit", std::nan("")};
    if (motions.fast.converged) {
      motions = {DecideCheiralityAgain(fast_, support, motions.fast),
                 DecideCheiralityAgain(reference_, fitted, motions.reference)};
      if (!motions.AreSame()) return CheiralityCause(fitted, motions);
    }
    for (int refit = 0; refit < kMaxRefits && motions.fast.converged; ++refit) {
      const std::vector<int> selected = reference_.SelectFitSet(motions.reference, fitted);
      const double max_leverage = MaxLeverage(static_cast<int>(fitted.size()));
      const std::vector<int> in_fast = IndicesOf(fast_.SelectFitSet(motions.fast, fast_.SetOf(fitted)));
      if (auto cause = Compare("fit set", motions.reference, fitted, kFitSignificance, max_leverage, in_fast,
                               selected)) {
        return cause;
      }
      if (refit > 0 && selected == fitted) break;
      fitted = selected;
      if (fitted.size() <= 5) return std::nullopt;
      motions =
          Refine(fitted, {motions.fast.cam2_from_cam1, motions.reference.cam2_from_cam1}, Loss::kSquared);
      if (!motions.AreSame()) return Cause{"refit", std::nan("")};
    }
    if (!motions.fast.converged) return std::nullopt;
    const double alpha = RansacOptions().significance_level;
    return Compare("final inlier", motions.reference, fitted, alpha, std::numeric_limits<double>::infinity(),
                   IndicesOf(fast_.FindAgreeing(motions.fast, fast_.SetOf(fitted), alpha)),
                   reference_.FindAgreeing(motions.reference, fitted, alpha));
  }

 private:
  struct Motions {
    RefinedMotion fast, reference;
    bool AreSame() const {
      return fast.converged == reference.converged &&
             LocalCoordinates(fast.cam2_from_cam1, reference.cam2_from_cam1).norm() < 1e-9;
    }
  };
  struct Starts {
    RelativePose fast, reference;
  };
  Motions Refine(const std::vector<int>& fitted, const Starts& starts, Loss loss) const {
    return {fast_.Refine(fast_.SetOf(fitted), starts.fast, loss),
            reference_.Refine(fitted, starts.reference, loss)};
  }

  // Of the four motions of E two may have as many matches in front of the cameras. The first is taken, and
  // which is first depends on the signs of a singular value decomposition.
  Cause CheiralityCause(const std::vector<int>& support, const Motions& motions) const {
    const auto count = [&](const RelativePose& pose) {
      return std::ranges::count_if(support, [&](int i) {
        const Correspondence& match = problem_.matches[static_cast<size_t>(i)];
        return IsInFrontOfBothCameras(pose, problem_.camera1.Ray(match.x1_px),
                                      problem_.camera2.Ray(match.x2_px));
      });
    };
    const bool is_tie = count(motions.fast.cam2_from_cam1) == count(motions.reference.cam2_from_cam1);
    return {is_tie ? kCheiralityTie : "cheirality", is_tie ? 0.0 : std::nan("")};
  }

  std::optional<Cause> Compare(const std::string& kind, const RefinedMotion& motion,
                               const std::vector<int>& fitted, double significance_level, double max_leverage,
                               const std::vector<int>& a, const std::vector<int>& b) const {
    std::vector<int> differing;
    std::ranges::set_symmetric_difference(a, b, std::back_inserter(differing));
    std::optional<Cause> cause;
    for (const int i : differing) {
      const bool is_fitted = std::ranges::binary_search(fitted, i);
      KeepGreater(kind,
                  DistanceFromTie(problem_, motion, problem_.matches[static_cast<size_t>(i)], is_fitted,
                                  significance_level, max_leverage),
                  &cause);
    }
    return cause;
  }

  const MotionProblem& problem_;
  MatchBlocks matches_;
  BlockMatches fast_;
  ReferenceMatches reference_;
};

// Of two estimates whose hypotheses agree.
template <typename Solver>
Cause CauseAfterTheLoop(const Variant& variant, const MotionProblem& problem, const MotionEstimate& fast,
                        const MotionEstimate& reference) {
  if (!HaveSameWinner(fast, reference)) {
    return {"selection or cheirality", RelativeDifference(fast.mean_entropy, reference.mean_entropy)};
  }
  const MatchMask support = FindWinnersSupport<Solver>(variant, problem, fast.hypothesis);
  const std::optional<Cause> cause =
      RefinementReplay(problem).FindCause(support, fast.initial_pose, reference.initial_pose);
  return cause.value_or(Cause{"unknown", std::nan("")});
}

template <typename Solver>
Cause FindCauseOf(const Variant& variant, const MotionProblem& problem, std::uint32_t trial,
                  Difference difference, const MotionEstimate& fast, const MotionEstimate& reference) {
  if (difference == Difference::kMissedModel) return {"missed model", 0.0};
  const RansacOptions options = variant.Options();
  const bool tests_sample = variant.estimator == "rcme" && Solver::kSampleTestDof > 0;
  std::optional<Cause> cause;
  if (difference != Difference::kEstimate) {
    cause = variant.estimator == "standard"
                ? Replay<Solver, KnownPoseTest>(problem, options, false, trial).FindCause()
            : variant.reading == Reading::kRankAware
                ? Replay<Solver, RankAwareTest>(problem, options, tests_sample, trial).FindCause()
                : Replay<Solver, AsPrintedTest>(problem, options, tests_sample, trial).FindCause();
  }
  return cause ? *cause : CauseAfterTheLoop<Solver>(variant, problem, fast, reference);
}

Cause FindCause(const Variant& variant, const MotionProblem& problem, std::uint32_t trial,
                Difference difference, const MotionEstimate& fast, const MotionEstimate& reference) {
  return variant.solver == MinimalSolver::kFivePoint
             ? FindCauseOf<FivePoint>(variant, problem, trial, difference, fast, reference)
             : FindCauseOf<EightPoint>(variant, problem, trial, difference, fast, reference);
}

struct Disagreement {
  std::uint32_t trial;
  Differing difference;
  Cause cause;
};

// Disagreements of every variant over `num_trials` trials, on all cores.
std::vector<std::vector<Disagreement>> CompareImplementations(std::uint32_t num_trials,
                                                              const RansacOptions& fast_options) {
  std::vector<std::vector<Disagreement>> found(Variants().size());
  std::mutex mutex;
  std::atomic<std::uint32_t> next = 0;
  const auto work = [&] {
    for (std::uint32_t trial = next++; trial < num_trials; trial = next++) {
      if (trial > 0 && trial % 1000 == 0) fmt::print(stderr, "trial {} of {}\n", trial, num_trials);
      const MotionProblem problem = MakeProblem(trial);
      for (size_t a = 0; a < Variants().size(); ++a) {
        const Variant& variant = Variants()[a];
        const MotionEstimate fast = Estimate(variant, fast_options, Implementation::kFast, problem, trial);
        const MotionEstimate reference = Estimate(variant, {}, Implementation::kReference, problem, trial);
        const std::optional<Differing> difference =
            FindDifference(fast, reference, HaveSameModels(variant, problem, trial));
        if (!difference) continue;
        const Cause cause = FindCause(variant, problem, trial, difference->kind, fast, reference);
        const std::lock_guard lock(mutex);
        found[a].push_back({trial, *difference, cause});
      }
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i) threads.emplace_back(work);
  threads.clear();
  return found;
}

std::int64_t Count(const std::vector<Disagreement>& found, Difference kind) {
  return std::ranges::count_if(found, [kind](const Disagreement& d) { return d.difference.kind == kind; });
}

// The rate that a test on n trials finds with probability 0.99: at the least count whose interval lies above
// the allowed rate, P(X >= count) = 0.99.
double DetectableRate(std::int64_t n) {
  std::int64_t count = 1;
  while (count <= n && ExactBinomialInterval(count, n, kConfidence).lower <= kAllowedRate) ++count;
  return ExactBinomialInterval(count - 1, n, 0.98).upper;
}

std::string RateText(std::int64_t count, std::int64_t n) {
  const Interval interval = ExactBinomialInterval(count, n);
  return fmt::format("{} [{:.4f}, {:.4f}] %", count, 100.0 * interval.lower, 100.0 * interval.upper);
}

void PrintRow(const std::string& label, std::int64_t n, const std::vector<Disagreement>& found) {
  struct Kind {
    int count = 0;
    double margin = 0.0;
    std::uint32_t trial = 0;
  };
  std::map<std::string, Kind> kinds;
  for (const Disagreement& d : found) {
    Kind& kind = kinds[d.difference.what + " by " + d.cause.kind];
    if (kind.count++ == 0 || !(d.cause.margin <= kind.margin)) {
      kind.margin = d.cause.margin;
      kind.trial = d.trial;
    }
  }
  std::string text;
  for (const auto& [name, kind] : kinds) {
    text += fmt::format("{}{} {}, at most {:.1e} (trial {})", text.empty() ? "" : "; ", kind.count, name,
                        kind.margin, kind.trial);
  }
  fmt::print("| {} | {} | {} | {} | {} | {} | {} |\n", label, n, RateText(Count(found, Difference::kLoop), n),
             RateText(Count(found, Difference::kEstimate), n),
             RateText(Count(found, Difference::kEntropy), n),
             RateText(Count(found, Difference::kMissedModel), n), text);
}

void PrintTable(std::int64_t num_trials, const std::vector<std::vector<Disagreement>>& found) {
  fmt::print(
      "| variant | trials | loop differs | status or final inliers alone | entropy by more than 1e-9 alone | "
      "another winner where models differ | what, why, distance to the tie |\n"
      "|---|---|---|---|---|---|---|\n");
  std::vector<Disagreement> all;
  for (size_t a = 0; a < found.size(); ++a) {
    PrintRow(Variants()[a].label, num_trials, found[a]);
    all.insert(all.end(), found[a].begin(), found[a].end());
  }
  const std::int64_t n = num_trials * static_cast<std::int64_t>(found.size());
  PrintRow("all", n, all);
  fmt::print("Found with probability 0.99: a rate of {:.2f} % in one variant, {:.2f} % overall.\n",
             100.0 * DetectableRate(num_trials), 100.0 * DetectableRate(n));
}

// Decisions differ in at most 0.1 % of the trials, each a tie within rounding. Rarer than 1 % are exact ties
// of the cheirality after the robust fit, which motions of few or far matches have. Printed entropies beyond
// 1e-9 belong to hypotheses near the singular set of the printed test (score_test.cc), which is where the
// least mean entropy finds its winner: 96 of 10^5, all but two of prcme_as_printed, the greatest 1.9e-5.
void ExpectAgreement(const std::string& label, std::int64_t n, const std::vector<Disagreement>& found) {
  const std::int64_t num_entropies = Count(found, Difference::kEntropy);
  const std::int64_t num_ties =
      std::ranges::count(found, kCheiralityTie, [](const Disagreement& d) { return d.cause.kind; });
  const std::int64_t num_missed = Count(found, Difference::kMissedModel);
  const std::int64_t num_decisions =
      static_cast<std::int64_t>(found.size()) - num_entropies - num_ties - num_missed;
  EXPECT_LE(ExactBinomialInterval(num_decisions, n, kConfidence).lower, kAllowedRate) << label;
  for (const std::int64_t count : {num_entropies, num_ties, num_missed}) {
    EXPECT_LE(ExactBinomialInterval(count, n, kConfidence).lower, 10.0 * kAllowedRate) << label;
  }
  for (const Disagreement& d : found) {
    const double greatest = d.difference.kind == Difference::kEntropy ? 1e-3 : 1e-8;
    EXPECT_LE(d.cause.margin, greatest)
        << label << ", trial " << d.trial << ": " << d.difference.what << " by " << d.cause.kind;
  }
}

std::uint32_t NumTrials() {
  const char* text = std::getenv("RCME_AGREEMENT_TRIALS");
  const size_t one_of_every_condition = 36 * SceneRegistry().size();
  return static_cast<std::uint32_t>(text ? std::strtoul(text, nullptr, 10) : one_of_every_condition);
}

TEST(Implementations, AgreeOnWholeEstimates) {
  const std::uint32_t num_trials = NumTrials();
  ASSERT_GT(num_trials, 0u);
  const auto found = CompareImplementations(num_trials, {});
  PrintTable(num_trials, found);
  std::vector<Disagreement> all;
  for (size_t a = 0; a < found.size(); ++a) {
    ExpectAgreement(Variants()[a].label, num_trials, found[a]);
    all.insert(all.end(), found[a].begin(), found[a].end());
  }
  ExpectAgreement("all", static_cast<std::int64_t>(num_trials) * static_cast<std::int64_t>(found.size()),
                  all);
}

TEST(Implementations, ASmallFaultIsSeen) {
  // One part in a hundred more significance moves the thresholds by 0.3 %.
  RansacOptions faulty;
  faulty.significance_level *= 1.01;
  const auto found = CompareImplementations(36, faulty);
  for (size_t a = 0; a < found.size(); ++a) {
    const std::int64_t count = Count(found[a], Difference::kLoop) + Count(found[a], Difference::kEstimate);
    EXPECT_GT(ExactBinomialInterval(count, 36, kConfidence).lower, kAllowedRate) << Variants()[a].label;
  }
}

}  // namespace
}  // namespace rcme
