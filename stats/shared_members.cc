#include "stats/shared_members.h"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

constexpr std::int64_t kLeastEvents = 5;  // for an estimate of the design effect

// Sum of u_i u_j over all ordered pairs (i, j) that share a member: the squared sums of every member, minus
// those of the pairs that share both members, which would count twice. The values are the u_i.
double SharedProducts(std::span<const PairValue> deviations) {
  std::map<std::int64_t, double> of_member;
  std::map<std::pair<std::int64_t, std::int64_t>, double> of_both;
  for (const auto& [member1, member2, u] : deviations) {
    of_member[member1] += u;
    if (member1 == member2) continue;
    of_member[member2] += u;
    of_both[std::minmax(member1, member2)] += u;
  }
  double sum = 0.0;
  for (const auto& [member, u] : of_member) sum += u * u;
  for (const auto& [both, u] : of_both) sum -= u * u;
  return sum;
}

// Clopper & Pearson's interval for `successes` of n, neither necessarily an integer.
Interval BetaInterval(double successes, double n, double confidence) {
  using Beta = boost::math::beta_distribution<>;
  const double tail = 0.5 * (1.0 - confidence);
  return {successes <= 0.0 ? 0.0 : quantile(Beta(successes, n - successes + 1.0), tail),
          successes >= n ? 1.0 : quantile(Beta(successes + 1.0, n - successes), 1.0 - tail)};
}

// The mean and num_apart, without interval.
SharedGroupMean AverageGroups(std::span<const GroupValue> groups) {
  SharedGroupMean mean{std::ssize(groups), 0, 0.0, {}};
  std::set<std::int64_t> taken;
  for (const auto& [members, value] : groups) {
    mean.value += value;
    if (std::ranges::any_of(members, [&](std::int64_t member) { return taken.contains(member); })) continue;
    taken.insert(members.begin(), members.end());
    ++mean.num_apart;
  }
  mean.value /= static_cast<double>(groups.size());  // NaN without groups; exactly 1 for ones
  return mean;
}

// G in the header.
template <typename Pair>
std::int64_t CountClusters(std::span<const Pair> pairs) {
  std::map<std::int64_t, std::set<std::int64_t>> partners;
  for (const Pair& pair : pairs) {
    partners[pair.member1].insert(pair.member2);
    partners[pair.member2].insert(pair.member1);
  }
  std::int64_t num_halves = 0;  // of pairs whose members have no other partner
  for (const auto& [member, others] : partners)
    num_halves += others.size() == 1 && *others.begin() != member && partners.at(*others.begin()).size() == 1;
  return std::ssize(partners) - num_halves / 2;
}

double ReductionForFewClusters(std::int64_t n, std::int64_t num_clusters, double confidence) {
  if (n < 2 || num_clusters < 2) return 1.0;
  const double p = 0.5 * (1.0 + confidence);
  const double ratio =
      StudentQuantile(static_cast<int>(n - 1), p) / StudentQuantile(static_cast<int>(num_clusters - 1), p);
  return std::min(1.0, ratio * ratio);
}

}  // namespace

SharedMemberRate MeasureSharedMemberRate(std::span<const PairEvent> pairs, double confidence) {
  SharedMemberRate measured;
  measured.n = std::ssize(pairs);
  measured.interval = {0.0, 1.0};
  measured.rate = std::numeric_limits<double>::quiet_NaN();
  if (pairs.empty()) return measured;
  std::set<std::int64_t> members, taken;
  for (const PairEvent& pair : pairs) {
    measured.num_events += pair.happened;
    members.insert({pair.member1, pair.member2});
    if (taken.contains(pair.member1) || taken.contains(pair.member2)) continue;
    taken.insert({pair.member1, pair.member2});
    ++measured.num_apart;
  }
  measured.num_members = std::ssize(members);
  const std::int64_t num_clusters = CountClusters(pairs);
  const double n = static_cast<double>(measured.n), G = static_cast<double>(num_clusters);
  measured.rate = static_cast<double>(measured.num_events) / n;
  const double independent = n * measured.rate * (1.0 - measured.rate);
  if (independent > 0.0 && G > 1.0) {
    std::vector<PairValue> deviations;
    for (const PairEvent& pair : pairs)
      deviations.push_back({pair.member1, pair.member2, (pair.happened ? 1.0 : 0.0) - measured.rate});
    measured.design_effect = std::max(1.0, G / (G - 1.0) * SharedProducts(deviations) / independent);
  }
  measured.effective_n =
      n / measured.design_effect * ReductionForFewClusters(measured.n, num_clusters, confidence);
  if (std::min(measured.num_events, measured.n - measured.num_events) < kLeastEvents)
    measured.effective_n = std::min(measured.effective_n, static_cast<double>(measured.num_apart));
  measured.interval = BetaInterval(measured.rate * measured.effective_n, measured.effective_n, confidence);
  return measured;
}

SharedMemberMean MeasureSharedMemberMean(std::span<const PairValue> pairs, double confidence) {
  std::set<std::int64_t> members;
  double sum = 0.0;
  for (const PairValue& pair : pairs) {
    members.insert({pair.member1, pair.member2});
    sum += pair.value;
  }
  const std::int64_t num_clusters = CountClusters(pairs);
  const double n = static_cast<double>(pairs.size()), G = static_cast<double>(num_clusters);
  SharedMemberMean mean{std::ssize(pairs), std::ssize(members), sum / n, kNaN, {-kInfinity, kInfinity}};
  if (pairs.size() < 2 || num_clusters < 2) return mean;
  std::vector<PairValue> deviations(pairs.begin(), pairs.end());
  double squares = 0.0;
  for (PairValue& pair : deviations) {
    pair.value -= mean.value;
    squares += pair.value * pair.value;
  }
  const double variance =
      std::max(G / (G - 1.0) * SharedProducts(deviations), n / (n - 1.0) * squares) / (n * n);
  mean.standard_error = std::sqrt(variance);
  const double half =
      mean.standard_error * StudentQuantile(static_cast<int>(num_clusters) - 1, 0.5 * (1.0 + confidence));
  mean.interval = {mean.value - half, mean.value + half};
  return mean;
}

SharedGroupMean MeasureSharedGroupMean(std::span<const GroupValue> groups) {
  SharedGroupMean mean = AverageGroups(groups);
  mean.interval = {-kInfinity, kInfinity};
  if (mean.num_apart < 2) return mean;
  double squares = 0.0;
  for (const GroupValue& group : groups) squares += (group.value - mean.value) * (group.value - mean.value);
  const double n = static_cast<double>(mean.n), apart = static_cast<double>(mean.num_apart);
  const double half =
      StudentQuantile(static_cast<int>(mean.num_apart) - 1, 0.975) * std::sqrt(squares / n / (apart - 1.0));
  mean.interval = {mean.value - half, mean.value + half};
  return mean;
}

SharedGroupMean MeasureSharedGroupRate(std::span<const GroupValue> groups) {
  constexpr double kConfidence = 0.95;
  SharedGroupMean rate = AverageGroups(groups);
  const double apart = static_cast<double>(rate.num_apart);
  rate.interval = groups.empty() ? Interval{0.0, 1.0} : BetaInterval(rate.value * apart, apart, kConfidence);
  return rate;
}

}  // namespace rcme
