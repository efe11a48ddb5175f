#include "experiments/audit/model_choice/choice_output.h"

#include <fmt/format.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"
#include "stats/intervals.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

// One number of a matrix. Of conditions counted together the rate is their mean: the binomial interval is
// then too wide, if anything (Hoeffding 1956).
struct Cell {
  std::int64_t count = 0, n = 0;
  double value = 0.0;  // NaN where n is 0
  Interval interval;
};

Cell CellOf(const ConfusionMatrix& matrix, size_t kind, size_t answer) {
  const auto& row = matrix[kind];
  const std::int64_t n = std::accumulate(row.begin(), row.end(), std::int64_t{0}), count = row[answer];
  return {count, n, static_cast<double>(count) / static_cast<double>(n), ExactBinomialInterval(count, n)};
}

std::string CellInWords(const Cell& cell) {
  if (cell.count == 0) return fmt::format("0 % [0, {:.2g}]", 100.0 * cell.interval.upper);
  return FormatEstimate({cell.value, cell.interval}, {100.0, "%", ".1f"});
}

std::string MatrixAsTable(const std::string& criterion, const ConfusionMatrix& matrix) {
  std::vector<std::vector<std::string>> rows = {{criterion, "n"}};
  for (size_t answer = 0; answer < kNumAnswers; ++answer) rows[0].push_back(AnswerName(answer));
  for (size_t kind = 0; kind < kTrueKinds.size(); ++kind) {
    const std::int64_t n = CellOf(matrix, kind, 0).n;
    if (n == 0) continue;
    rows.push_back({Name(kTrueKinds[kind]), fmt::format("{}", n)});
    for (size_t answer = 0; answer < kNumAnswers; ++answer) {
      rows.back().push_back(CellInWords(CellOf(matrix, kind, answer)));
    }
  }
  return FormatColumns(rows);
}

std::string LevelsInWords(const ChoiceCounts& counts, const ChoiceGroup& group) {
  std::vector<std::string> words;
  for (size_t f = 0; f < counts.by.size(); ++f)
    words.push_back(fmt::format("{} = {}", counts.by[f], group.levels[f]));
  return words.empty() ? "all conditions" : fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

std::string ChoicesAsTable(const StudyPlan& plan, const ChoiceCounts& counts) {
  std::string text = fmt::format(
      "{}: verdicts of model choice where the truth is known, {} trials in each of {} conditions\n"
      "Rows: the truth; columns: the verdict, its share of the row with the exact 95 % interval\n",
      plan.study.name, plan.study.trials, plan.conditions.size());
  for (const ChoiceGroup& group : counts.groups) {
    text += fmt::format("\n{}\n", LevelsInWords(counts, group));
    for (size_t c = 0; c < group.matrices.size(); ++c) {
      text += fmt::format("\n{}", MatrixAsTable(CriterionNames()[c].first, group.matrices[c]));
    }
  }
  return text;
}

std::string ChoicesAsCsv(const StudyPlan& plan, const ChoiceCounts& counts) {
  std::string text = "study,condition";
  for (const std::string& factor : counts.by) text += fmt::format(",{}", CsvField(factor));
  text += ",truth,verdict,estimator,quantity,kind,value,lower,upper,standard_error,n,count\n";
  for (size_t g = 0; g < counts.groups.size(); ++g) {
    std::string beginning = fmt::format("{},{}", CsvField(plan.study.name), g);
    for (const std::string& level : counts.groups[g].levels) beginning += fmt::format(",{}", CsvField(level));
    for (size_t c = 0; c < CriterionNames().size(); ++c) {
      for (size_t kind = 0; kind < kTrueKinds.size(); ++kind) {
        for (size_t answer = 0; answer < kNumAnswers; ++answer) {
          const Cell cell = CellOf(counts.groups[g].matrices[c], kind, answer);
          text +=
              fmt::format("{},{},{},{},share,rate,{},{},{},,{},{}\n", beginning, Name(kTrueKinds[kind]),
                          AnswerName(answer), CriterionNames()[c].first, CsvNumber(cell.value),
                          CsvNumber(cell.interval.lower), CsvNumber(cell.interval.upper), cell.n, cell.count);
        }
      }
    }
  }
  return text;
}

std::string ChoicesAsJson(const StudyPlan& plan, const ChoiceCounts& counts) {
  Json groups = Json::array();
  for (const ChoiceGroup& group : counts.groups) {
    Json matrices = Json::array();
    for (size_t c = 0; c < group.matrices.size(); ++c) {
      Json rows = Json::array();
      for (size_t kind = 0; kind < kTrueKinds.size(); ++kind) {
        Json cells = Json::array();
        for (size_t answer = 0; answer < kNumAnswers; ++answer) {
          const Cell cell = CellOf(group.matrices[c], kind, answer);
          cells.push_back({{"verdict", AnswerName(answer)},
                           {"count", cell.count},
                           {"value", JsonNumber(cell.value)},
                           {"lower", cell.interval.lower},
                           {"upper", cell.interval.upper}});
        }
        rows.push_back({{"truth", Name(kTrueKinds[kind])},
                        {"n", CellOf(group.matrices[c], kind, 0).n},
                        {"cells", cells}});
      }
      matrices.push_back({{"criterion", CriterionNames()[c].first}, {"rows", rows}});
    }
    groups.push_back({{"levels", group.levels}, {"matrices", matrices}});
  }
  const Json json = {{"study", plan.study.name},
                     {"seed", plan.study.seed},
                     {"trials_per_condition", plan.study.trials},
                     {"num_conditions", plan.conditions.size()},
                     {"by", counts.by},
                     {"groups", groups}};
  return JsonText(kModelChoiceFormat, json);
}

}  // namespace rcme
