// What is asked of the options of every estimator in the registry: that each has an effect, that texts go
// round, that defaults are allowed.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "estimator/estimator_registry.h"
#include "parameters/input_error.h"
#include "tests/test_support/estimator_variants.h"
#include "tests/test_support/family_problem.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {

// Two bodies that move differently.
inline MotionProblem TwoBodies() {
  MotionProblem problem = TwoCameraProblem(60, 0.5, 0.0, 1);
  const MotionProblem object = TwoCameraProblem(60, 0.5, 0.0, 2);
  problem.matches.insert(problem.matches.end(), object.matches.begin(), object.matches.end());
  return problem;
}

// 30 % wrong matches; so many that samples without one are rare; nearly all wrong; most on a plane; a camera
// that only turns; an object that moves.
inline std::vector<MotionProblem> Problems() {
  const Scene turn = TwoCameraScene(60, 0, /*baseline_m=*/0.0);
  const Observation observed = ObserveTwoCameraScene(turn, 0.5, 0.0, 0);
  return {TwoCameraProblem(60, 0.5, 0.3, 0),
          TwoCameraProblem(150, 0.5, 0.6, 0),
          TwoCameraProblem(100, 0.5, 0.98, 0),
          ProblemFamily("plane_and_parallax", "general", 100, 0.0).Make(0),
          {observed.matches, turn.camera1, turn.camera2, 0.5},
          TwoBodies()};
}

// All that an estimate says, as numbers; NaN is its own equal.
inline std::vector<double> ListEstimateNumbers(const MotionEstimate& e) {
  std::vector<double> numbers(e.inliers.begin(), e.inliers.end());
  for (const auto& matrix : {Eigen::MatrixXd(e.cam2_from_cam1.R), Eigen::MatrixXd(e.cam2_from_cam1.t),
                             Eigen::MatrixXd(e.pose_cov)}) {
    numbers.insert(numbers.end(), matrix.data(), matrix.data() + matrix.size());
  }
  const LoopCounts& c = e.counts;
  for (const double x : {1.0 * static_cast<int>(e.status), 1.0 * e.num_support, 1.0 * e.failed_by_kappa,
                         1.0 * c.num_hypotheses, 1.0 * c.num_inconsistent_samples,
                         1.0 * c.num_poor_inlier_sets, 1.0 * c.num_candidates, e.failure_probability}) {
    numbers.push_back(x);
  }
  for (double& x : numbers) x = std::isnan(x) ? 1e300 : x;
  return numbers;
}

// Null where the options contradict each other.
inline std::unique_ptr<MotionEstimator> MakeIfAllowed(const std::string& estimator, const Settings& options) {
  try {
    return MakeEstimator(estimator, options);
  } catch (const InputError&) {
    return nullptr;
  }
}

inline std::vector<double> Answer(const MotionEstimator& estimator, const MotionProblem& problem) {
  RandomStream rng({1, 0, 0, 4});
  return ListEstimateNumbers(estimator.Estimate(problem, rng));
}

// Values of all kinds that an option may take.
inline std::vector<std::string> ValuesFor(const Parameter& option) {
  std::vector<std::string> values = ListChoiceWords(option), allowed;
  for (const char* value : {"off", "0", "1e-09", "0.001", "0.3", "0.9", "1", "5", "40", "-10", "100"}) {
    values.push_back(value);
  }
  for (const std::string& value : values) {
    try {
      option.SetFromText(value);
      allowed.push_back(value);
    } catch (const InputError&) {
    }
  }
  return allowed;
}

// Options in whose company others matter, of those that the estimator has.
inline std::vector<Settings> Companies(const std::vector<Parameter>& options) {
  std::vector<Settings> companies = {{}};
  for (const auto& [name, value] : Settings{{"reading", "rank_aware"},
                                            {"inlier_ratio", "0.9"},
                                            {"refinement", "none"},
                                            {"lambda", "1"},
                                            {"covariance", "robust"},
                                            {"model_choice", "gic"},
                                            {"model_choice", "orb_slam2"}}) {
    if (std::ranges::count(options, name, &Parameter::name) > 0) companies.push_back({{name, value}});
  }
  return companies;
}

inline bool HasEffectOn(const std::vector<MotionProblem>& problems, const std::string& estimator,
                        const std::string& option) {
  const std::unique_ptr<EstimatorModel> model = FindEstimator(estimator).make();
  const std::vector<Parameter> options = model->Parameters();
  const std::vector<std::string> values = ValuesFor(FindOption(estimator, options, option));
  for (Settings company : Companies(options)) {
    const std::unique_ptr<MotionEstimator> without = MakeIfAllowed(estimator, company);
    if (!without) continue;
    std::vector<std::vector<double>> answers_without;  // of the first problems, as far as one was asked for
    for (const std::string& value : values) {
      company.emplace_back(option, value);
      const std::unique_ptr<MotionEstimator> with = MakeIfAllowed(estimator, company);
      company.pop_back();
      for (std::size_t i = 0; with && i < problems.size(); ++i) {
        if (i == answers_without.size()) answers_without.push_back(Answer(*without, problems[i]));
        if (Answer(*with, problems[i]) != answers_without[i]) return true;
      }
    }
  }
  return false;
}

// Half the matches wrong: which hypothesis wins, and whether it should be answered, is near a tie in one of
// ten problems or more.
inline std::vector<MotionProblem> CloseProblems() {
  std::vector<MotionProblem> problems;
  for (std::uint32_t trial = 0; trial < 40; ++trial)
    problems.push_back(TwoCameraProblem(60, 0.5, 0.5, trial));
  return problems;
}

inline bool HasEffect(const std::string& estimator, const std::string& option) {
  return HasEffectOn(Problems(), estimator, option) || HasEffectOn(CloseProblems(), estimator, option);
}

// Of the gate, which is the same before every estimator.
inline bool IsOfTheGate(const std::string& option) {
  return option == "model_choice" || option == "planar_scenes" || option == "parallax_significance_level" ||
         option == "least_parallax_share";
}

// Of the robust covariance, which is the same of every estimator but rcme_calibrated, which has its own.
inline bool IsOfTheCovariance(const std::string& option) {
  return option.starts_with("covariance") || option == "focal_sd" || option == "principal_point_sd_px" ||
         option == "distortion_sd";
}

// All but the implementation, which takes another time to the same answer, and those that are the same of
// every estimator, which `standard` is asked for.
inline void ExpectEveryOptionHasAnEffect(const EstimatorEntry& entry) {
  const std::unique_ptr<EstimatorModel> model = entry.make();
  const bool has_own_covariance = entry.name == "standard" || entry.name == "rcme_calibrated";
  for (const Parameter& option : model->Parameters()) {
    if (option.name() == "implementation") continue;
    if (entry.name != "standard" && IsOfTheGate(option.name())) continue;
    if (!has_own_covariance && IsOfTheCovariance(option.name())) continue;
    EXPECT_TRUE(HasEffect(entry.name, option.name())) << entry.name << ": " << option.name();
  }
}

inline void ExpectTextsGoRound(const EstimatorEntry& entry) {
  const std::unique_ptr<EstimatorModel> model = entry.make();
  const Settings defaults = ListValues(model->Parameters());
  for (const Parameter& option : model->Parameters()) {
    EXPECT_FALSE(option.doc().empty()) << entry.name << ": " << option.name();
    for (const std::string& value : ValuesFor(option)) {
      option.SetFromText(value);
      const std::string text = option.Value();
      option.SetFromText(text);
      EXPECT_EQ(option.Value(), text) << entry.name << ": " << option.name();
    }
  }
  EXPECT_EQ(ListValues(ConfigureEstimator(entry.name, defaults)->Parameters()), defaults);
}

inline void ExpectAllowedWithoutLimits(const EstimatorEntry& entry) {
  const std::unique_ptr<EstimatorModel> model = entry.make();
  model->LiftLimits();
  EXPECT_NO_THROW(MakeEstimator(entry.name, ListValues(model->Parameters()))) << entry.name;
}

}  // namespace rcme
