#pragma once

#include <limits>
#include <vector>

#include "parameters/parameter.h"

namespace rcme {

// Two readings of the paper's Sampson covariance (docs/estimators.md).
enum class Reading {
  kAsPrinted,  // full 4x4 inverse, chi2_3, entropy of a 4-dimensional Gaussian; each sample point tested on
               // its own
  kRankAware,  // the residual has one dimension: chi2_1, entropy of that dimension; the sample tested
               // jointly, chi2 with the solver's kSampleTestDof (three of eight points)
};

// When H0 "psi > mu" is rejected (eq::inlier-quality-test).
enum class QualityTest {
  kAsPrinted,   // Z <= +Phi^-1(1 - alpha), as the paper prints it
  kLevelAlpha,  // Z <= -Phi^-1(1 - alpha), a test whose size is alpha if entropies were independent
};

// Which candidate wins.
enum class Selection {
  kMeanEntropy,           // least psi (eq::model_select_entropy)
  kPredictiveLikelihood,  // greatest predictive likelihood of all matches; rank-aware reading only
};

enum class Refinement {
  kNone,    // the winner's motion as it is, with its first-order covariance
  kMle,     // the paper's: least squares of the reprojection error over the winner's inlier set
  kRobust,  // Cauchy loss over the winner's inlier set, then least squares over the matches that agree with
            // the result
};

// What the refinement minimises.
enum class RefinementError {
  kSampson,       // Sampson distance, over the motion alone; the same optimum to second order in the noise
  kReprojection,  // reprojection error, over the motion and one point per match: bundle adjustment
};

// What makes the hypotheses: matches of a sample -> F -> motion (solvers/minimal_solver.h).
// solvers/solver_list.h has the list.
enum class MinimalSolver : int;

// Two implementations of the same mathematics. They agree to rounding, but for solutions of five points that
// nearly coincide, of which each misses others (kernels/five_point_block.h).
enum class Implementation {
  kAutomatic,  // fast where the solver has it, else reference
  kFast,       // eight hypotheses, eight matches at a time, closed forms: kernels/; of eight and five points
  kReference,  // one by one, small matrices: the oracle of the tests
};

// Options of the loop and the refinement of the RANSAC family (standard, prcme, rcme), each of which shows
// those that have an effect on it. Defaults are the paper's where it gives a value.
struct RansacOptions {
  MinimalSolver solver{};            // the first of the list, eight_point
  int num_iterations = 200;          // N samples; fewer only where early_stop_entropy stops the loop
  double significance_level = 0.05;  // alpha of every test, the sample test's unless that has its own
  double sample_significance_level = std::numeric_limits<double>::quiet_NaN();  // NaN: significance_level
  Reading reading = Reading::kAsPrinted;
  double mu = std::numeric_limits<double>::quiet_NaN();  // entropy threshold, nats; NaN: MuOrDefault
  QualityTest quality_test = QualityTest::kAsPrinted;
  double lambda = 0.5;  // least inlier share as a fraction of omega_p, 0.5 <= lambda <= 1
  double inlier_ratio = std::numeric_limits<double>::quiet_NaN();  // omega_p; NaN: inferred during the loop
  Selection selection = Selection::kMeanEntropy;
  double early_stop_entropy = std::numeric_limits<double>::quiet_NaN();  // NaN: off
  Refinement refinement = Refinement::kRobust;
  RefinementError refinement_error = RefinementError::kSampson;
  Implementation implementation = Implementation::kAutomatic;
  int num_refined = 1;  // number of top candidates refined; the one that explains most matches wins
  double least_explained_share = 0.0;  // of the matches, by the refined motion; less is refused
  // Significance levels of the tests that may refuse the refined motion: the greatest probability of an
  // answer where the test's null hypothesis holds; 1: off; NaN: off as printed (the paper has neither test),
  // 0.001 rank-aware.
  double observability_significance_level = std::numeric_limits<double>::quiet_NaN();  // observability.h
  double chance_significance_level = std::numeric_limits<double>::quiet_NaN();         // motion_chance.h
  double kappa = 0.5;  // failure flag: n*_I / n_I <= kappa (eq::metric)

  // mu, or the default of the reading: -3.53 as printed (of a 4-dimensional density in px: it has units);
  // rank-aware, 6 nats of excess entropy: at 40 % outliers 3 nats refused 23 % of 150 trials and 6 nats 5 %,
  // with no more failures.
  double MuOrDefault() const;
  double SampleLevelOrDefault() const;
  bool IsFast() const;  // what implementation says, decided
  double ObservabilityLevelOrDefault() const;
  double ChanceLevelOrDefault() const;
};

// A mu above any entropy, the upper end of its range: every inlier set passes.
inline constexpr double kNoQualityTest = 1000.0;

// The fields by name, for study files and the command line; valid as long as `options` lives. Those that
// every estimator of the family has;
std::vector<Parameter> Parameters(RansacOptions& options);
// of estimators that have entropies;
std::vector<Parameter> EntropyParameters(RansacOptions& options);
// of those that test a model against its sample;
Parameter SampleTestParameter(RansacOptions& options);
// the levels of the tests of the refined motion, by default off, or as the reading says.
std::vector<Parameter> MotionTestParameters(RansacOptions& options, bool depend_on_reading);

// Throws InputError where two options contradict each other.
void Validate(const RansacOptions& options);

}  // namespace rcme
