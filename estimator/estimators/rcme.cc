#include "estimator/estimators/rcme.h"

#include "estimator/estimators/pipeline_estimator.h"
#include "estimator/estimators/ransac_model.h"
#include "estimator/sample_consistency.h"

namespace rcme {
namespace {

// Each sample point on its own, as printed (eq::sample-p-test).
struct PerPointSampleTest {
  static constexpr bool kTestsSample = true;
  template <typename Solver>
  static bool Passes(const MotionProblem& problem, const Hypothesis<Solver>& hypothesis,
                     const AsPrintedTest& test, const Thresholds& thresholds) {
    return EverySamplePointFits(problem, hypothesis, test, thresholds.sample);
  }
};

// What the sample has of constraints beyond the motion's five, jointly, rank-aware.
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
struct RcmePipeline {
  using PointTest = PointTestT;
  static constexpr bool kTestsSample = SampleTestT::kTestsSample;
  template <typename Solver>
  static bool SampleIsConsistent(const MotionProblem& problem, const Hypothesis<Solver>& hypothesis,
                                 const PointTest& test, const Thresholds& thresholds) {
    return SampleTestT::Passes(problem, hypothesis, test, thresholds);
  }
  static bool InlierSetIsGood(double z, const RansacOptions& options, const Thresholds& thresholds) {
    return PassesQualityTest(z, thresholds.normal, options.quality_test);
  }
  // The candidate of least mean entropy wins (eq::model_select_entropy).
  static bool IsBetter(const InlierScore& a, const InlierScore& b, const RansacOptions& options) {
    return options.selection == Selection::kMeanEntropy
               ? a.mean_entropy < b.mean_entropy
               : a.negative_log_likelihood < b.negative_log_likelihood;
  }
};

}  // namespace

std::unique_ptr<RansacEstimator> MakeRcme(const RansacOptions& options, SampleTest sample_test) {
  const bool tests_sample = sample_test == SampleTest::kOn;
  if (options.reading == Reading::kAsPrinted) {
    return tests_sample ? MakePipelineEstimator<RcmePipeline<AsPrintedTest, PerPointSampleTest>>(options)
                        : MakePipelineEstimator<RcmePipeline<AsPrintedTest, NoSampleTest>>(options);
  }
  return tests_sample ? MakePipelineEstimator<RcmePipeline<RankAwareTest, JointSampleTest>>(options)
                      : MakePipelineEstimator<RcmePipeline<RankAwareTest, NoSampleTest>>(options);
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
