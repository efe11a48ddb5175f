#include "experiments/run/outcome_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "experiments/core/text/message.h"

namespace rcme {
namespace {

constexpr size_t kMostReasons = 5;

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
    if (const MotionStatus status = result.records[e].status; status != MotionStatus::kOk)
      ++no_answers_[e][status];
  }
}

void OutcomeWatch::Warn(const StudyPlan& plan) const {
  const std::lock_guard lock(mutex_);
  WarnOfNoAnswers(plan);
  WarnOfNotSimulated(plan);
}

void OutcomeWatch::WarnOfNoAnswers(const StudyPlan& plan) const {
  if (num_simulated_ == 0) return;
  for (size_t e = 0; e < no_answers_.size(); ++e) {
    std::int64_t num_unanswered = 0;
    bool is_invalid_somewhere = false;
    std::vector<std::string> counts;
    for (const auto& [status, count] : no_answers_[e]) {
      num_unanswered += count;
      is_invalid_somewhere |=
          status == MotionStatus::kInvalidMotion || status == MotionStatus::kInvalidCovariance;
      counts.push_back(fmt::format("{} {}", StatusName(status), count));
    }
    if (num_unanswered < num_simulated_) continue;
    PrintMessage(
        "warning: {} {} of the {} trials run now ({}); rcme replay FILE --condition 0 --trial 0 shows why\n",
        plan.study.estimators.at(e).label,
        is_invalid_somewhere ? "gave no valid answer in any" : "refused every one", num_simulated_,
        fmt::join(counts, ", "));
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
