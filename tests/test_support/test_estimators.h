// Estimators that show what is done with them, in the registry under names of their own.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "estimator/estimator_registry.h"
#include "estimator/loop_inspection.h"

namespace rcme {

struct CallCounts {
  std::atomic<int> estimates{0}, traces{0}, decisions{0}, finishes{0};
};

// That of rcme, every call counted.
class CountedInspection : public LoopInspection {
 public:
  CountedInspection(std::unique_ptr<const LoopInspection> rcme, CallCounts* counts)
      : rcme_(std::move(rcme)), counts_(counts) {}
  HypothesisTrace Trace(const MotionProblem& problem, RandomStream& rng) const override {
    ++counts_->traces;
    return rcme_->Trace(problem, rng);
  }
  LoopResult Decide(const HypothesisTrace& trace) const override {
    ++counts_->decisions;
    return rcme_->Decide(trace);
  }
  MotionEstimate Finish(const MotionProblem& problem, const LoopResult& loop,
                        Refinements* refinements) const override {
    ++counts_->finishes;
    return rcme_->Finish(problem, loop, refinements);
  }
  ScoredMotion ScoreMotion(const MotionProblem& problem, const RelativePose& start) const override {
    return rcme_->ScoreMotion(problem, start);
  }
  const RansacOptions& options() const override { return rcme_->options(); }
  std::unique_ptr<LoopInspection> With(const RansacOptions& options) const override {
    return std::make_unique<CountedInspection>(rcme_->With(options), counts_);
  }

 private:
  std::unique_ptr<const LoopInspection> rcme_;
  CallCounts* counts_;
};

// rcme, every call counted, those of its inspection too.
class CountedEstimator : public InspectableEstimator {
 public:
  CountedEstimator(std::unique_ptr<MotionEstimator> rcme, CallCounts* counts)
      : InspectableEstimator(std::make_unique<CountedInspection>(CopyInspection(*rcme), counts)),
        rcme_(std::move(rcme)),
        counts_(counts) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    ++counts_->estimates;
    return rcme_->Estimate(problem, rng);
  }

 private:
  static std::unique_ptr<LoopInspection> CopyInspection(const MotionEstimator& rcme) {
    const LoopInspection* const inspection = FindInspection(rcme);
    return inspection->With(inspection->options());
  }

  std::unique_ptr<MotionEstimator> rcme_;
  CallCounts* counts_;
};

// rcme in one piece: its loop cannot be taken apart.
class WholeEstimator : public MotionEstimator {
 public:
  explicit WholeEstimator(std::unique_ptr<MotionEstimator> rcme) : rcme_(std::move(rcme)) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return rcme_->Estimate(problem, rng);
  }

 private:
  std::unique_ptr<MotionEstimator> rcme_;
};

// rcme with a fault planted in some of the motions it returns: each with probability `share`, drawn from its
// stream.
class FaultyEstimator : public MotionEstimator {
 public:
  using Plant = std::function<void(MotionEstimate&)>;
  explicit FaultyEstimator(Plant plant, double share = 1.0) : plant_(std::move(plant)), share_(share) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    MotionEstimate estimate = rcme_->Estimate(problem, rng);
    if (estimate.status == MotionStatus::kOk && rng.Uniform() < share_) plant_(estimate);
    return estimate;
  }

 private:
  std::unique_ptr<MotionEstimator> rcme_ = MakeEstimator("rcme");
  Plant plant_;
  double share_;
};

// Model of an estimator around rcme, with the options of that.
class AroundRcme : public EstimatorModel {
 public:
  using Wrap = std::function<std::unique_ptr<MotionEstimator>(std::unique_ptr<MotionEstimator>)>;
  explicit AroundRcme(Wrap wrap) : wrap_(std::move(wrap)) {}
  std::vector<Parameter> Parameters() override { return rcme_->Parameters(); }
  void LiftLimits() override { rcme_->LiftLimits(); }
  std::unique_ptr<MotionEstimator> Make() const override { return wrap_(rcme_->Make()); }

 private:
  std::unique_ptr<EstimatorModel> rcme_ = FindEstimator("rcme").make();
  Wrap wrap_;
};

// An estimator with options of its own, one of which is a limit.
class PeerEstimator : public MotionEstimator {
 public:
  explicit PeerEstimator(int min_inliers, const std::string& samples)
      : min_inliers_(min_inliers), rcme_(MakeEstimator("rcme", {{"num_iterations", samples}})) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    MotionEstimate estimate = rcme_->Estimate(problem, rng);
    if (std::ssize(estimate.inliers) < min_inliers_) estimate.status = MotionStatus::kNoCandidate;
    return estimate;
  }

 private:
  int min_inliers_;
  std::unique_ptr<MotionEstimator> rcme_;
};

class PeerModel : public EstimatorModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Integer("min_inliers", &min_inliers_, {0, 1000}, "refuse a motion with fewer"),
            Parameter::Choice<int>("effort", &num_samples_, {{"low", 10}, {"high", 40}}, "how many samples")};
  }
  void LiftLimits() override { min_inliers_ = 0; }
  std::unique_ptr<MotionEstimator> Make() const override {
    return std::make_unique<PeerEstimator>(min_inliers_, std::to_string(num_samples_));
  }

 private:
  int min_inliers_ = 8, num_samples_ = 10;
};

// Registers "counted", "whole" and "peer" once; the counts are those of all counted estimators of the
// process.
inline CallCounts& AddTestEstimators() {
  static CallCounts counts;
  static const bool once = [] {
    AddEstimator({"counted", "rcme, its calls counted", [] {
                    return std::make_unique<AroundRcme>([](std::unique_ptr<MotionEstimator> rcme) {
                      return std::make_unique<CountedEstimator>(std::move(rcme), &counts);
                    });
                  }});
    AddEstimator({"whole", "rcme in one piece", [] {
                    return std::make_unique<AroundRcme>([](std::unique_ptr<MotionEstimator> rcme) {
                      return std::make_unique<WholeEstimator>(std::move(rcme));
                    });
                  }});
    AddEstimator({"peer", "not of the RANSAC family", [] { return std::make_unique<PeerModel>(); }});
    return true;
  }();
  static_cast<void>(once);
  return counts;
}

}  // namespace rcme
