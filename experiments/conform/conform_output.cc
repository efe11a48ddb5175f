#include "experiments/conform/conform_output.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/conform/conform_strata.h"
#include "experiments/conform/conform_tables.h"
#include "experiments/conform/conform_words.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/table/table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"
#include "experiments/statistics/coverage_strata_output.h"

namespace rcme {

std::string ConformAsText(const ConformReport& report, bool by_strata) {
  std::string text = DescribeConformFindings(report) + DescribeJudgedAnswers(report);
  if (report.judged.empty()) return text;
  text += DescribeConformTruth(report);
  for (const Table& table : {MakeRegionTable(report), MakeAcceptTable(report), MakeProbabilityTable(report)})
    text += "\n" + RenderText(table);
  text += "\n" + DescribeConformColumns(report) + "\n";
  for (const std::string& promise : DescribePromises(report.rule)) text += FormatParagraph(promise);
  if (report.shares_images)
    text += FormatParagraph(
        "Pairs of one scene share images and are counted as if they were independent: the promises say too much.");
  if (by_strata)
    text += "\n" + StrataAsText({"size_deg"}, MeasureConformStrata(report)) +
            DescribeStrata(StrataIntervals::kClusters);
  return text;
}

std::string ConformAsJson(const ConformReport& report, bool by_strata) {
  nlohmann::ordered_json json = {
      {"estimator", report.label},
      {"is_check", report.is_check},
      {"answers", report.judged.size()},
      {"refusals", std::ranges::count(report.problems, true, &AskedProblem::is_refused)},
      {"without_truth", report.num_unscored},
      {"level", report.rule.level},
      {"strata", report.rule.factors.size()},
      {"intervals_are_of", report.is_check ? "the rule of the file" : "the mean of the folds' rules"},
      {"promises", DescribePromises(report.rule)},
      {"regions", RenderJson(WithIntervalColumns(MakeRegionTable(report)))},
      {"accept", RenderJson(WithIntervalColumns(MakeAcceptTable(report)))},
      {"probabilities", RenderJson(WithIntervalColumns(MakeProbabilityTable(report)))}};
  if (report.shift) {
    const ShiftFinding& shift = *report.shift;
    json["shift"] = {{"answers", shift.num_looked_at},
                     {"could_notice", shift.could_notice},
                     {"p_value", shift.p_value},
                     {"noticed_after", shift.noticed_after ? nlohmann::ordered_json(*shift.noticed_after)
                                                           : nlohmann::ordered_json()},
                     {"feature", shift.feature},
                     {"strange_share", shift.strange_share}};
  }
  if (report.kept) {
    const PromiseFinding& kept = *report.kept;
    json["promise_test"] = {{"holds", !kept.IsAnyRefuted()},
                            {"answers", kept.num_answers},
                            {"coverage_p_value", kept.coverage_p_value},
                            {"problems", kept.num_problems},
                            {"wrong_and_accepted_p_value", kept.accept_p_value}};
  }
  if (by_strata) {
    const Table strata = MakeStrataTable("region", {"size_deg"}, MeasureConformStrata(report));
    json["by_strata"] = RenderJson(WithIntervalColumns(strata));
  }
  return JsonText(kConformReportFormat, json);
}

CommandResult MakeConformResult(const ConformReport& report, bool by_strata) {
  return {ConformAsText(report, by_strata), WithIntervalColumns(MakeRegionTable(report)),
          ConformAsJson(report, by_strata)};
}

}  // namespace rcme
