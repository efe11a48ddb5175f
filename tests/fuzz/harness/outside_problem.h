// A problem that estimators outside the program are asked, and what is made of their answers.
#pragma once

#include <string>

#include "estimator/motion_estimator.h"
#include "experiments/trial/answer_check.h"
#include "peers/answer_json.h"
#include "tests/test_support/random_problem.h"

namespace rcme {

// The same for every input: twenty matches.
inline const MotionProblem& OutsideProblem() {
  static const MotionProblem problem = [] {
    RandomStream rng({.seed = 1});
    return MakeRandomProblem(rng, {.num_matches = 20}).problem;
  }();
  return problem;
}
inline RandomStream OutsideStream() { return RandomStream({.seed = 2}); }

inline const std::string& OutsideProblemId() {
  static const std::string id = [] {
    RandomStream rng = OutsideStream();
    return ProblemId(OutsideProblem(), SeedForOutside(rng));
  }();
  return id;
}

// The input with the problem's id in the place of each "PROBLEM", which no mutation would find.
inline std::string WithProblemId(std::string text) {
  const std::string& id = OutsideProblemId();
  constexpr std::string_view kPlaceholder = "PROBLEM";
  for (size_t at = text.find(kPlaceholder); at != std::string::npos;
       at = text.find(kPlaceholder, at + id.size()))
    text.replace(at, kPlaceholder.size(), id);
  return text;
}

// What the estimator makes of the problem, as it is scored.
inline MotionEstimate AskAndJudge(const MotionEstimator& estimator) {
  RandomStream rng = OutsideStream();
  return Judged(estimator.Estimate(OutsideProblem(), rng), OutsideProblem().matches.size());
}

}  // namespace rcme
