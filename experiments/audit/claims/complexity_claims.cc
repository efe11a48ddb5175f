#include <algorithm>
#include <cmath>
#include <numeric>

#include "estimator/refinement/reprojection_mle.h"
#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/design.h"
#include "experiments/audit/claims/families.h"
#include "experiments/core/work/thread_time.h"

namespace rcme {
namespace {

// Slope of the least-squares line of log y over log x.
double Exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double mean_x = 0.0, mean_y = 0.0, products = 0.0, squares = 0.0;
  const double n = static_cast<double>(x.size());
  for (size_t i = 0; i < x.size(); ++i) mean_x += std::log(x[i]) / n, mean_y += std::log(y[i]) / n;
  for (size_t i = 0; i < x.size(); ++i) {
    products += (std::log(x[i]) - mean_x) * (std::log(y[i]) - mean_y);
    squares += (std::log(x[i]) - mean_x) * (std::log(x[i]) - mean_x);
  }
  return products / squares;
}

// Processor time of this thread, s: the lesser of two runs, so that other load of the machine matters little.
double MeasureSeconds(const std::function<void()>& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int run = 0; run < 2; ++run) {
    const double start = ThreadSeconds();
    work();
    least = std::min(least, ThreadSeconds() - start);
  }
  return least;
}

MotionProblem FirstMatches(const MotionProblem& problem, double count) {
  MotionProblem part = problem;
  part.matches.resize(static_cast<size_t>(count));
  if (!part.noise_scale.empty()) part.noise_scale.resize(part.matches.size());
  if (!part.match_quality.empty()) part.match_quality.resize(part.matches.size());
  return part;
}

double SecondsOfLoop(const MotionProblem& problem, double num_iterations, const StreamName& name) {
  const std::unique_ptr<MotionEstimator> prcme = MakeEstimator(
      "prcme",
      {{"num_iterations", std::to_string(static_cast<int>(num_iterations))}, {"refinement", "none"}});
  return MeasureSeconds([&] {
    RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
    prcme->Estimate(problem, rng);
  });
}

// Exponents of the loop's time in n (at N = 50) and in N (at n = 500).
Outcome LoopStatistic(Case& made) {
  const std::vector<double> ns = {500, 1000, 2000}, Ns = {50, 100, 200};
  std::vector<double> times_n, times_N;
  for (const double n : ns) times_n.push_back(SecondsOfLoop(FirstMatches(made.problem(), n), 50, made.name));
  const MotionProblem few = FirstMatches(made.problem(), 500);
  for (const double N : Ns) times_N.push_back(SecondsOfLoop(few, N, made.name));
  return {Exponent(ns, times_n), Exponent(Ns, times_N)};
}

RefinedMotion Refine(const MotionProblem& problem, const RelativePose& start) {
  std::vector<int> indices(problem.matches.size());
  std::iota(indices.begin(), indices.end(), 0);
  return RefineByReprojection(problem, indices, start, Loss::kSquared);
}

// Exponent of the refinement's time in n, from a start 2 deg off.
Outcome RefinementStatistic(Case& made) {
  const std::vector<double> ns = {100, 200, 400, 800, 1600};
  const RelativePose start = Retract(made.pose_true(), Vector5d::Constant(0.035 / std::sqrt(5.0)));
  std::vector<double> times;
  for (const double n : ns) {
    const MotionProblem part = FirstMatches(made.problem(), n);
    times.push_back(MeasureSeconds([&] { Refine(part, start); }));
  }
  return {Exponent(ns, times)};
}

Check TimedCheck(const char* num_matches, const Statistic& statistic, const std::vector<Target>& targets,
                 const CheckDesign& design) {
  Check check = MakeCheck({{"num_matches", num_matches}}, statistic, targets, design.limits);
  check.is_timed = true;
  return check;
}

}  // namespace

std::vector<Claim> ComplexityClaims() {
  const char* kLabel = "Thm. complexity";
  return {{"complexity.loop",
           kLabel,
           "pRCME as printed: every sample is scored",
           "The loop takes O(N n): exponents 1 and 1 (within 0.15)",
           "slope of log time over log n (N = 50) and over log N (n = 500)",
           "",
           {TimedCheck("2000", LoopStatistic,
                       {PlannedMean("exponent in n", 1.0, kLoopExponent, 0),
                        PlannedMean("exponent in N", 1.0, kLoopExponent, 1)},
                       kLoopExponent)}},
          {"complexity.refinement",
           kLabel,
           "bundle adjustment, Schur complement",
           "The refinement takes O(n^3): exponent 3 (within 0.3)",
           "slope of log time over log n",
           "",
           {TimedCheck("1600", RefinementStatistic, {PlannedMean("exponent in n", 3.0, kRefinementExponent)},
                       kRefinementExponent)}}};
}

}  // namespace rcme
