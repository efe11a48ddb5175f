#include "estimator/estimators/rcme.h"

#include "estimator/run_pipeline.h"
#include "estimator/sample_consistency.h"

namespace rcme {
namespace {

// Each sample point on its own, as printed (eq::sample-p-test).
struct PerPointSampleTest {
  static constexpr bool kTestsSample = true;
  static bool Passes(const MotionProblem& problem, const Hypothesis& hypothesis, const AsPrintedTest& test,
                     const Thresholds& thresholds) {
    return EverySamplePointFits(problem, hypothesis, test, thresholds.point);
  }
};

// The sample's three constraints on the motion jointly, rank-aware.
struct JointSampleTest {
  static constexpr bool kTestsSample = true;
  static bool Passes(const MotionProblem&, const Hypothesis& hypothesis, const RankAwareTest&,
                     const Thresholds& thresholds) {
    return JointSampleStatistic(hypothesis) <= thresholds.sample;
  }
};

// pRCME: no sample test.
struct NoSampleTest {
  static constexpr bool kTestsSample = false;
  template <typename PointTest>
  static bool Passes(const MotionProblem&, const Hypothesis&, const PointTest&, const Thresholds&) {
    return true;
  }
};

template <typename PointTestT, typename SampleTest>
struct RcmePipeline {
  using PointTest = PointTestT;
  static constexpr bool kTestsSample = SampleTest::kTestsSample;
  static bool SampleIsConsistent(const MotionProblem& problem, const Hypothesis& hypothesis,
                                 const PointTest& test, const Thresholds& thresholds) {
    return SampleTest::Passes(problem, hypothesis, test, thresholds);
  }
  static bool InlierSetIsGood(double z, const RansacOptions& options, const Thresholds& thresholds) {
    return PassesQualityTest(z, thresholds.normal, options.quality_test);
  }
  static bool IsBetter(const InlierScore& a, const InlierScore& b, const RansacOptions& options) {
    return options.selection == Selection::kMeanEntropy
               ? a.mean_entropy < b.mean_entropy
               : a.negative_log_likelihood < b.negative_log_likelihood;
  }
};

}  // namespace

RcmeEstimator::RcmeEstimator(const RansacOptions& options, SampleTest sample_test)
    : options_(options), sample_test_(sample_test) {
  Validate(options);
}

MotionEstimate RcmeEstimator::Estimate(const MotionProblem& problem, RandomStream& rng) const {
  const bool tests_sample = sample_test_ == SampleTest::kOn;
  if (options_.reading == Reading::kAsPrinted) {
    return tests_sample ? RunPipeline<RcmePipeline<AsPrintedTest, PerPointSampleTest>>(problem, options_, rng)
                        : RunPipeline<RcmePipeline<AsPrintedTest, NoSampleTest>>(problem, options_, rng);
  }
  return tests_sample ? RunPipeline<RcmePipeline<RankAwareTest, JointSampleTest>>(problem, options_, rng)
                      : RunPipeline<RcmePipeline<RankAwareTest, NoSampleTest>>(problem, options_, rng);
}

}  // namespace rcme
