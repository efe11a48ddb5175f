#include "experiments/statistics/forecast_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "experiments/core/table/table.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMaxCurvePoints = 400;  // of a risk-coverage curve in a file

Estimate WithInterval(const ClusteredEstimate& estimate) { return {estimate.value, estimate.interval}; }

Estimate Rate(std::int64_t count, std::int64_t n, const Interval& interval) {
  return {static_cast<double>(count) / static_cast<double>(n), interval};
}

bool IsOfPopulation(const std::vector<ForecastMeasures>& measures) {
  return !measures.empty() && measures.front().is_of_population;
}

// Without answers there are only counts.
Table MakeMeasureTable(const std::vector<ForecastMeasures>& measures, const std::string& by) {
  const NumberFormat four{1.0, "", ".4f"}, three{1.0, "", ".3f"}, two{1.0, "", ".2f"};
  const bool is_of_population = IsOfPopulation(measures);
  const bool shows_without =
      std::ranges::any_of(measures, [](const ForecastMeasures& m) { return m.num_without > 0; });
  Table table;
  if (!by.empty()) table.AddColumns({Column::Key(by)});
  table.AddColumns(
      {Column::Key("estimator"), Column::Key("P from"), Column::Count("n"), Column::Count("refused")});
  if (shows_without) table.AddColumns({Column::Count("not judged")});
  table.AddColumns(
      {Column::Number("mean P", four), Column::Estimated("failed", four), Column::Estimated("Brier", four),
       is_of_population ? Column::Estimated("ECE", four) : Column::Number("ECE", four),
       Column::Number("if right", four), Column::Number("p", {1.0, "", ".2g"}),
       Column::Estimated("slope", two), Column::Estimated("AUC", three), Column::Estimated("AURC", four),
       Column::Estimated(fmt::format("failed at P <= {}", kSureBelow), kPercent),
       Column::Estimated("kept", kPercent)});
  for (const ForecastMeasures& m : measures) {
    std::vector<Value>& row = table.rows.emplace_back();
    if (!by.empty()) row.emplace_back(m.group);
    row.insert(row.end(), {m.estimator, Name(m.source), m.n, m.num_refused});
    if (shows_without) row.emplace_back(m.num_without);
    const MeasuredCalibrationError& error = m.error_of_equal_width;
    if (m.n > 0)
      row.insert(row.end(), {m.mean_probability, WithInterval(m.failure), WithInterval(m.brier),
                             is_of_population ? Value(Estimate{error.value, m.interval_of_equal_width})
                                              : Value(error.value),
                             error.mean_if_calibrated, error.p_value, WithInterval(m.line.slope),
                             Estimate{m.area.value, m.area.interval}, WithInterval(m.risk_coverage_area),
                             Rate(m.num_sure_failed, m.num_sure, m.sure_failed_interval),
                             Rate(m.num_sure, m.num_trials(), m.sure_interval)});
    row.resize(table.columns.size());
  }
  return table;
}

// The same for files: a row per estimator and level.
Table MakeForecastFileTable(const std::vector<ForecastMeasures>& measures) {
  using M = const ForecastMeasures&;
  std::vector<ColumnOf<ForecastMeasures>> columns = {
      {Column::Key("group"), [](M m) { return m.group; }},
      {Column::Key("estimator"), [](M m) { return m.estimator; }},
      {Column::Text("source"), [](M m) { return Name(m.source); }},
      {Column::Count("n"), [](M m) { return m.n; }},
      {Column::Count("refused"), [](M m) { return m.num_refused; }}};
  const auto add = [&](const std::string& name, const std::function<Estimate(M)>& measure) {
    columns.push_back({Column::Estimated(name), [=](M m) { return m.n > 0 ? measure(m) : Estimate(); }});
  };
  add("mean_probability", [](M m) { return Estimate{m.mean_probability}; });
  add("failure", [](M m) { return WithInterval(m.failure); });
  add("brier", [](M m) { return WithInterval(m.brier); });
  add("log_score", [](M m) { return WithInterval(m.log_score); });
  add("miscalibration", [](M m) { return Estimate{m.parts.miscalibration}; });
  add("miscalibration_p_value", [](M m) { return Estimate{m.check.p_value}; });
  add("calibration_error", [](M m) {
    const double value = m.error_of_equal_width.value;
    return m.is_of_population ? Estimate{value, m.interval_of_equal_width} : Estimate{value};
  });
  add("calibration_slope", [](M m) { return WithInterval(m.line.slope); });
  add("area_under_curve", [](M m) { return Estimate{m.area.value, m.area.interval}; });
  add("risk_coverage_area", [](M m) { return WithInterval(m.risk_coverage_area); });
  add("sure_failed", [](M m) { return Rate(m.num_sure_failed, m.num_sure, m.sure_failed_interval); });
  add("sure", [](M m) { return Rate(m.num_sure, m.num_trials(), m.sure_interval); });
  return WithIntervalColumns(MakeTable(columns, measures));
}

Json AsJson(double value, double standard_error, const Interval& interval) {
  return {{"value", JsonNumber(value)},
          {"standard_error", JsonNumber(standard_error)},
          {"interval", RenderJson(interval)}};
}
Json AsJson(const ClusteredEstimate& e) { return AsJson(e.value, e.standard_error, e.interval); }

Json AsJson(const MeasuredCalibrationError& error) {
  return {{"value", JsonNumber(error.value)},
          {"mean_if_calibrated", JsonNumber(error.mean_if_calibrated)},
          {"upper_if_calibrated", JsonNumber(error.upper_if_calibrated)},
          {"p_value", JsonNumber(error.p_value)}};
}

// Includes the interval if there is one.
Json ErrorAsJson(const ForecastMeasures& m) {
  Json json = AsJson(m.error_of_equal_width);
  if (m.is_of_population) json["interval"] = RenderJson(m.interval_of_equal_width);
  return json;
}

Json RateAsJson(std::int64_t count, std::int64_t n, const Interval& interval) {
  const double value = n > 0 ? static_cast<double>(count) / static_cast<double>(n) : std::nan("");
  return RenderJson(Estimate{.value = value, .interval = interval, .n = n});
}

Json CurveAsJson(const ForecastMeasures& m) {
  Json steps = Json::array();
  for (const ReliabilityStep& s : m.curve) {
    steps.push_back({{"first", s.first},
                     {"last", s.last},
                     {"recalibrated", s.recalibrated},
                     {"n", s.n},
                     {"failed", s.num_happened}});
  }
  return steps;
}

Json BandAsJson(const ForecastMeasures& m) {
  Json band = Json::array();
  for (const ConsistencyPoint& p : m.check.band)
    band.push_back({{"probability", p.probability}, {"lower", p.lower}, {"upper", p.upper}});
  return band;
}

Json BinsAsJson(const ForecastMeasures& m) {
  Json bins = Json::array();
  for (const CalibrationBin& b : m.bins) {
    bins.push_back({{"least", b.least},
                    {"greatest", b.greatest},
                    {"mean_probability", b.mean_probability},
                    {"failure", RateAsJson(b.num_happened, b.n, b.interval)}});
  }
  return bins;
}

// Returns at most some hundred points, evenly spaced along the curve, including its ends. A null
// `probability` means that refusals are included.
Json RiskCoverageAsJson(const ForecastMeasures& m) {
  Json points = Json::array();
  const size_t size = m.risk_coverage.size(), count = std::min(size, kMaxCurvePoints);
  for (size_t k = 0; k < count; ++k) {
    const RiskCoveragePoint& p = m.risk_coverage[count == 1 ? 0 : k * (size - 1) / (count - 1)];
    points.push_back({{"probability", JsonNumber(-p.threshold)}, {"coverage", p.coverage}, {"risk", p.risk}});
  }
  return points;
}

Json RenderForecastEntry(const ForecastMeasures& m) {
  Json entry = {{"estimator", m.estimator}, {"group", m.group},        {"source", Name(m.source)}, {"n", m.n},
                {"refused", m.num_refused}, {"without", m.num_without}};
  if (m.is_of_population) entry["intervals_of"] = "population";
  if (m.n == 0) return entry;
  entry.update(Json{{"mean_probability", m.mean_probability},
                    {"failure", AsJson(m.failure)},
                    {"brier", AsJson(m.brier)},
                    {"log_score", AsJson(m.log_score)},
                    {"miscalibration", m.parts.miscalibration},
                    {"miscalibration_if_calibrated", m.check.miscalibration_if_calibrated},
                    {"miscalibration_p_value", m.check.p_value},
                    {"discrimination", m.parts.discrimination},
                    {"uncertainty", m.parts.uncertainty},
                    {"calibration_error", ErrorAsJson(m)},
                    {"calibration_error_equal_mass", AsJson(m.error_of_equal_mass)},
                    {"calibration_intercept", AsJson(m.line.intercept)},
                    {"calibration_slope", AsJson(m.line.slope)},
                    {"area_under_curve", AsJson(m.area.value, m.area.standard_error, m.area.interval)},
                    {"risk_coverage_area", AsJson(m.risk_coverage_area)},
                    {"sure_failed", RateAsJson(m.num_sure_failed, m.num_sure, m.sure_failed_interval)},
                    {"sure", RateAsJson(m.num_sure, m.num_trials(), m.sure_interval)},
                    {"curve", CurveAsJson(m)},
                    {"band", BandAsJson(m)},
                    {"bins", BinsAsJson(m)},
                    {"histogram", m.histogram},
                    {"risk_coverage", RiskCoverageAsJson(m)}});
  return entry;
}

std::string ForecastsAsJson(const std::string& study, const std::string& by,
                            const std::vector<ForecastMeasures>& measures) {
  Json json = {{"study", study},
               {"by", by},
               {"sure_below", kSureBelow},
               {"histogram_edges", HistogramEdges()},
               {"entries", Json::array()}};
  json["rows"] = RenderJson(MakeForecastFileTable(measures));
  for (const ForecastMeasures& m : measures) json["entries"].push_back(RenderForecastEntry(m));
  return JsonText(kReliabilityFormat, json);
}

}  // namespace

std::string ForecastsAsTable(const std::vector<ForecastMeasures>& measures, const std::string& by) {
  const bool is_of_population = IsOfPopulation(measures);
  std::string text =
      "Probability of failure P, of the answers whose truth is known\n\n" +
      RenderText(MakeMeasureTable(measures, by)) + "\n" +
      FormatParagraph(fmt::format(
          "failed, Brier (mean (P - y)^2), slope (1: right, below: too sure), AUC, AURC: 95 % intervals, {}. "
          "ECE: {} bins of equal width; if right: its mean if P were right; p: the share of samples of such "
          "that reach it. AURC: mean failure rate over all shares of trials answered, surest first, a "
          "refusal as the last and a failure; kept: trials at P <= {}, of all; {}.",
          is_of_population
              ? "for the population that the conditions are a sample of, the trials of a draw as one cluster"
              : "the trials of a scene as one cluster",
          kNumCalibrationBins, kSureBelow,
          is_of_population ? "such intervals" : "exact intervals, or over scenes if scenes are repeated"));
  if (std::ranges::find(measures, ForecastSource::kInlierShare, &ForecastMeasures::source) !=
      measures.end()) {
    text += FormatParagraph(
        "P from inlier_share: the estimator states none; its share of inliers, recalibrated by isotonic "
        "regression on the other half of the scenes of this run, stands in; it is not judged by p.");
  }
  return text;
}

CommandResult MakeForecastResult(const std::string& study, const std::string& by,
                                 const std::vector<ForecastMeasures>& measures) {
  return {ForecastsAsTable(measures, by), MakeForecastFileTable(measures),
          ForecastsAsJson(study, by, measures)};
}

}  // namespace rcme
