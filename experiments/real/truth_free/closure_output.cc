#include "experiments/real/truth_free/closure_output.h"

#include "experiments/core/table/render_table.h"
#include "experiments/core/table/table.h"

namespace rcme {
namespace {

std::string DescribeShared(SharedErrors shared) {
  return shared == SharedErrors::kIgnored ? "ignored" : "allowed for";
}

std::vector<ColumnOf<LengthClosure>> ClosureColumns() {
  return {
      {Column::Count("images"),
       [](const LengthClosure& r) { return static_cast<std::int64_t>(r.num_images); }},
      {{.name = "shared_errors", .heading = "shared errors"},
       [](const LengthClosure& r) { return DescribeShared(r.shared); }},
      {Column::Text("of"), [](const LengthClosure& r) { return r.is_of_twins ? "twins" : "pairs"; }},
      {Column::Count("loops"), [](const LengthClosure& r) { return r.num_loops; }},
      {Column::Count("apart"), [](const LengthClosure& r) { return r.num_apart; }},
      {Column::Estimated("covered", {100.0, "%", ".0f"}), [](const LengthClosure& r) { return r.covered; }},
      {{.name = "rms_over_sd",
        .type = ColumnType::kEstimate,
        .format = {1.0, "", ".2f"},
        .heading = "rms over sd"},
       [](const LengthClosure& r) { return r.rms_over_sd; }}};
}

// One entry of a set, for a table of all sets.
struct SetClosure {
  const SetReport* set;
  const LengthClosure* closure;
};

}  // namespace

std::string ClosuresAsTable(const std::vector<SetReport>& reports) {
  std::string text;
  for (const SetReport& report : reports) {
    if (report.closures.empty()) continue;
    text += FormatParagraph(report.name + ": closure of rotations by the number of images in a loop") + "\n" +
            RenderText(MakeTable<LengthClosure>(ClosureColumns(), report.closures)) + "\n";
  }
  if (text.empty()) return text;
  return text +
         FormatParagraph(
             "covered: share of the loops within the 95 % region of the covariances, propagated around "
             "the loop; rms over sd: root mean square of the closure over its standard deviation, 1 is "
             "right. shared errors: whether the region allows for key points that several pairs of the "
             "loop share. apart: loops of which no two share an image. Intervals 95 %.");
}

Table MakeClosureTable(const std::vector<SetReport>& reports, const std::string& estimator) {
  std::vector<SetClosure> rows;
  for (const SetReport& report : reports) {
    for (const LengthClosure& closure : report.closures) rows.push_back({&report, &closure});
  }
  std::vector<ColumnOf<SetClosure>> columns = {
      {Column::Text("set"), [](const SetClosure& row) { return row.set->name; }}};
  if (!estimator.empty())
    columns.push_back({Column::Text("estimator"), [&](const SetClosure&) { return estimator; }});
  for (const ColumnOf<LengthClosure>& of_closure : ClosureColumns())
    columns.push_back({of_closure.column,
                       [value = of_closure.value](const SetClosure& row) { return value(*row.closure); }});
  return WithIntervalColumns(MakeTable<SetClosure>(columns, rows));
}

}  // namespace rcme
