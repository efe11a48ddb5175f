// The program `rcme` with one estimator more, `planted`: another estimator with a fault in its answers, for
// tests/studies/gate_runs.py. Faults that an option of an estimator can be have no need of it.
#include <memory>
#include <string>

#include "estimator/estimator_registry.h"
#include "experiments/core/work/thread_time.h"
#include "experiments/program.h"

namespace {

enum class Fault { kNone, kFreshSamples, kSignFlip, kCovariance, kProbability, kSlower, kRefusal };

struct PlantedOptions {
  std::string of = "rcme_calibrated";
  Fault fault = Fault::kNone;
  double size = 0.0;  // a share of the trials, a factor, a share of the time
};

class PlantedEstimator : public rcme::MotionEstimator {
 public:
  explicit PlantedEstimator(const PlantedOptions& options)
      : options_(options), sound_(rcme::MakeEstimator(options.of)) {}

  rcme::MotionEstimate Estimate(const rcme::MotionProblem& problem, rcme::RandomStream& rng) const override {
    if (options_.fault == Fault::kFreshSamples) rng.Next64();  // equal in law, other samples
    const double start = rcme::ThreadSeconds();
    rcme::MotionEstimate estimate = sound_->Estimate(problem, rng);
    const bool is_chosen = rng.Uniform() < options_.size;
    switch (options_.fault) {
      case Fault::kNone:
      case Fault::kFreshSamples:
        break;
      case Fault::kSignFlip:
        if (is_chosen) estimate.cam2_from_cam1.t *= -1.0;
        break;
      case Fault::kCovariance:
        estimate.pose_cov *= options_.size;
        break;
      case Fault::kProbability:
        estimate.failure_probability *= options_.size;
        break;
      case Fault::kSlower: {
        const double end = rcme::ThreadSeconds() + options_.size * (rcme::ThreadSeconds() - start);
        while (rcme::ThreadSeconds() < end) {
        }
        break;
      }
      case Fault::kRefusal:
        if (is_chosen) {
          estimate = {};
          estimate.status = rcme::MotionStatus::kTooUncertain;
        }
        break;
    }
    return estimate;
  }

 private:
  PlantedOptions options_;
  std::unique_ptr<rcme::MotionEstimator> sound_;
};

class PlantedModel : public rcme::EstimatorModel {
 public:
  std::vector<rcme::Parameter> Parameters() override {
    using rcme::Parameter;
    return {Parameter::Text("of", &options_.of, "the name of an estimator", "whose answers are changed"),
            Parameter::Choice<Fault>("fault", &options_.fault,
                                     {{"none", Fault::kNone},
                                      {"fresh_samples", Fault::kFreshSamples},
                                      {"sign_flip", Fault::kSignFlip},
                                      {"covariance", Fault::kCovariance},
                                      {"probability", Fault::kProbability},
                                      {"slower", Fault::kSlower},
                                      {"refusal", Fault::kRefusal}},
                                     "what is wrong with them"),
            Parameter::Real("size", &options_.size, {0.0, 10.0}, "",
                            "share of the answers or of the time, or a factor")};
  }
  std::unique_ptr<rcme::MotionEstimator> Make() const override {
    return std::make_unique<PlantedEstimator>(options_);
  }

 private:
  PlantedOptions options_;
};

}  // namespace

int main(int argc, char** argv) {
  rcme::AddEstimator({"planted", "another estimator with a fault in its answers",
                      [] { return std::make_unique<PlantedModel>(); }});
  return rcme::RunProgram(argc, argv);
}
