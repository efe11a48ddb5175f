#include "estimator/estimators/rcme.h"

#include "estimator/estimators/loop_estimator.h"
#include "estimator/estimators/ransac_model.h"
#include "estimator/sample_consistency.h"

namespace rcme {
namespace {

// Tests each sample point on its own, as printed (eq::sample-p-test).
struct PerPointSampleTest {
  static constexpr bool kTestsSample = true;
  template <typename Solver>
  static bool Passes(const MotionProblem& problem, const Hypothesis<Solver>& hypothesis,
                     const AsPrintedTest& test, const Thresholds& thresholds) {
    return EverySamplePointFits(problem, hypothesis, test, thresholds.sample);
  }
};

// Rank-aware: tests the constraints that the sample has beyond the motion's five jointly.
struct JointSampleTest {
  static constexpr bool kTestsSample = true;
  template <typename Solver>
  static bool Passes(const MotionProblem&, const Hypothesis<Solver>& hypothesis, const RankAwareTest&,
                     const Thresholds& thresholds) {
    return JointSampleStatistic(hypothesis) <= thresholds.sample;
  }
};

// pRCME: no sample test.
struct NoSampleTest {
  static constexpr bool kTestsSample = false;
};

template <typename PointTestT, typename SampleTestT>
class RcmeDecision {
 public:
  using PointTest = PointTestT;
  static constexpr bool kTestsSample = SampleTestT::kTestsSample;
  template <typename Solver>
  static bool SampleIsConsistent(const MotionProblem& problem, const Hypothesis<Solver>& hypothesis,
                                 const PointTest& test, const Thresholds& thresholds) {
    return SampleTestT::Passes(problem, hypothesis, test, thresholds);
  }

  RcmeDecision(const RansacOptions& options, const Thresholds& thresholds)
      : quality_test_(options.quality_test),
        deciding_score_(FindDecidingScore(options.selection)),
        normal_quantile_(thresholds.normal) {}
  // Z_j passes (eq::inlier-quality-test): one of the two conditions of C (eq::candidate-set).
  bool AcceptsInlierSet(double z) const { return PassesQualityTest(z, normal_quantile_, quality_test_); }
  DecidingScore deciding_score() const { return deciding_score_; }

 private:
  QualityTest quality_test_;
  DecidingScore deciding_score_;
  double normal_quantile_;
};

}  // namespace

std::unique_ptr<MotionEstimator> MakeRcme(const RansacOptions& options, SampleTest sample_test) {
  const bool tests_sample = sample_test == SampleTest::kOn;
  if (options.reading == Reading::kAsPrinted) {
    return tests_sample ? MakeLoopEstimator<RcmeDecision<AsPrintedTest, PerPointSampleTest>>(options)
                        : MakeLoopEstimator<RcmeDecision<AsPrintedTest, NoSampleTest>>(options);
  }
  return tests_sample ? MakeLoopEstimator<RcmeDecision<RankAwareTest, JointSampleTest>>(options)
                      : MakeLoopEstimator<RcmeDecision<RankAwareTest, NoSampleTest>>(options);
}

namespace {

class Rcme : public RansacModel {
 public:
  explicit Rcme(SampleTest sample_test) : sample_test_(sample_test) {}
  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = rcme::Parameters(options_);
    const auto add = [&](const std::vector<Parameter>& more) {
      all.insert(all.end(), more.begin(), more.end());
    };
    add(EntropyParameters(options_));
    if (sample_test_ == SampleTest::kOn) all.push_back(SampleTestParameter(options_));
    add(MotionTestParameters(options_, /*depend_on_reading=*/true));
    return all;
  }
  std::unique_ptr<MotionEstimator> Make() const override { return MakeRcme(options_, sample_test_); }

 private:
  SampleTest sample_test_;
};

}  // namespace

std::unique_ptr<EstimatorModel> RcmeModel(SampleTest sample_test) {
  return std::make_unique<Rcme>(sample_test);
}

}  // namespace rcme
