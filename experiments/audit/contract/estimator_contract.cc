#include "experiments/audit/contract/estimator_contract.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "experiments/audit/contract/contract_problems.h"
#include "experiments/audit/contract/estimate_difference.h"
#include "experiments/core/work/isolated_call.h"
#include "experiments/study/study.h"
#include "experiments/trial/answer_check.h"
#include "parameters/input_error.h"
#include "peers/outside_answer.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// A breach of the contract, found on a problem.
struct Breach {
  std::string problem, what;
};

// The tools of a contract check: the estimator, the problems, and the clock of its calls.
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

constexpr size_t kNumMatchesOfSome = 60;  // every scene has one problem of this size

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

// A fault of an answer: one that the score would find, or one that only the contract forbids. Nullopt: sound.
std::optional<std::string> FindContractFault(const MotionEstimate& estimate, const ContractProblem& problem) {
  const auto fault = FindFault(estimate, problem.problem.matches.size());
  const bool is_of_rcme =
      fault && fault->status == MotionStatus::kInvalidCovariance && HasCovarianceOfRcme(estimate);
  if (fault && !is_of_rcme) return fmt::format("{}: {}", StatusName(fault->status), fault->message);
  const MotionStatus status = estimate.status;
  if (status == MotionStatus::kInvalidMotion || status == MotionStatus::kInvalidCovariance)
    return fmt::format("returns the status {}, which only the check of its answer may give",
                       StatusName(status));
  if (!std::is_sorted(estimate.inliers.begin(), estimate.inliers.end()))
    return "the inliers are not in ascending order";
  if (status != MotionStatus::kOk && estimate.message.empty())
    return fmt::format("refuses ({}) without a message", StatusName(status));
  if (status == MotionStatus::kOk && problem.has_no_motion)
    return "returns a motion (status ok) where only a refusal can be right";
  return std::nullopt;
}

// Calls the estimator once on each problem. Counts all breaches and reports the first.
std::string ExpectSoundAnswers(Bench& bench, const std::vector<ContractProblem>& problems) {
  int num_ok = 0, num_broken = 0, num_without_covariance = 0;
  std::optional<Breach> first;
  for (const ContractProblem& problem : problems) {
    std::optional<std::string> fault;
    try {
      const MotionEstimate estimate = bench.Call(problem);
      num_ok += estimate.status == MotionStatus::kOk;
      num_without_covariance += HasCovarianceOfRcme(estimate);
      fault = FindContractFault(estimate, problem);
    } catch (const std::exception& error) {
      fault = fmt::format("throws: {}", error.what());
    } catch (...) {
      fault = "throws something that is not a std::exception";
    }
    num_broken += fault.has_value();
    if (fault && !first) first = Breach{problem.name, *fault};
  }
  if (num_broken > 1)
    first->what += fmt::format(" ({} of {} problems are answered wrongly)", num_broken, problems.size());
  if (first) throw Breach(*first);
  const std::string not_checked =
      num_without_covariance == 0
          ? ""
          : fmt::format("covariances of {} not checked: {}; ", num_without_covariance, kCovarianceOfRcme);
  return fmt::format("{} problems: {} motions, {} refusals; {}{}", problems.size(), num_ok,
                     std::ssize(problems) - num_ok, not_checked, bench.SlowestCall());
}

std::string CheckAnswers(Bench& bench) {
  return ExpectSoundAnswers(bench, bench.Chosen(OrdinaryProblems(bench.seed())));
}

std::string CheckBadInput(Bench& bench) {
  return ExpectSoundAnswers(bench, bench.Chosen(BadProblems(bench.seed())));
}

std::string CheckLarge(Bench& bench) {
  return ExpectSoundAnswers(bench, bench.Chosen({LargeProblem(bench.seed())}));
}

bool IsClose(const RelativePose& pose, const RelativePose& pose_true) {
  const FailureBounds bounds;
  return kDegPerRad * RotationAngleBetween(pose.R, pose_true.R) <= bounds.max_rotation_error_deg &&
         kDegPerRad * AngleBetween(pose.t, pose_true.t) <= bounds.max_direction_error_deg;
}

// Common mistakes of convention, each with the motion that it makes of the right one.
struct Mistake {
  std::string words;
  RelativePose (*right)(const RelativePose& pose);  // what the answer should have been
};

const std::vector<Mistake>& Mistakes() {
  static const std::vector<Mistake> all = {
      {"cam1_from_cam2 in place of cam2_from_cam1",
       [](const RelativePose& p) {
         return RelativePose{p.R.transpose(), -(p.R.transpose() * p.t)};
       }},
      {"R transposed",
       [](const RelativePose& p) {
         return RelativePose{p.R.transpose(), p.t};
       }},
      {"t of the wrong sign",
       [](const RelativePose& p) {
         return RelativePose{p.R, -p.t};
       }},
      {"the centre of camera 2 in place of t", [](const RelativePose& p) {
         return RelativePose{p.R, -(p.R * p.t)};
       }}};
  return all;
}

std::string CheckConventions(Bench& bench) {
  const std::vector<ContractProblem> problems = bench.Chosen(EasyProblems(bench.seed()));
  size_t num_right = 0, num_refused = 0;
  std::vector<size_t> num_mistaken(Mistakes().size());
  for (const ContractProblem& problem : problems) {
    const MotionEstimate estimate = bench.Call(problem);
    num_refused += estimate.status != MotionStatus::kOk;
    if (estimate.status != MotionStatus::kOk) continue;
    num_right += IsClose(estimate.cam2_from_cam1, *problem.cam2_from_cam1_true);
    for (size_t m = 0; m < Mistakes().size(); ++m) {
      num_mistaken[m] += IsClose(Mistakes()[m].right(estimate.cam2_from_cam1), *problem.cam2_from_cam1_true);
    }
  }
  const std::string count = fmt::format(
      "{} of {} easy problems (100 true matches, .1 px) solved within 3 degrees in rotation and 15 in "
      "direction, {} refused",
      num_right, problems.size(), num_refused);
  if (2 * num_right >= problems.size()) return count;
  const auto likely = std::max_element(num_mistaken.begin(), num_mistaken.end());
  const std::string& words = Mistakes()[static_cast<size_t>(likely - num_mistaken.begin())].words;
  throw Breach{"", 2 * *likely >= problems.size() ? count + "; the answers look like " + words : count};
}

void ExpectSame(const MotionEstimate& first, const MotionEstimate& second, const ContractProblem& problem,
                const std::string& when) {
  if (const auto difference = FirstDifference(first, second))
    throw Breach{problem.name, fmt::format("another answer {}: {}", when, *difference)};
}

std::vector<MotionEstimate> CallInTurn(Bench& bench, const std::vector<ContractProblem>& problems) {
  std::vector<MotionEstimate> estimates;
  for (const ContractProblem& problem : problems) estimates.push_back(bench.Call(problem));
  return estimates;
}

std::string CheckRepeatable(Bench& bench) {
  const std::vector<ContractProblem> problems = bench.SomeOrdinary();
  for (const ContractProblem& problem : problems) {
    const MotionEstimate first = bench.Call(problem);
    ExpectSame(first, bench.Call(problem), problem, "to the same problem and stream, called again");
  }
  return fmt::format("{} problems, the same bytes twice", problems.size());
}

std::string CheckOrder(Bench& bench) {
  const std::vector<ContractProblem> problems = bench.SomeOrdinary();
  const std::vector<MotionEstimate> in_turn = CallInTurn(bench, problems);
  const std::unique_ptr<MotionEstimator> fresh = bench.MakeAnother();
  for (size_t i = problems.size(); i-- > 0;) {
    ExpectSame(in_turn[i], bench.Call(problems[i]), problems[i], "when the calls come in another order");
    ExpectSame(in_turn[i], bench.Call(problems[i], fresh.get()), problems[i], "of another object");
  }
  return fmt::format("{} problems forwards, backwards and by another object: the same bytes",
                     problems.size());
}

std::string CheckThreads(Bench& bench) {
  constexpr size_t kNumThreads = 4, kNumRounds = 3;
  const std::vector<ContractProblem> problems = bench.SomeOrdinary();
  const std::vector<MotionEstimate> in_turn = CallInTurn(bench, problems);
  std::mutex mutex;
  std::optional<Breach> first;
  const auto run = [&](size_t thread) {
    for (size_t i = 0; i < kNumRounds * problems.size(); ++i) {
      const size_t p = (i + 3 * thread) % problems.size();  // at any time, threads work on different problems
      try {
        ExpectSame(in_turn[p], bench.Call(problems[p]), problems[p], "while other threads call");
      } catch (const Breach& breach) {
        const std::lock_guard lock(mutex);
        if (!first) first = breach;
      } catch (const std::exception& error) {
        const std::lock_guard lock(mutex);
        if (!first) first = Breach{problems[p].name, fmt::format("throws: {}", error.what())};
      }
    }
  };
  {
    std::vector<std::jthread> threads;
    for (size_t t = 0; t < kNumThreads; ++t) threads.emplace_back(run, t);
  }
  if (first) throw Breach(*first);
  return fmt::format("{} calls on {} threads: the bytes of calls one by one",
                     kNumThreads * kNumRounds * problems.size(), kNumThreads);
}

std::string CheckProblemUntouched(Bench& bench) {
  const std::vector<ContractProblem> problems = bench.SomeOrdinary();
  for (const ContractProblem& problem : problems) {
    const MotionProblem before = problem.problem;
    bench.Call(problem);
    if (const auto difference = FirstDifference(before, problem.problem))
      throw Breach{problem.name, "changes its problem: " + *difference};
  }
  return fmt::format("{} problems", problems.size());
}

struct RunnableCheck {
  ContractCheck description;
  std::string (*run)(Bench& bench);  // throws Breach, or returns what was done
};

const std::vector<RunnableCheck>& RunnableChecks() {
  static const std::vector<RunnableCheck> all = {
      {{"answers", "valid motions, covariances, inliers and messages on every scene"}, CheckAnswers},
      {{"conventions", "the motion of easy problems: X2 = R X1 + t, R from camera 1 to 2"}, CheckConventions},
      {{"repeatable", "the same problem and stream give the same bytes"}, CheckRepeatable},
      {{"order", "neither earlier calls nor the object matter"}, CheckOrder},
      {{"threads", "calls from several threads at once give the same bytes"}, CheckThreads},
      {{"untouched", "the problem is left as it is"}, CheckProblemUntouched},
      {{"bad_input", "a status and a message for whatever is wrong; no exception"}, CheckBadInput},
      {{"large", "100,000 matches"}, CheckLarge}};
  return all;
}

// The check's outcome as text: the first letter is one of these, then follow problem and finding.
constexpr char kPassed = '+', kBroken = '-', kUsage = '?';

std::string Attempt(const RunnableCheck& check, const EstimatorMaker& make, const ContractOptions& options,
                    const Announce& announce) {
  std::string problem;  // of the last call
  const Announce remember = [&, mutex = std::make_shared<std::mutex>()](const std::string& step) {
    const std::lock_guard lock(*mutex);
    problem = step;
    announce(step);
  };
  const auto text = [](char end, const std::string& at, const std::string& finding) {
    return end + at + '\n' + finding;
  };
  try {
    Bench bench(make, options, remember);
    return text(kPassed, "", check.run(bench));
  } catch (const Breach& breach) {
    return text(kBroken, breach.problem, breach.what);
  } catch (const InputError& error) {
    return text(problem.empty() ? kUsage : kBroken, problem, error.what());
  } catch (const std::exception& error) {
    return text(kBroken, problem, fmt::format("throws: {}", error.what()));
  } catch (...) {
    return text(kBroken, problem, "throws something that is not a std::exception");
  }
}

ContractResult ResultFrom(const std::string& text) {
  const size_t line = text.find('\n');
  if (text[0] == kUsage) throw InputError(text.substr(line + 1));
  return {text[0] == kPassed, text.substr(line + 1), text.substr(1, line - 1)};
}

}  // namespace

const std::vector<ContractCheck>& ContractChecks() {
  static const std::vector<ContractCheck> all = [] {
    std::vector<ContractCheck> checks;
    for (const RunnableCheck& check : RunnableChecks()) checks.push_back(check.description);
    return checks;
  }();
  return all;
}

ContractResult RunContractCheck(const std::string& name, const EstimatorMaker& make,
                                const ContractOptions& options) {
  const auto check = std::ranges::find_if(RunnableChecks(),
                                          [&](const RunnableCheck& c) { return c.description.name == name; });
  if (check == RunnableChecks().end()) throw InputError(fmt::format("no check is called '{}'", name));
  if (!options.is_isolated) return ResultFrom(Attempt(*check, make, options, [](const std::string&) {}));
  const IsolatedEnd end =
      RunIsolated([&](const Announce& announce) { return Attempt(*check, make, options, announce); },
                  options.seconds_per_call);
  if (end.kind == IsolatedEnd::Kind::kDone) return ResultFrom(end.result);
  return {false, DescribeEnd(end, options.seconds_per_call), end.last_step};
}

}  // namespace rcme
