// The tools of a contract check: the estimator, the problems, and the clock of its calls.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "experiments/audit/contract/contract_problems.h"
#include "experiments/audit/contract/estimator_contract.h"
#include "experiments/core/work/isolated_call.h"

namespace rcme {

// A breach of the contract, found on a problem.
struct Breach {
  std::string problem, what;
};

class Bench {
 public:
  // The arguments must outlive the bench.
  Bench(const EstimatorMaker& make, const ContractOptions& options, const Announce& announce)
      : make_(make), estimator_(make()), options_(options), announce_(announce) {}

  // Calls the estimator, or another one. May be called from any thread.
  MotionEstimate Call(const ContractProblem& problem, const MotionEstimator* other = nullptr);
  std::unique_ptr<MotionEstimator> MakeAnother() const { return make_(); }

  // The problems that the options select. Throws InputError if there is none.
  std::vector<ContractProblem> Chosen(std::vector<ContractProblem> problems) const;
  // One problem per scene, for checks that call the estimator several times.
  std::vector<ContractProblem> SomeOrdinary() const;

  std::uint64_t seed() const { return options_.seed; }
  // "slowest call 12 ms (problem)".
  std::string SlowestCall() const;

 private:
  const EstimatorMaker& make_;
  std::unique_ptr<MotionEstimator> estimator_;
  const ContractOptions& options_;
  const Announce& announce_;
  std::mutex mutex_;  // guards the two below
  double slowest_seconds_ = 0.0;
  std::string slowest_;
};

}  // namespace rcme
