// Rates of events among pairs (of images, of sequences); pairs with a common member are dependent.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

// One pair and whether the event happened to it. Equal members: the observation has a single member.
struct PairEvent {
  std::int64_t member1 = 0, member2 = 0;
  bool happened = false;
};
// A pair with a number.
struct PairValue {
  std::int64_t member1 = 0, member2 = 0;
  double value = 0.0;
};

struct SharedMemberRate {
  std::int64_t num_events = 0, n = 0;
  std::int64_t num_members = 0;
  std::int64_t num_apart = 0;  // size of a set of pairs (found greedily) without common members
  double rate = 0.0;           // NaN at n = 0
  double design_effect = 1.0;  // variance of the rate over that of n independent trials, at least 1
  double effective_n = 0.0;    // number of independent trials with the same information
  Interval interval;
};

// The variance of the rate p allows for any dependence between pairs that share a member (Fafchamps & Gubert
// 2007; Aronow, Samii & Assenova 2015). With u_i = x_i - p and G clusters, which are the members, except that
// two members without other partners are one (they have the same observations):
//
//   V = G / (G - 1) sum_(i, j share a member) u_i u_j / n^2,
//   design effect d = max(1, V / (p (1 - p) / n)).
//
// The interval is the exact binomial one of n* = n / d trials at the same rate (Korn & Graubard 1998). n* is
// further reduced by (t_(n-1) / t_(G-1))^2, the quantiles of Student's law, since d is itself estimated. A
// bootstrap over members would give [0, 0] if nothing has happened, where an interval is needed most, and
// three times the variance if no two pairs share anything (Owen 2007). With fewer than five events, or five
// non-events, d cannot be estimated: n* is then at most num_apart, the number of pairs that are independent
// in any case.
SharedMemberRate MeasureSharedMemberRate(std::span<const PairEvent> pairs, double confidence = 0.95);

struct SharedMemberMean {
  std::int64_t n = 0, num_members = 0;
  double value = 0.0;           // NaN at n = 0
  double standard_error = 0.0;  // NaN below two clusters or two observations
  Interval interval;            // unbounded if there is no standard error
};

// The mean with the same variance (u_i = x_i - mean), at least that of independent numbers: value +- t_(G-1)
// standard errors.
SharedMemberMean MeasureSharedMemberMean(std::span<const PairValue> pairs, double confidence = 0.95);

// A number with any number of members, such as that of a loop of images.
struct GroupValue {
  std::vector<std::int64_t> members;
  double value = 0.0;
};

struct SharedGroupMean {
  std::int64_t n = 0;
  std::int64_t num_apart = 0;  // size of a set of groups (found greedily) without common members
  double value = 0.0;          // NaN at n = 0
  Interval interval;
};

// The mean over groups that share members, with its 95 % interval. Groups that are runs of L consecutive
// members fall into L classes whose groups have no common member, and the mean over all groups is the mean of
// the class means. Its variance is therefore at most that of one class, sigma^2 / a with a = num_apart,
// whatever the correlation of groups that share a member. Both intervals assume this bound.
//   a mean   value +- t_(a-1) s / sqrt(a); s^2 = a / (a - 1) sum u_i^2 / n, since the deviations u_i from
//            the mean lack the variance of the mean itself, at most sigma^2 / a. Unbounded if num_apart < 2.
//   a rate   of values 0 and 1: the exact binomial interval of a trials at the same rate (Korn & Graubard
//            1998)
SharedGroupMean MeasureSharedGroupMean(std::span<const GroupValue> groups);
SharedGroupMean MeasureSharedGroupRate(std::span<const GroupValue> groups);

}  // namespace rcme
