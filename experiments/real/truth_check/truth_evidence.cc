#include "experiments/real/truth_check/truth_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "estimator/calibrated/explanation.h"
#include "estimator/noise_scale.h"
#include "estimator/robust_covariance/clustered_covariance.h"
#include "experiments/core/text/pick_name.h"
#include "experiments/data/data_source.h"
#include "experiments/trial/answer_check.h"
#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr int kBlocksPerSide = 6, kSquaresPerSide = 12;
constexpr double kKeyPointRadiusPx = 1.0;
constexpr double kMostOverChance = 2.0;
constexpr int kMixtureSteps = 20, kChanceShifts = 8;
constexpr int kFitsAnyMotion = 5;  // matches: a motion has as many dimensions

// Keeps the first match of each key point.
MotionProblem OneOfEachKeyPoint(const MotionProblem& problem) {
  const std::vector<int> groups = KeyPointGroups(problem.matches, kKeyPointRadiusPx);
  std::set<int> seen;
  std::vector<size_t> kept;
  for (size_t i = 0; i < groups.size(); ++i) {
    if (seen.insert(groups[i]).second) kept.push_back(i);
  }
  return SelectPart(problem, kept);
}

MixturePrior MakeMixturePrior(const MotionProblem& problem) {
  return {2.0 * problem.sigma_px / std::hypot(problem.camera2.width, problem.camera2.height), true};
}

std::vector<bool> FindExplained(const MatchBlocks& matches, const RelativePose& pose,
                                const MixtureParameters& mixture) {
  Mode mode;
  mode.pose = pose;
  mode.mixture = mixture;
  mode.used = matches.All();
  std::vector<bool> is_explained;
  for (const double probability : Explain(matches, mode).probability)
    is_explained.push_back(probability > 0.5);
  return is_explained;
}

// Returns P(Binomial(first + second, 1 / 2) >= first).
double SignTest(std::int64_t first, std::int64_t second) {
  if (first + second == 0) return 1.0;
  return BinomialUpperTail(static_cast<int>(first + second), static_cast<int>(first), 0.5);
}

// Returns the share of random matches that the motion explains; a random match has the second point of
// another match.
double ShareOfRandom(const MotionProblem& problem, const RelativePose& pose,
                     const MixtureParameters& mixture) {
  const size_t n = problem.matches.size();
  std::int64_t num_explained = 0, num_random = 0;
  for (size_t k = 1; k <= kChanceShifts; ++k) {
    const size_t shift = k * n / (kChanceShifts + 1);
    if (shift == 0) continue;
    MotionProblem random = problem;
    for (size_t i = 0; i < n; ++i) random.matches[i].x2_px = problem.matches[(i + shift) % n].x2_px;
    const std::vector<bool> is_explained = FindExplained(MatchBlocks(random), pose, mixture);
    num_explained += std::ranges::count(is_explained, true);
    num_random += std::ssize(is_explained);
  }
  return static_cast<double>(num_explained + 1) / static_cast<double>(num_random + 1);
}

// Fits the mixture at both motions and returns the one that explains the matches better.
MixtureParameters FitCommonMixture(const MatchBlocks& matches, const MixturePrior& prior,
                                   const std::array<RelativePose, 2>& poses) {
  std::array<MixtureParameters, 2> mixtures;
  std::array<double, 2> likelihoods{};
  for (size_t k = 0; k < 2; ++k) {
    mixtures[k] = FitMixture(matches, prior, poses[k], FirstGuess(prior, 1.0, 0.5), kMixtureSteps);
    likelihoods[k] = SumMixture(matches, matches.All(), poses[k], mixtures[k]).log_likelihood;
  }
  return mixtures[likelihoods[1] > likelihoods[0] ? 1 : 0];
}

// Returns the candidates for the truth, beginning with the given one (truth_reach.h), and in `best` the
// index of the one that explains the matches best. There are two rounds: the mixture is first fitted at the
// given truth, then at the best candidate.
std::vector<RelativePose> ListTruths(const MotionProblem& problem, const MatchBlocks& matches,
                                     const GivenTruth& truth, const FailureBounds& bounds,
                                     const RelativePose& motion, MixtureParameters* mixture, size_t* best) {
  const MixturePrior prior = MakeMixturePrior(problem);
  std::vector<RelativePose> truths = {truth.cam2_from_cam1};
  *mixture = FitCommonMixture(matches, prior, {truths[0], motion});
  for (int round = 0; round < 2; ++round) {
    Matrix5d calibration_cov = Matrix5d::Zero();
    if (truth.sd) calibration_cov = AllowedCalibrationCovariance(problem, motion, *mixture);
    truths = MoveTruth(matches, TruthReach(truth, bounds, calibration_cov), truths[0], motion, *mixture);
    std::vector<double> likelihoods;
    for (const RelativePose& pose : truths)
      likelihoods.push_back(SumMixture(matches, matches.All(), pose, *mixture).log_likelihood);
    *best = static_cast<size_t>(std::ranges::max_element(likelihoods) - likelihoods.begin());
    *mixture = FitCommonMixture(matches, prior, {truths[*best], motion});
  }
  return truths;
}

struct OnlyBy {
  std::int64_t truth = 0, motion = 0;
};

// Counts the matches and blocks of one half for one candidate of the truth.
void CountMatches(const std::vector<bool>& by_truth, const std::vector<bool>& by_motion,
                  const std::vector<int>& block_of, TruthContest* contest) {
  std::map<int, OnlyBy> blocks;
  for (size_t i = 0; i < by_truth.size(); ++i) {
    contest->by_truth += by_truth[i];
    contest->by_motion += by_motion[i];
    OnlyBy& block = blocks[block_of[i]];
    block.truth += by_truth[i] && !by_motion[i];
    block.motion += by_motion[i] && !by_truth[i];
  }
  for (const auto& [number, block] : blocks) {
    contest->by_truth_only += block.truth;
    contest->by_motion_only += block.motion;
    contest->blocks_of_truth += block.truth > block.motion;
    contest->blocks_of_motion += block.motion > block.truth;
    contest->p_least_block = std::min(contest->p_least_block, SignTest(block.truth, block.motion));
  }
  contest->p_least_block = std::min(1.0, contest->p_least_block * static_cast<double>(blocks.size()));
  contest->p_matches = SignTest(contest->by_motion_only, contest->by_truth_only);
  contest->p_blocks = SignTest(contest->blocks_of_motion, contest->blocks_of_truth);
}

// Tests that so many of n matches are more than twice the `share` of random ones plus the five that any
// motion can be fitted to. Returns the p-value.
double TestAboveChance(std::int64_t num_explained, std::int64_t n, double share) {
  const auto num_found = static_cast<int>(num_explained) - kFitsAnyMotion;
  if (num_found <= 0) return 1.0;
  return BinomialUpperTail(static_cast<int>(n), num_found, std::min(1.0, kMostOverChance * share));
}

}  // namespace

double TruthContest::PValue() const { return std::max(p_matches, p_blocks); }

bool TruthContest::SpeaksAgainstTruth(double level) const {
  return PValue() <= level && by_motion >= kLeastExplainedByHalf &&
         static_cast<double>(by_motion) >= kLeastExplainedRatio * static_cast<double>(by_truth) &&
         p_above_chance > kTruthDoubtLevel && p_least_block > kTruthDoubtLevel;
}

bool TruthContest::SpeaksForTruth() const {
  return by_truth >= kLeastExplainedByHalf && p_of_truth <= kTruthDoubtLevel;
}

void TruthContest::AddCounts(const TruthContest& other) {
  num_matches += other.num_matches;
  by_truth += other.by_truth;
  by_motion += other.by_motion;
  by_truth_only += other.by_truth_only;
  by_motion_only += other.by_motion_only;
  blocks_of_truth += other.blocks_of_truth;
  blocks_of_motion += other.blocks_of_motion;
}

TruthContest CompareWithTruth(const MotionProblem& given, const GivenTruth& truth,
                              const FailureBounds& bounds, const RelativePose& motion) {
  const MotionProblem problem = OneOfEachKeyPoint(given);
  TruthContest none{.num_matches = std::ssize(problem.matches)};
  if (problem.matches.empty()) return none;
  const MatchBlocks matches(problem);
  MixtureParameters mixture;
  size_t best = 0;
  const std::vector<RelativePose> truths =
      ListTruths(problem, matches, truth, bounds, motion, &mixture, &best);
  const std::vector<bool> by_motion = FindExplained(matches, motion, mixture);
  const std::vector<int> block_of = BlockGroups(problem.camera1, problem.matches, kBlocksPerSide);
  std::vector<TruthContest> contests;
  double p_above_chance = 1.0, p_least_block = 1.0, p_of_truth = 1.0;
  for (const RelativePose& pose : truths) {
    TruthContest& contest = contests.emplace_back(none);
    CountMatches(FindExplained(matches, pose, mixture), by_motion, block_of, &contest);
    const double share = ShareOfRandom(problem, pose, mixture);
    const std::int64_t num_left = contest.num_matches - contest.by_motion;
    p_above_chance = std::min(p_above_chance, TestAboveChance(contest.by_truth_only, num_left, share));
    p_of_truth = std::min(p_of_truth, TestAboveChance(contest.by_truth, contest.num_matches, share));
    p_least_block = std::min(p_least_block, contest.p_least_block);
  }
  contests[best].p_above_chance = p_above_chance;
  contests[best].p_least_block = p_least_block;
  contests[best].p_of_truth = p_of_truth;
  return contests[best];
}

std::vector<bool> IsInWhiteSquare(const MotionProblem& problem) {
  const auto square = [](double x_px, int length_px) {
    return static_cast<int>(
        std::clamp(std::floor((x_px + 0.5) / length_px * kSquaresPerSide), 0.0, kSquaresPerSide - 1.0));
  };
  std::vector<bool> is_white;
  for (const Correspondence& match : problem.matches) {
    const int column = square(match.x1_px.x(), problem.camera1.width),
              row = square(match.x1_px.y(), problem.camera1.height);
    is_white.push_back((column + row) % 2 == 0);
  }
  return is_white;
}

const char* Name(TruthVerdict verdict) { return PickName(verdict, {"silent", "holds", "in_doubt"}); }

namespace {

std::optional<RelativePose> FindMotion(const MotionProblem& problem, const MotionEstimator& estimator,
                                       std::uint64_t seed) {
  RandomStream rng = StreamFor({seed, 0, 0, 0}, StreamPurpose::kSampling);
  const MotionEstimate estimate = Judged(estimator.Estimate(problem, rng), problem.matches.size());
  if (estimate.status != MotionStatus::kOk) return std::nullopt;
  return estimate.cam2_from_cam1;
}

void NoteErrors(const std::optional<RelativePose>& motion, const GivenTruth& truth,
                FrontEndEvidence* evidence) {
  evidence->rotation_error_deg = evidence->direction_error_deg = kNaN;
  if (!motion) return;
  evidence->rotation_error_deg = kDegPerRad * RotationAngleBetween(motion->R, truth.cam2_from_cam1.R);
  if (truth.is_direction_known)
    evidence->direction_error_deg = kDegPerRad * AngleBetween(motion->t, truth.cam2_from_cam1.t);
}

}  // namespace

FrontEndEvidence WeighTruth(const MotionProblem& problem, const GivenTruth& truth,
                            const FailureBounds& bounds, const MotionEstimator& estimator, std::uint64_t seed,
                            size_t num_front_ends) {
  FrontEndEvidence evidence;
  NoteErrors(FindMotion(problem, estimator, seed), truth, &evidence);
  std::array<std::vector<size_t>, 2> squares;
  const std::vector<bool> is_white = IsInWhiteSquare(problem);
  for (size_t i = 0; i < is_white.size(); ++i) squares[is_white[i]].push_back(i);
  const std::array<MotionProblem, 2> halves = {SelectPart(problem, squares[0]),
                                               SelectPart(problem, squares[1])};
  const double level = kTruthDoubtLevel / static_cast<double>(num_front_ends);
  int num_against = 0, num_for = 0;
  evidence.p_value = 0.0;
  for (const size_t found_in : {size_t{0}, size_t{1}}) {
    const std::optional<RelativePose> motion = FindMotion(halves[found_in], estimator, seed);
    if (!motion) {
      evidence.p_value = 1.0;
      continue;
    }
    const TruthContest contest = CompareWithTruth(halves[1 - found_in], truth, bounds, *motion);
    evidence.counts.AddCounts(contest);
    evidence.p_value = std::max(evidence.p_value, contest.PValue());
    const bool is_beyond = IsBeyond(bounds, truth, *motion);
    num_against += is_beyond && contest.SpeaksAgainstTruth(level);
    // A wrong truth explains more matches than chance too, but another motion explains more than it.
    num_for += contest.SpeaksForTruth() && !(is_beyond && contest.p_matches <= level);
  }
  evidence.verdict = num_against == 2 ? TruthVerdict::kInDoubt
                     : num_for > 0    ? TruthVerdict::kHolds
                                      : TruthVerdict::kSilent;
  return evidence;
}

PairVerdict JudgeTruth(const std::vector<FrontEndEvidence>& front_ends) {
  PairVerdict pair;
  for (const FrontEndEvidence& evidence : front_ends) {
    pair.p_value = std::min(pair.p_value, static_cast<double>(front_ends.size()) * evidence.p_value);
    if (evidence.verdict == TruthVerdict::kHolds) pair.verdict = TruthVerdict::kHolds;
    if (evidence.verdict == TruthVerdict::kInDoubt && pair.verdict == TruthVerdict::kSilent)
      pair.verdict = TruthVerdict::kInDoubt;
  }
  return pair;
}

}  // namespace rcme
