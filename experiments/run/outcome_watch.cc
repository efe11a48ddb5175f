#include "experiments/run/outcome_watch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "experiments/core/text/message.h"
#include "experiments/core/text/program_name.h"
#include "experiments/core/text/shell_word.h"
#include "experiments/study/command_permission.h"

namespace rcme {
namespace {

constexpr size_t kMostReasons = 5;

// Whether an answer from outside the program is missing; the next call may give it.
bool IsMissingAnswer(MotionStatus status) {
  return status == MotionStatus::kNoAnswer || status == MotionStatus::kTimedOut ||
         status == MotionStatus::kUnreadableAnswer;
}

// "; rcme replay run.sqlite --condition 0 --trial 3 shows why".
std::string FormatReplay(const StudyPlan& plan, const std::string& run_file,
                         const std::pair<std::uint32_t, std::uint32_t>& trial) {
  // A function of Python is not there for the command.
  if (std::ranges::any_of(plan.study.estimators,
                          [](const EstimatorSpec& spec) { return spec.name == "python"; }))
    return fmt::format("; rcme.replay({}, {}, {}, estimators) shows why", nlohmann::json(run_file).dump(),
                       trial.first, trial.second);
  const bool has_command = std::ranges::any_of(
      plan.study.estimators, [](const EstimatorSpec& spec) { return !FindCommand(spec).empty(); });
  return fmt::format("; {} replay {} --condition {} --trial {}{} shows why", CommandName(),
                     QuoteForShell(run_file), trial.first, trial.second,
                     has_command ? " --allow-process" : "");
}

}  // namespace

void OutcomeWatch::Add(const TrialResult& result) {
  const std::lock_guard lock(mutex_);
  no_answers_.resize(result.records.size());
  if (!result.why_not_simulated.empty()) {
    ++num_not_simulated_;
    ++reasons_[result.why_not_simulated.substr(0, result.why_not_simulated.find(':'))];
    NotSimulatedTrials& of_condition = not_simulated_[result.problem.condition];
    const std::uint32_t trial = result.problem.trial;
    if (of_condition.count == 0 || trial < of_condition.first)
      of_condition = {of_condition.count, trial, result.why_not_simulated};
    ++of_condition.count;
    return;
  }
  if (!IsCounted(result.records.front())) return;
  ++num_simulated_;
  for (size_t e = 0; e < result.records.size(); ++e) {
    const MotionStatus status = result.records[e].status;
    if (status == MotionStatus::kOk) continue;
    const std::pair place(result.problem.condition, result.problem.trial);
    const auto [known, is_new] = no_answers_[e].try_emplace(status, TrialsWith{0, place});
    ++known->second.count;
    known->second.first = std::min(known->second.first, place);
  }
}

void OutcomeWatch::Warn(const StudyPlan& plan, const std::string& run_file) const {
  const std::lock_guard lock(mutex_);
  WarnOfNoAnswers(plan, run_file);
  WarnOfNotSimulated(plan);
}

OutcomeWatch::TrialsWith OutcomeWatch::SumTrials(size_t estimator, bool (*is_counted)(MotionStatus),
                                                 std::vector<std::string>* counts,
                                                 std::vector<std::string>* names) const {
  TrialsWith sum;
  for (const auto& [status, trials] : no_answers_[estimator]) {
    if (!is_counted(status)) continue;
    sum.first = sum.count == 0 ? trials.first : std::min(sum.first, trials.first);
    sum.count += trials.count;
    counts->push_back(fmt::format("{} {}", StatusName(status), trials.count));
    names->push_back(StatusName(status));
  }
  return sum;
}

void OutcomeWatch::WarnOfNoAnswers(const StudyPlan& plan, const std::string& run_file) const {
  if (num_simulated_ == 0) return;
  for (size_t e = 0; e < no_answers_.size(); ++e) {
    const EstimatorSpec& spec = plan.study.estimators.at(e);
    std::vector<std::string> counts, names, missing_counts, missing_names;
    const TrialsWith all = SumTrials(
        e, [](MotionStatus) { return true; }, &counts, &names);
    const TrialsWith missing = SumTrials(e, IsMissingAnswer, &missing_counts, &missing_names);
    const bool has_none = all.count == num_simulated_;
    if (!has_none && missing.count == 0) continue;
    const bool is_invalid_somewhere = no_answers_[e].contains(MotionStatus::kInvalidMotion) ||
                                      no_answers_[e].contains(MotionStatus::kInvalidCovariance);
    std::string text =
        has_none ? fmt::format("{} {} of the {} trials run now ({})", spec.label,
                               is_invalid_somewhere ? "gave no valid answer in any" : "refused every one",
                               num_simulated_, fmt::join(counts, ", "))
                 : fmt::format("{} gave no answer in {} of the {} trials run now ({})", spec.label,
                               missing.count, num_simulated_, fmt::join(missing_counts, ", "));
    if (!run_file.empty()) text += FormatReplay(plan, run_file, has_none ? all.first : missing.first);
    if (!run_file.empty() && missing.count > 0 && !FindCommand(spec).empty())
      text += fmt::format("; rcme run with --retry {} asks again", fmt::join(missing_names, ","));
    PrintMessage("warning: {}\n", text);
  }
}

// "parallax_deg 200, num_boxes 12"
std::string OutcomeWatch::ListReasons() const {
  std::vector<std::pair<std::string, std::int64_t>> reasons(reasons_.begin(), reasons_.end());
  std::ranges::stable_sort(reasons, std::ranges::greater(), [](const auto& one) { return one.second; });
  std::vector<std::string> texts;
  std::int64_t num_others = 0;
  for (const auto& [reason, count] : reasons) {
    if (texts.size() < kMostReasons)
      texts.push_back(fmt::format("{} {}", reason, count));
    else
      num_others += count;
  }
  if (num_others > 0) texts.push_back(fmt::format("other reasons {}", num_others));
  return fmt::format("{}", fmt::join(texts, ", "));
}

void OutcomeWatch::WarnOfNotSimulated(const StudyPlan& plan) const {
  if (not_simulated_.empty()) return;
  size_t num_whole = 0;
  for (const auto& [condition, trials] : not_simulated_)
    num_whole += trials.count == plan.conditions.at(condition).num_trials;
  const auto& [condition, example] = *not_simulated_.begin();
  PrintMessage(
      "warning: {} of the {} trials run now could not be simulated: in {} of {} conditions, in {} of them "
      "all. Trials by reason: {}. They are kept as {}, and no other rate counts them. Condition {}, trial "
      "{}: {}\n",
      num_not_simulated_, num_not_simulated_ + num_simulated_, not_simulated_.size(), plan.conditions.size(),
      num_whole, ListReasons(), StatusName(MotionStatus::kNotSimulated), condition, example.first,
      example.why);
}

}  // namespace rcme
