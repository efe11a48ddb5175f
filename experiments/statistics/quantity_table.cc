#include "experiments/statistics/quantity_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

#include "experiments/core/table/render_table.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

// The quantities of one estimator in one condition.
struct EstimatorRow {
  const std::vector<std::string>& levels;
  std::int64_t num_trials = 0;  // the greatest n; some quantities count all trials
  std::span<const SummaryRow> rows = {};

  // Returns null if there is no such row. `place` is where the quantity was found last; it is tried first,
  // because the rows of all groups have the same order.
  const SummaryRow* FindRow(const SharedText& quantity, size_t* place) const {
    if (*place >= rows.size() || rows[*place].quantity != quantity) {
      *place = 0;
      while (*place < rows.size() && rows[*place].quantity != quantity) ++*place;
    }
    return *place < rows.size() ? &rows[*place] : nullptr;
  }
};

bool IsOfProblems(const SummaryRow& row) {
  static const SharedText scene = kSceneLabel;
  return row.estimator == scene;
}

std::vector<EstimatorRow> GroupRows(const Summary& summary, bool is_of_problems) {
  std::vector<EstimatorRow> groups;
  const std::span<const SummaryRow> rows = summary.rows;
  for (size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    std::int64_t num_trials = 0;
    for (; end < rows.size() && rows[end].condition == rows[begin].condition &&
           rows[end].estimator == rows[begin].estimator;
         ++end)
      num_trials = std::max(num_trials, rows[end].n);
    if (IsOfProblems(rows[begin]) == is_of_problems)
      groups.push_back(
          {summary.levels.at(rows[begin].condition), num_trials, rows.subspan(begin, end - begin)});
  }
  return groups;
}

NumberFormat ChooseNumberFormat(SummaryRow::Kind kind) {
  const bool is_share = kind == SummaryRow::Kind::kRate || kind == SummaryRow::Kind::kScore ||
                        kind == SummaryRow::Kind::kVarianceShare;
  return is_share ? kPercent : kSignificant;
}

std::vector<ColumnOf<EstimatorRow>> MakeColumns(const Summary& summary, bool is_of_problems,
                                                const std::vector<std::string>& quantities) {
  using R = const EstimatorRow&;
  std::vector<ColumnOf<EstimatorRow>> columns = LevelColumns<EstimatorRow>(summary.factor_names);
  if (!is_of_problems)
    columns.push_back(
        {{.name = "estimator", .is_key = true}, [](R r) { return r.rows.front().estimator.text(); }});
  columns.push_back({{.name = summary.repeats_per_scene > 1 ? "scenes" : "n",
                      .type = ColumnType::kCount,
                      .is_key = true,
                      .is_symbol = summary.repeats_per_scene == 1},
                     [](R r) { return r.num_trials; }});
  for (const std::string& quantity : quantities) {
    const auto row = std::ranges::find_if(summary.rows, [&](const SummaryRow& r) {
      return r.quantity == quantity && IsOfProblems(r) == is_of_problems;
    });
    if (row == summary.rows.end()) continue;
    columns.push_back({{quantity, ColumnType::kEstimate, ChooseNumberFormat(row->kind)},
                       [name = row->quantity, place = size_t{0}](R r) mutable {
                         const SummaryRow* found = r.FindRow(name, &place);
                         return found ? MakeEstimate(*found, r.num_trials) : Estimate();
                       }});
  }
  return columns;
}

}  // namespace

Estimate MakeEstimate(const SummaryRow& row, std::int64_t num_trials) {
  if (row.n == 0) return {};
  Estimate estimate{.value = row.value};
  if (row.kind != SummaryRow::Kind::kMean) estimate.interval = row.interval;
  if (row.kind == SummaryRow::Kind::kMean || row.interval_kind == IntervalKind::kWeighted)
    estimate.standard_error = row.standard_error;
  if (row.n != num_trials) estimate.n = row.n;
  if (row.coverage_verdict) estimate.note = DescribeCoverageVerdict(*row.coverage_verdict);
  return estimate;
}

void CheckAreQuantities(const Summary& summary, const std::vector<std::string>& quantities) {
  std::set<std::string> known;
  for (const SummaryRow& row : summary.rows) {
    if (row.estimator != kSceneLabel) known.insert(row.quantity);
  }
  for (const std::string& quantity : quantities) {
    if (!known.contains(quantity))
      throw InputError(fmt::format(
          "--quantities: {} is not a quantity of an estimator in this summary{}; allowed: {}",
          Quoted(quantity), DidYouMean(quantity, {known.begin(), known.end()}), fmt::join(known, ", ")));
  }
}

std::vector<std::string> AddSharpness(const Summary& summary, std::vector<std::string> quantities) {
  const auto is_of_sharpness = [](const std::string& quantity) {
    return quantity == "sd_over_crb" || quantity == "rotation_sd_deg" || quantity == "direction_sd_deg" ||
           quantity == "log_det_cov";
  };
  const auto coverage = std::ranges::find(quantities, "nees_coverage");
  if (coverage == quantities.end() || std::ranges::any_of(quantities, is_of_sharpness)) return quantities;
  const auto is_known = [&](const std::string& quantity) {
    return std::ranges::any_of(summary.rows, [&](const SummaryRow& row) {
      return row.estimator != kSceneLabel && row.quantity == quantity;
    });
  };
  std::vector<std::string> sharpness = {"sd_over_crb"};
  if (!is_known("sd_over_crb")) sharpness = {"rotation_sd_deg", "direction_sd_deg"};
  std::erase_if(sharpness, [&](const std::string& quantity) { return !is_known(quantity); });
  quantities.insert(coverage + 1, sharpness.begin(), sharpness.end());
  return quantities;
}

void KeepQuantities(const std::vector<std::string>& quantities, Summary* summary) {
  CheckAreQuantities(*summary, quantities);
  const std::vector<SharedText> kept(quantities.begin(), quantities.end());
  std::erase_if(summary->rows, [&](const SummaryRow& row) {
    return IsOfProblems(row) || std::ranges::count(kept, row.quantity) == 0;
  });
}

Table MakeQuantityTable(const Summary& summary, const std::vector<std::string>& quantities) {
  return MakeTable(MakeColumns(summary, /*is_of_problems=*/false, quantities),
                   GroupRows(summary, /*is_of_problems=*/false));
}

std::string RenderQuantityTable(const Summary& summary, const std::vector<std::string>& quantities) {
  return RenderText(MakeColumns(summary, /*is_of_problems=*/false, quantities),
                    GroupRows(summary, /*is_of_problems=*/false));
}

std::string RenderProblemTable(const Summary& summary, const std::vector<std::string>& quantities) {
  return RenderText(MakeColumns(summary, /*is_of_problems=*/true, quantities),
                    GroupRows(summary, /*is_of_problems=*/true));
}

}  // namespace rcme
