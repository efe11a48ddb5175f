#include "experiments/real/truth_free/calibration_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/real/truth_free/calibration_score.h"
#include "stats/constants.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

constexpr PooledParameter kUnknown = {kNaN, kNaN, {-kNaN, kNaN}, 0.0};
constexpr double kTooWide = 50.0;  // half-width, in nominal sizes, of an interval that says nothing
// Intrinsics that are decomposed from projection matrices of one camera differ by rounding.
bool IsOfCamera(const NamedPair& pair, const Camera& camera) {
  const auto same = [&](const Camera& other) {
    return other.K().isApprox(camera.K(), 1e-4) && other.width == camera.width &&
           other.height == camera.height;
  };
  return same(pair.problem.camera1) && same(pair.problem.camera2);
}

void Add(const Answered& answered, const ImageNumbers& images, double readout_scale,
         std::vector<UnitScore>* units) {
  if (!answered.IsOk()) return;
  std::optional<CalibrationScore> score = ScoreCalibration(answered.pair.problem, answered.estimate);
  if (!score) return;
  constexpr auto kReadout = static_cast<Eigen::Index>(CameraFault::kReadoutTime);
  score->score(kReadout) *= readout_scale;
  score->information.row(kReadout) *= readout_scale;
  score->information.col(kReadout) *= readout_scale;
  units->push_back({images.image1, images.image2, score->score, score->information});
}

// A pair's twins are one unit: they share its geometry.
void AddTwins(const PairAnswers& answers, const ImageNumbers& images, double readout_scale,
              std::vector<UnitScore>* units) {
  std::vector<UnitScore> twins;
  for (const Answered& twin : answers.twins) Add(twin, images, readout_scale, &twins);
  if (twins.empty()) return;
  for (size_t k = 1; k < twins.size(); ++k) {
    twins[0].score += twins[k].score;
    twins[0].information += twins[k].information;
  }
  units->push_back(twins[0]);
}

std::vector<UnitScore> PickFaults(const std::vector<UnitScore>& units,
                                  const std::vector<CameraFault>& faults) {
  std::vector<UnitScore> picked;
  const auto k = std::ssize(faults);
  for (const UnitScore& unit : units) {
    UnitScore of{unit.member1, unit.member2, Eigen::VectorXd(k), Eigen::MatrixXd(k, k)};
    for (Eigen::Index i = 0; i < k; ++i) {
      const auto from = static_cast<Eigen::Index>(faults[static_cast<size_t>(i)]);
      of.score(i) = unit.score(from);
      for (Eigen::Index j = 0; j < k; ++j)
        of.information(i, j) =
            unit.information(from, static_cast<Eigen::Index>(faults[static_cast<size_t>(j)]));
    }
    picked.push_back(std::move(of));
  }
  return picked;
}

Interval FindNominalRange(CameraFault fault) {
  return {-FindFaultText(fault).nominal, FindFaultText(fault).nominal};
}

TruthFreeVerdict DecideFault(CameraFault fault, const PooledParameter& of) {
  if (std::isnan(of.value)) return TruthFreeVerdict::kNoData;
  return VerdictOnInterval(of.interval, 0.0, FindNominalRange(fault));
}

// Whether the interval lies entirely on one side of both zero and the other interval.
bool IsBeyond(const Interval& interval, const Interval& other) {
  return interval.lower > std::max(0.0, other.upper) || interval.upper < std::min(0.0, other.lower);
}

TruthFreeVerdict VerdictOnAll(const CalibrationReport& report) {
  if (std::isnan(report.p_value)) return TruthFreeVerdict::kNoData;
  const auto holds = [](const FaultReport& each) { return each.verdict == TruthFreeVerdict::kHolds; };
  if (std::ranges::all_of(report.faults, holds)) return TruthFreeVerdict::kHolds;
  return report.p_value < 1.0 - kFaultConfidence ? TruthFreeVerdict::kTooLarge : TruthFreeVerdict::kUndecided;
}

std::optional<CameraFault> MostAlike(const Eigen::MatrixXd& correlations, Eigen::Index of,
                                     const std::vector<CameraFault>& asked) {
  if (correlations.size() == 0) return std::nullopt;
  Eigen::VectorXd sizes = correlations.col(of).cwiseAbs();
  sizes(of) = -1.0;
  Eigen::Index most = 0;
  sizes.maxCoeff(&most);
  return asked[static_cast<size_t>(most)];
}

std::string RangeIn(const CameraFaultText& text, const PooledParameter& of, bool is_turned) {
  const double scale = (is_turned ? -1.0 : 1.0) * text.per_unit;
  const double one = scale * of.interval.lower, other = scale * of.interval.upper;
  return fmt::format("{:.2g}{}{} [{:.2g}, {:.2g}]", scale * of.value, *text.unit ? " " : "", text.unit,
                     std::min(one, other), std::max(one, other));
}

// "0.52 % [0.45, 0.6] too long"
std::string DescribeFound(CameraFault fault, const PooledParameter& of) {
  const CameraFaultText& text = FindFaultText(fault);
  const bool is_less = of.value < 0.0;
  return fmt::format("{} {}", RangeIn(text, of, is_less), is_less ? text.less : text.more);
}

// Intervals shrink with the root of the number of pairs.
double PairsNeeded(CameraFault fault, const PooledParameter& of, int num_pairs) {
  const double half = 0.5 * (of.interval.upper - of.interval.lower), nominal = FindFaultText(fault).nominal;
  if (!(half < kTooWide * nominal)) return 0.0;
  const double target = std::max(std::abs(of.value), nominal - std::abs(of.value));
  return std::ceil(num_pairs * std::max(1.0, half * half / (target * target)));
}

// "focal length +-4200 %"
std::string DescribeHalf(CameraFault fault, const PooledParameter& of) {
  const CameraFaultText& text = FindFaultText(fault);
  return fmt::format("{} {:.2g} +-{:.2g}{}{}", text.words, text.per_unit * of.value,
                     0.5 * text.per_unit * (of.interval.upper - of.interval.lower), *text.unit ? " " : "",
                     text.unit);
}

// Describes a fault whose estimate leaves the range of the linear step; empty if none does.
std::string OutOfRange(const CalibrationReport& report) {
  for (const FaultReport& each : report.faults) {
    const double greatest = GreatestFault(each.fault, report.camera);
    if (!(std::abs(each.joint.value) <= greatest) ||
        !(each.joint.interval.upper - each.joint.interval.lower < greatest))
      return DescribeHalf(each.fault, each.joint);
  }
  return "";
}

}  // namespace

bool IsFault(TruthFreeVerdict verdict) {
  return verdict == TruthFreeVerdict::kTooSmall || verdict == TruthFreeVerdict::kTooLarge;
}

bool NamesFault(const CalibrationReport& report) {
  return std::ranges::any_of(report.faults, [](const FaultReport& each) { return IsFault(each.verdict); });
}

void NameNothing(std::string why, CalibrationReport* report) {
  for (FaultReport& each : report->faults) {
    if (IsFault(each.verdict)) each.verdict = TruthFreeVerdict::kUndecided;
    each.correction = 0.0;
  }
  report->why_unnamed = std::move(why);
  report->p_corrected = kNaN;
}

std::vector<double> ReadoutScales(const std::vector<PairAnswers>& answers) {
  std::vector<double> seconds, scales;
  for (const PairAnswers& each : answers) seconds.push_back(each.whole.pair.seconds_between);
  const double median = ComputeMedian(seconds);
  for (const double own : seconds) scales.push_back(std::isfinite(median / own) ? median / own : 1.0);
  return scales;
}

FaultEstimates EstimateFaults(const std::vector<PairAnswers>& answers) {
  FaultEstimates estimates;
  if (!answers.empty()) estimates.camera = answers.front().whole.pair.problem.camera1;
  const std::vector<ImageNumbers> images = NumberImages(answers);
  const std::vector<double> scales = ReadoutScales(answers);
  bool has_times = true;
  for (size_t i = 0; i < answers.size(); ++i) {
    if (!IsOfCamera(answers[i].whole.pair, estimates.camera)) continue;
    has_times &= std::isfinite(answers[i].whole.pair.seconds_between);
    Add(answers[i].whole, images[i], scales[i], &estimates.units);
    AddTwins(answers[i], images[i], scales[i], &estimates.twins);
  }
  for (size_t j = 0; j < kNumNamedFaults; ++j) {
    if (kCameraFaults[j] != CameraFault::kReadoutTime || has_times)
      estimates.asked.push_back(kCameraFaults[j]);
  }
  estimates.num_pairs = static_cast<int>(estimates.units.size());
  return estimates;
}

PooledScores PoolFaults(const std::vector<UnitScore>& units, const std::vector<CameraFault>& faults) {
  return PoolScores(PickFaults(units, faults), 1.0 - (1.0 - kFaultConfidence) / kNumNamedFaults);
}

std::optional<CameraFault> FindOtherFault(const std::vector<UnitScore>& units) {
  constexpr int kNumOthers = kNumCameraFaults - kNumNamedFaults;
  std::optional<CameraFault> other;
  double most = 0.0;
  for (Eigen::Index j = kNumNamedFaults; j < kNumCameraFaults; ++j) {
    const PooledParameter alone = PoolScoreAlone(units, j, 1.0 - (1.0 - kFaultConfidence) / kNumOthers);
    const double size = std::abs(alone.value) / alone.standard_error;
    if (alone.interval.Contains(0.0) || !(size > most)) continue;
    most = size;
    other = kCameraFaults[static_cast<size_t>(j)];
  }
  return other;
}

void JudgeFaults(CalibrationReport* report) {
  for (FaultReport& each : report->faults) {
    each.verdict = DecideFault(each.fault, each.joint);
    if (IsFault(DecideFault(each.fault, each.twins)) && !IsBeyond(each.joint.interval, each.twins.interval))
      each.verdict = TruthFreeVerdict::kUndecided;
  }
  report->verdict = VerdictOnAll(*report);
  if (!NamesFault(*report)) return;
  const std::string beyond = OutOfRange(*report);
  if (!(report->p_value < 1.0 - kFaultConfidence)) {
    NameNothing("all faults together are not significant", report);
  } else if (!beyond.empty()) {
    NameNothing("these pairs hardly determine the camera: " + beyond, report);
  }
}

CalibrationReport TestCalibration(const std::vector<PairAnswers>& answers) {
  const FaultEstimates estimates = EstimateFaults(answers);
  CalibrationReport report;
  report.camera = estimates.camera;
  report.num_pairs = estimates.num_pairs;
  const PooledScores joint = PoolFaults(estimates.units, estimates.asked),
                     twins = PoolFaults(estimates.twins, estimates.asked);
  report.p_value = joint.p_value;
  report.dispersion = joint.dispersion;
  for (size_t j = 0; j < estimates.asked.size() && report.num_pairs > 0; ++j) {
    const CameraFault fault = estimates.asked[j];
    const auto pool_alone = [&](const std::vector<UnitScore>& units) {
      const PooledScores pooled = PoolFaults(units, {fault});
      return pooled.parameters.empty() ? kUnknown : pooled.parameters.front();
    };
    FaultReport of{fault, joint.parameters[j], pool_alone(estimates.units), {}, {}, {}};
    of.twins = twins.parameters.empty() ? pool_alone(estimates.twins) : twins.parameters[j];
    report.faults.push_back(of);
  }
  JudgeFaults(&report);
  for (size_t j = 0; j < report.faults.size(); ++j) {
    FaultReport& of = report.faults[j];
    if (of.verdict != TruthFreeVerdict::kUndecided) continue;
    of.pairs_needed = PairsNeeded(of.fault, of.joint, report.num_pairs);
    if (IsFault(DecideFault(of.fault, of.alone)))
      of.confused_with = MostAlike(joint.correlations, static_cast<Eigen::Index>(j), estimates.asked);
  }
  return report;
}

std::string DescribeCalibration(const CalibrationReport& report) {
  switch (report.verdict) {
    case TruthFreeVerdict::kNoData:
      return "no data";
    case TruthFreeVerdict::kHolds:
      return fmt::format("holds (p = {:.2g})", report.p_value);
    case TruthFreeVerdict::kUndecided:
      return fmt::format("undecided (p = {:.2g})", report.p_value);
    default:
      break;
  }
  std::string words = fmt::format("some fault (p = {:.2g})", report.p_value);
  if (!report.why_unnamed.empty()) words += "; none is named: " + report.why_unnamed;
  if (std::isfinite(report.p_corrected))
    words += fmt::format("; p = {:.2g} where what is named is corrected", report.p_corrected);
  return words;
}

std::string DescribeFault(const FaultReport& report) {
  const CameraFaultText& text = FindFaultText(report.fault);
  switch (report.verdict) {
    case TruthFreeVerdict::kNoData:
      return "no data";
    case TruthFreeVerdict::kHolds: {
      const Interval& interval = report.joint.interval;
      return fmt::format("holds (within +-{:.2g}{}{})",
                         text.per_unit * std::max(-interval.lower, interval.upper), *text.unit ? " " : "",
                         text.unit);
    }
    case TruthFreeVerdict::kUndecided: {
      const double half = 0.5 * (report.joint.interval.upper - report.joint.interval.lower);
      if (!std::isfinite(half)) return "undecided: these pairs are too few to tell";
      if (!(half < kTooWide * text.nominal) && !report.confused_with)
        return fmt::format("undecided: these pairs hardly tell (+-{:.2g}{}{})", text.per_unit * half,
                           *text.unit ? " " : "", text.unit);
      std::string words = "undecided: " + RangeIn(text, report.joint, false);
      if (report.confused_with)
        words += fmt::format("; were it the only fault: {}; hard to tell from {}",
                             RangeIn(text, report.alone, false), FindFaultText(*report.confused_with).words);
      if (report.pairs_needed > 0.0)
        words += fmt::format("; some {:.2g} pairs would decide it", report.pairs_needed);
      return words;
    }
    default:
      return DescribeFound(report.fault, report.joint);
  }
}

std::vector<std::string> CalibrationAdvice(const CalibrationReport& report) {
  std::vector<std::string> advice;
  const Camera& camera = report.camera;
  for (const FaultReport& each : report.faults) {
    if (!IsFault(each.verdict)) continue;
    const double theta = each.correction;
    std::string change;
    switch (each.fault) {
      case CameraFault::kFocalLength:
        change = fmt::format("fx, fy = {:.5g}, {:.5g} in place of {:.5g}, {:.5g}", camera.fx / (1.0 + theta),
                             camera.fy / (1.0 + theta), camera.fx, camera.fy);
        break;
      case CameraFault::kPrincipalPointX:
        change = fmt::format("cx = {:.5g} in place of {:.5g}", camera.cx - theta, camera.cx);
        break;
      case CameraFault::kPrincipalPointY:
        change = fmt::format("cy = {:.5g} in place of {:.5g}", camera.cy - theta, camera.cy);
        break;
      case CameraFault::kDistortion:
        change = fmt::format("undistort the matches with k1 = {:.2g}", theta);
        break;
      case CameraFault::kImage2ShiftX:
        change = fmt::format("shift the key points of image 2 by {:.2g} px in x", -theta);
        break;
      case CameraFault::kImage2ShiftY:
        change = fmt::format("shift the key points of image 2 by {:.2g} px in y", -theta);
        break;
      default:
        change = "take a global shutter, correct the rows' times, or move less between images";
        break;
    }
    advice.push_back(fmt::format("{}: {}: {}", FindFaultText(each.fault).words,
                                 DescribeFound(each.fault, each.joint), change));
  }
  if (report.verdict == TruthFreeVerdict::kTooLarge && advice.empty())
    advice.emplace_back(
        "the camera is not as calibrated, but these pairs cannot tell in what: pairs that move and turn in "
        "other ways can");
  return advice;
}

}  // namespace rcme
