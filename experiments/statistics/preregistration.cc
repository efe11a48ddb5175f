#include "experiments/statistics/preregistration.h"

#include <fmt/format.h>

#include "experiments/core/text/pick_name.h"
#include "experiments/statistics/hypothesis_evidence.h"
#include "experiments/study/population.h"
#include "experiments/study/study_lock.h"
#include "parameters/text_lines.h"

namespace rcme {
namespace {

// Empty if the interval decides.
std::string WhyOpen(const HypothesisEvidence& evidence, const EvidenceTrials& read,
                    const std::vector<std::int64_t>& before, const DecidedHypothesis& decided) {
  if (!evidence.HasEstimators()) return "the run lacks the estimator";
  if (decided.num_conditions == 0) return "the run lacks these conditions";
  if (read.is_weighted) return "the trials are weighted (tilted_to)";
  std::int64_t num_done = 0, num_before = 0;
  for (size_t c = 0; c < before.size(); ++c) {
    if (!evidence.HasCondition(c)) continue;
    num_done += read.num_trials[c];
    num_before += before[c];
  }
  if (num_done < num_before) return fmt::format("{} of {} trials are done", num_done, num_before);
  return decided.n == 0 ? "no trial says anything of it" : "";
}

std::vector<DecidedHypothesis> DecideAll(const ResultStore& store, const RunDescription& run,
                                         const WrittenPlan& plan, double confidence) {
  const std::vector<std::int64_t> before = CountTrialsBefore(run, plan.trials);
  std::vector<HypothesisEvidence> evidence;
  for (const StatedHypothesis& stated : plan.hypotheses) evidence.emplace_back(run, stated);
  const EvidenceTrials read = ReadEvidence(store, run, before, &evidence);
  std::vector<DecidedHypothesis> all;
  for (size_t i = 0; i < evidence.size(); ++i) {
    DecidedHypothesis decided;
    decided.stated = plan.hypotheses[i];
    const MeasuredHypothesis measured = evidence[i].Measure(IsSampleOfPopulation(run.identity), confidence);
    decided.value = measured.value;
    decided.interval = measured.interval;
    decided.n = measured.n;
    decided.num_conditions = evidence[i].CountConditions();
    decided.sharpness = evidence[i].MeasureSharpness(HypothesisEvidence::Side::kEstimator);
    decided.sharpness_against = evidence[i].MeasureSharpness(HypothesisEvidence::Side::kAgainst);
    decided.why_open = WhyOpen(evidence[i], read, before, decided);
    if (decided.why_open.empty()) decided.verdict = Decide(decided.stated, decided.interval);
    all.push_back(std::move(decided));
  }
  return all;
}

// Returns the text of what was planned; empty if there is none, or if this program cannot read the study.
std::string PlanText(const RunDescription& run, const std::string& path) {
  if (!run.lock.empty()) return ParseLock(run.lock, path + " (its lock)").text;
  return run.study_yaml.find("\nhypotheses:") == std::string::npos ? "" : run.study_yaml;
}

}  // namespace

std::string Name(HypothesisVerdict verdict) { return PickName(verdict, {"holds", "does not hold", "open"}); }

HypothesisVerdict Decide(const StatedHypothesis& hypothesis, const Interval& interval) {
  const auto [lower, upper] = interval;
  const double bound = hypothesis.bound;
  const auto verdict = [](bool holds, bool does_not_hold) {
    return holds           ? HypothesisVerdict::kHolds
           : does_not_hold ? HypothesisVerdict::kDoesNotHold
                           : HypothesisVerdict::kOpen;
  };
  switch (hypothesis.direction) {
    case StatedDirection::kAtLeast:
      return verdict(lower >= bound, upper < bound);
    case StatedDirection::kAtMost:
      return verdict(upper <= bound, lower > bound);
    case StatedDirection::kLower:
      return verdict(upper < -bound, lower >= -bound);
    case StatedDirection::kHigher:
      return verdict(lower > bound, upper <= bound);
    case StatedDirection::kNotLower:
      return verdict(lower > -bound, upper <= -bound);
    case StatedDirection::kNotHigher:
      return verdict(upper < bound, lower >= bound);
  }
  return HypothesisVerdict::kOpen;
}

std::optional<Preregistration> DescribePreregistered(const RunDescription& run, const std::string& path) {
  if (PlanText(run, path).empty()) return std::nullopt;
  Preregistration preregistration;
  const WrittenPlan plan = ReadWrittenPlan(PlanText(run, path), path + " (its study)");
  for (const StatedHypothesis& stated : plan.hypotheses) {
    DecidedHypothesis open;
    open.stated = stated;
    open.why_open = "the file keeps counts, not trials";
    preregistration.hypotheses.push_back(std::move(open));
  }
  if (run.lock.empty()) return preregistration;
  const StudyLock lock = ParseLock(run.lock, path + " (its lock)");
  preregistration.is_locked = true;
  preregistration.locked_at = lock.locked_at;
  preregistration.program = lock.program;
  preregistration.sha256 = lock.sha256;
  preregistration.deviations = DeviationsFrom(lock, run.study_yaml, run.identity, run.stopping_rule);
  preregistration.reasons = SplitText(run.despite_lock, '\n');
  return preregistration;
}

std::optional<Preregistration> DecidePreregistered(const ResultStore& store, const std::string& path) {
  const RunDescription run = store.Description();
  std::optional<Preregistration> preregistration = DescribePreregistered(run, path);
  if (!preregistration) return std::nullopt;
  const WrittenPlan plan = ReadWrittenPlan(PlanText(run, path), path + " (its study)");
  if (plan.hypotheses.empty()) return preregistration;
  const auto num_hypotheses = static_cast<double>(plan.hypotheses.size());
  preregistration->confidence_each = 1.0 - (1.0 - preregistration->confidence) / num_hypotheses;
  preregistration->hypotheses = DecideAll(store, run, plan, preregistration->confidence_each);
  return preregistration;
}

}  // namespace rcme
