#include "experiments/run/find_effort.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "experiments/core/work/thread_time.h"
#include "experiments/trial/simulate_draw.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr double kTimeTolerance = 0.03;

// One point of the search.
struct Timed {
  double effort, ms;
};

// Returns the estimator with another effort; nothing if its options do not allow it.
std::optional<EstimatorSpec> WithEffort(EstimatorSpec spec, const std::string& option, double effort) {
  try {
    SetOptions(&spec, {{option, std::to_string(static_cast<std::int64_t>(effort))}});
    Make(spec);
    return spec;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

double Round(double effort) { return std::max(1.0, std::round(effort)); }

// Returns the effort at which a line through two points, in logarithms, takes `ms`; at least a tenth of the
// bracket away from its ends.
double Between(const Timed& less, const Timed& more, double ms) {
  const double share = std::log(ms / less.ms) / std::log(more.ms / less.ms);
  return less.effort * std::pow(more.effort / less.effort, std::clamp(share, 0.1, 0.9));
}

// Returns the next effort to try. It equals that of a known point if no effort lies between the two.
double NextEffort(const std::optional<Timed>& less, const std::optional<Timed>& more, double ms) {
  if (less && more) return Round(Between(*less, *more, ms));
  if (less) return Round(less->effort * std::clamp(1.1 * ms / less->ms, 2.0, 16.0));
  return Round(more->effort * std::clamp(0.9 * ms / more->ms, 1.0 / 16.0, 0.5));
}

}  // namespace

std::vector<TimedProblem> TimedProblems(const StudyPlan& plan, std::uint32_t first,
                                        std::uint32_t per_condition) {
  std::vector<TimedProblem> problems;
  for (const Condition& condition : plan.conditions) {
    for (std::uint32_t trial = first; trial < first + per_condition; ++trial) {
      const StreamName name = NameOfTrial(plan, condition, trial);
      auto simulated = SimulateDraw(plan.study, [&] { return condition.source->Make(name).problem; });
      if (simulated.made) problems.push_back({*std::move(simulated.made), name});
    }
  }
  if (problems.empty())
    throw InputError("budget: conditions: no trial of the draws could be simulated; change their ranges");
  return problems;
}

Moments TimeCalls(const EstimatorSpec& spec, const std::vector<TimedProblem>& problems) {
  const std::unique_ptr<MotionEstimator> estimator = Make(spec);
  Moments ms;
  for (const auto& [problem, name] : problems) {
    RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
    const double start = ThreadSeconds();
    estimator->Estimate(problem, rng);
    ms.Add(1e3 * (ThreadSeconds() - start));
  }
  return ms;
}

FoundEffort FindEffort(const EstimatorSpec& given, const std::vector<TimedProblem>& problems,
                       double time_ms) {
  const std::unique_ptr<EstimatorModel> model = Configure(given);
  const std::optional<Effort> effort = model->EffortOption();
  FoundEffort found{EffortEnd::kNoEffort, given, 0};
  found.spec.budget_ms.reset();
  if (!effort) return found;
  double next = std::stod(FindParameter(model->Parameters(), effort->option).Value());
  std::optional<Timed> less, more;  // the nearest efforts that take less and more than the time
  const auto end_with = [&](EffortEnd end) {
    found.end = end;
    if (end == EffortEnd::kReached) found.spec.budget_ms = time_ms;
    return found;
  };
  for (;;) {
    const std::optional<EstimatorSpec> spec = WithEffort(given, effort->option, next);
    if (!spec) return end_with(EffortEnd::kAtTheLimit);
    const Timed now{next, TimeCalls(*spec, problems).mean()};
    const bool has_saturated =
        effort->has_own_rule && less && next >= 2.0 * less->effort && now.ms < 1.05 * less->ms;
    found.spec = *spec;
    found.effort = static_cast<std::int64_t>(next);
    if (std::abs(now.ms / time_ms - 1.0) < kTimeTolerance) return end_with(EffortEnd::kReached);
    if (has_saturated && now.ms < time_ms) return end_with(EffortEnd::kOwnRule);
    (now.ms < time_ms ? less : more) = now;
    if (!less && next == 1.0) return end_with(EffortEnd::kTooSlow);
    next = NextEffort(less, more, time_ms);
    const auto is_known = [&](const std::optional<Timed>& point) { return point && point->effort == next; };
    if (is_known(less) || is_known(more)) return end_with(EffortEnd::kReached);
  }
}

}  // namespace rcme
