// Tests whether a rule keeps its promises on new problems with known truth. There are two one-sided tests.
//
// Regions. Their promise is an average over calibrations. A calibration with n answers covers a share
// P ~ Beta(k, n + 1 - k), k >= level (n + 1), of new answers exchangeable with these. The number X covered of
// m new answers is therefore beta-binomial. The p-value is P(X <= covered) with the parameters
// level (n + 1) and (1 - level) (n + 1). Over calibrations and checks it is at most p with probability at
// most p, since a greater k covers more.
//   - Each stratum has its own bound, but all are treated as one stratum of n answers. In a stratum of n_s
//     answers P_s has the variance level (1 - level) / (n_s + 2). The mean of P_s weighted by n_s has at most
//     the variance of the single stratum.
//   - The file does not say how many answers trained the models. n is the number left after training. It is
//     too small for a rule without training, which widens the distribution of P.
//   - If problems share groups, one random problem of each group is tested, as in the promise, and n counts
//     groups.
//
// Accept rule. Its promise is for one calibration and may break in the share `risk` of them. The hypothesis
// is "at most `wrong_and_accepted` of the problems are answered wrongly and accepted by this rule". The
// p-value is exact binomial, or from the groups' mean losses if problems share groups (stats/risk_control.h).
#pragma once

#include <cstdint>
#include <vector>

#include "experiments/conform/cross_validate.h"

namespace rcme {

inline constexpr double kPromiseLevel = 0.025;  // of both tests together, half for each

struct PromiseFinding {
  std::int64_t num_answers = 0;   // whose regions are tested, at most one of each group
  std::int64_t num_problems = 0;  // groups, including those without an answer
  double coverage_p_value = 1.0, accept_p_value = 1.0;

  bool IsCoverageRefuted() const { return coverage_p_value <= kPromiseLevel / 2.0; }
  bool IsAcceptRefuted() const { return accept_p_value <= kPromiseLevel / 2.0; }
  bool IsAnyRefuted() const { return IsCoverageRefuted() || IsAcceptRefuted(); }
};

// `judged`: the rows of `answers` as judged by the rule.
PromiseFinding TestPromises(const ConformRule& rule, const AnswerRows& answers,
                            const std::vector<JudgedAnswer>& judged);

}  // namespace rcme
