#include "experiments/statistics/trial_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "experiments/core/text/field_text.h"
#include "experiments/trial/trial_fields.h"
#include "experiments/trial/trial_outcome.h"

namespace rcme {
namespace {

template <typename Field>
std::string FieldText(const Field& field) {
  if constexpr (std::is_same_v<Field, double>) {
    return std::isnan(field) ? std::string() : fmt::format("{}", field);
  } else {
    return fmt::format("{}", static_cast<std::int64_t>(field));
  }
}

// Visits the columns of a row after the outcome: those of the record, then those of the problem.
template <typename Visit>
void VisitNumbers(const TrialRecord& record, const ProblemRecord& problem, bool with_times, Visit visit) {
  VisitFields(record, [&](const std::string& name, const auto& field) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(field)>, MotionStatus>) {
      const bool is_key = name == "condition" || name == "trial" || name == "estimator";
      if (!is_key && (with_times || name != "seconds")) visit(name, FieldText(field));
    }
  });
  VisitProblemFields(problem, [&](const std::string& name, const auto& field) {
    if (name != "condition" && name != "trial") visit(name, FieldText(field));
  });
}

std::string Header(const std::vector<std::string>& factors, bool with_times) {
  std::vector<std::string> before = {"study", "condition"}, after = {"trial", "estimator", "outcome"};
  VisitNumbers({}, {}, with_times,
               [&](const std::string& name, const std::string&) { after.push_back(name); });
  const auto is_taken = [&](const std::string& name) {
    return std::ranges::count(before, name) + std::ranges::count(after, name) > 0;
  };
  std::vector<std::string> levels;
  for (const std::string& factor : factors)
    levels.push_back(CsvField(is_taken(factor) ? "level_" + factor : factor));
  before.insert(before.end(), levels.begin(), levels.end());
  return fmt::format("{},{}\n", fmt::join(before, ","), fmt::join(after, ","));
}

// What the rows of a condition begin with.
std::string BeginningOf(const RunDescription& run, std::uint32_t condition) {
  std::vector<std::string> fields = {CsvField(run.study), fmt::format("{}", condition)};
  for (const std::string& level : run.conditions[condition].levels) fields.push_back(CsvField(level));
  return fmt::format("{}", fmt::join(fields, ","));
}

}  // namespace

void WriteTrialTable(const ResultStore& store, bool with_times,
                     const std::function<void(const std::string&)>& write) {
  const RunDescription run = store.Description();
  write(Header(run.factors, with_times));
  std::vector<std::string> beginnings, labels;
  for (std::uint32_t c = 0; c < run.conditions.size(); ++c) beginnings.push_back(BeginningOf(run, c));
  for (const DescribedEstimator& estimator : run.estimators) labels.push_back(CsvField(estimator.label));
  store.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    std::string rows;
    for (const TrialRecord& record : records) {
      rows += fmt::format("{},{},{},{}", beginnings[record.condition], record.trial, labels[record.estimator],
                          OutcomeInFull(record, run.failure));
      VisitNumbers(record, problem, with_times,
                   [&](const std::string&, const std::string& text) { rows += "," + text; });
      rows += "\n";
    }
    write(rows);
  });
}

}  // namespace rcme
