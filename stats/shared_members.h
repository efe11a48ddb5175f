// Rates of events among pairs of things (two images, two sequences), where pairs that have a thing in common
// are not independent.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

// One pair and whether the event happened to it. Equal members: the observation belongs to that one alone.
struct PairEvent {
  std::int64_t member1 = 0, member2 = 0;
  bool happened = false;
};
// The same with a number.
struct PairValue {
  std::int64_t member1 = 0, member2 = 0;
  double value = 0.0;
};

struct SharedMemberRate {
  std::int64_t num_events = 0, n = 0;
  std::int64_t num_members = 0;
  std::int64_t num_apart = 0;  // pairs of a set (found greedily) in which no two share a member
  double rate = 0.0;           // NaN at n = 0
  double design_effect = 1.0;  // variance of the rate over that of n independent events, at least 1
  double effective_n = 0.0;    // independent events that would tell as much
  Interval interval;
};

// The variance of the rate p allows for any dependence between pairs that share a member (Fafchamps & Gubert
// 2007; Aronow, Samii & Assenova 2015), with u_i = x_i - p and G members in all:
//
//   V = G / (G - 1) sum_(i, j share a member) u_i u_j / n^2,    design effect d = max(1, V / (p (1 - p) /
//   n)).
//
// The interval is the exact binomial one of n* = n / d events at the same rate (Korn & Graubard 1998), n*
// further reduced by (t_(n-1) / t_(G-1))^2, the quantiles of Student's law, since d is itself estimated. A
// bootstrap that draws members again would say [0, 0] where nothing has happened, which is where an interval
// is needed most, and three times the variance where no two pairs share anything (Owen 2007). Of fewer than
// five events, or five that did not happen, d cannot be seen: n* is then at most num_apart, the pairs that
// are independent whatever the others are.
SharedMemberRate MeasureSharedMemberRate(std::span<const PairEvent> pairs, double confidence = 0.95);

struct SharedMemberMean {
  std::int64_t n = 0, num_members = 0;
  double value = 0.0;           // NaN at n = 0
  double standard_error = 0.0;  // NaN below two members or two pairs
  Interval interval;            // then unbounded
};

// The mean, with the same variance (u_i = x_i - mean), at least that of independent numbers: value +-
// t_(G-1) standard errors.
SharedMemberMean MeasureSharedMemberMean(std::span<const PairValue> pairs, double confidence = 0.95);

// A number that is of any number of members, as one of a loop of images is.
struct GroupValue {
  std::vector<std::int64_t> members;
  double value = 0.0;
};

struct SharedGroupMean {
  std::int64_t n = 0;
  std::int64_t num_apart = 0;  // groups of a set (found greedily) in which no two share a member
  double value = 0.0;          // NaN at n = 0
  Interval interval;
};

// The mean over groups that share members, and what is known of it. Where groups are runs of consecutive
// members, of L each, they fall into L classes whose groups are apart, and the mean over all is that of the
// classes' means: its variance is at most that of a class, sigma^2 / a with a = num_apart, whatever the
// correlation of groups that share a member. Neither interval supposes less.
//   a mean   value +- t_(a-1) s / sqrt(a); s^2 = a / (a - 1) sum u_i^2 / n, since the deviations u_i from
//            the mean lack the mean's own variance, of at most sigma^2 / a. Unbounded below two apart.
//   a rate   of values 0 and 1: the exact binomial interval of a events at the same rate (Korn & Graubard
//            1998)
SharedGroupMean MeasureSharedGroupMean(std::span<const GroupValue> groups, double confidence = 0.95);
SharedGroupMean MeasureSharedGroupRate(std::span<const GroupValue> groups, double confidence = 0.95);

}  // namespace rcme
