#include "experiments/real/camera_noise/shared_variance.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

#include "estimator/robust_covariance/residual_variances.h"
#include "stats/constants.h"

namespace rcme {
namespace {

constexpr double kVarianceLevel = 0.05;
constexpr int kOwnPart = 0, kKeyPointPart = 1, kFirstLengthPart = 2;
constexpr double kLeastRepeats = 1.0;  // key points of two matches, for their variance
// The longest of the three reaches of one set of moments, px; together a ratio of 3^1/2 from 10 to 4,209 px.
const double kLongestReachesPx[] = {90.0, 90.0 * std::sqrt(3.0), 2430.0, 2430.0 * std::sqrt(3.0)};

// Of a field at one reach, and of key points, in one pair: 2 parts, own variance eliminated.
struct VarianceScore {
  Eigen::Vector2d score = Eigen::Vector2d::Zero();  // [field, key points]
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
};

VarianceScore ScoreVariances(const ResidualMoments& moments, int length, double variance) {
  std::vector<int> parts = {kOwnPart, kFirstLengthPart + length};
  const bool has_repeats = moments.M(kKeyPointPart, kKeyPointPart) >= kLeastRepeats;
  if (has_repeats) parts.push_back(kKeyPointPart);
  const Eigen::MatrixXd T = moments.T(parts, parts);
  const Eigen::MatrixXd weighted =
      Eigen::MatrixXd(moments.M(parts, parts)).ldlt().solve(T) / (2.0 * variance * variance);
  const Eigen::MatrixXd N = T.transpose() * weighted;
  const Eigen::VectorXd b = weighted.transpose() * Eigen::VectorXd(moments.q(parts));
  const Eigen::Index k = N.rows() - 1;
  VarianceScore of;
  of.score.head(k) = b.tail(k) - N.col(0).tail(k) * b(0) / N(0, 0);
  of.information.topLeftCorner(k, k) =
      N.bottomRightCorner(k, k) - N.col(0).tail(k) * N.row(0).tail(k) / N(0, 0);
  return of;
}

// The field alone: what key points share eliminated too.
UnitScore TakeField(const FittedPair& pair, const VarianceScore& of) {
  double score = of.score(0), information = of.information(0, 0);
  if (of.information(1, 1) > 0.0) {
    const double slope = of.information(0, 1) / of.information(1, 1);
    score -= slope * of.score(1);
    information -= slope * of.information(1, 0);
  }
  return {pair.images.image1, pair.images.image2, Eigen::VectorXd::Constant(1, score),
          Eigen::MatrixXd::Constant(1, 1, std::max(information, 0.0))};
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

// log reach at the top of the parabola through the greatest gain and its neighbours.
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

// Leaving out one pair at a time; the factor of one standard error.
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

bool IsAbove(const std::vector<UnitScore>& units, double level) {
  return PoolScoreAlone(units, 0, 1.0 - 2.0 * level).interval.lower > 0.0;
}

struct PairMoments {
  const FittedPair* pair;
  ResidualMoments moments;
};

std::vector<PairMoments> ComputeAllMoments(const std::vector<FittedPair>& pairs, double longest_px) {
  std::vector<PairMoments> all;
  for (const FittedPair& pair : pairs) {
    const std::optional<ResidualMoments> moments =
        ComputeResidualMoments(pair.scores, KeyPointGroups(pair.scores.matches, kKeyPointRadiusPx),
                               longest_px / kNeighbourLengthsPx.back());
    if (moments) all.push_back({&pair, *moments});
  }
  return all;
}

constexpr int kLongest = static_cast<int>(kNeighbourLengthsPx.size()) - 1;

// What key points share beside a field of known variance.
void FitKeyPoints(const std::vector<PairMoments>& all, double field, SharedVariance* shared) {
  std::vector<UnitScore> units;
  for (const PairMoments& each : all) {
    const VarianceScore of = ScoreVariances(each.moments, kLongest, each.pair->variance);
    if (!(of.information(1, 1) > 0.0)) continue;
    units.push_back({each.pair->images.image1, each.pair->images.image2,
                     Eigen::VectorXd::Constant(1, of.score(1) - field * of.information(0, 1)),
                     Eigen::MatrixXd::Constant(1, 1, of.information(1, 1))});
  }
  shared->key_point = {kNaN, kNaN, {-kInfinity, kInfinity}, 0.0};
  if (units.empty()) return;
  shared->key_point = PoolScoreAlone(units, 0, 0.95);
  shared->is_key_point_found = IsAbove(units, kVarianceLevel);
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

}  // namespace

SharedVariance FitSharedVariance(const std::vector<FittedPair>& pairs) {
  UnitsByReach units;
  for (const double longest_px : kLongestReachesPx) {
    for (const PairMoments& each : ComputeAllMoments(pairs, longest_px)) {
      for (int length = 0; length <= kLongest; ++length) {
        const double reach =
            longest_px * kNeighbourLengthsPx[static_cast<size_t>(length)] / kNeighbourLengthsPx.back();
        units[std::round(100.0 * reach) / 100.0].push_back(
            TakeField(*each.pair, ScoreVariances(each.moments, length, each.pair->variance)));
      }
    }
  }
  SharedVariance shared;
  for (const auto& [reach, of_reach] : units)
    shared.by_reach.push_back(
        {reach, PoolScoreAlone(of_reach, 0, 0.95), ComputeGain(of_reach, kLeaveNoneOut)});
  if (shared.by_reach.empty()) return shared;
  const double reach_px = std::exp(FindLogReach(units, kLeaveNoneOut));
  const std::vector<PairMoments> at_reach = ComputeAllMoments(pairs, reach_px);
  std::vector<UnitScore> of_field;
  for (const PairMoments& each : at_reach)
    of_field.push_back(TakeField(*each.pair, ScoreVariances(each.moments, kLongest, each.pair->variance)));
  shared.field = {reach_px, PoolScoreAlone(of_field, 0, 0.95), ComputeGain(of_field, kLeaveNoneOut)};
  shared.is_found = shared.field.gain > 0.0 &&
                    IsAbove(of_field, kVarianceLevel / static_cast<double>(shared.by_reach.size()));
  shared.reach_factor = ComputeReachFactor(units, of_field.size());
  FitKeyPoints(at_reach, shared.is_found ? shared.field.variance.value : 0.0, &shared);
  FitOwn(at_reach, &shared);
  return shared;
}

}  // namespace rcme
