#include "experiments/audit/model_choice/choice_output.h"

#include <fmt/format.h>

#include <numeric>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/trial/simulate_draw.h"
#include "stats/intervals.h"

namespace rcme {
namespace {

// One entry of a matrix. For conditions counted together the rate is their mean, and the binomial interval
// is, if anything, too wide (Hoeffding 1956).
struct Cell {
  std::int64_t count = 0, n = 0;
  double value = 0.0;  // NaN if n is 0
  Interval interval;
};

Cell ComputeConfusionCell(const ConfusionMatrix& matrix, size_t kind, size_t answer) {
  const auto& row = matrix[kind];
  const std::int64_t n = std::accumulate(row.begin(), row.end(), std::int64_t{0}), count = row[answer];
  return {count, n, static_cast<double>(count) / static_cast<double>(n), ExactBinomialInterval(count, n)};
}

Table MakeMatrixTable(const std::string& criterion, const ConfusionMatrix& matrix) {
  Table table{{Column::Key(criterion), Column::Count("n")}};
  for (size_t answer = 0; answer < kNumAnswers; ++answer)
    table.columns.push_back(Column::Estimated(AnswerName(answer), {100.0, "%", ".1f"}));
  for (size_t kind = 0; kind < kTrueKinds.size(); ++kind) {
    if (ComputeConfusionCell(matrix, kind, 0).n == 0) continue;
    table.rows.push_back({Name(kTrueKinds[kind]), ComputeConfusionCell(matrix, kind, 0).n});
    for (size_t answer = 0; answer < kNumAnswers; ++answer) {
      const Cell cell = ComputeConfusionCell(matrix, kind, answer);
      table.rows.back().emplace_back(Estimate{cell.value, cell.interval});
    }
  }
  return table;
}

std::int64_t CountTrials(const ConfusionMatrix& matrix) {
  std::int64_t n = 0;
  for (size_t kind = 0; kind < kTrueKinds.size(); ++kind) n += ComputeConfusionCell(matrix, kind, 0).n;
  return n;
}

std::string DescribeLevels(const ChoiceCounts& counts, const ChoiceGroup& group) {
  std::vector<std::string> words;
  for (size_t f = 0; f < counts.by.size(); ++f)
    words.push_back(fmt::format("{} = {}", counts.by[f], group.levels[f]));
  return words.empty() ? "all conditions" : fmt::format("{}", fmt::join(words, ", "));
}

std::string ChoicesAsTable(const StudyPlan& plan, const ChoiceCounts& counts) {
  const std::int64_t num_trials = plan.study.trials * std::ssize(plan.conditions);
  std::int64_t num_simulated = 0;
  for (const ChoiceGroup& group : counts.groups) num_simulated += CountTrials(group.matrices.front());
  std::string text =
      FormatParagraph(plan.study.name + ": verdicts of model choice where the truth is known") +
      FormatParagraph(
          fmt::format("{} trials in each of {} conditions. Rows: the truth; columns: the verdict, "
                      "its share of the row with the exact 95 % interval.",
                      plan.study.trials, plan.conditions.size())) +
      (plan.study.population
           ? FormatParagraph("The conditions are draws of a population; the intervals are of these draws "
                             "alone, not of the population.")
           : "") +
      FormatParagraph(DescribeNotSimulated(num_trials - num_simulated, num_trials));
  for (const ChoiceGroup& group : counts.groups) {
    text += fmt::format("\n{}\n", DescribeLevels(counts, group));
    for (size_t c = 0; c < group.matrices.size(); ++c)
      text += "\n" + RenderText(MakeMatrixTable(CriterionNames()[c].first, group.matrices[c]));
  }
  return text;
}

Table MakeChoiceFileTable(const StudyPlan& plan, const ChoiceCounts& counts) {
  Table table{{{.name = "study", .json_name = kNotInJson}, Column::Count("condition")}};
  for (const std::string& factor : counts.by) table.columns.push_back({.name = factor, .group = "levels"});
  table.AddColumns({Column::Text("truth"),
                    Column::Text("verdict"),
                    Column::Text("estimator"),
                    Column::Text("quantity"),
                    Column::Text("kind"),
                    Column::Number("value"),
                    {"lower,upper", ColumnType::kInterval},
                    Column::Number("standard_error"),
                    Column::Count("n"),
                    Column::Count("count")});
  for (size_t g = 0; g < counts.groups.size(); ++g) {
    std::vector<Value> beginning = {plan.study.name, static_cast<std::int64_t>(g)};
    beginning.insert(beginning.end(), counts.groups[g].levels.begin(), counts.groups[g].levels.end());
    for (size_t c = 0; c < CriterionNames().size(); ++c) {
      for (size_t kind = 0; kind < kTrueKinds.size(); ++kind) {
        for (size_t answer = 0; answer < kNumAnswers; ++answer) {
          const Cell cell = ComputeConfusionCell(counts.groups[g].matrices[c], kind, answer);
          std::vector<Value>& row = table.rows.emplace_back(beginning);
          row.insert(row.end(), {Name(kTrueKinds[kind]),
                                 AnswerName(answer),
                                 CriterionNames()[c].first,
                                 "share",
                                 "rate",
                                 cell.value,
                                 cell.interval,
                                 {},
                                 cell.n,
                                 cell.count});
        }
      }
    }
  }
  return table;
}

}  // namespace

CommandResult MakeChoiceResult(const StudyPlan& plan, const ChoiceCounts& counts) {
  const Facts facts = {{"study", plan.study.name},
                       {"seed", static_cast<std::int64_t>(plan.study.seed)},
                       {"trials_per_condition", std::int64_t{plan.study.trials}},
                       {"num_conditions", std::ssize(plan.conditions)}};
  return MakeResult(ChoicesAsTable(plan, counts), kModelChoiceFormat, facts,
                    MakeChoiceFileTable(plan, counts));
}

}  // namespace rcme
