#include "experiments/tuning/setting_counts.h"

#include <map>

#include "experiments/run/run_trials.h"
#include "experiments/trial/simulate_draw.h"
#include "experiments/trial/trial_event.h"
#include "parameters/input_error.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// Decides all settings in one trial.
class TrialDecisions {
 public:
  TrialDecisions(const StreamName& name, const FailureBounds& bounds, TrialData data)
      : name_(name), bounds_(bounds), data_(std::move(data)) {
    if (data_.weight != 1.0)
      throw InputError("tune: tilted_to: weighted trials cannot be used to tune; leave it out");
  }

  // The outcome of each setting of the group, with and without its limits.
  template <typename Visit>
  void ForEachSetting(const SettingPlan& plan, const TraceGroup& group, Visit visit) {
    refinements_.clear();
    outcomes_.clear();
    decided_.clear();
    if (group.tracer) {
      RandomStream rng = StreamFor(name_, StreamPurpose::kSampling);
      trace_ = group.tracer->Trace(data_.problem, rng);
    }
    for (const size_t s : group.settings) {
      const Decided without = DecideOnce(*plan.without_limits[s]);
      const std::optional<double>& limit = plan.greatest_probability[s];
      const bool is_refused = limit && without.failure_probability > *limit;
      visit(s,
            is_refused ? TrialOutcome::kRefusal
            : limit    ? without.outcome
                       : OutcomeUnder(*plan.estimators[s]).outcome,
            without.outcome);
    }
  }

 private:
  struct Decided {
    TrialOutcome outcome = TrialOutcome::kRefusal;
    double failure_probability = kNaN;  // as stated
  };
  // The steps after a loop depend on the candidates that it hands over and on the share that they must
  // explain.
  using Handover = std::pair<std::vector<HypothesisId>, double>;

  Decided DecideOnce(const MotionEstimator& estimator) {
    const auto known = decided_.find(&estimator);
    return known != decided_.end() ? known->second : decided_[&estimator] = OutcomeUnder(estimator);
  }

  Decided OutcomeUnder(const MotionEstimator& estimator) {
    const LoopInspection* parts = FindInspection(estimator);
    if (!parts) {
      RandomStream rng = StreamFor(name_, StreamPurpose::kSampling);
      return JudgedOutcome(estimator.Estimate(data_.problem, rng));
    }
    const LoopResult loop = parts->Decide(trace_);
    if (!loop.winner) return {};
    Handover handover{{loop.winner->id}, parts->options().least_explained_share};
    for (const Candidate& candidate : loop.runners_up) handover.first.push_back(candidate.id);
    const auto known = outcomes_.find(handover);
    if (known != outcomes_.end()) return known->second;
    return outcomes_[handover] = JudgedOutcome(parts->Finish(data_.problem, loop, &refinements_));
  }

  Decided JudgedOutcome(const MotionEstimate& estimate) const {
    return {ClassifyOutcome(Score(estimate, data_, 0.0), bounds_), estimate.failure_probability};
  }

  StreamName name_;
  const FailureBounds& bounds_;
  TrialData data_;
  HypothesisTrace trace_;
  Refinements refinements_;
  std::map<Handover, Decided> outcomes_;
  std::map<const MotionEstimator*, Decided> decided_;
};

void AddOutcome(TrialOutcome outcome, TrialOutcome without_limits, SettingCount* count) {
  const bool is_refused = outcome == TrialOutcome::kRefusal,
             is_good = without_limits == TrialOutcome::kSuccess;
  ++count->n;
  count->failures += outcome == TrialOutcome::kFailure;
  count->refusals += is_refused;
  count->good += is_good;
  count->false_refusals += is_refused && is_good;
}

void CheckTrialsAreFresh(const StudyPlan& plan) {
  for (const Condition& condition : plan.conditions) {
    if (condition.source->SharedScene()) {
      throw InputError(
          "tune: scene: match_files: the pairs of a folder repeat, so no fresh trials can verify a setting; "
          "tune in simulation, then run the pairs with --add-estimator");
    }
  }
}

}  // namespace

SettingCount& SettingCount::operator+=(const SettingCount& other) {
  n += other.n;
  failures += other.failures;
  refusals += other.refusals;
  good += other.good;
  false_refusals += other.false_refusals;
  return *this;
}

SettingCounts CountOutcomes(const StudyPlan& plan, const SettingPlan& settings, TrialRange trials) {
  CheckTrialsAreFresh(plan);
  SettingCounts counts(plan.conditions.size(), std::vector<SettingCount>(settings.settings.size()));
  const std::int64_t per_condition = trials.end - trials.first;
  ForEachTrial(plan, trials, [&](const Condition& condition, std::uint32_t trial, std::int64_t index) {
    // By its index in the plan, which may be a part of a study's plan.
    std::vector<SettingCount>& of_condition = counts[static_cast<size_t>(index / per_condition)];
    const StreamName name = NameOfTrial(plan, condition, trial);
    auto simulated = SimulateDraw(plan.study, [&] { return condition.source->Make(name); });
    if (!simulated.made) return;
    TrialDecisions decisions(name, plan.study.failure, *std::move(simulated.made));
    for (const TraceGroup& group : settings.groups) {
      decisions.ForEachSetting(settings, group, [&](size_t s, TrialOutcome outcome, TrialOutcome without) {
        AddOutcome(outcome, without, &of_condition[s]);
      });
    }
  });
  return counts;
}

std::vector<SettingCount> SumOver(const SettingCounts& counts, const std::vector<std::uint32_t>& conditions) {
  std::vector<SettingCount> sums(counts.front().size());
  for (const std::uint32_t condition : conditions) {
    for (size_t s = 0; s < sums.size(); ++s) sums[s] += counts[condition][s];
  }
  return sums;
}

}  // namespace rcme
