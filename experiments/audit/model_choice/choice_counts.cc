#include "experiments/audit/model_choice/choice_counts.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "experiments/run/for_each_trial.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

std::vector<ModelChoiceOptions> EveryCriterion() {
  std::vector<ModelChoiceOptions> all;
  for (const auto& [name, criterion] : CriterionNames()) all.push_back({.criterion = criterion});
  return all;
}

size_t AnswerOf(const ModelChoice& choice) {
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
  return KindOf(measures, options.least_parallax_share);
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
          "model-choice: scene: match_files: of real pairs nobody knows the exact scene; take a simulated "
          "one");
    }
  }
}

std::vector<size_t> PlacesOf(const std::vector<std::string>& by, const std::vector<std::string>& factors) {
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

// Counters of a matrix that several threads add to.
using SharedMatrix = std::array<std::array<std::atomic<std::int64_t>, kNumAnswers>, kTrueKinds.size()>;

void Add(const SharedMatrix& from, ConfusionMatrix* to) {
  for (size_t kind = 0; kind < kTrueKinds.size(); ++kind) {
    for (size_t answer = 0; answer < kNumAnswers; ++answer) (*to)[kind][answer] += from[kind][answer];
  }
}

}  // namespace

const std::string& AnswerName(size_t answer) {
  static const std::string none = "no_verdict";
  return answer < kSceneVerdicts.size() ? Name(kSceneVerdicts[answer]) : none;
}

ChoiceCounts CountChoices(const StudyPlan& plan, const std::vector<std::string>& by, int num_threads) {
  CheckCanBeScored(plan);
  ChoiceCounts counts{by, {}};
  const std::vector<size_t> places = PlacesOf(by, plan.factor_names);
  const std::vector<ModelChoiceOptions> criteria = EveryCriterion();
  std::vector<SharedMatrix> shared(plan.conditions.size() * criteria.size());  // all zero
  const TrialRange trials{0, static_cast<std::uint32_t>(plan.study.trials)};
  const std::vector<TrialsOfCondition> work = TrialsOfEach(plan, trials);
  Progress progress("trials", NumTrials(work));
  ForEachTrial(work, num_threads, &progress,
               [&](const Condition& condition, std::uint32_t trial, std::int64_t index) {
                 const StreamName name = NameOfTrial(plan, condition, trial);
                 const TrialData data = condition.source->Make(name);
                 if (data.weight != 1.0) {
                   throw InputError("model-choice: tilted_to: trials with weights have no plain rates");
                 }
                 const auto kind =
                     static_cast<size_t>(KindOfTrial(condition.source->SceneOf(name).value(), data, name));
                 RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
                 const std::vector<ModelChoice> choices = ChooseModels(data.problem, criteria, rng);
                 const auto place = static_cast<size_t>(index / trials.end);
                 for (size_t c = 0; c < choices.size(); ++c) {
                   ++shared[place * criteria.size() + c][kind][AnswerOf(choices[c])];
                 }
               });
  for (size_t place = 0; place < plan.conditions.size(); ++place) {
    std::vector<std::string> levels;
    for (const size_t f : places) levels.push_back(plan.conditions[place].levels[f]);
    ChoiceGroup& group = GroupWith(levels, &counts.groups);
    for (size_t c = 0; c < criteria.size(); ++c) Add(shared[place * criteria.size() + c], &group.matrices[c]);
  }
  return counts;
}

}  // namespace rcme
