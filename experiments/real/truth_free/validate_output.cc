#include "experiments/real/truth_free/validate_output.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/json_output.h"
#include "experiments/real/truth_free/closure_output.h"
#include "experiments/real/truth_free/validate.h"
#include "experiments/real/truth_free/validate_words.h"

namespace rcme {
namespace {

// A part of a set: a test, a fault, ...
template <typename Part>
struct PartOfSet {
  const SetReport* set;
  const Part* part;
};
template <typename Part>
using PartColumns = std::vector<ColumnOf<PartOfSet<Part>>>;

// A row for each part of each set, after a column for the set.
template <typename Part, typename ListParts>
Table MakeTableOfParts(PartColumns<Part> columns, const std::vector<SetReport>& reports,
                       ListParts list_parts) {
  columns.insert(columns.begin(), {Column::Key("set"), [](const auto& row) { return row.set->name; }});
  std::vector<PartOfSet<Part>> rows;
  for (const SetReport& report : reports) {
    for (const Part& part : list_parts(report)) rows.push_back({&report, &part});
  }
  return MakeTable(columns, rows);
}

// A number and its interval.
template <typename Part, typename Measured>
void AddMeasured(const std::string& name, Measured Part::*member, double Measured::*value,
                 PartColumns<Part>* columns) {
  using P = const PartOfSet<Part>&;
  columns->push_back({Column::Number(name), [=](P of) { return of.part->*member.*value; }});
  columns->push_back({Column::Bounds(name), [=](P of) { return (of.part->*member).interval; }});
}

// The parameter, its interval, and as how many pairs it counts.
void AddPooled(const std::string& name, PooledParameter FaultReport::*member,
               PartColumns<FaultReport>* columns) {
  AddMeasured(name, member, &PooledParameter::value, columns);
  columns->push_back({Column::Number(name + "_effective_pairs"),
                      [=](const auto& of) { return (of.part->*member).effective_n; }});
}

std::vector<ColumnOf<SetReport>> MakeSetColumns() {
  using S = const SetReport&;
  return {
      {Column::Key("set"), [](S s) { return s.name; }},
      {Column::Count("pairs"), [](S s) { return s.num_pairs; }},
      {Column::Count("answered"), [](S s) { return s.num_answered; }},
      {Column::Text("covariances"), [](S s) { return VerdictName(s.covariances.verdict); }},
      {Column::Text("cause"), [](S s) { return CauseName(s.covariances.cause); }},
      {Column::Text("by_tests"), [](S s) { return fmt::format("{}", fmt::join(s.covariances.tests, " ")); }},
      {Column::Number("rotation_sd_deg"), [](S s) { return s.rotation_sd_deg; }},
      {Column::Number("direction_sd_deg"), [](S s) { return s.direction_sd_deg; }},
      {Column::Number("assumed_sigma_px"), [](S s) { return s.assumed_sigma_px; }},
      {Column::Number("sigma_px"), [](S s) { return s.sigma_px.value; }},
      {Column::Bounds("sigma_px"), [](S s) { return s.sigma_px.interval; }},
      {Column::Text("sigma_verdict"), [](S s) { return VerdictName(s.sigma_verdict); }},
      {Column::Count("calibration_pairs"), [](S s) { return s.calibration.num_pairs; }},
      {Column::Number("calibration_p_value"), [](S s) { return s.calibration.p_value; }},
      {Column::Number("calibration_dispersion"), [](S s) { return s.calibration.dispersion; }},
      {Column::Text("calibration_verdict"), [](S s) { return FaultVerdict(s.calibration.verdict); }},
      {Column::Count("size_pairs"), [](S s) { return s.sizes.num_pairs; }},
      {Column::Number("size_slope"), [](S s) { return s.sizes.slope.value; }},
      {Column::Bounds("size_slope"), [](S s) { return s.sizes.slope.interval; }},
      {Column::Number("size_slope_effective_pairs"), [](S s) { return s.sizes.slope.effective_n; }},
      {Column::Text("size_verdict"), [](S s) { return VerdictName(s.sizes.verdict); }}};
}

using LoopCount = std::pair<const size_t, int>;  // images, loops of so many
PartColumns<LoopCount> MakeLoopColumns() {
  using L = const PartOfSet<LoopCount>&;
  return {{Column::Count("images"), [](L l) { return static_cast<std::int64_t>(l.part->first); }},
          {Column::Count("loops"), [](L l) { return l.part->second; }}};
}

PartColumns<TruthFreeTest> MakeTestColumns() {
  using T = const PartOfSet<TruthFreeTest>&;
  PartColumns<TruthFreeTest> columns = {
      {Column::Key("test"), [](T t) { return t.part->name; }},
      {Column::Count("degrees_of_freedom"), [](T t) { return t.part->degrees_of_freedom; }},
      {Column::Count("n"), [](T t) { return t.part->num_values; }}};
  AddMeasured("coverage", &TruthFreeTest::coverage, &SharedMemberRate::rate, &columns);
  AddMeasured("twin_coverage", &TruthFreeTest::twin_coverage, &SharedMemberRate::rate, &columns);
  AddMeasured("ratio", &TruthFreeTest::ratio, &ComparedMedians::value, &columns);
  AddMeasured("in_simulation", &TruthFreeTest::in_simulation, &ComparedMedians::value, &columns);
  AddMeasured("against_twins", &TruthFreeTest::against_twins, &ComparedMedians::value, &columns);
  columns.push_back({Column::Text("verdict"), [](T t) { return VerdictName(t.part->verdict); }});
  columns.push_back({Column::Text("cause"), [](T t) { return CauseName(t.part->cause); }});
  columns.push_back({Column::Count("units"), [](T t) { return t.part->num_units; }});
  columns.push_back({Column::Number("units_needed"), [](T t) { return t.part->units_needed; }});
  return columns;
}

PartColumns<DistanceCorrelation> MakeCorrelationColumns() {
  using C = const PartOfSet<DistanceCorrelation>&;
  return {{Column::Number("from_px"), [](C c) { return c.part->from_px; }},
          {Column::Number("to_px"), [](C c) { return c.part->to_px; }},
          {Column::Number("n"), [](C c) { return c.part->num_products; }},
          {Column::Number("correlation"), [](C c) { return c.part->correlation; }},
          {Column::Number("twin_correlation"), [](C c) { return c.part->twin_correlation; }},
          {Column::Bounds("difference"), [](C c) { return c.part->difference; }},
          {Column::Text("verdict"), [](C c) { return CorrelationVerdict(*c.part); }}};
}

PartColumns<FaultReport> MakeFaultColumns() {
  using F = const PartOfSet<FaultReport>&;
  PartColumns<FaultReport> columns = {
      {Column::Key("fault"), [](F f) { return FindFaultText(f.part->fault).name; }},
      {Column::Number("nominal"), [](F f) { return FindFaultText(f.part->fault).nominal; }}};
  AddPooled("beside_others", &FaultReport::joint, &columns);
  AddPooled("alone", &FaultReport::alone, &columns);
  AddPooled("twins", &FaultReport::twins, &columns);
  columns.push_back({Column::Text("verdict"), [](F f) { return FaultVerdict(f.part->verdict); }});
  columns.push_back({Column::Text("in_words"), [](F f) { return DescribeFault(*f.part); }});
  return columns;
}

PartColumns<std::string> MakeAdviceColumns() {
  return {{Column::Text("advice"), [](const PartOfSet<std::string>& a) { return *a.part; }}};
}

// The tables of the JSON document: the sets, and one each of their loops, tests, correlations, closures,
// camera faults and advice.
std::vector<NamedTable> MakeValidationParts(const std::vector<SetReport>& reports) {
  return {{"sets", MakeTable(MakeSetColumns(), reports)},
          {"loops", MakeTableOfParts(
                        MakeLoopColumns(), reports,
                        [](const SetReport& set) -> const auto& { return set.num_loops; })},
          {"tests",
           MakeTableOfParts(
               MakeTestColumns(), reports, [](const SetReport& set) -> const auto& { return set.tests; })},
          {"correlations", MakeTableOfParts(
                               MakeCorrelationColumns(), reports,
                               [](const SetReport& set) -> const auto& { return set.correlations; })},
          {"closures", MakeClosureTable(reports)},
          {"camera_faults", MakeTableOfParts(
                                MakeFaultColumns(), reports,
                                [](const SetReport& set) -> const auto& { return set.calibration.faults; })},
          {"advice", MakeTableOfParts(
                         MakeAdviceColumns(), reports,
                         [](const SetReport& set) -> const auto& { return set.advice; })}};
}

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
  row.interval = {std::max(c.difference.lower, -2.0), std::min(c.difference.upper, 2.0)};
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
