#include "experiments/statistics/summary_cell.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "experiments/core/files/damage.h"
#include "experiments/statistics/summary_quantities.h"
#include "experiments/statistics/truth_quality.h"
#include "experiments/study/population.h"
#include "parameters/parameter.h"
#include "stats/confidence_sequence.h"
#include "stats/constants.h"

namespace rcme {
namespace {

using Kind = SummaryRow::Kind;

QuantityCounts EmptyCounts(Kind kind) {
  switch (kind) {
    case Kind::kRate:
      return WeightedEvents();
    case Kind::kMedian:
      return StreamMedian();
    case Kind::kScore:
      return ExactScores();
    case Kind::kMean:
    case Kind::kVarianceShare:
    case Kind::kArea:
      break;
  }
  return ExactMoments();
}

template <typename Record>
QuantitySums EmptySums(const std::vector<Quantity<Record>>& quantities) {
  QuantitySums sums;
  for (const Quantity<Record>& quantity : quantities) sums.counts.push_back(EmptyCounts(quantity.kind));
  return sums;
}

void PrepareForRows(bool has_repeats, QuantitySums* sums) {
  for (QuantityCounts& counts : sums->counts) {
    if (std::holds_alternative<ExactMoments>(counts)) counts = Moments();
  }
  sums->scores.resize(sums->counts.size());
  if (has_repeats) sums->scene.resize(sums->counts.size());
}

// Returns whether the quantity is accumulated as scores. Rates are, if scenes are repeated, because the
// means of scenes are not just 0 or 1.
bool IsOfScores(const QuantitySums& sums, Kind kind) {
  return !sums.scores.empty() && (kind == Kind::kScore || (kind == Kind::kRate && !sums.scene.empty()));
}

// Returns whether only the first trial of a scene counts.
bool IsOfFirst(Kind kind) { return kind == Kind::kRate || kind == Kind::kMedian; }

struct AddNumber {
  double x, weight;
  void operator()(WeightedEvents& rate) const { rate.Add(weight, x != 0.0); }
  void operator()(auto& numbers) const { numbers.Add(x); }
};

// Adds the mean of a scene; for a scene with one trial this is its value.
void AddMean(double mean, Kind kind, size_t q, QuantitySums* sums) {
  if (IsOfScores(*sums, kind)) {
    sums->scores[q].moments.Add(mean);
    sums->scores[q].scores.Add(mean);
  } else if (!IsOfFirst(kind)) {
    std::visit(AddNumber{mean, 1.0}, sums->counts[q]);
  }
}

template <typename Record>
void AddRecord(const Record& record, double weight, bool is_first_of_scene, const FailureBounds& bounds,
               const std::vector<Quantity<Record>>& quantities, QuantitySums* sums) {
  const bool has_repeats = !sums->scene.empty();
  sums->is_weighted = sums->is_weighted || weight != 1.0;
  sums->num_scenes += !has_repeats;
  for (size_t q = 0; q < quantities.size(); ++q) {
    const std::optional<double> value = quantities[q].Measure(record, bounds);
    if (!value) continue;
    if (is_first_of_scene && IsOfFirst(quantities[q].kind))
      std::visit(AddNumber{*value, weight}, sums->counts[q]);
    if (has_repeats) {
      sums->scene[q].Add(*value);
    } else {
      AddMean(*value, quantities[q].kind, q, sums);
    }
  }
}

struct FillFrom {
  std::int64_t num_trials;  // of the cell
  SummaryRow* row;

  void operator()(const WeightedEvents& rate) const {
    const bool is_of_fixed_n = row->interval_kind == IntervalKind::kExact;
    const std::int64_t num_events = std::llround(rate.sum_weights);
    row->n = rate.num_trials;
    row->interval =
        is_of_fixed_n ? ExactBinomialInterval(num_events, row->n) : ConfidenceSequence(num_events, row->n);
    row->value = row->n > 0 ? static_cast<double>(num_events) / static_cast<double>(row->n) : kNaN;
    if (row->n > 0 && row->quantity == "nees_coverage")
      row->coverage_verdict = JudgeCoverage(row->value, row->interval, row->n, num_trials, is_of_fixed_n);
  }
  // The interval requires a number of trials fixed beforehand.
  void operator()(const StreamMedian& median) const {
    row->n = median.n();
    row->value = median.median();
    row->interval = row->interval_kind == IntervalKind::kExact ? median.interval() : Interval{kNaN, kNaN};
  }
  void operator()(const ExactScores& exact) const { FillScores(exact.moments(), exact.Scores()); }
  void operator()(const RowScores& plain) const { FillScores(plain.moments, plain.scores); }
  void operator()(const auto& moments) const {
    row->n = moments.n();
    row->value = moments.mean();
    row->standard_error = moments.standard_error();
  }

  void FillScores(const auto& moments, const ScoreMean& scores) const {
    row->n = moments.n();
    row->value = moments.mean();
    row->interval_kind = IntervalKind::kBetting;
    row->interval = scores.Sequence();
  }
};

// Weighted trials have only rates over all trials.
void FillWeighted(const QuantityCounts& counts, std::int64_t num_trials, SummaryRow* row) {
  row->interval_kind = IntervalKind::kWeighted;
  if (row->kind == Kind::kMedian) return FillFrom{num_trials, row}(StreamMedian());
  const auto* events = std::get_if<WeightedEvents>(&counts);
  const bool is_of_all = events && events->num_trials == num_trials;
  const WeightedRate rate = EstimateWeightedRate(is_of_all ? *events : WeightedEvents());
  row->n = is_of_all ? num_trials : 0;
  row->value = is_of_all ? std::min(rate.estimate, 1.0) : kNaN;
  row->standard_error = is_of_all ? rate.standard_error : kNaN;
  row->interval = {std::min(rate.interval.lower, 1.0), std::min(rate.cautious_upper, 1.0)};
}

// Returns the names of TrialQuantities() or ProblemQuantities().
template <typename Record>
const std::vector<SharedText>& ListNames(const std::vector<Quantity<Record>>& quantities) {
  static const std::vector<SharedText> names = [&] {
    std::vector<SharedText> texts;
    for (const Quantity<Record>& quantity : quantities) texts.emplace_back(quantity.name);
    return texts;
  }();
  return names;
}

template <typename Record>
void AppendQuantityRows(const std::vector<Quantity<Record>>& quantities, const QuantitySums& sums,
                        const SummaryRow& cell, std::vector<SummaryRow>* rows) {
  const std::vector<SharedText>& names = ListNames(quantities);
  for (size_t q = 0; q < quantities.size(); ++q) {
    SummaryRow row = cell;
    row.quantity = names[q];
    row.kind = quantities[q].kind;
    const FillFrom fill{sums.num_scenes, &row};
    if (sums.is_weighted) {
      FillWeighted(sums.counts[q], sums.num_scenes, &row);
    } else if (IsOfScores(sums, row.kind)) {
      fill(sums.scores[q]);
    } else {
      std::visit(fill, sums.counts[q]);
    }
    rows->push_back(std::move(row));
  }
}

void MergeSums(const QuantitySums& from, QuantitySums* into) {
  into->num_scenes += from.num_scenes;
  for (size_t q = 0; q < from.counts.size(); ++q) {
    std::visit([&]<typename Counts>(Counts& counts) { counts.Merge(std::get<Counts>(from.counts[q])); },
               into->counts[q]);
  }
}

struct SetTexts {
  CountedQuantity* row;
  void operator()(const WeightedEvents& rate) const {
    row->n = rate.num_trials;
    row->sum = std::to_string(std::llround(rate.sum_weights));
  }
  void operator()(const StreamMedian& median) const {
    row->n = median.n();
    row->cells = median.Text();
  }
  void operator()(const ExactMoments& moments) const { SetMoments(moments); }
  void operator()(const Moments&) const { throw std::logic_error("rows have no counts"); }
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
  void operator()(WeightedEvents& rate) const {
    long long num_events = 0;
    if (!ParseInteger(row.sum, &num_events) || num_events < 0 || num_events > row.n)
      throw std::invalid_argument("more events than trials");
    const auto sum = static_cast<double>(num_events);
    rate = {row.n, 1.0, sum, sum, 1.0};
  }
  void operator()(StreamMedian& median) const {
    median = StreamMedian::FromText(row.cells);
    if (median.n() != row.n) throw std::invalid_argument("a median of another number");
  }
  void operator()(ExactMoments& moments) const {
    moments = ExactMoments::FromTexts({std::to_string(row.n), row.sum, row.sum_squares});
  }
  void operator()(Moments&) const { throw std::logic_error("rows have no counts"); }
  void operator()(ExactScores& scores) const {
    scores = ExactScores::FromTexts({std::to_string(row.n), row.sum, row.sum_squares, row.cells});
  }
};

template <typename Record>
void AppendTexts(const std::vector<Quantity<Record>>& quantities, const QuantitySums& sums, size_t estimator,
                 std::vector<CountedQuantity>* texts) {
  for (size_t q = 0; q < quantities.size(); ++q) {
    CountedQuantity row;
    row.estimator = static_cast<std::uint32_t>(estimator);
    row.quantity = quantities[q].name;
    std::visit(SetTexts{&row}, sums.counts[q]);
    texts->push_back(std::move(row));
  }
}

using TextsByName = std::map<std::pair<size_t, std::string>, const CountedQuantity*>;

template <typename Record>
void ReadAllTexts(const TextsByName& texts, size_t estimator, std::int64_t num_trials,
                  const std::vector<Quantity<Record>>& quantities, QuantitySums* sums) {
  sums->num_scenes = num_trials;
  for (size_t q = 0; q < quantities.size(); ++q) {
    const auto found = texts.find({estimator, quantities[q].name});
    if (found == texts.end())
      throw Damage(fmt::format("table counts lacks '{}' (of another version of rcme?)", quantities[q].name));
    const CountedQuantity& row = *found->second;
    try {
      if (row.n < 0 || row.n > num_trials) throw std::invalid_argument("more numbers than trials");
      std::visit(ReadTexts{row}, sums->counts[q]);
    } catch (const std::invalid_argument& error) {
      throw Damage(fmt::format("'{}' of table counts is not possible: {}", row.quantity, error.what()));
    }
  }
}

}  // namespace

SummaryCell::SummaryCell(size_t num_estimators)
    : estimators_(num_estimators, EmptySums(TrialQuantities())), problems_(EmptySums(ProblemQuantities())) {}

SummaryCell::SummaryCell(size_t num_estimators, int repeats_per_scene) : SummaryCell(num_estimators) {
  const bool has_repeats = repeats_per_scene > 1;
  for (QuantitySums& estimator : estimators_) PrepareForRows(has_repeats, &estimator);
  PrepareForRows(/*has_repeats=*/false, &problems_);  // the trials of a scene share one problem
  if (has_repeats) splits_.assign(num_estimators, SceneSplit(repeats_per_scene));
  RankErrors();
}

void SummaryCell::RankErrors() { rankings_.resize(estimators_.size()); }

void SummaryCell::Add(const ProblemRecord& problem, const std::vector<TrialRecord>& records,
                      const FailureBounds& bounds, bool is_first_of_scene) {
  ++num_trials_;
  if (is_first_of_scene) AddRecord(problem, problem.weight, true, bounds, ProblemQuantities(), &problems_);
  for (size_t e = 0; e < estimators_.size(); ++e)
    AddRecord(records[e], problem.weight, is_first_of_scene, bounds, TrialQuantities(), &estimators_[e]);
  for (size_t e = 0; e < splits_.size(); ++e) splits_[e].Add(records[e], bounds);
  for (size_t e = 0; e < rankings_.size(); ++e) rankings_[e].Add(records[e]);
}

void SummaryCell::EndScene() {
  for (ErrorRanking& ranking : rankings_) ranking.EndCluster();
  if (splits_.empty()) return;
  for (QuantitySums& sums : estimators_) {
    ++sums.num_scenes;
    for (size_t q = 0; q < sums.scene.size(); ++q) {
      if (const std::optional<double> mean = sums.scene[q].Take())
        AddMean(*mean, TrialQuantities()[q].kind, q, &sums);
    }
  }
  for (SceneSplit& split : splits_) split.EndScene();
}

void SummaryCell::Merge(const SummaryCell& other) {
  num_trials_ += other.num_trials_;
  for (size_t e = 0; e < estimators_.size(); ++e) MergeSums(other.estimators_[e], &estimators_[e]);
  MergeSums(other.problems_, &problems_);
  for (size_t e = 0; e < rankings_.size(); ++e) rankings_[e].Merge(other.rankings_.at(e));
}

void SummaryCell::AppendRows(const RunDescription& run, SummaryRow cell,
                             std::vector<SummaryRow>* rows) const {
  for (size_t e = 0; e < estimators_.size(); ++e) {
    cell.estimator = run.estimators[e].label;
    AppendQuantityRows(TrialQuantities(), estimators_[e], cell, rows);
    if (!rankings_.empty() && !estimators_[e].is_weighted)
      rankings_[e].AppendRows(cell, /*counts_clusters=*/!splits_.empty(), rows);
    if (!splits_.empty()) splits_[e].AppendRows(cell, rows);
  }
  cell.estimator = kSceneLabel;
  AppendQuantityRows(ProblemQuantities(), problems_, cell, rows);
}

std::vector<CountedQuantity> SummaryCell::Texts() const {
  std::vector<CountedQuantity> texts;
  for (size_t e = 0; e < estimators_.size(); ++e) AppendTexts(TrialQuantities(), estimators_[e], e, &texts);
  AppendTexts(ProblemQuantities(), problems_, estimators_.size(), &texts);
  return texts;
}

bool SummaryCell::IsNotSimulated() const {
  const std::vector<TrialQuantity>& quantities = TrialQuantities();
  const auto place = std::ranges::find_if(quantities,
                                          [](const TrialQuantity& quantity) {
                                            return quantity.name == StatusName(MotionStatus::kNotSimulated);
                                          }) -
                     quantities.begin();
  const QuantityCounts& counts = estimators_.front().counts.at(static_cast<size_t>(place));
  return num_trials_ > 0 && std::llround(std::get<WeightedEvents>(counts).sum_weights) == num_trials_;
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

GroupSummarizer::GroupSummarizer(const RunDescription& run, const TrialGroups& groups) : run_(run) {
  summary_.study = run.study;
  summary_.factor_names = groups.factor_names;
  summary_.levels = groups.levels;
  summary_.num_trials_planned = run.NumTrials();
  summary_.is_target_open = IsTargetOpen(run);
  summary_.repeats_per_scene = run.repeats_per_scene;
  summary_.truth_quality = DescribeTruthQuality(run.identity);
  summary_.population = DescribePopulation(run.identity);
  summary_.num_retried = run.retried_trials;
  for (const DescribedEstimator& estimator : run.estimators) {
    summary_.efforts.emplace_back(estimator.label, estimator.effort);
    if (IsOutside(estimator.name)) summary_.outside.push_back(estimator.label);
  }
}

void GroupSummarizer::Append(const SummaryCell& cell) {
  summary_.num_trials_done += cell.num_trials();
  SummaryRow row;
  row.condition = num_groups_++;
  if (!run_.stopping_rule.empty()) row.interval_kind = IntervalKind::kAnytimeValid;
  cell.AppendRows(run_, row, &summary_.rows);
  if (num_groups_ == 1) summary_.rows.reserve(summary_.rows.size() * summary_.levels.size());
}

Summary GroupSummarizer::Finish(bool with_times) {
  LeaveOutRows(with_times, &summary_);
  return std::move(summary_);
}

Summary SummarizeCells(const RunDescription& run, const TrialGroups& groups,
                       const std::vector<const SummaryCell*>& cells, bool with_times) {
  GroupSummarizer summary(run, groups);
  for (const SummaryCell* cell : cells) summary.Append(*cell);
  return summary.Finish(with_times);
}

}  // namespace rcme
