#include "estimator/ransac_options.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "estimator/solvers/solver_table.h"
#include "parameters/input_error.h"

namespace rcme {

double RansacOptions::MuOrDefault() const {
  if (!std::isnan(mu)) return mu;
  return reading == Reading::kAsPrinted ? -3.53 : 6.0;
}

double RansacOptions::SampleLevelOrDefault() const {
  return std::isnan(sample_significance_level) ? significance_level : sample_significance_level;
}

namespace {

bool HasFast(MinimalSolver solver) {
  return VisitSolver(solver, []<typename Solver>(std::type_identity<Solver>) { return kHasFast<Solver>; });
}

double LevelOrDefault(double level, Reading reading) {
  if (!std::isnan(level)) return level;
  return reading == Reading::kAsPrinted ? 1.0 : 0.001;
}

}  // namespace

bool RansacOptions::IsFast() const {
  return implementation == Implementation::kFast ||
         (implementation == Implementation::kAutomatic && HasFast(solver));
}

double RansacOptions::ObservabilityLevelOrDefault() const {
  return LevelOrDefault(observability_significance_level, reading);
}

double RansacOptions::ChanceLevelOrDefault() const {
  return LevelOrDefault(chance_significance_level, reading);
}

std::vector<Parameter> Parameters(RansacOptions& o) {
  return {
      Parameter::Choice<MinimalSolver>("solver", &o.solver, SolverNames(),
                                       "minimal solver; one_point: a car on a plane"),
      Parameter::Integer("num_iterations", &o.num_iterations, {1, 1e6}, "samples N of Algorithm 1"),
      Parameter::Real("significance_level", &o.significance_level, {1e-9, 0.5}, "",
                      "alpha of the loop's tests and of agreement with the refined motion"),
      Parameter::Real("lambda", &o.lambda, {0.0, 1.0}, "", "least inlier share as a fraction of omega_p"),
      Parameter::RealOrWord("inlier_ratio", &o.inlier_ratio, {0.0, 1.0}, "inferred", "",
                            "omega_p, the expected share of inliers"),
      Parameter::Choice<Refinement>(
          "refinement", &o.refinement,
          {{"none", Refinement::kNone}, {"mle", Refinement::kMle}, {"robust", Refinement::kRobust}},
          "none, the paper's MLE, or a robust loss and then the MLE"),
      Parameter::Choice<RefinementError>(
          "refinement_error", &o.refinement_error,
          {{"sampson", RefinementError::kSampson}, {"reprojection", RefinementError::kReprojection}},
          "Sampson distance (fast) or reprojection error (bundle adjustment)"),
      Parameter::Choice<Implementation>(
          "implementation", &o.implementation,
          {{"automatic", Implementation::kAutomatic},
           {"fast", Implementation::kFast},
           {"reference", Implementation::kReference}},
          "fast: vectorised, for eight_point and five_point alone; reference: independent, one match "
          "at a time; automatic: fast where there is one"),
      Parameter::Integer("num_refined", &o.num_refined, {1, 1000},
                         "top candidates refined; the one that explains most matches wins"),
      Parameter::Real("least_explained_share", &o.least_explained_share, {0.0, 1.0}, "",
                      "a refined motion that explains less is refused"),
      Parameter::Real("kappa", &o.kappa, {0.0, 1.0}, "",
                      "failure flag: consistent matches after / before refinement <= kappa"),
  };
}

std::vector<Parameter> EntropyParameters(RansacOptions& o) {
  return {
      Parameter::Choice<Reading>("reading", &o.reading,
                                 {{"as_printed", Reading::kAsPrinted}, {"rank_aware", Reading::kRankAware}},
                                 "of the covariance of the Sampson vector"),
      Parameter::RealOrWord("mu", &o.mu, {-1000.0, 1000.0}, "auto", "nats",
                            "entropy threshold; auto: -3.53 as printed, excess entropy 6 rank-aware"),
      Parameter::Choice<QualityTest>(
          "quality_test", &o.quality_test,
          {{"as_printed", QualityTest::kAsPrinted}, {"level_alpha", QualityTest::kLevelAlpha}},
          "mean entropy's Z <= +1.645 (as printed) or <= -1.645 (level alpha)"),
      Parameter::Choice<Selection>("selection", &o.selection,
                                   {{"mean_entropy", Selection::kMeanEntropy},
                                    {"predictive_likelihood", Selection::kPredictiveLikelihood}},
                                   "criterion of the winning candidate"),
      Parameter::RealOrWord("early_stop_entropy", &o.early_stop_entropy, {-1000.0, 1000.0}, "off", "nats",
                            "stop at the first candidate with at most this mean entropy"),
  };
}

Parameter SampleTestParameter(RansacOptions& o) {
  return Parameter::RealOrWord("sample_significance_level", &o.sample_significance_level, {1e-9, 0.5},
                               "significance_level", "", "alpha of the sample test");
}

std::vector<Parameter> MotionTestParameters(RansacOptions& o, bool depend_on_reading) {
  std::vector<std::pair<std::string, double>> words = {{"off", 1.0}};
  std::string rule;
  if (depend_on_reading) {
    words.insert(words.begin(), {"auto", std::numeric_limits<double>::quiet_NaN()});
    rule = "; auto: off as printed, 0.001 rank-aware";
  }
  return {
      Parameter::RealOrWords(
          "observability_significance_level", &o.observability_significance_level, {1e-9, 1.0}, words, "",
          "greatest probability that a pure rotation passes; refusal: direction_not_observable" + rule),
      Parameter::RealOrWords(
          "chance_significance_level", &o.chance_significance_level, {1e-9, 1.0}, words, "",
          "greatest probability that random matches pass; refusal: not_better_than_chance" + rule),
  };
}

void Validate(const RansacOptions& options) {
  if (options.implementation == Implementation::kFast && !HasFast(options.solver)) {
    std::string solvers;
    for (const auto& [name, solver] : SolverNames()) {
      if (HasFast(solver)) solvers += (solvers.empty() ? "" : ", ") + name;
    }
    throw InputError(fmt::format(
        "implementation: 'fast' exists for the solvers {} alone; say automatic or reference", solvers));
  }
  if (options.selection == Selection::kPredictiveLikelihood && options.reading == Reading::kAsPrinted) {
    throw InputError(
        "selection: 'predictive_likelihood' needs reading: rank_aware (as printed, the residual has no "
        "density)");
  }
}

}  // namespace rcme
