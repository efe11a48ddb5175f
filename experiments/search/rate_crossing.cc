#include "experiments/search/rate_crossing.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "experiments/core/work/for_each_index.h"
#include "experiments/core/work/progress.h"
#include "experiments/study/study_file.h"
#include "experiments/trial/trial.h"
#include "parameters/input_error.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

// Converts the place of a level in [0, 1], with which the rate increases, to the setting.
class Scale {
 public:
  Scale(const CrossingQuestion& question, bool is_whole) : question_(question), is_whole_(is_whole) {}

  double SettingAt(double place) const {
    if (std::isinf(place)) return question_.is_falling ? -place : place;
    const double along = question_.is_falling ? 1.0 - place : place;
    return question_.is_logarithmic ? question_.from * std::pow(question_.to / question_.from, along)
                                    : question_.from + (question_.to - question_.from) * along;
  }
  std::string TextAt(double place) const {
    const double setting = SettingAt(place);
    return is_whole_ ? fmt::format("{:.0f}", setting) : fmt::format("{:.10g}", setting);
  }
  bool is_whole() const { return is_whole_; }
  // The place of the whole number that TextAt(place) names.
  double PlaceOfWhole(double place) const {
    const double setting = std::round(SettingAt(place));
    const double along = question_.is_logarithmic
                             ? std::log(setting / question_.from) / std::log(question_.to / question_.from)
                             : (setting - question_.from) / (question_.to - question_.from);
    return question_.is_falling ? 1.0 - along : along;
  }
  // The setting of a place, to the whole number that is run there.
  double RoundedSettingAt(double place) const {
    return is_whole_ ? std::round(SettingAt(place)) : SettingAt(place);
  }
  Interval SettingsIn(const Interval& places) const {
    const double a = RoundedSettingAt(places.lower), b = RoundedSettingAt(places.upper);
    return {std::min(a, b), std::max(a, b)};
  }
  std::vector<EventsAtLevel> SettingsOfEvents(std::vector<EventsAtLevel> events) const {
    for (EventsAtLevel& one : events) one.level = RoundedSettingAt(one.level);
    return events;
  }

 private:
  const CrossingQuestion& question_;
  bool is_whole_;
};

Study MakeStudyAt(Study study, const CrossingQuestion& question, const std::string& level) {
  Override(&study, question.setting, level);
  study.common_scenes = false;
  return study;
}

// The conditions, which are the same for every value of the setting.
struct PlannedConditions {
  StudyPlan plan;
  bool is_drawn_by_level = true;  // whether the setting is one of the data, in the names of their streams
};

// Whole plans are made only here, in the middle and at both ends, so that a value that is not allowed is
// reported before any trial.
PlannedConditions PlanConditions(const Study& study, const CrossingQuestion& question, const Scale& scale) {
  const auto plan_at = [&](double place) {
    return MakePlan(MakeStudyAt(study, question, scale.TextAt(place)));
  };
  PlannedConditions planned{plan_at(0.5)};
  const std::vector<Condition>& conditions = planned.plan.conditions;
  std::vector<std::vector<Condition>> at_ends;
  for (const double end : {0.0, 1.0}) {
    at_ends.push_back(plan_at(end).conditions);
    if (!std::ranges::equal(conditions, at_ends.back(), {}, &Condition::levels, &Condition::levels))
      throw InputError(
          fmt::format("solve: conditions: `given` leaves other draws at {} = {} than at {}; give "
                      "other --from and --to",
                      question.setting, scale.TextAt(end), scale.TextAt(0.5)));
  }
  for (size_t c = 0; c < conditions.size(); ++c)
    planned.is_drawn_by_level &= at_ends[0][c].stream_key != at_ends[1][c].stream_key;
  return planned;
}

// Whether the setting takes only whole numbers; then the middle between two of them is refused.
bool IsWhole(const Study& study, const CrossingQuestion& question) {
  if (question.from != std::round(question.from) || question.to != std::round(question.to)) return false;
  Study between = study;
  try {
    Override(&between, question.setting, fmt::format("{}", question.from + 0.5));
    MakePlan(between, PlanEstimators::kNotMade);
    return false;
  } catch (const InputError&) {
    Override(&between, question.setting, fmt::format("{}", question.from));
    MakePlan(between, PlanEstimators::kNotMade);  // throws if something else is wrong
    return true;
  }
}

void CheckTrial(const TrialResult& result, const CrossingQuestion& question) {
  if (result.problem.weight != 1.0)
    throw InputError(
        "solve: the trials of this study are weighted (tilted_to), which its intervals do not allow");
  if (question.event.needs_truth && !IsScored(result.records.front()))
    throw InputError("solve: the truth of this study's pairs is not known");
}

// Counts the events of one estimator in one condition.
class Asker {
 public:
  Asker(const Study& study, const CrossingQuestion& question, const Scale& scale,
        const std::vector<std::string>& condition, bool is_drawn_by_level, size_t estimator, int num_threads,
        KeptSteps* steps, std::optional<Progress>* progress, std::int64_t total, std::int64_t* num_done)
      : study_(study),
        question_(question),
        scale_(scale),
        condition_(condition),
        is_drawn_by_level_(is_drawn_by_level),
        num_threads_(num_threads),
        steps_(steps),
        progress_(progress),
        total_(total),
        num_done_(num_done) {
    study_.estimators = {study.estimators[estimator]};
  }

  std::int64_t num_refused() const { return num_refused_; }

  // Returns the events among those of the trials that could be simulated.
  EventsAtLevel Ask(double place, std::int64_t num_trials) {
    const std::string level = scale_.TextAt(place);
    std::int64_t& next = levels_[level].next_trial;
    const StepForm<Events> form = {
        [](const Events& events) {
          return fmt::format("[{},{},{}]", events.num_events, events.num_trials, events.num_refused);
        },
        [&](const std::string& json) {
          const nlohmann::ordered_json counts = ParsePiece(json);
          RequireSize(counts, 3);
          const std::int64_t num_simulated = CountFrom(counts[1], num_trials),
                             num_events = CountFrom(counts[0], num_simulated);
          return Events{num_events, num_simulated, CountFrom(counts[2], num_simulated - num_events)};
        }};
    const Events events = TakeStep<Events>(
        steps_, [&] { return Count(level, next, num_trials); }, form);
    next += num_trials;
    *num_done_ += num_trials;
    num_refused_ += events.num_refused;
    return {place, events.num_events, events.num_trials};
  }

 private:
  struct Events {
    std::int64_t num_events = 0, num_trials = 0;
    std::int64_t num_refused = 0;  // refusals that are no events
  };

  // A setting that does not enter the names of the streams is added to them: otherwise all levels would have
  // the same trials, and the interval needs independent ones.
  StudyPlan MakePlanAt(const std::string& level) const {
    StudyPlan plan = MakeConditionPlan(MakeStudyAt(study_, question_, level), condition_);
    std::uint64_t& key = plan.conditions.front().stream_key;
    if (!is_drawn_by_level_) key = HashToStreamKey(fmt::format("{}\n{}={}", key, question_.setting, level));
    return plan;
  }

  // Counts the events in trials first, ..., first + num_trials - 1.
  Events Count(const std::string& level, std::int64_t first, std::int64_t num_trials) {
    if (!*progress_) progress_->emplace("trials", total_, *num_done_);
    std::optional<StudyPlan>& made = levels_[level].plan;
    if (!made) made = MakePlanAt(level);
    const StudyPlan& plan = *made;
    const Condition& condition = plan.conditions.front();
    std::atomic<std::int64_t> num_events = 0, num_simulated = 0, num_refused = 0;
    ForEachIndex(num_trials, num_threads_, [&](std::int64_t index) {
      const TrialResult result = RunTrialOfDraw(plan, condition, static_cast<std::uint32_t>(first + index));
      (*progress_)->Advance(1);
      if (!result.why_not_simulated.empty()) return;
      if (!IsCounted(result.records.front())) return;
      CheckTrial(result, question_);
      ++num_simulated;
      const bool has_happened = question_.event.has_happened(result.records.front(), plan.study.failure);
      num_events += has_happened;
      num_refused += !has_happened && HasRefused(result.records.front());
    });
    return {num_events, num_simulated, num_refused};
  }

  Study study_;
  const CrossingQuestion& question_;
  const Scale& scale_;
  std::vector<std::string> condition_;  // the levels of the condition
  bool is_drawn_by_level_;
  int num_threads_;
  KeptSteps* steps_;
  std::optional<Progress>* progress_;  // starts with the first trial whose result is not kept
  std::int64_t total_;
  std::int64_t* num_done_;
  std::int64_t num_refused_ = 0;
  struct Level {
    std::optional<StudyPlan> plan;  // of this condition only, made for its first trial
    std::int64_t next_trial = 0;
  };
  std::map<std::string, Level> levels_;
};

void RequireIndependentTrials(const StudyPlan& plan) {
  if (plan.study.repeats_per_scene > 1)
    throw InputError(
        "solve: repeats of a scene (repeats_per_scene) are not independent, as its intervals require");
  for (const Condition& condition : plan.conditions) {
    if (condition.source->SharedScene())
      throw InputError(
          "solve: scene: match_files: the pairs of a folder repeat, but its intervals require independent "
          "trials; give a simulated scene");
  }
}

}  // namespace

std::int64_t RateCrossing::num_trials() const {
  std::int64_t sum = 0;
  for (const std::vector<EventsAtLevel>* part : {&searched, &fresh}) {
    for (const EventsAtLevel& one : *part) sum += one.num_trials;
  }
  return sum;
}

Study KeepEstimatorsWithSetting(Study study, const CrossingQuestion& question) {
  std::vector<EstimatorSpec> kept;
  const std::string from = fmt::format("{}", question.from);
  for (const EstimatorSpec& spec : study.estimators) {
    Study alone = study;
    alone.estimators = {spec};
    try {
      Override(&alone, question.setting, from);
      kept.push_back(spec);
    } catch (const InputError&) {  // it has no such option
    }
  }
  if (kept.empty()) {
    try {
      Override(&study, question.setting, from);  // says what is wrong for all of them
    } catch (const InputError& error) {
      const std::string why = error.what();
      throw InputError("--over: " + why.substr(why.starts_with("--set: ") ? 7 : 0));
    }
  }
  study.estimators = kept;
  return study;
}

WorkPlan PlanCrossings(const Study& study, const CrossingQuestion& question) {
  const std::string identity = fmt::format(
      "{}\ncrossing with refusals: {} of {} in [{}, {}], logarithmic {}, falling {}, at {}, {} trials\n",
      MakePlan(study, PlanEstimators::kNotMade).identity, question.event.name, question.setting,
      question.from, question.to, question.is_logarithmic, question.is_falling, question.rate,
      question.num_trials);
  return {"solve", "step", identity, {}, true};
}

CrossingAnswer FindCrossings(const Study& study, const CrossingQuestion& question, int num_threads,
                             KeptSteps* steps) {
  const Scale scale(question, IsWhole(study, question));
  const auto [plan, is_drawn_by_level] = PlanConditions(study, question, scale);
  RequireIndependentTrials(plan);
  CrossingAnswer answer{plan.factor_names, {}};
  std::optional<Progress> progress;
  std::int64_t num_done = 0;
  const auto total =
      static_cast<std::int64_t>(plan.conditions.size() * study.estimators.size()) * question.num_trials;
  for (const Condition& condition : plan.conditions) {
    for (size_t e = 0; e < study.estimators.size(); ++e) {
      Asker asker(study, question, scale, condition.levels, is_drawn_by_level, e, num_threads, steps,
                  &progress, total, &num_done);
      PlaceOfRun place_of_run;
      if (scale.is_whole()) place_of_run = [&](double place) { return scale.PlaceOfWhole(place); };
      Crossing found =
          FindCrossing([&](double place, std::int64_t number) { return asker.Ask(place, number); },
                       question.rate, question.num_trials, 0.95, place_of_run);
      answer.crossings.push_back({condition.levels, study.estimators[e].label,
                                  scale.RoundedSettingAt(found.estimate), scale.SettingsIn(found.interval),
                                  scale.SettingsIn(found.logistic_interval),
                                  scale.SettingsOfEvents(std::move(found.searched)),
                                  scale.SettingsOfEvents(std::move(found.fresh)), asker.num_refused()});
    }
  }
  return answer;
}

}  // namespace rcme
