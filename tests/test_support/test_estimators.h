// Estimators that show what is done with them, in the registry under names of their own.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "estimator/estimator_registry.h"
#include "estimator/ransac_estimator.h"

namespace rcme {

struct CallCounts {
  std::atomic<int> estimates{0}, traces{0}, decisions{0}, finishes{0};
};

// rcme, every call counted.
class CountedEstimator : public RansacEstimator {
 public:
  CountedEstimator(const RansacOptions& options, CallCounts* counts)
      : rcme_(FindEstimator("rcme").make(options)), counts_(counts) {}
  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    ++counts_->estimates;
    return rcme_->Estimate(problem, rng);
  }
  HypothesisTrace Trace(const MotionProblem& problem, RandomStream& rng) const override {
    ++counts_->traces;
    return AsRansac(*rcme_)->Trace(problem, rng);
  }
  LoopResult Decide(const HypothesisTrace& trace) const override {
    ++counts_->decisions;
    return AsRansac(*rcme_)->Decide(trace);
  }
  MotionEstimate Finish(const MotionProblem& problem, const LoopResult& loop,
                        Refinements* refinements) const override {
    ++counts_->finishes;
    return AsRansac(*rcme_)->Finish(problem, loop, refinements);
  }

 private:
  std::unique_ptr<MotionEstimator> rcme_;
  CallCounts* counts_;
};

// rcme in one piece: its loop cannot be taken apart.
class WholeEstimator : public MotionEstimator {
 public:
  explicit WholeEstimator(const RansacOptions& options) : rcme_(FindEstimator("rcme").make(options)) {}
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
  std::unique_ptr<MotionEstimator> rcme_ = FindEstimator("rcme").make(RansacOptions());
  Plant plant_;
  double share_;
};

// Registers "counted" and "whole" once; the counts are those of all counted estimators of the process.
inline CallCounts& AddTestEstimators() {
  static CallCounts counts;
  static const bool once = [] {
    AddEstimator({"counted", "rcme, its calls counted",
                  [](const RansacOptions& o) { return std::make_unique<CountedEstimator>(o, &counts); }});
    AddEstimator({"whole", "rcme in one piece",
                  [](const RansacOptions& o) { return std::make_unique<WholeEstimator>(o); }});
    return true;
  }();
  static_cast<void>(once);
  return counts;
}

}  // namespace rcme
