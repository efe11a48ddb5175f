#include "experiments/statistics/readable_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "experiments/core/files/first_difference.h"
#include "experiments/study/command_files.h"
#include "experiments/trial/trial_columns.h"
#include "parameters/input_error.h"
#include "parameters/text_lines.h"

namespace rcme {
namespace {

struct WholeTrial {
  ProblemRecord problem;
  std::vector<TrialRecord> records;
};

std::vector<double> ListNumbers(const ProblemRecord& problem, const TrialRecord& record) {
  std::vector<double> numbers = {static_cast<double>(record.num_matches)};
  VisitColumns(problem, [&](const StoredColumn&, const auto& field) {
    numbers.push_back(static_cast<double>(field));
  });
  return numbers;
}

// Equal except for last digits, which may depend on the instruction set.
bool AreEqual(double a, double b) {
  if (std::isnan(a) || std::isnan(b)) return std::isnan(a) && std::isnan(b);
  return a == b || std::abs(a - b) <= 1e-4 * std::max({1.0, std::abs(a), std::abs(b)});
}

void RequireSameProblem(const WholeTrial& first, const WholeTrial& second) {
  if (!WasSimulated(first.records.front()) && !WasSimulated(second.records.front())) return;
  if (std::ranges::equal(ListNumbers(first.problem, first.records.front()),
                         ListNumbers(second.problem, second.records.front()), AreEqual))
    return;
  throw InputError(fmt::format(
      "condition {}, trial {}: the two result files hold different problems, made by simulators that differ; "
      "run both versions with one of them",
      first.problem.condition, first.problem.trial));
}

std::vector<WholeTrial> ReadTrials(const ResultStore& store, std::uint32_t condition) {
  std::vector<WholeTrial> trials;
  store.ForEachTrial(
      [&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
        trials.push_back({problem, records});
      },
      condition);
  return trials;
}

void AppendChosen(const std::vector<TrialRecord>& records, const std::vector<size_t>& chosen,
                  std::vector<TrialRecord>* joined) {
  for (const size_t e : chosen) {
    joined->push_back(records[e]);
    joined->back().estimator = static_cast<std::uint32_t>(joined->size() - 1);
  }
}

void AppendChosen(const RunDescription& run, const std::vector<size_t>& chosen,
                  std::vector<DescribedEstimator>* joined) {
  for (const size_t e : chosen) joined->push_back(run.estimators.at(e));
}

std::string JoinNames(const std::string& first, const std::string& second) {
  return first == second || second.empty() ? first : first.empty() ? second : first + ", " + second;
}

RunDescription JoinDescriptions(const RunDescription& first, const std::vector<size_t>& of_first,
                                const RunDescription& second, const std::vector<size_t>& of_second) {
  RunDescription joined = second;
  joined.estimators.clear();
  AppendChosen(first, of_first, &joined.estimators);
  AppendChosen(second, of_second, &joined.estimators);
  for (size_t i = 0; i < of_first.size(); ++i) {
    for (size_t k = of_first.size(); k < joined.estimators.size(); ++k)
      TellApart(&joined.estimators[i].label, &joined.estimators[k].label);
  }
  for (size_t c = 0; c < joined.conditions.size(); ++c) {
    std::int64_t& num_trials = joined.conditions[c].num_trials;
    num_trials = std::min(num_trials, first.conditions.at(c).num_trials);
  }
  joined.stopping_rule = JoinNames(first.stopping_rule, second.stopping_rule);
  joined.origin = {JoinNames(first.origin.program, second.origin.program),
                   JoinNames(first.origin.instruction_set, second.origin.instruction_set)};
  return joined;
}

// The part of a run's identity on which its problems depend: all except its name and estimators.
std::string IdentityOfProblems(const std::string& identity) {
  std::string kept;
  bool is_left_out = false;
  for (const std::string& line : SplitText(identity, '\n')) {
    if (!line.empty() && line[0] != ' ')
      is_left_out = line.starts_with("estimators:") || line.starts_with("name:");
    if (!is_left_out && !IsOfCommandFile(line)) kept += line + "\n";
  }
  return kept;
}

}  // namespace

ReadableRun ReadRun(const ResultStore& store) {
  return {store.Description(), [&store](const VisitTrial& visit) { store.ForEachTrial(visit); }};
}

void TellApart(std::string* old_label, std::string* new_label) {
  if (*old_label != *new_label) return;
  *old_label += "_old";
  *new_label += "_new";
}

ReadableRun SelectLevel(const ReadableRun& run, const std::string& factor, const std::string& level) {
  const std::vector<std::string>& factors = run.description.factors;
  const auto index = static_cast<size_t>(std::ranges::find(factors, factor) - factors.begin());
  std::vector<bool> is_kept;  // by condition
  for (const DescribedCondition& condition : run.description.conditions)
    is_kept.push_back(condition.levels.at(index) == level);
  return SelectTrials(run, [is_kept](const ProblemRecord& problem) { return is_kept[problem.condition]; });
}

ReadableRun SelectTrials(const ReadableRun& run, std::function<bool(const ProblemRecord&)> is_kept) {
  return {run.description,
          [whole = run.for_each_trial, is_kept = std::move(is_kept)](const VisitTrial& visit) {
            whole([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
              if (is_kept(problem)) visit(problem, records);
            });
          }};
}

ReadableRun JoinRuns(const ResultStore& first, const std::vector<size_t>& of_first, const ResultStore& second,
                     const std::vector<size_t>& of_second) {
  const RunDescription of_old = first.Description(), of_new = second.Description();
  const std::string old_problems = IdentityOfProblems(of_old.identity),
                    new_problems = IdentityOfProblems(of_new.identity);
  if (old_problems != new_problems || of_old.conditions.size() != of_new.conditions.size()) {
    throw InputError(
        fmt::format("the two result files are of different problems, whose estimators cannot be paired; "
                    "first difference: {}",
                    FirstDifference(old_problems, new_problems)));
  }
  const RunDescription joined = JoinDescriptions(of_old, of_first, of_new, of_second);
  return {joined, [=, &first, &second](const VisitTrial& visit) {
            for (std::uint32_t c = 0; c < joined.conditions.size(); ++c) {
              const std::vector<WholeTrial> old_trials = ReadTrials(first, c),
                                            new_trials = ReadTrials(second, c);
              auto old_trial = old_trials.begin();
              for (const WholeTrial& trial : new_trials) {
                while (old_trial != old_trials.end() && old_trial->problem.trial < trial.problem.trial)
                  ++old_trial;
                if (old_trial == old_trials.end()) break;
                if (old_trial->problem.trial > trial.problem.trial) continue;
                RequireSameProblem(*old_trial, trial);
                std::vector<TrialRecord> records;
                AppendChosen(old_trial->records, of_first, &records);
                AppendChosen(trial.records, of_second, &records);
                visit(trial.problem, records);
              }
            }
          }};
}

}  // namespace rcme
