#include "experiments/real/camera_noise/shared_variance.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "estimator/robust_covariance/residual_variances.h"
#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr double kVarianceLevel = 0.05, kKeyPointLevel = 0.01;
constexpr int kOwnPart = 0, kKeyPointPart = 1, kFirstLengthPart = 2;
// Pairs of matches of one key point, for their variance: in a pair, in all, and pairs that have them.
constexpr double kLeastRepeats = 1.0, kLeastRepeatsInAll = 50.0;
constexpr size_t kLeastPairsWithRepeats = 5;
// The longest of the three reaches of one set of moments, px; together a ratio of 3^1/2 from 10 to 4,209 px.
const double kLongestReachesPx[] = {90.0, 90.0 * std::sqrt(3.0), 2430.0, 2430.0 * std::sqrt(3.0)};

// One match of each key point, the first: their moments have T alone in them,
//
//   W_0 = I, W_f = K_f - I:  tr(W_0 P W_0 P) = T_00, tr(W_0 P W_f P) = T_f0, tr(W_f P W_f P) = T_ff - T_f0.
MatchScores KeepFirstOfEach(const MatchScores& scores) {
  MatchScores kept;
  int next = 0;
  const std::vector<int> groups = KeyPointGroups(scores.matches, kKeyPointRadiusPx);
  for (size_t i = 0; i < groups.size(); ++i) {
    if (groups[i] != next) continue;
    ++next;
    kept.rows.push_back(scores.rows[i]);
    kept.residuals.push_back(scores.residuals[i]);
    kept.matches.push_back(scores.matches[i]);
    kept.normals.push_back(scores.normals[i]);
    kept.information += scores.rows[i] * scores.rows[i].transpose();
  }
  return kept;
}

// Score and information of the second unknown of two equations, with the first eliminated.
UnitScore Eliminate(const ImageNumbers& images, const Eigen::Vector2d& q, const Eigen::Matrix2d& T,
                    const Eigen::Matrix2d& M, double variance) {
  const Eigen::Matrix2d weighted = M.ldlt().solve(T) / (2.0 * variance * variance);
  const Eigen::Matrix2d N = T.transpose() * weighted;
  const Eigen::Vector2d b = weighted.transpose() * q;
  const double score = b(1) - N(1, 0) / N(0, 0) * b(0), information = N(1, 1) - N(1, 0) / N(0, 0) * N(0, 1);
  const bool is_known = std::isfinite(score) && information > 0.0;
  return {images.image1, images.image2, Eigen::VectorXd::Constant(1, is_known ? score : 0.0),
          Eigen::MatrixXd::Constant(1, 1, is_known ? information : 0.0)};
}

// Score and information of the field's variance at one reach.
UnitScore TakeField(const FittedPair& pair, const ResidualMoments& moments, int length) {
  const int parts[] = {kOwnPart, kFirstLengthPart + length};
  const Eigen::Matrix2d T = moments.T(parts, parts);
  Eigen::Matrix2d M;
  M << T(0, 0), T(1, 0), T(1, 0), T(1, 1) - T(1, 0);
  return Eliminate(pair.images, moments.q(parts), T, M, pair.variance);
}

double ComputeGain(const std::vector<UnitScore>& units, size_t left_out) {
  double score = 0.0, information = 0.0;
  for (size_t i = 0; i < units.size(); ++i) {
    if (i == left_out) continue;
    score += units[i].score(0);
    information += units[i].information(0, 0);
  }
  return score > 0.0 && information > 0.0 ? 0.5 * score * score / information : 0.0;
}

using UnitsByReach = std::map<double, std::vector<UnitScore>>;

// log reach at the maximum of the parabola through the greatest gain and its neighbours.
double FindLogReach(const UnitsByReach& units, size_t left_out) {
  std::vector<double> at, gains;
  for (const auto& [reach, of_reach] : units) {
    at.push_back(std::log(reach));
    gains.push_back(ComputeGain(of_reach, left_out));
  }
  const size_t best = static_cast<size_t>(std::ranges::max_element(gains) - gains.begin());
  if (best == 0 || best + 1 == gains.size()) return at[best];
  const double left = gains[best - 1], right = gains[best + 1], bend = left - 2.0 * gains[best] + right;
  const double shift = bend < 0.0 ? std::clamp(0.5 * (left - right) / bend, -0.5, 0.5) : 0.0;
  return at[best] + shift * 0.5 * (at[best + 1] - at[best - 1]);
}

constexpr size_t kLeaveNoneOut = static_cast<size_t>(-1);

// Standard error of the reach as a factor, by a jackknife that leaves out one pair at a time.
double ComputeReachFactor(const UnitsByReach& units, size_t num_pairs) {
  double sum = 0.0, squares = 0.0;
  for (size_t i = 0; i < num_pairs; ++i) {
    const double log_reach = FindLogReach(units, i);
    sum += log_reach;
    squares += log_reach * log_reach;
  }
  const auto n = static_cast<double>(num_pairs);
  return std::exp(std::sqrt((n - 1.0) / n * std::max(0.0, squares - sum * sum / n)));
}

// score / information^1/2, clipped to +-3. Its variance is about 1 if nothing is shared. The clipping limits
// the influence of a pair with wrong matches or with a field much larger than the others'.
double Standardise(const UnitScore& unit) {
  const double information = unit.information(0, 0);
  return information > 0.0 ? std::clamp(unit.score(0) / std::sqrt(information), -3.0, 3.0) : 0.0;
}

// One-sided test whether the mean of the standardised scores exceeds zero, by their scatter.
bool IsAbove(std::vector<UnitScore> units, double level) {
  for (UnitScore& unit : units) {
    unit.score(0) = Standardise(unit);
    unit.information.setOnes();
  }
  return !units.empty() && PoolScoreAlone(units, 0, 1.0 - 2.0 * level).interval.lower > 0.0;
}

// The score of each pair at the reach where the sum of the other pairs' standardised scores is greatest. The
// choice does not depend on the pair's own score, so testing the mean needs no correction for several
// reaches.
std::vector<UnitScore> TakeAtReachOfOthers(const UnitsByReach& units) {
  std::map<double, double> sums;
  for (const auto& [reach, of_reach] : units) {
    for (const UnitScore& unit : of_reach) sums[reach] += Standardise(unit);
  }
  std::vector<UnitScore> taken;
  for (size_t i = 0; i < units.begin()->second.size(); ++i) {
    double greatest = -kInfinity;
    const UnitScore* best = nullptr;
    for (const auto& [reach, of_reach] : units) {
      const double of_others = sums[reach] - Standardise(of_reach[i]);
      if (of_others <= greatest) continue;
      greatest = of_others;
      best = &of_reach[i];
    }
    taken.push_back(*best);
  }
  return taken;
}

struct PairMoments {
  const FittedPair* pair;
  ResidualMoments moments;
};

enum class Repeats { kFirstOnly, kAll };

std::vector<PairMoments> ComputeAllMoments(const std::vector<FittedPair>& pairs, double longest_px,
                                           Repeats repeats) {
  std::vector<PairMoments> all;
  for (const FittedPair& pair : pairs) {
    const bool is_first_only = repeats == Repeats::kFirstOnly;
    const MatchScores scores = is_first_only ? KeepFirstOfEach(pair.scores) : pair.scores;
    const std::vector<int> groups =
        is_first_only ? Separate(scores.matches.size()) : KeyPointGroups(scores.matches, kKeyPointRadiusPx);
    const std::optional<ResidualMoments> moments =
        ComputeResidualMoments(scores, groups, longest_px / kNeighbourLengthsPx.back());
    if (moments) all.push_back({&pair, *moments});
  }
  return all;
}

// Diagonal of the image, px. For a longer reach an image determines only the ratio of variance to reach.
double FindDiagonal(const std::vector<FittedPair>& pairs) {
  return std::hypot(pairs.front().camera.width, pairs.front().camera.height);
}

constexpr int kLongest = static_cast<int>(kNeighbourLengthsPx.size()) - 1;

// The variance that matches of one key point share, given the variance of the field.
void FitKeyPoints(const std::vector<PairMoments>& all, double field, SharedVariance* shared) {
  constexpr int kParts[] = {kOwnPart, kKeyPointPart};
  std::vector<UnitScore> units;
  double num_repeated = 0.0;
  for (const PairMoments& each : all) {
    const ResidualMoments& m = each.moments;
    if (m.M(kKeyPointPart, kKeyPointPart) < kLeastRepeats) continue;
    num_repeated += m.M(kKeyPointPart, kKeyPointPart);
    const Eigen::Vector2d by_field = field * m.T(kParts, kFirstLengthPart + kLongest);
    units.push_back(Eliminate(each.pair->images, m.q(kParts) - by_field, m.T(kParts, kParts),
                              m.M(kParts, kParts), each.pair->variance));
  }
  shared->key_point = {kNaN, kNaN, {-kInfinity, kInfinity}, 0.0};
  if (units.size() < kLeastPairsWithRepeats || num_repeated < kLeastRepeatsInAll) return;
  shared->key_point = PoolScoreAlone(units, 0, 0.95);
  shared->is_key_point_found = IsAbove(units, kKeyPointLevel);
}

// q_0 = T_00 v_0 + T_01 v_1 + T_0f v_f, summed over pairs.
void FitOwn(const std::vector<PairMoments>& all, SharedVariance* shared) {
  const double field = shared->is_found ? shared->field.variance.value : 0.0,
               key_point = shared->is_key_point_found ? shared->key_point.value : 0.0;
  std::vector<UnitScore> units;
  for (const PairMoments& each : all) {
    const ResidualMoments& m = each.moments;
    const double left = m.q(kOwnPart) - m.T(kOwnPart, kFirstLengthPart + kLongest) * field -
                        m.T(kOwnPart, kKeyPointPart) * key_point;
    units.push_back({each.pair->images.image1, each.pair->images.image2, Eigen::VectorXd::Constant(1, left),
                     Eigen::MatrixXd::Constant(1, 1, m.T(kOwnPart, kOwnPart))});
  }
  shared->own = PoolScoreAlone(units, 0, 0.95);
}

PooledParameter FitFieldAt(const std::vector<FittedPair>& pairs, double reach_px) {
  std::vector<UnitScore> units;
  for (const PairMoments& each : ComputeAllMoments(pairs, reach_px, Repeats::kFirstOnly))
    units.push_back(TakeField(*each.pair, each.moments, kLongest));
  return PoolScoreAlone(units, 0, 0.95);
}

// Sets `unseen` if no field is found. The expected variance is a part of the residuals' variance.
void ExpectUnseen(const std::vector<FittedPair>& pairs, SharedVariance* shared) {
  if (shared->is_found) return;
  shared->unseen.reach_px = FindDiagonal(pairs);
  shared->unseen.variance = FitFieldAt(pairs, shared->unseen.reach_px);
  shared->unseen.variance.value = ExpectVariance(shared->unseen.variance, shared->own.value);
}

}  // namespace

double ExpectVariance(const PooledParameter& estimate, double total) {
  constexpr int kNumSteps = 400;
  constexpr double kLeastShare = 0.01;
  const double sd = 0.5 * (estimate.interval.upper - estimate.interval.lower) / NormalQuantile(0.975);
  if (!std::isfinite(estimate.value) || !std::isfinite(sd) || !(sd > 0.0) || !(total > 0.0)) return 0.0;
  // Likelihoods over that of v = 0, in logarithms until the greatest is known.
  std::vector<double> variances = {0.0}, logs = {0.0};
  for (int i = 0; i < kNumSteps; ++i) {
    const double v = total * std::pow(kLeastShare, 1.0 - (i + 0.5) / kNumSteps);
    variances.push_back(v);
    logs.push_back((v * estimate.value - 0.5 * v * v) / (sd * sd) - std::log(kNumSteps));
  }
  const double greatest = *std::ranges::max_element(logs);
  double sum = 0.0, weighted = 0.0;
  for (size_t i = 0; i < logs.size(); ++i) {
    const double weight = std::exp(logs[i] - greatest);
    sum += weight;
    weighted += weight * variances[i];
  }
  return weighted / sum;
}

SharedVariance FitSharedVariance(const std::vector<FittedPair>& pairs) {
  UnitsByReach units;
  for (const double longest_px : kLongestReachesPx) {
    for (const PairMoments& each : ComputeAllMoments(pairs, longest_px, Repeats::kFirstOnly)) {
      for (int length = 0; length <= kLongest; ++length) {
        const double reach =
            longest_px * kNeighbourLengthsPx[static_cast<size_t>(length)] / kNeighbourLengthsPx.back();
        if (reach > FindDiagonal(pairs)) continue;
        units[std::round(100.0 * reach) / 100.0].push_back(TakeField(*each.pair, each.moments, length));
      }
    }
  }
  SharedVariance shared;
  for (const auto& [reach, of_reach] : units)
    shared.by_reach.push_back(
        {reach, PoolScoreAlone(of_reach, 0, 0.95), ComputeGain(of_reach, kLeaveNoneOut)});
  if (shared.by_reach.empty()) return shared;
  const double reach_px = std::exp(FindLogReach(units, kLeaveNoneOut));
  std::vector<UnitScore> of_field;
  for (const PairMoments& each : ComputeAllMoments(pairs, reach_px, Repeats::kFirstOnly))
    of_field.push_back(TakeField(*each.pair, each.moments, kLongest));
  shared.field = {reach_px, PoolScoreAlone(of_field, 0, 0.95), ComputeGain(of_field, kLeaveNoneOut)};
  shared.is_found = shared.field.gain > 0.0 && IsAbove(TakeAtReachOfOthers(units), kVarianceLevel);
  shared.reach_factor = ComputeReachFactor(units, of_field.size());
  const std::vector<PairMoments> at_reach = ComputeAllMoments(pairs, reach_px, Repeats::kAll);
  FitKeyPoints(at_reach, shared.is_found ? shared.field.variance.value : 0.0, &shared);
  FitOwn(at_reach, &shared);
  ExpectUnseen(pairs, &shared);
  return shared;
}

}  // namespace rcme
