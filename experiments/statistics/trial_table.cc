#include "experiments/statistics/trial_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "experiments/core/text/field_text.h"
#include "experiments/trial/trial_columns.h"
#include "experiments/trial/trial_event.h"

namespace rcme {
namespace {

// Formats a field as the file stores it: a flag as a number, an unknown value as an empty text.
std::string FieldAsStored(double number) { return std::isnan(number) ? std::string() : FormatField(number); }
template <typename Integer>
std::string FieldAsStored(Integer number) {
  return FormatField(static_cast<std::int64_t>(number));
}

// Visits the columns of a row after the status, with their fields: those of the record, then those of the
// problem.
template <typename Visit>
void VisitNumbers(const TrialRecord& record, const ProblemRecord& problem, bool with_times, Visit visit) {
  using Role = StoredColumn::Role;
  const auto visit_number = [&](const StoredColumn& column, const auto& field) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(field)>, MotionStatus>) {
      if (column.role == Role::kNumber || (with_times && column.role == Role::kTime)) visit(column, field);
    }
  };
  VisitColumns(record, visit_number);
  VisitColumns(problem, visit_number);
}

std::string Header(const std::vector<std::string>& factors, bool with_times) {
  std::vector<std::string> before = {"study", "condition"},
                           after = {"trial", "estimator", "outcome", "status"};
  VisitNumbers({}, {}, with_times,
               [&](const StoredColumn& column, const auto&) { after.emplace_back(column.name); });
  const auto is_taken = [&](const std::string& name) {
    return std::ranges::count(before, name) + std::ranges::count(after, name) > 0;
  };
  std::vector<std::string> levels;
  for (const std::string& factor : factors)
    levels.push_back(CsvField(is_taken(factor) ? "level_" + factor : factor));
  before.insert(before.end(), levels.begin(), levels.end());
  return fmt::format("{},{}\n", fmt::join(before, ","), fmt::join(after, ","));
}

// The first cells of the rows of a condition.
std::string FormatRowBeginning(const RunDescription& run, std::uint32_t condition) {
  std::vector<std::string> fields = {CsvField(run.study), fmt::format("{}", condition)};
  for (const std::string& level : run.conditions[condition].levels) fields.push_back(CsvField(level));
  return fmt::format("{}", fmt::join(fields, ","));
}

}  // namespace

void WriteTrialTable(const ResultStore& store, bool with_times,
                     const std::function<void(const std::string&)>& write) {
  store.CheckTrials();
  const RunDescription run = store.Description();
  write(Header(run.factors, with_times));
  std::vector<std::string> beginnings, labels;
  for (std::uint32_t c = 0; c < run.conditions.size(); ++c) beginnings.push_back(FormatRowBeginning(run, c));
  for (const DescribedEstimator& estimator : run.estimators) labels.push_back(CsvField(estimator.label));
  store.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    std::string rows;
    for (const TrialRecord& record : records) {
      rows +=
          fmt::format("{},{},{},{},{}", beginnings[record.condition], record.trial, labels[record.estimator],
                      Name(ClassifyOutcome(record, run.failure)), StatusName(record.status));
      VisitNumbers(record, problem, with_times, [&](const StoredColumn&, const auto& field) {
        rows += ',';
        rows += FieldAsStored(field);
      });
      rows += "\n";
    }
    write(rows);
  });
}

}  // namespace rcme
