#include "experiments/tuning/tuning_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numeric>

#include "parameters/input_error.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kTrialsOfItem = 10;

// The use of a group's trials. Every condition has one group of each kind, in this order.
enum class Kind : size_t { kExplore, kCalibrate, kVerify, kEntropies, kPlainCalls };
constexpr std::array<const char*, 5> kKinds = {"explore", "calibrate", "verify", "entropies", "plain calls"};

size_t FirstGroup(const StudyPlan& plan, Kind kind) {
  return static_cast<size_t>(kind) * plan.conditions.size();
}

Kind FindKind(const StudyPlan& plan, const ItemPlace& place) {
  return static_cast<Kind>(place.group / plan.conditions.size());
}

size_t FindConditionNumber(const StudyPlan& plan, const ItemPlace& place) {
  return place.group % plan.conditions.size();
}

TrialRange FindTrialRange(const StudyPlan& plan, Kind kind) {
  const TuningTrials trials(*plan.study.tuning);
  if (kind == Kind::kExplore) return trials.explore;
  return kind == Kind::kCalibrate ? trials.calibrate : trials.verify;
}

TrialRange FindItemTrials(const StudyPlan& plan, const ItemPlace& place) {
  const TrialRange all = FindTrialRange(plan, FindKind(plan, place));
  const auto first = all.first + static_cast<std::uint32_t>(place.item) * kTrialsOfItem;
  return {first, std::min(first + kTrialsOfItem, all.end)};
}

// The plan with only one of its conditions.
StudyPlan OneCondition(const StudyPlan& plan, size_t condition) {
  StudyPlan one = plan;
  one.conditions = {plan.conditions[condition]};
  return one;
}

// Everything on which the results depend, one line each.
std::string Identity(const StudyPlan& plan) {
  Tuning tuning = *plan.study.tuning;
  std::string identity;
  for (const Parameter& parameter : Parameters(tuning)) {
    identity += fmt::format("tune: {}: {}\n", parameter.name(), parameter.Value());
  }
  for (const TunedOption& option : tuning.options) {
    identity += fmt::format("tune: {}: {}\n", option.name, fmt::join(option.levels, ", "));
  }
  return identity + plan.identity;
}

TuningWork PlanWork(const StudyPlan& plan, const std::string& work, size_t num_kinds, size_t num_first) {
  TuningWork made{
      {work, "block", Identity(plan), {}}, 2 * plan.conditions.size(), num_first * plan.conditions.size()};
  for (size_t k = 0; k < num_kinds; ++k) {
    const TrialRange range = FindTrialRange(plan, static_cast<Kind>(k));
    const size_t num_items = (range.end - range.first + kTrialsOfItem - 1) / kTrialsOfItem;
    for (const Condition& condition : plan.conditions) {
      made.items.groups.push_back({fmt::format("{} of condition {}", kKinds[k], condition.index), num_items});
    }
  }
  return made;
}

Json CountsAsJson(const std::vector<SettingCount>& counts) {
  Json json = Json::array();
  for (const SettingCount& c : counts)
    json.push_back({c.n, c.failures, c.refusals, c.good, c.false_refusals});
  return json;
}

// Adds the counts of this many trials, or of those that could be simulated.
void AddCounts(const Json& json, std::int64_t num_trials, bool is_drawn, std::vector<SettingCount>* counts) {
  RequireSize(json, counts->size());
  for (size_t s = 0; s < counts->size(); ++s) {
    RequireSize(json[s], 5);
    const std::int64_t n = CountFrom(json[s][0], num_trials);
    RequirePossible(n == num_trials || is_drawn, "counts", "fewer trials than there are");
    const auto number = [&](size_t i) { return CountFrom(json[s][i], n); };
    const SettingCount count{n, number(1), number(2), number(3), number(4)};
    RequirePossible(count.failures + count.refusals <= n, "counts", "more failures and refusals than trials");
    RequirePossible(count.false_refusals <= count.refusals, "counts", "more false refusals than refusals");
    RequirePossible(count.false_refusals <= count.good, "counts", "more false refusals than good trials");
    RequirePossible(count.good - count.false_refusals <= n - count.refusals, "counts",
                    "more good trials than were refused or not");
    (*counts)[s] += count;
  }
}

Json VerifiedAsJson(const std::vector<VerifiedEstimator>& estimators) {
  Json json = Json::array();
  for (const VerifiedEstimator& e : estimators) {
    const PairedCounts& paired = e.against_first;
    json.push_back({e.failure.errors, e.refusal.errors, e.failure_or_refusal.errors, paired.both,
                    paired.first_only, paired.second_only, paired.neither});
  }
  return json;
}

// The counts of one estimator in a piece, and in how many of its trials the first estimator failed or
// refused.
VerifiedEstimator VerifiedFrom(const Json& json, std::int64_t n, std::int64_t num_bad_of_first) {
  RequireSize(json, 7);
  const auto number = [&](size_t i) { return CountFrom(json[i], n); };
  const VerifiedEstimator one{
      {}, {number(0), n}, {number(1), n}, {number(2), n}, {number(3), number(4), number(5), number(6)}};
  const PairedCounts& paired = one.against_first;
  RequirePossible(one.failure.errors + one.refusal.errors == one.failure_or_refusal.errors, "counts",
                  "failures and refusals are not their sum");
  RequirePossible(paired.n() == n, "counts", "the pairs are not the trials");
  RequirePossible(paired.both + paired.second_only == one.failure_or_refusal.errors, "counts",
                  "the pairs have other failures and refusals");
  RequirePossible(paired.both + paired.first_only == num_bad_of_first, "counts",
                  "the pairs have other failures and refusals of the first estimator");
  return one;
}

void AddVerified(const Json& json, std::int64_t num_trials, bool is_drawn,
                 std::vector<VerifiedEstimator>* estimators) {
  RequireSize(json, estimators->size());
  if (estimators->empty()) return;
  RequireSize(json[0], 7);
  std::int64_t n = 0;  // trials that could be simulated
  for (size_t i = 3; i < 7; ++i) n += CountFrom(json[0][i], num_trials - n);
  RequirePossible(n == num_trials || is_drawn, "counts", "the pairs are not the trials");
  const std::int64_t num_bad_of_first = CountFrom(json[0][2], n);
  for (size_t e = 0; e < estimators->size(); ++e) {
    const VerifiedEstimator one = VerifiedFrom(json[e], n, num_bad_of_first);
    VerifiedEstimator& sum = (*estimators)[e];
    for (const auto count :
         {&VerifiedEstimator::failure, &VerifiedEstimator::refusal, &VerifiedEstimator::failure_or_refusal}) {
      (sum.*count).n += n;
      (sum.*count).errors += (one.*count).errors;
    }
    sum.against_first.Merge(one.against_first);
  }
}

constexpr std::array<std::optional<double> TrialEntropies::*, 4> kEntropies = {
    &TrialEntropies::good_sample, &TrialEntropies::bad_sample, &TrialEntropies::good_winner,
    &TrialEntropies::bad_winner};

Json EntropiesAsJson(const EntropiesOfTrials& entropies) {
  Json json = Json::array();
  for (const std::vector<TrialEntropies>& trials : entropies) {
    Json& of_estimator = json.emplace_back(Json::array());
    for (const TrialEntropies& trial : trials) {
      Json& numbers = of_estimator.emplace_back(Json::array());
      for (const auto entropy : kEntropies)
        numbers.push_back(trial.*entropy ? NumberAsJson(*(trial.*entropy)) : Json());
    }
  }
  return json;
}

// Writes the entropies of a piece to trial `first` and those after it.
void SetEntropies(const Json& json, size_t first, size_t num_trials, EntropiesOfTrials* entropies) {
  RequireSize(json, entropies->size());
  for (size_t e = 0; e < json.size(); ++e) {
    RequireSize(json[e], num_trials);
    for (size_t trial = 0; trial < num_trials; ++trial) {
      RequireSize(json[e][trial], kEntropies.size());
      for (size_t k = 0; k < kEntropies.size(); ++k) {
        const Json& number = json[e][trial][k];
        if (!number.is_null()) (*entropies)[e][first + trial].*kEntropies[k] = NumberFrom(number);
      }
      const TrialEntropies& one = (*entropies)[e][first + trial];
      RequirePossible(!(one.good_winner && one.bad_winner), "counts", "a trial has two winners");
    }
  }
}

std::string ComputeBlock(const StudyPlan& plan, const SettingPlan& settings, std::optional<size_t> tuned,
                         const ItemPlace& place) {
  const StudyPlan one = OneCondition(plan, FindConditionNumber(plan, place));
  const TrialRange trials = FindItemTrials(plan, place);
  const Kind kind = FindKind(plan, place);
  if (kind == Kind::kEntropies) return EntropiesAsJson(MeasureEntropies(one, trials)).dump();
  if (kind == Kind::kPlainCalls) {
    return VerifiedAsJson(VerifyEstimators(PlanWithTuned(one, settings, tuned.value()), trials)).dump();
  }
  return CountsAsJson(CountOutcomes(one, settings, trials).front()).dump();
}

std::int64_t CountTrialsIn(const StudyPlan& plan, const ItemPlace& place) {
  const TrialRange trials = FindItemTrials(plan, place);
  return trials.end - trials.first;
}

// The choice of the tuning with another seed: the number of a setting, or null.
std::string ComputeRepetition(const StudyPlan& plan, const SettingPlan& settings, size_t number) {
  StudyPlan fresh = plan;
  fresh.study.seed += number + 1;
  const auto count = [&](TrialRange range) { return CountOutcomes(fresh, settings, range); };
  const Choice choice = ChooseFrom(fresh, settings, {count, {}});
  return (choice.setting ? Json(*choice.setting) : Json()).dump();
}

void AddRepetition(const Json& json, const Tuning& tuning, Repetitions* repetitions) {
  ++repetitions->num_done;
  if (json.is_null()) {
    ++repetitions->num_without_choice;
    return;
  }
  const auto chosen = static_cast<size_t>(CountFrom(json, std::ssize(repetitions->num_chosen) - 1));
  ++repetitions->num_chosen[chosen];
  const Verdict verdict = DecideSetting(tuning, repetitions->reference[chosen]);
  repetitions->num_violated += verdict == Verdict::kDoesNotHold;
  repetitions->num_undecided += verdict == Verdict::kUndecided;
}

}  // namespace

TuningWork PlanTuningWork(const StudyPlan& plan) {
  CheckTrialsSuffice(*plan.study.tuning, plan.conditions.size());
  return PlanWork(plan, "tuning", kKinds.size(), kKinds.size() - 1);
}

TuningWork PlanTransferWork(const StudyPlan& plan) { return PlanWork(plan, "transfer", 3, 3); }

void GetTuningResults(const StudyPlan& plan, const SettingPlan& settings, const TuningWork& work,
                      Unreached unreached, Runner* runner) {
  const size_t num_groups = work.items.groups.size();
  std::optional<size_t> tuned;
  const auto get = [&](size_t first, size_t end) {
    runner->Get(ListItems(work.items, {}, first, end),
                [&](const ItemPlace& place) { return ComputeBlock(plan, settings, tuned, place); });
  };
  // The parts must have the whole first round, so that every shard that lacks some of it is named.
  if (runner->ReadsParts() || work.num_first == num_groups) get(0, work.num_first);
  if (work.num_first == num_groups) return;
  get(0, work.num_choosing);
  tuned = ChooseFrom(plan, settings, CountsIn(plan, settings, work, runner->results())).setting;
  if (tuned || unreached == Unreached::kVerifyAll) get(work.num_choosing, work.num_first);
  if (tuned) get(work.num_first, num_groups);
}

MissingItems GetTuningShard(const StudyPlan& plan, const SettingPlan& settings, const TuningWork& work,
                            const WorkResults& merged, Runner* runner) {
  const size_t num_groups = work.items.groups.size();
  std::optional<size_t> tuned;
  const auto get = [&](size_t first, size_t end) {
    runner->Get(ListItems(work.items, runner->shard(), first, end),
                [&](const ItemPlace& place) { return ComputeBlock(plan, settings, tuned, place); });
  };
  get(0, work.num_first);
  if (work.num_first == num_groups) return {};
  const MissingItems missing = FindMissingIn(work.items, merged, 0, work.num_first);
  if (missing.num_items > 0) return missing;
  tuned = ChooseFrom(plan, settings, CountsIn(plan, settings, work, merged)).setting;
  if (tuned) get(work.num_first, num_groups);
  return {};
}

TuningSource CountsIn(const StudyPlan& plan, const SettingPlan& settings, const TuningWork& work,
                      const WorkResults& results) {
  const auto count = [&](TrialRange range) {
    Kind kind = Kind::kExplore;
    while (FindTrialRange(plan, kind).first != range.first)
      kind = static_cast<Kind>(static_cast<size_t>(kind) + 1);
    const size_t first = FirstGroup(plan, kind), num_conditions = plan.conditions.size();
    SettingCounts counts(num_conditions, std::vector<SettingCount>(settings.settings.size()));
    ReadResults(work.items, results, first, first + num_conditions,
                [&](const ItemPlace& place, const std::string& json) {
                  AddCounts(ParsePiece(json), CountTrialsIn(plan, place), plan.study.population.has_value(),
                            &counts[place.group - first]);
                });
    return counts;
  };
  const auto verify = [&](size_t tuned) {
    std::vector<VerifiedEstimator> estimators;
    for (const EstimatorSpec& spec : PlanWithTuned(plan, settings, tuned).study.estimators)
      estimators.push_back({spec, {}, {}, {}, {}});
    const size_t first = FirstGroup(plan, Kind::kPlainCalls);
    ReadResults(work.items, results, first, first + plan.conditions.size(),
                [&](const ItemPlace& place, const std::string& json) {
                  AddVerified(ParsePiece(json), CountTrialsIn(plan, place), plan.study.population.has_value(),
                              &estimators);
                });
    return estimators;
  };
  return {count, verify};
}

EntropiesOfTrials EntropiesIn(const StudyPlan& plan, const TuningWork& work, const WorkResults& results) {
  const TrialRange range = FindTrialRange(plan, Kind::kEntropies);
  const size_t num_trials = range.end - range.first, first = FirstGroup(plan, Kind::kEntropies);
  EntropiesOfTrials entropies(plan.estimators.size(),
                              std::vector<TrialEntropies>(num_trials * plan.conditions.size()));
  ReadResults(work.items, results, first, first + plan.conditions.size(),
              [&](const ItemPlace& place, const std::string& json) {
                const size_t begin = (place.group - first) * num_trials + place.item * kTrialsOfItem;
                SetEntropies(ParsePiece(json), begin, static_cast<size_t>(CountTrialsIn(plan, place)),
                             &entropies);
              });
  return entropies;
}

// The groups that a tuning has for its verification hold the reference; the groups before them are empty. One
// further group holds the tunings.
WorkPlan PlanRepetitions(const StudyPlan& plan, int n) {
  const Tuning& tuning = *plan.study.tuning;
  CheckTrialsSuffice(tuning, plan.conditions.size());
  if (tuning.target == TuneTarget::kRisk)
    throw InputError("--repeat: target: risk: the least risk is no limit that a repetition could violate");
  WorkPlan work = PlanWork(plan, "repeated tuning", 3, 3).items;
  for (size_t group = 0; group < FirstGroup(plan, Kind::kVerify); ++group) work.groups[group].num_items = 0;
  work.groups.push_back({"repetitions", static_cast<size_t>(n)});
  work.item_name = "piece";
  return work;
}

Repetitions RepeatTuning(const StudyPlan& plan, const SettingPlan& settings, Runner* runner) {
  const Tuning& tuning = *plan.study.tuning;
  const WorkPlan& work = runner->plan();
  const size_t tunings = work.groups.size() - 1;
  const auto compute = [&](const ItemPlace& place) {
    return place.group == tunings ? ComputeRepetition(plan, settings, place.item)
                                  : ComputeBlock(plan, settings, {}, place);
  };
  const auto num_trials = [&](const ItemPlace& place) {
    return place.group == tunings
               ? (tuning.explore + std::int64_t{tuning.calibrate}) * std::ssize(plan.conditions)
               : CountTrialsIn(plan, place);
  };
  runner->Get(ListItems(work, {}), compute, {"trials", num_trials});
  Repetitions repetitions;
  const TuningSource reference = CountsIn(plan, settings, {work, 0, 0}, runner->results());
  std::vector<std::uint32_t> conditions(plan.conditions.size());
  std::iota(conditions.begin(), conditions.end(), 0u);
  repetitions.reference = SumOver(reference.count(TuningTrials(tuning).verify), conditions);
  repetitions.num_chosen.resize(settings.settings.size());
  ReadResults(work, runner->results(), tunings, tunings + 1, [&](const ItemPlace&, const std::string& json) {
    AddRepetition(ParsePiece(json), tuning, &repetitions);
  });
  return repetitions;
}

}  // namespace rcme
