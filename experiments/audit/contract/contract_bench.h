// What a check of the contract works with: the estimator, the problems, and the clock of its calls.
#pragma once

#include <mutex>

#include "experiments/core/work/isolated_call.h"
#include "experiments/audit/contract/contract_problems.h"
#include "experiments/audit/contract/estimator_contract.h"

namespace rcme {

// A breach of the contract, found on a problem.
struct Breach {
  std::string problem, what;
};

class Bench {
 public:
  // What is passed has to live as long.
  Bench(const EstimatorMaker& make, const ContractOptions& options, const Announce& announce)
      : make_(make), estimator_(make()), options_(options), announce_(announce) {}

  // One call of the estimator, or of another one. From any thread.
  MotionEstimate Call(const ContractProblem& problem, const MotionEstimator* other = nullptr);
  std::unique_ptr<MotionEstimator> MakeAnother() const { return make_(); }

  // Those that are asked for. Throws InputError if none is.
  std::vector<ContractProblem> Chosen(std::vector<ContractProblem> problems) const;
  // Every scene once: for checks that call several times.
  std::vector<ContractProblem> SomeOrdinary() const;

  std::uint64_t seed() const { return options_.seed; }
  // "slowest call 12 ms (problem)".
  std::string SlowestCall() const;

 private:
  const EstimatorMaker& make_;
  std::unique_ptr<MotionEstimator> estimator_;
  const ContractOptions& options_;
  const Announce& announce_;
  std::mutex mutex_;  // of the two below
  double slowest_seconds_ = 0.0;
  std::string slowest_;
};

}  // namespace rcme
