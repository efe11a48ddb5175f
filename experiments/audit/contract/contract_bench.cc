#include "experiments/audit/contract/contract_bench.h"

#include <fmt/format.h>

#include <chrono>

#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr size_t kNumMatchesOfSome = 60;  // every scene has one problem of this size

}  // namespace

MotionEstimate Bench::Call(const ContractProblem& problem, const MotionEstimator* other) {
  announce_(problem.name);
  RandomStream rng = StreamFor(problem.stream, StreamPurpose::kSampling);
  const auto start = std::chrono::steady_clock::now();
  MotionEstimate estimate = (other ? *other : *estimator_).Estimate(problem.problem, rng);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  const std::lock_guard lock(mutex_);
  if (elapsed.count() > slowest_seconds_) {
    slowest_seconds_ = elapsed.count();
    slowest_ = problem.name;
  }
  return estimate;
}

std::vector<ContractProblem> Bench::Chosen(std::vector<ContractProblem> problems) const {
  if (options_.problem.empty()) return problems;
  std::erase_if(problems, [&](const ContractProblem& p) { return p.name != options_.problem; });
  if (problems.empty())
    throw InputError(fmt::format("--problem: this check has no problem '{}'", options_.problem));
  return problems;
}

std::vector<ContractProblem> Bench::SomeOrdinary() const {
  std::vector<ContractProblem> all = OrdinaryProblems(options_.seed);
  if (!options_.problem.empty()) return Chosen(std::move(all));
  std::erase_if(all, [](const ContractProblem& p) { return p.problem.matches.size() != kNumMatchesOfSome; });
  return all;
}

std::string Bench::SlowestCall() const {
  return fmt::format("slowest call {:.3g} ms ({})", 1e3 * slowest_seconds_, slowest_);
}

}  // namespace rcme
