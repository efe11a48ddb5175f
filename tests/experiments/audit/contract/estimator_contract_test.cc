// The contract's checks against the estimators of the registry, which keep it, and against doubles that each
// break it in one way.
#include "experiments/audit/contract/estimator_contract.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

#include "parameters/input_error.h"
#include "peers/outside_answer.h"
#include "stats/constants.h"
#include "tests/test_support/estimator_variants.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/test_estimators.h"

namespace rcme {
namespace {

using testing::AllOf;
using testing::HasSubstr;

// rcme with something done before and after.
class ChangedEstimator : public MotionEstimator {
 public:
  using Before = std::function<void(const MotionProblem&)>;
  using After = std::function<void(const MotionProblem&, MotionEstimate&)>;
  ChangedEstimator(Before before, After after) : before_(std::move(before)), after_(std::move(after)) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    if (before_) before_(problem);
    MotionEstimate estimate = rcme_->Estimate(problem, rng);
    if (after_) after_(problem, estimate);
    return estimate;
  }

 private:
  std::unique_ptr<MotionEstimator> rcme_ = MakeEstimator("rcme");
  Before before_;
  After after_;
};

EstimatorMaker Before(ChangedEstimator::Before before) {
  return [before] { return std::make_unique<ChangedEstimator>(before, nullptr); };
}
EstimatorMaker After(ChangedEstimator::After after) {
  return [after] { return std::make_unique<ChangedEstimator>(nullptr, after); };
}
EstimatorMaker Planted(FaultyEstimator::Plant plant) {
  return [plant] { return std::make_unique<FaultyEstimator>(plant); };
}

struct BrokenContract {
  std::string name;
  EstimatorMaker make;
  std::string check;    // that finds it
  std::string problem;  // part of the name of where it is found
  std::string said;     // part of the finding
};

std::vector<BrokenContract> BrokenContracts() {
  static const std::thread::id main_thread = std::this_thread::get_id();
  return {
      {"NaN in R", Planted([](MotionEstimate& e) { e.cam2_from_cam1.R(2, 1) = kNaN; }), "answers", "matches",
       "invalid_motion"},
      {"asymmetric covariance", Planted([](MotionEstimate& e) { e.pose_cov(0, 4) += 1.0; }), "answers",
       "matches", "invalid_covariance"},
      {"inliers in descending order",
       Planted([](MotionEstimate& e) { std::reverse(e.inliers.begin(), e.inliers.end()); }), "answers",
       "matches", "ascending"},
      {"a refusal without a word", After([](const MotionProblem&, MotionEstimate& e) { e.message.clear(); }),
       "bad_input", "no match", "without a message"},
      {"the inverse motion", Planted([](MotionEstimate& e) {
         RelativePose& p = e.cam2_from_cam1;
         p = {p.R.transpose(), -(p.R.transpose() * p.t)};
       }),
       "conventions", "", "cam1_from_cam2 in place of cam2_from_cam1"},
      {"t of the wrong sign", Planted([](MotionEstimate& e) { e.cam2_from_cam1.t *= -1.0; }), "conventions",
       "", "wrong sign"},
      {"a global counter", After([](const MotionProblem&, MotionEstimate& e) {
         static int calls = 0;
         e.num_support = ++calls % 8;
       }),
       "repeatable", "matches", "num_support is"},
      {"state of a thread", After([](const MotionProblem&, MotionEstimate& e) {
         if (std::this_thread::get_id() != main_thread) e.mean_entropy += 1.0;
       }),
       "threads", "matches", "mean_entropy is"},
      {"changes its problem", Before([](const MotionProblem& p) {
         const_cast<MotionProblem&>(p).sigma_px *= 2.0;  // as a C library might
       }),
       "untouched", "matches", "sigma_px is"},
      {"throws", Before([](const MotionProblem& p) {
         if (p.matches.empty()) throw std::out_of_range("matches[0]");
       }),
       "bad_input", "no match", "throws: matches[0]"},
      {"answers whatever it gets",
       After([](const MotionProblem&, MotionEstimate& e) { e.status = MotionStatus::kOk; }), "bad_input",
       "no match", "where only a refusal can be right"},
      {"crashes", Before([](const MotionProblem& p) {
         if (p.matches.size() == 1) std::abort();
       }),
       "bad_input", "one match", "signal 6"},
      {"ends the program", Before([](const MotionProblem& p) {
         if (p.sigma_px < 0.0) std::_Exit(3);
       }),
       "bad_input", "negative sigma", "exit code 3"},
      {"never returns", Before([](const MotionProblem& p) {
         while (p.matches.size() == 4) std::this_thread::sleep_for(std::chrono::hours(1));
       }),
       "bad_input", "four matches", "has not returned within 8 s"},
  };
}

TEST(EstimatorContract, EveryFaultIsFound) {
  for (const BrokenContract& fault : BrokenContracts()) {
    SCOPED_TRACE(fault.name);
    ContractOptions options;
    if (fault.name == "never returns") options.seconds_per_call = 8.0;
    const ContractResult result = RunContractCheck(fault.check, fault.make, options);
    EXPECT_FALSE(result.has_passed);
    EXPECT_THAT(result.finding, HasSubstr(fault.said));
    EXPECT_THAT(result.problem, HasSubstr(fault.problem));
    if (result.problem.empty() || fault.name == "never returns") continue;
    // The problem alone, as the command that is printed asks for it.
    ContractOptions again = options;
    again.problem = result.problem;
    EXPECT_FALSE(RunContractCheck(fault.check, fault.make, again).has_passed);
  }
}

// Of an estimator outside the program that states no covariance.
TEST(EstimatorContract, CovariancesOfRcmeAreNotHeldAgainstTheEstimator) {
  const auto planted = [](const std::string& message) {
    return Planted([message](MotionEstimate& e) {
      if (e.status != MotionStatus::kOk) return;
      e.pose_cov.setConstant(kNaN);
      e.message = message;
    });
  };
  const std::string end(kCovarianceOfRcme);
  const ContractResult result = RunContractCheck("answers", planted("found; " + end), {});
  EXPECT_TRUE(result.has_passed) << result.finding;
  EXPECT_THAT(result.finding, HasSubstr("not checked: " + end));
  EXPECT_FALSE(RunContractCheck("answers", planted("found"), {}).has_passed);
}

TEST(EstimatorContract, AStateThatCallsLeaveBehindIsFound) {
  const EstimatorMaker make = [] {
    return std::make_unique<ChangedEstimator>(
        nullptr, [last = std::make_shared<double>(0.0)](const MotionProblem& p, MotionEstimate& e) {
          e.z_statistic += *last;  // of the call before
          *last = p.matches[0].x1_px.x();
        });
  };
  const ContractResult result = RunContractCheck("order", make, {});
  EXPECT_FALSE(result.has_passed);
  EXPECT_THAT(result.finding, AllOf(HasSubstr("in another order"), HasSubstr("z_statistic is")));
}

TEST(EstimatorContract, NamesThatThereAreNotAreErrors) {
  const EstimatorMaker make = Planted([](MotionEstimate&) {});
  ContractOptions options;
  options.problem = "no such problem";
  EXPECT_TRUE(
      ThrowsInputError([&] { RunContractCheck("answers", make, options); }, {"--problem", "no such"}));
  EXPECT_TRUE(ThrowsInputError([&] { RunContractCheck("nonsense", make, {}); }, {"nonsense"}));
}

void ExpectContract(const EstimatorVariant& variant, bool with_large) {
  const EstimatorMaker make = [&] { return variant.Make(); };
  for (const ContractCheck& check : ContractChecks()) {
    if (check.name == "large" && !with_large) continue;
    const ContractResult result = RunContractCheck(check.name, make, {});
    EXPECT_TRUE(result.has_passed) << variant.name << ", " << check.name << " on '" << result.problem
                                   << "': " << result.finding;
  }
}

TEST(EstimatorContract, TheRegistryKeepsIt) {
  for (const EstimatorVariant& variant : EstimatorVariants({"reading"})) ExpectContract(variant, true);
}

// 100,000 matches would take its small matrices minutes.
TEST(EstimatorContract, TheReferenceKeepsIt) {
  for (EstimatorVariant variant : EstimatorVariants({"implementation"})) {
    if (!variant.name.ends_with("_reference")) continue;
    variant.options.emplace_back("num_iterations", "20");
    ExpectContract(variant, false);
  }
}

}  // namespace
}  // namespace rcme
