// The options of every estimator in the registry: what a study, a command line and the tuner rely on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "estimator/estimator_registry.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/option_checks.h"

namespace rcme {
namespace {

TEST(EstimatorOptions, EveryOneHasAnEffect) {
  for (const EstimatorEntry& entry : EstimatorRegistry()) ExpectEveryOptionHasAnEffect(entry);
}

TEST(EstimatorOptions, DefaultsAreAllowedAndTextsGoRound) {
  for (const EstimatorEntry& entry : EstimatorRegistry()) ExpectTextsGoRound(entry);
}

TEST(EstimatorOptions, WithoutLimitsAnEstimatorHasValuesThatAreAllowed) {
  for (const EstimatorEntry& entry : EstimatorRegistry()) ExpectAllowedWithoutLimits(entry);
}

TEST(EstimatorOptions, TheLimitsOfTheFamilyAreLifted) {
  const auto model = ConfigureEstimator(
      "rcme", {{"mu", "3"}, {"inlier_ratio", "0.5"}, {"least_explained_share", "0.5"}, {"lambda", "0.7"}});
  model->LiftLimits();
  const auto value = [&](const char* name) {
    const std::vector<Parameter> options = model->Parameters();
    return FindOption("rcme", options, name).Value();
  };
  EXPECT_EQ(value("mu"), "1000");
  EXPECT_EQ(value("inlier_ratio"), "inferred");
  EXPECT_EQ(value("least_explained_share"), "0");
  EXPECT_EQ(value("lambda"), "0.7");
}

TEST(EstimatorOptions, OneThatIsNotThereListsThoseThatAre) {
  EXPECT_TRUE(ThrowsInputError(
      [] {
        MakeEstimator("standard", {{"mu", "3"}});
      },
      {"estimator standard has no option 'mu'", "its options: solver, num_iterations", "kappa"}));
  EXPECT_TRUE(ThrowsInputError(
      [] {
        MakeEstimator("prcme", {{"sample_significance_level", "0.1"}});
      },
      {"estimator prcme has no option", "mu"}));
  EXPECT_TRUE(ThrowsInputError([] { MakeEstimator("rcme", {{"mu", "x"}}); }, {"mu", "'x'", "or auto"}));
}

class OneOption : public EstimatorModel {
 public:
  explicit OneOption(std::string name, double value = 1.0) : name_(std::move(name)), value_(value) {}
  std::vector<Parameter> Parameters() override {
    return {Parameter::Real("first", &first_, {}, "", "one"),
            Parameter::Real(name_, &value_, {0, 2}, "", "two")};
  }
  std::unique_ptr<MotionEstimator> Make() const override { return nullptr; }

 private:
  std::string name_;
  double first_ = 0.0, value_;
};

TEST(AddEstimator, RefusesOptionsThatCannotBeGiven) {
  for (const std::string name : {"", "first", "a.b", "a=b"}) {
    EXPECT_TRUE(ThrowsInputError(
        [&] {
          AddEstimator({"bad", "", [&] { return std::make_unique<OneOption>(name); }});
        },
        {"'bad'", name}));
  }
  EXPECT_TRUE(ThrowsInputError(
      [] {
        AddEstimator({"bad", "", [] { return std::make_unique<OneOption>("second", 3.0); }});
      },
      {"'bad'", "default of option second", "[0, 2]"}));
  EXPECT_TRUE(ThrowsInputError(
      [] {
        AddEstimator({"rcme", "", [] { return std::make_unique<OneOption>("second"); }});
      },
      {"'rcme' is taken"}));
}

}  // namespace
}  // namespace rcme
