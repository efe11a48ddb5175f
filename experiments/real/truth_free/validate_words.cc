#include "experiments/real/truth_free/validate_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "experiments/core/text/columns.h"
#include "experiments/core/text/pick_name.h"

namespace rcme {
namespace {

// Of a ratio without an interval (stats/median_ratio.h).
std::string DescribeTooFew(const TruthFreeTest& test) {
  return fmt::format("the variances' ratio, {:.2g} here, cannot be told from {} {}: it takes {} at least",
                     test.ratio.value, test.num_units,
                     test.num_units == 1 ? "pair or loop" : "pairs or loops", kLeastUnitsOfRatio);
}

// What a fault is of, as the end of a sentence; empty: nothing is said of it.
std::string DescribeCause(FaultCause cause, bool is_small) {
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
std::string DescribeCovariances(const CovarianceVerdict& of) {
  const std::string text = std::string("covariances: ") + VerdictName(of.verdict);
  if (of.verdict == TruthFreeVerdict::kNoData) return text;
  return fmt::format("{}{} ({})", text, DescribeCause(of.cause, of.verdict == TruthFreeVerdict::kTooSmall),
                     fmt::join(of.tests, ", "));
}

// Printed beside the coverage, because a region that is wide enough always covers.
std::string DescribeSharpness(const SetReport& report) {
  if (std::isnan(report.rotation_sd_deg)) return "";
  return FormatParagraph(fmt::format("stated sd (median): {:.2g} deg of rotation, {:.2g} deg of direction",
                                     report.rotation_sd_deg, report.direction_sd_deg));
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

// "focal length 0.2 %, ...".
std::string NominalFaults() {
  std::string words;
  for (size_t j = 0; j < kNumNamedFaults; ++j) {
    const CameraFaultText& text = FindFaultText(kCameraFaults[j]);
    words += fmt::format("{}{} {:g}{}{}", words.empty() ? "" : ", ", text.words, text.per_unit * text.nominal,
                         *text.unit ? " " : "", text.unit);
  }
  return words;
}

}  // namespace

bool IsBounded(const Interval& interval) {
  return std::isfinite(interval.lower) && std::isfinite(interval.upper);
}

std::string FormatRange(double value, const Interval& interval) {
  if (!IsBounded(interval)) return fmt::format("{:.2g} (too few for an interval)", value);
  return fmt::format("{:.2g} [{:.2g}, {:.2g}]", value, interval.lower, interval.upper);
}

const char* CauseName(FaultCause cause) { return PickName(cause, {"", "data", "estimator", "both"}); }

std::string DescribeVerdict(const TruthFreeTest& test) {
  const ComparedMedians& ratio = test.ratio;
  if (!std::isnan(ratio.value) && !IsBounded(ratio.interval) && test.verdict != TruthFreeVerdict::kNoData) {
    if (test.verdict != TruthFreeVerdict::kTooSmall) return "undecided: " + DescribeTooFew(test);
    return fmt::format("too small by the coverage; {}{}", DescribeTooFew(test),
                       DescribeCause(test.cause, true));
  }
  const std::string range = FormatRange(ratio.value, ratio.interval);
  switch (test.verdict) {
    case TruthFreeVerdict::kTooSmall:
      return fmt::format("too small by {} in variance{}", range, DescribeCause(test.cause, true));
    case TruthFreeVerdict::kTooLarge:
      return fmt::format(
          "too large by {} in variance{}",
          FormatRange(1.0 / ratio.value, {1.0 / ratio.interval.upper, 1.0 / ratio.interval.lower}),
          DescribeCause(test.cause, false));
    case TruthFreeVerdict::kUndecided:
      if (std::isnan(test.units_needed)) return fmt::format("undecided: {}", range);
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

bool IsKnown(const DistanceCorrelation& c) { return std::isfinite(c.difference.lower); }

std::string CorrelationVerdict(const DistanceCorrelation& c) {
  if (!IsKnown(c)) return "no data";
  if (c.difference.upper < kNominalCorrelation) return "holds";
  return c.difference.lower > kNominalCorrelation ? "correlated" : "undecided";
}

std::string FaultVerdict(TruthFreeVerdict verdict) {
  return IsFault(verdict) ? "wrong" : VerdictName(verdict);
}

std::string DescribeSet(const SetReport& report) {
  return FormatParagraph(fmt::format("{}: {} pairs, {} answered, {}", report.name, report.num_pairs,
                                     report.num_answered, LoopsText(report))) +
         FormatParagraph(DescribeCovariances(report.covariances)) + DescribeSharpness(report);
}

std::string DescribeValidationColumns() {
  return FormatParagraph(fmt::format(
             "Covariances as they are stated against the differences of two halves of the matches (5 degrees of freedom), the closure of rotations around loops of images (3) and of directions around three (1): "
             "medians over that of chi-square; 1 is right. "
             "simulation: the answers to simulated twins (the same matches at the estimated geometry with independent noise anew) against the motion that they were made of; "
             "what is too small there is the estimator's own. "
             "Intervals 95 %: bootstrap over pairs or loops; those of coverage know which pairs share an image. "
             "holds: the whole interval within [1/{0:g}, {0:g}], and coverage accordingly. "
             "Correlations are beyond those of the twins; nominal below {1:g}.",
             kNominalVariance, kNominalCorrelation)) +
         FormatParagraph(fmt::format(
             "Camera faults: self-calibration over all pairs of one camera, each beside the others; "
             "the intervals of a set hold together in 95 % of sets, by the scatter of pairs. "
             "One is named only if the test of all is rejected, the steps converge, and correcting what is named leaves nothing. "
             "A readout time is asked of pairs that state seconds_between. "
             "Nominal: {}.",
             NominalFaults())) +
         FormatParagraph(fmt::format(
             "Noise by size: slope of log r^2 on log noise^2 over that of the twins; nominal within {:g} of one.",
             kNominalSlope));
}

}  // namespace rcme
