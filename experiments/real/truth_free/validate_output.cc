#include "experiments/real/truth_free/validate_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"
#include "experiments/real/truth_free/closure_output.h"
#include "experiments/real/truth_free/validate_json.h"
#include "experiments/real/truth_free/validate_words.h"

namespace rcme {
namespace {

const NumberFormat kTwoDigits{1.0, "", ".2g"};

// What a set says of one thing.
struct SetRow {
  const SetReport* set;
  std::string name, heading;  // in files; for people, who do not see it where this is empty
  std::string verdict, words;
  std::int64_t n = 0;
  double value = std::nan("");
  Interval interval{std::nan(""), std::nan("")};
  FaultCause cause = FaultCause::kNone;
  const TruthFreeTest* test = nullptr;  // null: it is none of the covariances
};

SetRow MakeCorrelationRow(const SetReport& set, const DistanceCorrelation& c) {
  SetRow row{&set, fmt::format("correlation_{:g}_to_{:g}_px", c.from_px, c.to_px),
             "",   CorrelationVerdict(c),
             "",   std::llround(c.num_products)};
  row.interval = c.difference;
  if (!IsKnown(c)) return row;
  row.value = c.correlation - c.twin_correlation;
  row.heading = fmt::format("residuals {:g} to {:g} px apart", c.from_px, c.to_px);
  row.words = fmt::format("{}: correlation {}", row.verdict, FormatRange(row.value, row.interval));
  return row;
}

std::vector<SetRow> MakeSetRows(const SetReport& set) {
  const ComparedMedians none{std::nan(""), {std::nan(""), std::nan("")}};
  std::vector<SetRow> rows;
  const auto add = [&](const std::string& name, const std::string& heading, const std::string& verdict,
                       const std::string& words, std::int64_t n, const auto& value,
                       FaultCause cause = FaultCause::kNone, const TruthFreeTest* test = nullptr) {
    rows.push_back({&set, name, heading, verdict, words, n, value.value, value.interval, cause, test});
  };
  add("covariances", "", VerdictName(set.covariances.verdict), "", set.num_answered, none,
      set.covariances.cause);
  for (const auto& [name, sd_deg] : {std::pair("rotation_sd_deg", set.rotation_sd_deg),
                                     std::pair("direction_sd_deg", set.direction_sd_deg)}) {
    if (!std::isnan(sd_deg)) add(name, "", "", "", set.num_answered, ComparedMedians{sd_deg, none.interval});
  }
  for (const TruthFreeTest& test : set.tests) {
    add(test.name, test.name, VerdictName(test.verdict), DescribeVerdict(test), test.num_values, test.ratio,
        test.cause, &test);
  }
  for (const DistanceCorrelation& c : set.correlations) rows.push_back(MakeCorrelationRow(set, c));
  const CalibrationReport& calibration = set.calibration;
  add("calibration", "calibration", FaultVerdict(calibration.verdict), DescribeCalibration(calibration),
      calibration.num_pairs, ComparedMedians{calibration.p_value, none.interval});
  for (const FaultReport& fault : calibration.faults) {
    add(FindFaultText(fault.fault).name, FindFaultText(fault.fault).words, FaultVerdict(fault.verdict),
        DescribeFault(fault), calibration.num_pairs, fault.joint);
  }
  add("noise_by_size", "noise by size", VerdictName(set.sizes.verdict), DescribeSizeTest(set.sizes),
      set.sizes.num_pairs, set.sizes.slope);
  add("sigma_px", "noise", VerdictName(set.sigma_verdict),
      fmt::format("sigma {} px, assumed {:g}: {}", FormatRange(set.sigma_px.value, set.sigma_px.interval),
                  set.assumed_sigma_px, VerdictName(set.sigma_verdict)),
      set.num_answered, set.sigma_px);
  return rows;
}

Estimate EstimateCoverage(const SharedMemberRate& coverage) { return {coverage.rate, coverage.interval}; }

// The simulation has no twins of its own.
Value AgainstTwins(const SetRow& row, Estimate estimate) {
  if (!IsBounded(estimate.interval)) {
    estimate.interval = {std::nan(""), std::nan("")};
    estimate.note = "too few for an interval";
  }
  return row.test && row.name != kSimulationTest ? Value(estimate) : Value();
}

std::string SetAsTable(const SetReport& report) {
  using R = const SetRow&;
  const NumberFormat percent{100.0, "%", ".0f"};
  std::vector<SetRow> rows = MakeSetRows(report);
  std::erase_if(rows, [](R row) { return row.heading.empty(); });
  const Table table = MakeTable<SetRow>(
      {{Column::Key("test"), [](R r) { return r.heading; }},
       {Column::Text("verdict"), [](R r) { return r.words; }},
       {Column::Count("n"), [](R r) { return r.n; }},
       {Column::Estimated("covered", percent),
        [](R r) { return r.test ? Value(EstimateCoverage(r.test->coverage)) : Value(); }},
       {Column::Estimated("over the twins", kTwoDigits),
        [](R r) {
          const bool is_known = r.test && r.test->verdict != TruthFreeVerdict::kNoData;
          return is_known ? AgainstTwins(r, {r.test->against_twins.value, r.test->against_twins.interval})
                          : Value();
        }},
       {Column::Estimated("twins covered", percent),
        [](R r) { return r.test ? AgainstTwins(r, EstimateCoverage(r.test->twin_coverage)) : Value(); }}},
      rows);
  std::string text = DescribeSet(report) + "\n" + RenderText(table);
  for (const std::string& advice : report.advice) text += FormatParagraph("  -> " + advice);
  return text + "\n";
}

}  // namespace

std::string ValidationAsTable(const std::vector<SetReport>& reports) {
  std::string text;
  for (const SetReport& report : reports) text += SetAsTable(report);
  return text + DescribeValidationColumns();
}

Table MakeValidationTable(const std::vector<SetReport>& reports) {
  using R = const SetRow&;
  std::vector<SetRow> rows;
  for (const SetReport& report : reports) std::ranges::copy(MakeSetRows(report), std::back_inserter(rows));
  const double none = std::nan("");
  return MakeTable<SetRow>(
      {{Column::Text("set"), [](R r) { return r.set->name; }},
       {Column::Count("pairs"), [](R r) { return r.set->num_pairs; }},
       {Column::Count("answered"), [](R r) { return r.set->num_answered; }},
       {Column::Text("test"), [](R r) { return r.name; }},
       {Column::Number("value"), [](R r) { return r.value; }},
       {{"lower,upper", ColumnType::kInterval}, [](R r) { return r.interval; }},
       {Column::Count("n"), [](R r) { return r.n; }},
       {Column::Number("coverage"), [&](R r) { return r.test ? r.test->coverage.rate : none; }},
       {Column::Number("twin_coverage"), [&](R r) { return r.test ? r.test->twin_coverage.rate : none; }},
       {Column::Text("verdict"), [](R r) { return r.verdict; }},
       {Column::Text("cause"), [](R r) { return CauseName(r.cause); }}},
      rows);
}

CommandResult MakeValidationResult(const std::vector<SetReport>& reports) {
  return MakeResult(ValidationAsTable(reports) + ClosuresAsTable(reports), kValidationFormat,
                    {{"nominal_variance", kNominalVariance}, {"nominal_correlation", kNominalCorrelation}},
                    MakeValidationTable(reports), MakeValidationParts(reports));
}

}  // namespace rcme
