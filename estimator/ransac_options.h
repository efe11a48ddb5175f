#pragma once

#include <limits>
#include <vector>

#include "parameters/parameter.h"

namespace rcme {

// Two interpretations of the paper's Sampson covariance (docs/estimators.md).
enum class Reading {
  kAsPrinted,  // full 4x4 inverse, chi2_3, entropy of a 4-dimensional Gaussian; each sample point is tested
               // on its own
  kRankAware,  // the residual has one dimension: chi2_1, entropy of that dimension; the points of a sample
               // are tested jointly, chi2 with the solver's kSampleTestDof (eight points: three)
};

// The rule that rejects H0 "psi > mu" (eq::inlier-quality-test).
enum class QualityTest {
  kAsPrinted,   // Z <= +Phi^-1(1 - alpha), as the paper prints it
  kLevelAlpha,  // Z <= -Phi^-1(1 - alpha), of size alpha if the entropies were independent
};

// The score that selects the winner.
enum class Selection {
  kMeanEntropy,           // least psi (eq::model_select_entropy)
  kPredictiveLikelihood,  // greatest predictive likelihood of all matches; rank-aware reading only
};

enum class Refinement {
  kNone,    // none: the winner's motion with its first-order covariance
  kMle,     // the paper's: least squares over the winner's inlier set
  kRobust,  // Cauchy loss over the winner's inlier set, then least squares over the matches that agree with
            // the result
};

// The error that the refinement minimises.
enum class RefinementError {
  kSampson,       // Sampson distance, over the motion alone; same optimum up to second order in the noise
  kReprojection,  // reprojection error, over the motion and one point per match: bundle adjustment
};

// The minimal solver: matches of a sample -> F -> motion (solvers/minimal_solver.h). The enumerators are in
// solvers/solver_list.h.
enum class MinimalSolver : int;

// Two implementations of the same mathematics. They agree to rounding, except where five-point solutions
// nearly coincide: each then misses other solutions (kernels/five_point_block.h).
enum class Implementation {
  kAutomatic,  // fast if the solver has it, else reference
  kFast,       // eight hypotheses and matches at a time, in closed form (kernels/); for eight and five points
  kReference,  // one hypothesis and match at a time, small matrices: the oracle of the tests
};

// Options of the loop and the refinement of the RANSAC family (standard, prcme, rcme, ...). Each estimator
// offers only the options that have an effect on it. Defaults are the paper's where it gives a value.
struct RansacOptions {
  MinimalSolver solver{};            // eight_point, the first of the list
  int num_iterations = 200;          // N samples; fewer only if early_stop_entropy stops the loop
  double significance_level = 0.05;  // alpha of all tests of the loop
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
  int num_refined = 1;  // number of candidates refined; the motion that explains most matches wins
  double least_explained_share = 0.0;  // a refined motion that explains less of the matches is refused
  // Significance levels of the two tests that may refuse the refined motion: the greatest probability of an
  // answer if the null hypothesis holds. 1: off. NaN: off as printed (the paper has neither test), 0.001
  // rank-aware.
  double observability_significance_level = std::numeric_limits<double>::quiet_NaN();  // observability.h
  double chance_significance_level = std::numeric_limits<double>::quiet_NaN();         // motion_chance.h
  double kappa = 0.5;  // failure flag: n*_I / n_I <= kappa (eq::metric)

  // mu, or the default of the reading. As printed: -3.53 nats, of a 4-dimensional density in px. Rank-aware:
  // 6 nats of excess entropy; at 40 % outliers a bound of 3 nats refused 23 % of 150 trials and 6 nats 5 %,
  // with no more failures.
  double MuOrDefault() const;
  double SampleLevelOrDefault() const;
  bool IsFast() const;  // resolves kAutomatic
  double ObservabilityLevelOrDefault() const;
  double ChanceLevelOrDefault() const;
};

// A mu above any entropy, the upper end of the option's range: every inlier set passes.
inline constexpr double kNoQualityTest = 1000.0;

// The fields as named options, for study files and the command line; valid as long as `options` lives.
// The options that every estimator of the family has:
std::vector<Parameter> Parameters(RansacOptions& options);
// The options of estimators that compute entropies:
std::vector<Parameter> EntropyParameters(RansacOptions& options);
// The option of estimators that test a model against its sample:
Parameter SampleTestParameter(RansacOptions& options);
// The levels of the tests of the refined motion; the default is off, or "auto" if they depend on the reading:
std::vector<Parameter> MotionTestParameters(RansacOptions& options, bool depend_on_reading);

// Throws InputError if two options contradict each other.
void Validate(const RansacOptions& options);

}  // namespace rcme
