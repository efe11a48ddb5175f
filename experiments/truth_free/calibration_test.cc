#include "experiments/truth_free/calibration_test.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments/truth_free/calibration_score.h"

namespace rcme {
namespace {

constexpr double kTooWide = 50.0;  // times what is nominal: half of an interval that says nothing
constexpr double kOfEach = 1.0 - (1.0 - kFaultConfidence) / kNumCameraFaults;

bool IsOfCamera(const NamedPair& pair, const Camera& camera) {
  const auto same = [&](const Camera& other) {
    return other.K() == camera.K() && other.width == camera.width && other.height == camera.height;
  };
  return same(pair.problem.camera1) && same(pair.problem.camera2);
}

void Add(const Answered& answered, const ImageNumbers& images, std::vector<UnitScore>* units) {
  if (!answered.IsOk()) return;
  const std::optional<CalibrationScore> score = ScoreCalibration(answered.pair.problem, answered.estimate);
  if (score) units->push_back({images.image1, images.image2, score->score, score->information});
}

// A pair's twins are one unit: they share its geometry.
void AddTwins(const PairAnswers& answers, const ImageNumbers& images, std::vector<UnitScore>* units) {
  std::vector<UnitScore> twins;
  for (const Answered& twin : answers.twins) Add(twin, images, &twins);
  if (twins.empty()) return;
  for (size_t k = 1; k < twins.size(); ++k) {
    twins[0].score += twins[k].score;
    twins[0].information += twins[k].information;
  }
  units->push_back(twins[0]);
}

Interval NominalOf(CameraFault fault) { return {-TextOf(fault).nominal, TextOf(fault).nominal}; }

TruthFreeVerdict VerdictOf(CameraFault fault, const PooledParameter& of) {
  if (std::isnan(of.value)) return TruthFreeVerdict::kNoData;
  return VerdictOnInterval(of.interval, 0.0, NominalOf(fault));
}

bool IsFault(TruthFreeVerdict verdict) {
  return verdict == TruthFreeVerdict::kTooSmall || verdict == TruthFreeVerdict::kTooLarge;
}

// Further from zero than all of the other interval, to the same side or the other.
bool IsBeyond(const Interval& interval, const Interval& other) {
  return interval.lower > std::max(0.0, other.upper) || interval.upper < std::min(0.0, other.lower);
}

TruthFreeVerdict VerdictOnAll(const CalibrationReport& report) {
  if (std::isnan(report.p_value)) return TruthFreeVerdict::kNoData;
  const auto holds = [](const FaultReport& each) { return each.verdict == TruthFreeVerdict::kHolds; };
  if (std::ranges::all_of(report.faults, holds)) return TruthFreeVerdict::kHolds;
  return report.p_value < 1.0 - kFaultConfidence ? TruthFreeVerdict::kTooLarge : TruthFreeVerdict::kUndecided;
}

std::optional<CameraFault> MostAlike(const Eigen::MatrixXd& correlations, Eigen::Index of) {
  if (correlations.size() == 0) return std::nullopt;
  Eigen::VectorXd sizes = correlations.col(of).cwiseAbs();
  sizes(of) = -1.0;
  Eigen::Index most = 0;
  sizes.maxCoeff(&most);
  return kCameraFaults[static_cast<size_t>(most)];
}

std::string RangeIn(const CameraFaultText& text, const PooledParameter& of, bool is_turned) {
  const double scale = (is_turned ? -1.0 : 1.0) * text.per_unit;
  const double one = scale * of.interval.lower, other = scale * of.interval.upper;
  return fmt::format("{:.2g}{}{} [{:.2g}, {:.2g}]", scale * of.value, *text.unit ? " " : "", text.unit,
                     std::min(one, other), std::max(one, other));
}

// "too long by 0.52 % [0.45, 0.60]"
std::string FoundInWords(CameraFault fault, const PooledParameter& of) {
  const CameraFaultText& text = TextOf(fault);
  const bool is_less = of.value < 0.0;
  return fmt::format("{} {}", RangeIn(text, of, is_less), is_less ? text.less : text.more);
}

}  // namespace

CalibrationReport TestCalibration(const std::vector<PairAnswers>& answers) {
  CalibrationReport report;
  if (!answers.empty()) report.camera = answers.front().whole.pair.problem.camera1;
  const std::vector<ImageNumbers> images = ImageNumbersOf(answers);
  std::vector<UnitScore> units, of_twins;
  for (size_t i = 0; i < answers.size(); ++i) {
    if (!IsOfCamera(answers[i].whole.pair, report.camera)) continue;
    Add(answers[i].whole, images[i], &units);
    AddTwins(answers[i], images[i], &of_twins);
  }
  report.num_pairs = static_cast<int>(units.size());
  const PooledScores joint = PoolScores(units, kOfEach), twins = PoolScores(of_twins, kOfEach);
  report.p_value = joint.p_value;
  report.dispersion = joint.dispersion;
  for (size_t j = 0; j < kCameraFaults.size() && !units.empty(); ++j) {
    const CameraFault fault = kCameraFaults[j];
    const auto column = static_cast<Eigen::Index>(j);
    FaultReport of{fault, joint.parameters[j], PoolScoreAlone(units, column, kOfEach), {}, {}, {}};
    of.twins = twins.parameters.empty() ? PoolScoreAlone(of_twins, column, kOfEach) : twins.parameters[j];
    of.verdict = VerdictOf(fault, of.joint);
    if (IsFault(VerdictOf(fault, of.twins)) && !IsBeyond(of.joint.interval, of.twins.interval))
      of.verdict = TruthFreeVerdict::kUndecided;
    if (of.verdict == TruthFreeVerdict::kUndecided && IsFault(VerdictOf(fault, of.alone)))
      of.confused_with = MostAlike(joint.correlations, column);
    report.faults.push_back(of);
  }
  report.verdict = VerdictOnAll(report);
  return report;
}

std::string CalibrationInWords(const CalibrationReport& report) {
  switch (report.verdict) {
    case TruthFreeVerdict::kNoData:
      return "no data";
    case TruthFreeVerdict::kHolds:
      return fmt::format("holds (p = {:.2g})", report.p_value);
    case TruthFreeVerdict::kUndecided:
      return fmt::format("undecided (p = {:.2g})", report.p_value);
    default:
      return fmt::format("some fault (p = {:.2g})", report.p_value);
  }
}

std::string FaultInWords(const FaultReport& report) {
  const CameraFaultText& text = TextOf(report.fault);
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
      if (!(half < kTooWide * text.nominal) && !report.confused_with)
        return fmt::format("undecided: these pairs hardly tell (+-{:.2g}{}{})", text.per_unit * half,
                           *text.unit ? " " : "", text.unit);
      std::string words = "undecided: " + RangeIn(text, report.joint, false);
      if (report.confused_with)
        words += fmt::format("; were it the only fault: {}; hard to tell from {}",
                             RangeIn(text, report.alone, false), TextOf(*report.confused_with).words);
      return words;
    }
    default:
      return FoundInWords(report.fault, report.joint);
  }
}

std::vector<std::string> CalibrationAdvice(const CalibrationReport& report) {
  std::vector<std::string> advice;
  const Camera& camera = report.camera;
  for (const FaultReport& each : report.faults) {
    if (!IsFault(each.verdict)) continue;
    const double theta = each.joint.value;
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
      case CameraFault::kReadoutTime:
        change = "take a global shutter, correct the rows' times, or move less between images";
        break;
    }
    advice.push_back(fmt::format("{}: {}: {}; then validate again (one step: what is far off takes two)",
                                 TextOf(each.fault).words, FoundInWords(each.fault, each.joint), change));
  }
  if (report.verdict == TruthFreeVerdict::kTooLarge && advice.empty())
    advice.emplace_back(
        "the camera is not as calibrated, but these pairs cannot tell in what: pairs that move and turn in "
        "other ways can");
  return advice;
}

}  // namespace rcme
