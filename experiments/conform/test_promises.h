// Are the promises of a rule kept on new problems whose truth is known? Two one-sided tests.
//
// Regions. The promise is an average over calibrations: one of n answers covers, of new answers exchangeable
// with these, a share P ~ Beta(k, n + 1 - k), k >= level (n + 1). So the number covered of m new ones is
// beta-binomial, and the p-value P(X <= covered) with a = level (n + 1), b = (1 - level) (n + 1) is at most a
// beyond the share a of calibrations and checks: a greater k covers more. Strata, each with its own bound,
// are taken as one of all n: in a stratum of n_s answers P_s has the variance level (1 - level) / (n_s + 2),
// and their mean by n_s the variance of the one or less. Which answers have trained models the file does not
// say; n is the share that is left where models are trained, fewer than where none are, which widens the law
// of P. Where problems share groups a group gives one problem at random, as the promise is for, and n counts
// groups.
//
// Accept rule. The promise is of one calibration (it may break in the share `risk` of them), so the p-value
// is of "at most `wrong_and_accepted` of the problems are answered wrongly and accepted by this rule": exact
// binomial, or of the groups' mean losses (stats/risk_control.h).
#pragma once

#include <cstdint>
#include <vector>

#include "experiments/conform/cross_validate.h"

namespace rcme {

inline constexpr double kPromiseLevel = 0.025;  // of both tests together, half for each

struct PromiseFinding {
  std::int64_t num_answers = 0;   // of which the regions are tested: one of each group
  std::int64_t num_problems = 0;  // groups, also those without an answer
  double coverage_p_value = 1.0, accept_p_value = 1.0;

  bool IsCoverageRefuted() const { return coverage_p_value <= kPromiseLevel / 2.0; }
  bool IsAcceptRefuted() const { return accept_p_value <= kPromiseLevel / 2.0; }
  bool IsAnyRefuted() const { return IsCoverageRefuted() || IsAcceptRefuted(); }
};

// `judged`: the rows of `answers`, by the rule.
PromiseFinding TestPromises(const ConformRule& rule, const AnswerRows& answers,
                            const std::vector<JudgedAnswer>& judged);

}  // namespace rcme
