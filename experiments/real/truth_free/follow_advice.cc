#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "experiments/real/truth_free/advice.h"
#include "experiments/real/truth_free/self_calibration.h"

namespace rcme {
namespace {

constexpr int kMostSigmas = 3;  // an estimator that cuts off residuals finds the noise in several rounds

bool AreWrong(const CovarianceVerdict& covariances) {
  return covariances.verdict == TruthFreeVerdict::kTooSmall ||
         covariances.verdict == TruthFreeVerdict::kTooLarge;
}

// "covariances: holds (spatial_halves 0.9 [0.7, 1.2], simulation 1 [0.9, 1.1])".
std::string DescribeCovariances(const SetReport& report) {
  std::string ranges;
  for (const TruthFreeTest& test : report.tests) {
    if (test.verdict == TruthFreeVerdict::kNoData || test.name == "random_halves") continue;
    ranges += fmt::format("{}{} {:.2g} [{:.2g}, {:.2g}]", ranges.empty() ? "" : ", ", test.name,
                          test.ratio.value, test.ratio.interval.lower, test.ratio.interval.upper);
  }
  return fmt::format("covariances: {} ({})", VerdictName(report.covariances.verdict), ranges);
}

std::string DescribeCamera(const SetReport& report) {
  return fmt::format("camera: {}", DescribeCalibration(report.calibration));
}

// The largest |log ratio| of the tests that count.
double Misfit(const SetReport& report) {
  double worst = 0.0;
  for (const TruthFreeTest& test : report.tests) {
    if (test.name != "random_halves" && std::isfinite(test.ratio.value))
      worst = std::max(worst, std::abs(std::log(test.ratio.value)));
  }
  return worst;
}

class Follower {
 public:
  Follower(const PairSet& set, const AdvisedEstimator& estimator, const ValidationOptions& options,
           KeptSteps* steps)
      : estimator_(estimator), options_(options), steps_(steps), set_(set), now_(Run(set_, {})) {}

  SetReport Take() {
    SetReport report = now_;
    advice_ = FindReasons(report);
    FollowSigma();
    FollowCamera(&report.calibration);
    FollowCovariance();
    report.advice = std::move(advice_);
    return report;
  }

 private:
  SetReport Run(const PairSet& set, const Settings& settings) const {
    return Validate(set, *estimator_.make(settings), options_, steps_);
  }

  void FollowSigma() {
    const double assumed_px = now_.assumed_sigma_px;
    for (int round = 0; round < kMostSigmas && IsFault(now_.sigma_verdict); ++round) {
      for (NamedPair& pair : set_.pairs) pair.problem.sigma_px = now_.sigma_px.value;
      now_ = Run(set_, {});
    }
    if (now_.assumed_sigma_px == assumed_px) return;
    advice_.push_back(
        fmt::format("the assumed sigma, {:g} px, is too {}: assume {:.2g} (--sigma); followed: the residuals "
                    "say {:.2g}, {}",
                    assumed_px, now_.assumed_sigma_px > assumed_px ? "small" : "large", now_.assumed_sigma_px,
                    now_.sigma_px.value, DescribeCovariances(now_)));
  }

  void FollowCamera(CalibrationReport* shown) {
    if (!NamesFault(now_.calibration)) {
      for (const std::string& advice : CalibrationAdvice(now_.calibration)) advice_.push_back(advice);
      return;
    }
    const std::unique_ptr<MotionEstimator> estimator = estimator_.make({});
    const PairSet corrected = CorrectPairs(set_, now_.calibration, *estimator, options_.seed, steps_);
    SetReport after = Run(corrected, {});
    if (after.calibration.verdict == TruthFreeVerdict::kTooLarge) {
      NameNothing(fmt::format("what they look like, corrected, leaves p = {:.2g}", after.calibration.p_value),
                  shown);
      return;
    }
    for (const std::string& advice : CalibrationAdvice(now_.calibration))
      advice_.push_back(
          fmt::format("{}; followed: {}, {}", advice, DescribeCamera(after), DescribeCovariances(after)));
    set_ = corrected;
    now_ = std::move(after);
  }

  // The factor for the covariances: the greatest ratio among the tests behind the verdict.
  double MissingFactor(const SetReport& report) const {
    double factor = 0.0;
    for (const TruthFreeTest& test : report.tests) {
      if (std::ranges::count(report.covariances.tests, test.name) > 0)
        factor = std::max(factor, test.ratio.value);
    }
    return factor;
  }

  void FollowCovariance() {
    if (!AreWrong(now_.covariances)) return;
    const double before = Misfit(now_);
    std::string tried;
    SetReport after = now_;
    double factor = estimator_.factor;
    const auto follow = [&](const Settings& options, const std::string& words) {
      after = Run(set_, options);
      tried += fmt::format("{}{}; followed: {}", tried.empty() ? "" : "; then ", words,
                           DescribeCovariances(after));
      if (AreWrong(after.covariances)) return false;
      advice_.push_back(tried);
      return true;
    };
    if (!estimator_.is_robust && follow({{"covariance", "robust"}}, "covariance=robust")) return;
    factor *= MissingFactor(after);
    const std::string value = fmt::format("{:.3g}", std::clamp(factor, 1e-3, 1e3));
    if (follow({{"covariance", "robust"}, {"covariance_factor", value}},
               "covariance=robust, covariance_factor=" + value))
      return;
    advice_.push_back(fmt::format(
        "covariance_factor={} does not make them hold{} ({}): wrong matches or faults of the camera "
        "may be left",
        value, Misfit(after) < before ? ", though it is better" : "", tried));
  }

  const AdvisedEstimator& estimator_;
  const ValidationOptions& options_;
  KeptSteps* steps_;
  PairSet set_;
  SetReport now_;  // of what has been followed so far
  std::vector<std::string> advice_;
};

}  // namespace

SetReport ValidateAndAdvise(const PairSet& set, const AdvisedEstimator& estimator,
                            const ValidationOptions& options, KeptSteps* steps) {
  return Follower(set, estimator, options, steps).Take();
}

}  // namespace rcme
