#include "experiments/real/truth_free/validate_output.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/core/text/columns.h"
#include "experiments/core/text/field_text.h"
#include "experiments/core/text/json_output.h"

namespace rcme {
namespace {

std::string RangeText(double value, const Interval& interval) {
  return fmt::format("{:.2g} [{:.2g}, {:.2g}]", value, interval.lower, interval.upper);
}

// "74 % [62, 84]".
std::string CoverageText(const SharedMemberRate& coverage) {
  if (std::isnan(coverage.rate)) return "-";
  return fmt::format("{:.0f} % [{:.0f}, {:.0f}]", 100.0 * coverage.rate, 100.0 * coverage.interval.lower,
                     100.0 * coverage.interval.upper);
}

const char* CauseName(FaultCause cause) {
  switch (cause) {
    case FaultCause::kData:
      return "data";
    case FaultCause::kEstimator:
      return "estimator";
    case FaultCause::kBoth:
      return "both";
    case FaultCause::kNone:
      break;
  }
  return "";
}

// What a fault is of, as the end of a sentence; empty: nothing is said of it.
std::string CauseInWords(FaultCause cause, bool is_small) {
  switch (cause) {
    case FaultCause::kData:
      return "; the data: in simulation it is not";
    case FaultCause::kEstimator:
      return fmt::format("; the estimator's own covariance is too {}, in simulation too",
                         is_small ? "small" : "large");
    case FaultCause::kBoth:
      return "; in simulation too, and more so here";
    case FaultCause::kNone:
      break;
  }
  return "";
}

// "covariances: too small; the data: in simulation it is not (spatial_halves)".
std::string CovariancesInWords(const CovarianceVerdict& of) {
  const std::string text = std::string("covariances: ") + VerdictName(of.verdict);
  if (of.verdict == TruthFreeVerdict::kNoData) return text;
  return fmt::format("{}{} ({})", text, CauseInWords(of.cause, of.verdict == TruthFreeVerdict::kTooSmall),
                     fmt::join(of.tests, ", "));
}

std::string CorrelationName(const DistanceCorrelation& c) {
  return fmt::format("correlation_{:g}_to_{:g}_px", c.from_px, c.to_px);
}

bool IsKnown(const DistanceCorrelation& c) { return std::isfinite(c.difference.lower); }

std::string CorrelationVerdict(const DistanceCorrelation& c) {
  if (!IsKnown(c)) return "no data";
  if (c.difference.upper < kNominalCorrelation) return "holds";
  return c.difference.lower > kNominalCorrelation ? "correlated" : "undecided";
}

// "3 loops of images (2 of 3, 1 of 4)".
std::string LoopsText(const SetReport& report) {
  int sum = 0;
  std::string lengths;
  for (const auto& [length, count] : report.num_loops) {
    sum += count;
    lengths += fmt::format("{}{} of {}", lengths.empty() ? "" : ", ", count, length);
  }
  return fmt::format("{} loops of images{}", sum, sum > 0 ? " (" + lengths + ")" : "");
}

// In files a fault that is found is "wrong", whichever way.
std::string FaultVerdict(TruthFreeVerdict verdict) {
  const bool is_fault = verdict == TruthFreeVerdict::kTooSmall || verdict == TruthFreeVerdict::kTooLarge;
  return is_fault ? "wrong" : VerdictName(verdict);
}

// "focal length 0.2 %, ...".
std::string NominalFaults() {
  std::string words;
  for (size_t j = 0; j < kNumNamedFaults; ++j) {
    const CameraFaultText& text = TextOf(kCameraFaults[j]);
    words += fmt::format("{}{} {:g}{}{}", words.empty() ? "" : ", ", text.words, text.per_unit * text.nominal,
                         *text.unit ? " " : "", text.unit);
  }
  return words;
}

std::string SetAsTable(const SetReport& report) {
  std::string text = fmt::format("{}: {} pairs, {} answered, {}\n", report.name, report.num_pairs,
                                 report.num_answered, LoopsText(report));
  text += CovariancesInWords(report.covariances) + "\n";
  std::vector<std::vector<std::string>> rows = {
      {"test", "verdict", "n", "covered", "over the twins", "twins covered"}};
  for (const TruthFreeTest& test : report.tests) {
    const bool is_of_pairs = test.name != kSimulationTest;
    rows.push_back({test.name, VerdictInWords(test), std::to_string(test.num_values),
                    CoverageText(test.coverage),
                    is_of_pairs && test.verdict != TruthFreeVerdict::kNoData
                        ? RangeText(test.against_twins.value, test.against_twins.interval)
                        : "",
                    is_of_pairs ? CoverageText(test.twin_coverage) : ""});
  }
  for (const DistanceCorrelation& c : report.correlations) {
    if (!IsKnown(c)) continue;
    rows.push_back({fmt::format("residuals {:g} to {:g} px apart", c.from_px, c.to_px),
                    fmt::format("{}: correlation {}", CorrelationVerdict(c),
                                RangeText(c.correlation - c.twin_correlation, c.difference)),
                    fmt::format("{:.0f}", c.num_products), "", ""});
  }
  rows.push_back({"calibration", CalibrationInWords(report.calibration),
                  std::to_string(report.calibration.num_pairs), "", ""});
  for (const FaultReport& fault : report.calibration.faults) {
    rows.push_back({TextOf(fault.fault).words, FaultInWords(fault),
                    std::to_string(report.calibration.num_pairs), "", ""});
  }
  rows.push_back(
      {"noise by size", SizeInWords(report.sizes), std::to_string(report.sizes.num_pairs), "", ""});
  rows.push_back({"noise",
                  fmt::format("sigma {} px, assumed {:g}: {}",
                              RangeText(report.sigma_px.value, report.sigma_px.interval),
                              report.assumed_sigma_px, VerdictName(report.sigma_verdict)),
                  std::to_string(report.num_answered), "", ""});
  text += FormatColumns(rows);
  for (const std::string& advice : report.advice) text += "  -> " + advice + "\n";
  return text + "\n";
}

}  // namespace

std::string VerdictInWords(const TruthFreeTest& test) {
  const ComparedMedians& ratio = test.ratio;
  const std::string range = RangeText(ratio.value, ratio.interval);
  switch (test.verdict) {
    case TruthFreeVerdict::kTooSmall:
      return fmt::format("too small by {} in variance{}", range, CauseInWords(test.cause, true));
    case TruthFreeVerdict::kTooLarge:
      return fmt::format(
          "too large by {} in variance{}",
          RangeText(1.0 / ratio.value, {1.0 / ratio.interval.upper, 1.0 / ratio.interval.lower}),
          CauseInWords(test.cause, false));
    case TruthFreeVerdict::kUndecided:
      if (std::isnan(test.units_needed)) return fmt::format("undecided: {}; it takes five at least", range);
      if (test.units_needed > test.num_units)
        return fmt::format("undecided: {}; some {:.2g} in place of {} would decide it", range,
                           test.units_needed, test.num_units);
      return fmt::format("undecided: {}; within {:g} of one it would be by the approximation", range,
                         kApproximation);
    case TruthFreeVerdict::kNoData:
      return VerdictName(test.verdict);
    default:
      return fmt::format("{}: {}", VerdictName(test.verdict), range);
  }
}

std::string ValidationAsTable(const std::vector<SetReport>& reports) {
  std::string text;
  for (const SetReport& report : reports) text += SetAsTable(report);
  return text +
         fmt::format(
             "Covariances as they are stated against the differences of two halves of the matches (5 degrees "
             "of freedom), the closure\n"
             "of rotations around loops of images (3) and of directions around three (1): medians over that "
             "of chi-square; 1 is right.\n"
             "simulation: the answers to simulated twins (the same matches at the estimated geometry with "
             "independent noise anew)\n"
             "against the motion that they were made of; what is too small there is the estimator's own. "
             "Intervals 95 %: bootstrap\n"
             "over pairs or loops; those of coverage know which pairs share an image. holds: the whole "
             "interval within [1/{0:g}, {0:g}],\n"
             "and coverage accordingly. Correlations are beyond those of the twins; nominal below {1:g}.\n"
             "Camera faults: self-calibration over all pairs of one camera, each beside the others; the "
             "intervals of a set hold together\n"
             "in 95 % of sets, by the scatter of pairs. One is named only if the test of all is rejected, "
             "the "
             "steps converge, and correcting\n"
             "what is named leaves nothing. A readout time is asked of pairs that state seconds_between. "
             "Nominal: {2}.\n"
             "Noise by size: slope of log r^2 on log noise^2 over that of the twins; nominal within "
             "{3:g} of one.\n",
             kNominalVariance, kNominalCorrelation, NominalFaults(), kNominalSlope);
}

std::string ValidationAsCsv(const std::vector<SetReport>& reports) {
  std::string text = "set,pairs,answered,test,value,lower,upper,n,coverage,twin_coverage,verdict,cause\n";
  const auto row = [&](const SetReport& report, const std::string& test, double value,
                       const Interval& interval, double n, double coverage, double twin_coverage,
                       const std::string& verdict, const char* cause = "") {
    text += fmt::format("{},{},{},{},{},{},{},{:.0f},{},{},{},{}\n", CsvField(report.name), report.num_pairs,
                        report.num_answered, test, CsvNumber(value), CsvFinite(interval.lower),
                        CsvFinite(interval.upper), n, CsvNumber(coverage), CsvNumber(twin_coverage), verdict,
                        cause);
  };
  const double none = std::nan("");
  for (const SetReport& report : reports) {
    row(report, "covariances", none, {none, none}, report.num_answered, none, none,
        VerdictName(report.covariances.verdict), CauseName(report.covariances.cause));
    for (const TruthFreeTest& test : report.tests) {
      row(report, test.name, test.ratio.value, test.ratio.interval, test.num_values, test.coverage.rate,
          test.twin_coverage.rate, VerdictName(test.verdict), CauseName(test.cause));
    }
    for (const DistanceCorrelation& c : report.correlations) {
      row(report, CorrelationName(c), IsKnown(c) ? c.correlation - c.twin_correlation : none, c.difference,
          c.num_products, none, none, CorrelationVerdict(c));
    }
    row(report, "calibration", report.calibration.p_value, {none, none}, report.calibration.num_pairs, none,
        none, FaultVerdict(report.calibration.verdict));
    for (const FaultReport& fault : report.calibration.faults) {
      row(report, TextOf(fault.fault).name, fault.joint.value, fault.joint.interval,
          report.calibration.num_pairs, none, none, FaultVerdict(fault.verdict));
    }
    row(report, "noise_by_size", report.sizes.slope.value, report.sizes.slope.interval,
        report.sizes.num_pairs, none, none, VerdictName(report.sizes.verdict));
    row(report, "sigma_px", report.sigma_px.value, report.sigma_px.interval, report.num_answered, none, none,
        VerdictName(report.sigma_verdict));
  }
  return text;
}

std::string ValidationAsJson(const std::vector<SetReport>& reports) {
  const auto interval_of = [](const Interval& interval) {
    return nlohmann::ordered_json{JsonNumber(interval.lower), JsonNumber(interval.upper)};
  };
  const auto pooled = [&](const PooledParameter& of) {
    return nlohmann::ordered_json{{"value", JsonNumber(of.value)},
                                  {"interval", interval_of(of.interval)},
                                  {"effective_pairs", JsonNumber(of.effective_n)}};
  };
  const auto compared = [&](const ComparedMedians& of) {
    return nlohmann::ordered_json{{"ratio", JsonNumber(of.value)}, {"interval", interval_of(of.interval)}};
  };
  nlohmann::ordered_json json = {{"nominal_variance", kNominalVariance},
                                 {"nominal_correlation", kNominalCorrelation},
                                 {"sets", nlohmann::ordered_json::array()}};
  for (const SetReport& report : reports) {
    nlohmann::ordered_json set = {{"name", report.name},
                                  {"pairs", report.num_pairs},
                                  {"answered", report.num_answered},
                                  {"loops", nlohmann::ordered_json::object()},
                                  {"assumed_sigma_px", JsonNumber(report.assumed_sigma_px)},
                                  {"sigma_px", JsonNumber(report.sigma_px.value)},
                                  {"sigma_px_interval", interval_of(report.sigma_px.interval)},
                                  {"sigma_verdict", VerdictName(report.sigma_verdict)},
                                  {"covariances",
                                   {{"verdict", VerdictName(report.covariances.verdict)},
                                    {"cause", CauseName(report.covariances.cause)},
                                    {"tests", report.covariances.tests}}},
                                  {"tests", nlohmann::ordered_json::array()},
                                  {"correlations", nlohmann::ordered_json::array()},
                                  {"calibration",
                                   {{"pairs", report.calibration.num_pairs},
                                    {"p_value", JsonNumber(report.calibration.p_value)},
                                    {"dispersion", JsonNumber(report.calibration.dispersion)},
                                    {"verdict", FaultVerdict(report.calibration.verdict)}}},
                                  {"camera_faults", nlohmann::ordered_json::array()},
                                  {"noise_by_size",
                                   {{"pairs", report.sizes.num_pairs},
                                    {"slope", pooled(report.sizes.slope)},
                                    {"verdict", VerdictName(report.sizes.verdict)}}},
                                  {"advice", report.advice}};
    for (const TruthFreeTest& test : report.tests) {
      set["tests"].push_back({{"test", test.name},
                              {"degrees_of_freedom", test.degrees_of_freedom},
                              {"n", test.num_values},
                              {"coverage", JsonNumber(test.coverage.rate)},
                              {"coverage_interval", interval_of(test.coverage.interval)},
                              {"twin_coverage", JsonNumber(test.twin_coverage.rate)},
                              {"ratio", JsonNumber(test.ratio.value)},
                              {"interval", interval_of(test.ratio.interval)},
                              {"in_simulation", compared(test.in_simulation)},
                              {"against_twins", compared(test.against_twins)},
                              {"verdict", VerdictName(test.verdict)},
                              {"cause", CauseName(test.cause)},
                              {"units", test.num_units},
                              {"units_needed", JsonNumber(test.units_needed)}});
    }
    for (const DistanceCorrelation& c : report.correlations) {
      set["correlations"].push_back({{"from_px", c.from_px},
                                     {"to_px", c.to_px},
                                     {"n", c.num_products},
                                     {"correlation", JsonNumber(c.correlation)},
                                     {"twin_correlation", JsonNumber(c.twin_correlation)},
                                     {"difference_interval", interval_of(c.difference)},
                                     {"verdict", CorrelationVerdict(c)}});
    }
    for (const auto& [length, count] : report.num_loops) set["loops"][std::to_string(length)] = count;
    for (const FaultReport& fault : report.calibration.faults) {
      set["camera_faults"].push_back({{"fault", TextOf(fault.fault).name},
                                      {"nominal", TextOf(fault.fault).nominal},
                                      {"beside_others", pooled(fault.joint)},
                                      {"alone", pooled(fault.alone)},
                                      {"twins", pooled(fault.twins)},
                                      {"verdict", FaultVerdict(fault.verdict)},
                                      {"in_words", FaultInWords(fault)}});
    }
    json["sets"].push_back(std::move(set));
  }
  return JsonText(kValidationFormat, json);
}

}  // namespace rcme
