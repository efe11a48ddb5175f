#include "experiments/statistics/preregistration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "experiments/core/text/columns.h"
#include "experiments/statistics/scenes_of_run.h"
#include "experiments/statistics/summary_quantities.h"
#include "experiments/statistics/trial_groups.h"
#include "experiments/study/population.h"
#include "experiments/study/study_lock.h"
#include "parameters/text_lines.h"
#include "stats/paired.h"
#include "stats/population_mean.h"
#include "stats/population_rate.h"
#include "stats/score_mean.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

const TrialQuantity& FindQuantity(const std::string& name) {
  const auto found = std::ranges::find(TrialQuantities(), name, &TrialQuantity::name);
  if (found == TrialQuantities().end()) throw std::logic_error("no quantity of trials: " + name);
  return *found;
}

std::optional<size_t> FindLabel(const RunDescription& run, const std::string& label) {
  const auto found = std::ranges::find(run.estimators, label, &DescribedEstimator::label);
  if (found == run.estimators.end()) return std::nullopt;
  return static_cast<size_t>(found - run.estimators.begin());
}

std::vector<bool> ConditionsWhere(const RunDescription& run, const Settings& where) {
  std::vector<bool> has(run.conditions.size(), true);
  for (const auto& [factor, level] : where) {
    const auto found = std::ranges::find(run.factors, factor);
    const auto f = static_cast<size_t>(found - run.factors.begin());
    for (size_t c = 0; c < has.size(); ++c)
      has[c] = has[c] && found != run.factors.end() && run.conditions[c].levels[f] == level;
  }
  return has;
}

// What the trials say of one hypothesis, growing trial by trial.
class Evidence {
 public:
  Evidence(const RunDescription& run, const StatedHypothesis& stated)
      : quantity_(FindQuantity(stated.quantity)),
        estimator_(FindLabel(run, stated.estimator)),
        against_(FindLabel(run, stated.against)),
        is_paired_(!stated.against.empty()),
        is_of_means_(run.repeats_per_scene > 1 || quantity_.kind == SummaryRow::Kind::kScore),
        bounds_(run.failure),
        has_(ConditionsWhere(run, stated.where)),
        cluster_of_(NumberDraws(run)),
        clusters_(run.conditions.size()),
        scores_(is_paired_ ? Interval{-1.0, 1.0} : Interval{0.0, 1.0}) {}

  bool HasEstimators() const { return estimator_ && (against_ || !is_paired_); }
  bool HasCondition(size_t condition) const { return has_[condition]; }

  void Add(std::uint32_t condition, const std::vector<TrialRecord>& records) {
    if (!has_[condition]) return;
    const std::optional<double> first = quantity_.contribution(records[*estimator_], bounds_);
    const std::optional<double> second =
        is_paired_ ? quantity_.contribution(records[*against_], bounds_) : std::optional(0.0);
    if (!first || !second) return;
    if (is_of_means_) return scene_.Add(*first - *second);
    const bool is_first = *first != 0.0, is_second = *second != 0.0;
    Cluster& cluster = clusters_[cluster_of_[condition]];
    cluster.count.num_events += is_first;
    ++cluster.count.num_trials;
    cluster.pair.num_first_only += is_first && !is_second;
    cluster.pair.num_second_only += is_second && !is_first;
    ++cluster.pair.num_trials;
    pairs_.Add(is_first, is_second);
  }

  void EndScene(std::uint32_t condition) {
    const std::optional<double> mean = scene_.Take();
    if (!mean || !has_[condition]) return;
    clusters_[cluster_of_[condition]].moments.Add(*mean);
    scores_.Add(*mean);
  }

  // Value, interval, n and the number of conditions.
  void Fill(bool is_of_population, double confidence, DecidedHypothesis* decided) const {
    decided->n = is_of_means_ ? scores_.n() : pairs_.n();
    decided->num_conditions = std::ranges::count(has_, true);
    if (is_of_population) {
      FillPopulation(confidence, decided);
    } else if (is_of_means_) {
      decided->value = scores_.mean();
      decided->interval = scores_.Sequence(confidence);
    } else if (is_paired_) {
      decided->value = decided->n > 0 ? pairs_.RiskDifference() : std::nan("");
      decided->interval = RiskDifferenceInterval(pairs_, confidence);
    } else {
      const std::int64_t num_events = pairs_.both + pairs_.first_only;
      decided->value =
          decided->n > 0 ? static_cast<double>(num_events) / static_cast<double>(decided->n) : std::nan("");
      decided->interval = ExactBinomialInterval(num_events, decided->n, confidence);
    }
  }

 private:
  struct Cluster {
    ConditionCount count;
    ConditionPair pair;
    Moments moments;
  };

  template <typename Field>
  std::vector<Field> Clusters(Field Cluster::*field) const {
    std::vector<Field> all;
    for (const Cluster& cluster : clusters_) all.push_back(cluster.*field);
    return all;
  }

  void FillPopulation(double confidence, DecidedHypothesis* decided) const {
    const auto fill = [&](const auto& measured) {
      decided->value = measured.value;
      decided->interval = measured.interval;
    };
    constexpr ConditionWeights kWeights = ConditionWeights::kByTrials;  // as in a pooled summary
    if (is_of_means_) {
      fill(MeasurePopulationMean(Clusters(&Cluster::moments), kWeights, confidence));
    } else if (is_paired_) {
      fill(MeasurePopulationDifference(Clusters(&Cluster::pair), kWeights, confidence));
    } else {
      fill(MeasurePopulationRate(Clusters(&Cluster::count), kWeights, confidence));
    }
  }

  const TrialQuantity& quantity_;
  std::optional<size_t> estimator_, against_;
  bool is_paired_, is_of_means_;
  FailureBounds bounds_;
  std::vector<bool> has_;  // by condition
  std::vector<size_t> cluster_of_;
  std::vector<Cluster> clusters_;
  PairedCounts pairs_;
  SceneMean scene_;
  ScoreMean scores_;
};

// How many trials of each condition were asked for beforehand.
std::vector<std::int64_t> TrialsBefore(const RunDescription& run, int trials) {
  std::vector<std::int64_t> num_trials;
  for (const DescribedCondition& condition : run.conditions) {
    // Of a folder of pairs, a pass has several trials.
    const std::int64_t per_pass =
        run.stopping_rule.empty() && run.trials > 0 ? condition.num_trials / run.trials : 1;
    num_trials.push_back(std::max<std::int64_t>(per_pass, 1) * trials);
  }
  return num_trials;
}

// Reads the run once.
struct TrialsRead {
  std::vector<std::int64_t> num_trials;  // by condition, of those asked for beforehand
  bool is_weighted = false;
};
TrialsRead ReadEvidence(const ResultStore& store, const RunDescription& run,
                        const std::vector<std::int64_t>& before, std::vector<Evidence>* evidence) {
  TrialsRead read{std::vector<std::int64_t>(run.conditions.size())};
  ForEachTrialByScene(
      store, run.repeats_per_scene,
      [&](const ProblemRecord& problem, const std::vector<TrialRecord>& records, bool) {
        if (problem.trial >= before[problem.condition]) return;
        ++read.num_trials[problem.condition];
        read.is_weighted = read.is_weighted || problem.weight != 1.0;
        for (Evidence& one : *evidence) {
          if (one.HasEstimators()) one.Add(problem.condition, records);
        }
      },
      [&](std::uint32_t condition) {
        for (Evidence& one : *evidence) one.EndScene(condition);
      });
  return read;
}

// Empty: the interval decides.
std::string WhyOpen(const Evidence& evidence, const TrialsRead& read, const std::vector<std::int64_t>& before,
                    const DecidedHypothesis& decided) {
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
  const std::vector<std::int64_t> before = TrialsBefore(run, plan.trials);
  std::vector<Evidence> evidence;
  for (const StatedHypothesis& stated : plan.hypotheses) evidence.emplace_back(run, stated);
  const TrialsRead read = ReadEvidence(store, run, before, &evidence);
  std::vector<DecidedHypothesis> all;
  for (size_t i = 0; i < evidence.size(); ++i) {
    DecidedHypothesis decided;
    decided.stated = plan.hypotheses[i];
    evidence[i].Fill(IsSampleOfPopulation(run.identity), confidence, &decided);
    decided.why_open = WhyOpen(evidence[i], read, before, decided);
    if (decided.why_open.empty()) decided.verdict = Decide(decided.stated, decided.interval);
    all.push_back(std::move(decided));
  }
  return all;
}

// The text that says what was decided before; empty: none. A study that this program cannot read has none.
std::string PlanText(const RunDescription& run, const std::string& path) {
  if (!run.lock.empty()) return ParseLock(run.lock, path + " (its lock)").text;
  return run.study_yaml.find("\nhypotheses:") == std::string::npos ? "" : run.study_yaml;
}

std::string InPerCent(const DecidedHypothesis& decided) {
  if (decided.n == 0) return "-";
  return fmt::format("{:.2f} % [{:.2f}, {:.2f}]", 100.0 * decided.value, 100.0 * decided.interval.lower,
                     100.0 * decided.interval.upper);
}

std::string VerdictText(const DecidedHypothesis& decided) {
  return decided.why_open.empty() ? Name(decided.verdict)
                                  : fmt::format("{}: {}", Name(decided.verdict), decided.why_open);
}

}  // namespace

std::string Name(HypothesisVerdict verdict) {
  switch (verdict) {
    case HypothesisVerdict::kHolds:
      return "holds";
    case HypothesisVerdict::kDoesNotHold:
      return "does not hold";
    case HypothesisVerdict::kOpen:
      return "open";
  }
  return "";
}

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

std::string PreregistrationAsText(const Preregistration& preregistration) {
  std::string text =
      preregistration.is_locked
          ? fmt::format("Decided before the run (locked at {} by {}, SHA-256\n{})\n",
                        preregistration.locked_at, preregistration.program, preregistration.sha256)
          : "Hypotheses of the study. It has no lock (rcme lock): nothing shows that they were\nwritten "
            "before "
            "the run.\n";
  size_t number = 0;
  for (const DecidedHypothesis& decided : preregistration.hypotheses) {
    text += "\n" + FormatParagraph(fmt::format("{}. {}", ++number, Describe(decided.stated)));
    text += fmt::format("   {}; {}, n = {}\n", VerdictText(decided), InPerCent(decided), decided.n);
  }
  if (number > 0) {
    text += fmt::format(
        "\nAll {} intervals together hold with {:.0f} %, each with {:.2f} %. They are of the\n"
        "trials that were asked for beforehand.\n",
        number, 100.0 * preregistration.confidence, 100.0 * preregistration.confidence_each);
  } else if (preregistration.is_locked) {
    text += "It states no hypothesis.\n";
  }
  if (!preregistration.deviations.empty()) text += "\nDecided after: the run departs from its lock\n";
  for (const std::string& deviation : preregistration.deviations) text += fmt::format("  {}\n", deviation);
  for (const std::string& reason : preregistration.reasons) text += fmt::format("  reason: {}\n", reason);
  return text + "\nAll else in this summary was not decided before the run: it explores.\n";
}

Json PreregistrationAsJson(const Preregistration& preregistration) {
  Json hypotheses = Json::array();
  for (const DecidedHypothesis& decided : preregistration.hypotheses) {
    hypotheses.push_back({{"hypothesis", Describe(decided.stated)},
                          {"quantity", decided.stated.quantity},
                          {"estimator", decided.stated.estimator},
                          {"against", decided.stated.against},
                          {"value", decided.value},
                          {"interval", {decided.interval.lower, decided.interval.upper}},
                          {"n", decided.n},
                          {"conditions", decided.num_conditions},
                          {"verdict", Name(decided.verdict)},
                          {"why_open", decided.why_open}});
  }
  return {{"locked", preregistration.is_locked},
          {"locked_at", preregistration.locked_at},
          {"program", preregistration.program},
          {"sha256", preregistration.sha256},
          {"confidence", preregistration.confidence},
          {"confidence_each", preregistration.confidence_each},
          {"deviations", preregistration.deviations},
          {"reasons", preregistration.reasons},
          {"hypotheses", hypotheses}};
}

}  // namespace rcme
