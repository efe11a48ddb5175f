#include "experiments/statistics/coverage_strata_output.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/core/table/render_table.h"
#include "experiments/core/table/table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"
#include "experiments/core/text/pick_name.h"

namespace rcme {
namespace {

const char* NameIntervals(StrataIntervals intervals) {
  return PickName(intervals,
                  {"exact, or by betting on the sums of scenes where scenes are repeated or shared",
                   "anytime-valid", "of the population that the conditions are a sample of"});
}

}  // namespace

Table MakeStrataTable(const std::string& label_column, const std::vector<std::string>& sharpness_names,
                      const std::vector<CoverageStratum>& strata) {
  using S = const CoverageStratum&;
  std::vector<ColumnOf<CoverageStratum>> columns = {
      {Column::Key(label_column), [](S s) { return s.label; }},
      {Column::Key("seen"), [](S s) { return s.seen; }},
      {Column::Key("quarter"),
       [](S s) { return s.quarter > 0 ? std::to_string(s.quarter) : std::string("unknown"); }},
      {Column::Estimated("coverage", {100.0, "%", ".1f", ".2g"}), [](S s) {
         Estimate coverage = s.coverage;
         coverage.note.clear();
         return coverage;
       }}};
  for (size_t i = 0; i < sharpness_names.size(); ++i)  // the first is next to the coverage
    columns.push_back({Column::Number(sharpness_names[i]), [i](S s) { return s.sharpness.at(i); }});
  columns.push_back({Column::Text("verdict"), [](S s) { return s.coverage.note; }});
  columns.push_back({Column::Number("from"), [](S s) { return s.least; }});
  columns.push_back({Column::Number("to"), [](S s) { return s.most; }});
  columns.push_back({Column::Count("n"), [](S s) { return s.n; }});
  return MakeTable(columns, strata);
}

std::string StrataAsText(const std::vector<std::string>& sharpness_names,
                         const std::vector<CoverageStratum>& strata) {
  std::string text;
  for (auto first = strata.begin(); first != strata.end();) {
    const auto last =
        std::find_if(first, strata.end(), [&](const CoverageStratum& s) { return s.label != first->label; });
    Table table = MakeStrataTable("", sharpness_names, {first, last});
    table.columns.erase(table.columns.begin());
    for (std::vector<Value>& row : table.rows) row.erase(row.begin());
    text += first->label + "\n\n" + RenderText(table) + "\n";
    first = last;
  }
  return text;
}

std::string DescribeStrata(StrataIntervals intervals) {
  return FormatParagraph(fmt::format(
      "Quarters of the answers by what is visible at run time, the least values first; equal values are in "
      "one quarter. coverage: truth within the region, with its 95 % interval ({}), each by itself. covers: "
      "the whole interval is within 95 +- 1 %. Beside it medians: how sharp the regions are there.",
      NameIntervals(intervals)));
}

CommandResult MakeStrataResult(const std::string& study, const CoverageStrata& strata) {
  const Table table = MakeStrataTable("estimator", strata.sharpness_names, strata.rows);
  const std::string text =
      FormatParagraph(fmt::format("Study {}: coverage by strata that are visible at run time", study)) +
      "\n" + StrataAsText(strata.sharpness_names, strata.rows) + DescribeStrata(strata.intervals);
  return MakeResult(text, kStrataFormat,
                    {{"study", study}, {"intervals", std::string(NameIntervals(strata.intervals))}},
                    WithIntervalColumns(table));
}

}  // namespace rcme
