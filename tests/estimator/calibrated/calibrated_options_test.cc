#include "estimator/calibrated/calibrated_options.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

TEST(CalibratedOptions, TheLeastNumberOfSamplesMayBeTheGreatest) {
  CalibratedOptions options;
  options.min_samples = options.max_samples = 100;
  EXPECT_NO_THROW(Validate(options));
  options.max_samples = 99;
  EXPECT_TRUE(ThrowsInputError([&] { Validate(options); }, {"min_samples", "100", "max_samples", "99"}));
}

// Every option is there once, and setting it by its name changes the options that it is of.
TEST(CalibratedOptions, AreSetByTheirNames) {
  CalibratedOptions options;
  std::set<std::string> names;
  for (const Parameter& parameter : Parameters(options)) EXPECT_TRUE(names.insert(parameter.name()).second);
  const auto set = [&](const std::string& name, const std::string& value) {
    for (const Parameter& parameter : Parameters(options)) {
      if (parameter.name() == name) parameter.SetFromText(value);
    }
  };
  set("num_modes", "7");
  set("max_direction_error_deg", "12.5");
  set("covariance", "robust");
  set("leave_out", "twisted_pair");
  set("covariance_factor", "2.5");
  set("focal_sd", "0.01");
  EXPECT_EQ(options.num_modes, 7);
  EXPECT_EQ(options.max_direction_error_deg, 12.5);
  EXPECT_EQ(options.covariance, CovarianceKind::kRobust);
  EXPECT_EQ(options.leave_out, CalibratedStep::kTwistedPair);
  EXPECT_EQ(options.robust.factor, 2.5);
  EXPECT_EQ(options.calibration.focal_sd, 0.01);
}

// Those of the robust covariance alone; the uncertainty of the intrinsics widens every covariance.
TEST(CalibratedOptions, RefuseOptionsOfTheRobustCovarianceWithoutIt) {
  CalibratedOptions options;
  options.calibration.focal_sd = 0.01;
  EXPECT_NO_THROW(Validate(options));
  options.robust.factor = 2.0;
  EXPECT_THROW(Validate(options), InputError);
  options.covariance = CovarianceKind::kRobust;
  EXPECT_NO_THROW(Validate(options));
  options.robust = {};
  options.robust.adds_jackknife = true;
  options.covariance = CovarianceKind::kSandwich;
  EXPECT_THROW(Validate(options), InputError);
}

}  // namespace
}  // namespace rcme
