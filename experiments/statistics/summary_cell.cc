#include "experiments/statistics/summary_cell.h"

#include <fmt/format.h>

#include <map>
#include <stdexcept>
#include <utility>

#include "experiments/statistics/summary_quantities.h"
#include "experiments/core/files/damage.h"
#include "parameters/parameter.h"

namespace rcme {
namespace {

QuantityCounts EmptyCounts(SummaryRow::Kind kind) {
  switch (kind) {
    case SummaryRow::Kind::kRate:
      return RateCount();
    case SummaryRow::Kind::kMedian:
      return StreamMedian();
    case SummaryRow::Kind::kScore:
      return ExactScores();
    case SummaryRow::Kind::kMean:
    case SummaryRow::Kind::kVarianceShare:
      break;
  }
  return ExactMoments();
}

template <typename Record>
std::vector<QuantityCounts> EmptyCounts(const std::vector<Quantity<Record>>& quantities) {
  std::vector<QuantityCounts> counts;
  for (const Quantity<Record>& quantity : quantities) counts.push_back(EmptyCounts(quantity.kind));
  return counts;
}

struct AddNumber {
  double x;
  void operator()(RateCount& rate) const { ++rate.n, rate.num_events += x != 0.0; }
  void operator()(auto& numbers) const { numbers.Add(x); }
};

template <typename Record>
void AddRecord(const Record& record, const FailureBounds& bounds,
               const std::vector<Quantity<Record>>& quantities, std::vector<QuantityCounts>* counts) {
  for (size_t q = 0; q < quantities.size(); ++q) {
    const std::optional<double> value = quantities[q].contribution(record, bounds);
    if (value) std::visit(AddNumber{*value}, (*counts)[q]);
  }
}

void MergeCounts(const std::vector<QuantityCounts>& from, std::vector<QuantityCounts>* into) {
  for (size_t q = 0; q < from.size(); ++q) {
    std::visit(
        [&]<typename Counts>(Counts& counts) {
          const Counts& other = std::get<Counts>(from[q]);
          if constexpr (std::is_same_v<Counts, RateCount>) {
            counts.n += other.n;
            counts.num_events += other.num_events;
          } else {
            counts.Merge(other);
          }
        },
        (*into)[q]);
  }
}

void FillFrom(const RateCount& rate, std::int64_t num_trials, SummaryRow* row) {
  Collected collected{.n = rate.n};
  if (rate.n > 0) collected.mean = static_cast<double>(rate.num_events) / static_cast<double>(rate.n);
  FillRow(collected, num_trials, row);
}
void FillFrom(const ExactMoments& moments, std::int64_t num_trials, SummaryRow* row) {
  FillRow({moments.n(), moments.mean(), moments.standard_error()}, num_trials, row);
}
void FillFrom(const StreamMedian& median, std::int64_t num_trials, SummaryRow* row) {
  FillRow({.median = &median}, num_trials, row);
}
void FillFrom(const ExactScores& exact, std::int64_t num_trials, SummaryRow* row) {
  const ScoreMean scores = exact.Scores();
  FillRow({.n = exact.moments().n(), .mean = exact.moments().mean(), .scores = &scores}, num_trials, row);
}

template <typename Record>
void AppendRowsOf(const std::vector<Quantity<Record>>& quantities, const std::vector<QuantityCounts>& counts,
                  std::int64_t num_trials, const SummaryRow& cell, std::vector<SummaryRow>* rows) {
  for (size_t q = 0; q < quantities.size(); ++q) {
    SummaryRow row = cell;
    row.quantity = quantities[q].name;
    row.kind = quantities[q].kind;
    std::visit([&](const auto& numbers) { FillFrom(numbers, num_trials, &row); }, counts[q]);
    rows->push_back(std::move(row));
  }
}

struct SetTexts {
  CountedQuantity* row;
  void operator()(const RateCount& rate) const {
    row->n = rate.n;
    row->sum = std::to_string(rate.num_events);
  }
  void operator()(const StreamMedian& median) const {
    row->n = median.n();
    row->cells = median.Text();
  }
  void operator()(const ExactMoments& moments) const { SetMoments(moments); }
  void operator()(const ExactScores& scores) const {
    SetMoments(scores.moments());
    row->cells = scores.Texts().back();
  }
  void SetMoments(const ExactMoments& moments) const {
    const std::vector<std::string> texts = moments.Texts();
    row->n = moments.n();
    row->sum = texts[1];
    row->sum_squares = texts[2];
  }
};

// Throws std::invalid_argument.
struct ReadTexts {
  const CountedQuantity& row;
  void operator()(RateCount& rate) const {
    long long num_events = 0;
    if (!ParseInteger(row.sum, &num_events) || num_events < 0 || num_events > row.n)
      throw std::invalid_argument("more events than trials");
    rate = {row.n, num_events};
  }
  void operator()(StreamMedian& median) const {
    median = StreamMedian::FromText(row.cells);
    if (median.n() != row.n) throw std::invalid_argument("a median of another number");
  }
  void operator()(ExactMoments& moments) const {
    moments = ExactMoments::FromTexts({std::to_string(row.n), row.sum, row.sum_squares});
  }
  void operator()(ExactScores& scores) const {
    scores = ExactScores::FromTexts({std::to_string(row.n), row.sum, row.sum_squares, row.cells});
  }
};

template <typename Record>
void AppendTexts(const std::vector<Quantity<Record>>& quantities, const std::vector<QuantityCounts>& counts,
                 size_t estimator, std::vector<CountedQuantity>* texts) {
  for (size_t q = 0; q < quantities.size(); ++q) {
    CountedQuantity row;
    row.estimator = static_cast<std::uint32_t>(estimator);
    row.quantity = quantities[q].name;
    std::visit(SetTexts{&row}, counts[q]);
    texts->push_back(std::move(row));
  }
}

using TextsByName = std::map<std::pair<size_t, std::string>, const CountedQuantity*>;

template <typename Record>
void ReadAllTexts(const TextsByName& texts, size_t estimator, std::int64_t num_trials,
                  const std::vector<Quantity<Record>>& quantities, std::vector<QuantityCounts>* counts) {
  for (size_t q = 0; q < quantities.size(); ++q) {
    const auto found = texts.find({estimator, quantities[q].name});
    if (found == texts.end())
      throw Damage(fmt::format("table counts lacks '{}' (of another version of rcme?)", quantities[q].name));
    const CountedQuantity& row = *found->second;
    try {
      if (row.n < 0 || row.n > num_trials) throw std::invalid_argument("more numbers than trials");
      std::visit(ReadTexts{row}, (*counts)[q]);
    } catch (const std::invalid_argument& error) {
      throw Damage(fmt::format("'{}' of table counts is not possible: {}", row.quantity, error.what()));
    }
  }
}

}  // namespace

SummaryCell::SummaryCell(size_t num_estimators)
    : estimators_(num_estimators, EmptyCounts(TrialQuantities())),
      problems_(EmptyCounts(ProblemQuantities())) {}

void SummaryCell::Add(const ProblemRecord& problem, const std::vector<TrialRecord>& records,
                      const FailureBounds& bounds) {
  ++num_trials_;
  for (size_t e = 0; e < estimators_.size(); ++e)
    AddRecord(records[e], bounds, TrialQuantities(), &estimators_[e]);
  AddRecord(problem, bounds, ProblemQuantities(), &problems_);
}

void SummaryCell::Merge(const SummaryCell& other) {
  num_trials_ += other.num_trials_;
  for (size_t e = 0; e < estimators_.size(); ++e) MergeCounts(other.estimators_[e], &estimators_[e]);
  MergeCounts(other.problems_, &problems_);
}

void SummaryCell::AppendRows(const RunDescription& run, SummaryRow cell,
                             std::vector<SummaryRow>* rows) const {
  for (size_t e = 0; e < estimators_.size(); ++e) {
    cell.estimator = run.estimators[e].label;
    AppendRowsOf(TrialQuantities(), estimators_[e], num_trials_, cell, rows);
  }
  cell.estimator = kSceneLabel;
  AppendRowsOf(ProblemQuantities(), problems_, num_trials_, cell, rows);
}

std::vector<CountedQuantity> SummaryCell::Texts() const {
  std::vector<CountedQuantity> texts;
  for (size_t e = 0; e < estimators_.size(); ++e) AppendTexts(TrialQuantities(), estimators_[e], e, &texts);
  AppendTexts(ProblemQuantities(), problems_, estimators_.size(), &texts);
  return texts;
}

SummaryCell SummaryCell::FromTexts(const std::vector<CountedQuantity>& texts, size_t num_estimators,
                                   std::int64_t num_trials) {
  SummaryCell cell(num_estimators);
  cell.num_trials_ = num_trials;
  if (texts.empty() && num_trials == 0) return cell;
  TextsByName by_name;
  for (const CountedQuantity& row : texts) by_name[{row.estimator, row.quantity}] = &row;
  for (size_t e = 0; e < num_estimators; ++e)
    ReadAllTexts(by_name, e, num_trials, TrialQuantities(), &cell.estimators_[e]);
  ReadAllTexts(by_name, num_estimators, num_trials, ProblemQuantities(), &cell.problems_);
  const size_t num_rows = num_estimators * TrialQuantities().size() + ProblemQuantities().size();
  if (texts.size() != num_rows) throw Damage("table counts has rows of quantities that there are not");
  return cell;
}

}  // namespace rcme
