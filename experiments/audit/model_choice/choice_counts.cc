#include "experiments/audit/model_choice/choice_counts.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "experiments/trial/simulate_draw.h"
#include "experiments/trial/trial_range.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

std::vector<ModelChoiceOptions> EveryCriterion() {
  std::vector<ModelChoiceOptions> all;
  for (const auto& [name, criterion] : CriterionNames()) all.push_back({.criterion = criterion});
  return all;
}

size_t FindAnswer(const ModelChoice& choice) {
  return choice.status == MotionStatus::kOk ? static_cast<size_t>(choice.verdict) : kNumAnswers - 1;
}

TrueKind KindOfTrial(const Scene& scene, const TrialData& data, const StreamName& name) {
  std::vector<Eigen::Vector3d> points;  // of the right matches
  for (size_t i = 0; i < data.scene_point.size(); ++i) {
    if (data.truth.is_inlier_true[i]) points.push_back(scene.points_in_cam1[data.scene_point[i]]);
  }
  RandomStream rng = StreamFor(name, StreamPurpose::kTrueKind);
  const ModelChoiceOptions options;
  const KindMeasures measures =
      MeasureKind(scene, points, data.problem.sigma_px, options.parallax_significance_level, rng);
  return ClassifyKind(measures, options.least_parallax_share);
}

void CheckCanBeScored(const StudyPlan& plan) {
  if (plan.study.repeats_per_scene > 1) {
    throw InputError(
        "model-choice: repeats_per_scene: trials that share a scene are not independent; set it to 1");
  }
  if (plan.study.common_scenes) {
    throw InputError(
        "model-choice: common_scenes: conditions that share scenes are not independent; set it to false");
  }
  for (const Condition& condition : plan.conditions) {
    if (condition.source->SharedScene()) {
      throw InputError(
          "model-choice: scene: match_files: real pairs have no known exact scene; use a simulated one");
    }
  }
}

std::vector<size_t> FindFactorPlaces(const std::vector<std::string>& by,
                                     const std::vector<std::string>& factors) {
  std::vector<size_t> places;
  for (const std::string& name : by) {
    const auto found = std::ranges::find(factors, name);
    if (found == factors.end()) {
      throw InputError(fmt::format("--by {}: the study has no such factor; its factors: {}", name,
                                   factors.empty() ? "none" : fmt::format("{}", fmt::join(factors, ", "))));
    }
    places.push_back(static_cast<size_t>(found - factors.begin()));
  }
  return places;
}

ChoiceGroup& GroupWith(const std::vector<std::string>& levels, std::vector<ChoiceGroup>* groups) {
  const auto found = std::ranges::find(*groups, levels, &ChoiceGroup::levels);
  if (found != groups->end()) return *found;
  groups->push_back({levels, std::vector<ConfusionMatrix>(CriterionNames().size())});
  return groups->back();
}

// A matrix per criterion, in the order of CriterionNames().
using Matrices = std::vector<ConfusionMatrix>;

constexpr std::uint32_t kTrialsOfChoiceItem = 10;

TrialRange FindChoiceTrials(const StudyPlan& plan, const ItemPlace& place) {
  const auto first = static_cast<std::uint32_t>(place.item) * kTrialsOfChoiceItem;
  return {first, std::min(first + kTrialsOfChoiceItem, static_cast<std::uint32_t>(plan.study.trials))};
}

Matrices CountTrials(const StudyPlan& plan, const Condition& condition, TrialRange trials) {
  const std::vector<ModelChoiceOptions> criteria = EveryCriterion();
  Matrices matrices(criteria.size(), ConfusionMatrix{});
  for (std::uint32_t trial = trials.first; trial < trials.end; ++trial) {
    const StreamName name = NameOfTrial(plan, condition, trial);
    const auto simulated = SimulateDraw(plan.study, [&] { return condition.source->Make(name); });
    if (!simulated.made) continue;
    const TrialData& data = *simulated.made;
    if (data.weight != 1.0)
      throw InputError("model-choice: tilted_to: weighted trials have no plain rates; leave it out");
    const auto kind = static_cast<size_t>(KindOfTrial(condition.source->FindScene(name).value(), data, name));
    RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
    const std::vector<ModelChoice> choices = ChooseModels(data.problem, criteria, rng);
    for (size_t c = 0; c < choices.size(); ++c) ++matrices[c][kind][FindAnswer(choices[c])];
  }
  return matrices;
}

// Adds the matrices of this many trials, or of those that could be simulated. Counts that no trials can have
// given are damage, even if the checksums are right.
void AddMatrices(const nlohmann::ordered_json& json, std::int64_t num_trials, bool is_drawn, Matrices* sum) {
  RequireSize(json, sum->size());
  std::int64_t num_of_first = 0;
  for (size_t c = 0; c < sum->size(); ++c) {
    RequireSize(json[c], kTrueKinds.size());
    std::int64_t n = 0;
    for (size_t kind = 0; kind < kTrueKinds.size(); ++kind) {
      RequireSize(json[c][kind], kNumAnswers);
      for (size_t answer = 0; answer < kNumAnswers; ++answer) {
        const std::int64_t count = CountFrom(json[c][kind][answer], num_trials);
        n += count;
        (*sum)[c][kind][answer] += count;
      }
    }
    if (c == 0) num_of_first = n;
    if (n > num_trials || n != num_of_first || (n < num_trials && !is_drawn))
      throw std::invalid_argument(fmt::format("it counts {} trials, not {}", n, num_trials));
  }
}

}  // namespace

const std::string& AnswerName(size_t answer) {
  static const std::string none = "no_verdict";
  return answer < kSceneVerdicts.size() ? Name(kSceneVerdicts[answer]) : none;
}

WorkPlan PlanChoices(const StudyPlan& plan) {
  CheckCanBeScored(plan);
  WorkPlan work{"model choice", "block", fmt::format("trials: {}\n{}", plan.study.trials, plan.identity), {}};
  const auto num_blocks =
      (static_cast<size_t>(plan.study.trials) + kTrialsOfChoiceItem - 1) / kTrialsOfChoiceItem;
  for (const Condition& condition : plan.conditions)
    work.groups.push_back({fmt::format("condition {}", condition.index), num_blocks});
  return work;
}

ChoiceCounts CountChoices(const StudyPlan& plan, const std::vector<std::string>& by, Runner* runner) {
  ChoiceCounts counts{by, {}};
  const std::vector<size_t> places = FindFactorPlaces(by, plan.factor_names);
  runner->Get(ListItems(runner->plan(), {}), [&](const ItemPlace& place) {
    const Condition& condition = plan.conditions[place.group];
    return nlohmann::ordered_json(CountTrials(plan, condition, FindChoiceTrials(plan, place))).dump();
  });
  for (size_t c = 0; c < plan.conditions.size(); ++c) {
    std::vector<std::string> levels;
    for (const size_t f : places) levels.push_back(plan.conditions[c].levels[f]);
    ChoiceGroup& group = GroupWith(levels, &counts.groups);
    ReadResults(runner->plan(), runner->results(), c, c + 1,
                [&](const ItemPlace& place, const std::string& json) {
                  const TrialRange trials = FindChoiceTrials(plan, place);
                  AddMatrices(ParsePiece(json), trials.end - trials.first, plan.study.population.has_value(),
                              &group.matrices);
                });
  }
  return counts;
}

}  // namespace rcme
