#include "experiments/real/camera_noise/calibrate_noise_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "stats/constants.h"

namespace rcme {
namespace {

struct NoiseRow {
  std::string name, heading, unit;  // in files; for people
  Estimate estimate;
  std::string verdict;
  std::int64_t n = 0;  // matches, or pairs
};

Estimate EstimateFrom(const PooledParameter& of, double scale = 1.0) {
  return {scale * of.value, {scale * of.interval.lower, scale * of.interval.upper}, kNaN};
}

// The root of a variance; an interval that reaches below zero begins at zero.
Estimate RootEstimate(const PooledParameter& variance) {
  const auto root = [](double x) { return std::sqrt(std::max(0.0, x)); };
  return {root(variance.value), {root(variance.interval.lower), root(variance.interval.upper)}, kNaN};
}

// Without a factor the reach is at an end of its range. Reaches beyond the image look alike.
Estimate ReachEstimate(const SharedVariance& shared, const Camera& camera) {
  const double reach = shared.field.reach_px, factor = std::pow(shared.reach_factor, 1.96);
  const double lower = reach / factor >= 1.0 ? reach / factor : 0.0;
  const bool is_open = factor == 1.0 || reach * factor > std::hypot(camera.width, camera.height);
  return {reach, {lower, is_open ? std::numeric_limits<double>::infinity() : reach * factor}, kNaN};
}

std::string FieldVerdict(const NoiseCalibration& calibration) {
  if (!calibration.shared.is_found) return "not found";
  const Camera& camera = calibration.noise.camera;
  const bool is_wide = calibration.shared.field.reach_px > 0.5 * std::hypot(camera.width, camera.height);
  return fmt::format("found, {:.1f} % of the variance{}", 100.0 * calibration.noise.DisplacementShare(),
                     is_wide ? ", image-wide" : "");
}

void AddSharedRows(const NoiseCalibration& calibration, std::vector<NoiseRow>* rows) {
  const SharedVariance& shared = calibration.shared;
  const std::int64_t pairs = calibration.noise.num_pairs;
  rows->push_back({"displacement_px", "displacement field", "px", RootEstimate(shared.field.variance),
                   FieldVerdict(calibration), pairs});
  if (shared.is_found)
    rows->push_back(
        {"reach_px", "its reach", "px", ReachEstimate(shared, calibration.noise.camera), "", pairs});
  if (std::isfinite(shared.key_point.value)) {
    rows->push_back({"key_point_px", "shared by a key point", "px", RootEstimate(shared.key_point),
                     shared.is_key_point_found ? "found" : "not found", pairs});
  }
}

// Says whether the test names the fault and what is removed: a fault that is more probable than not is
// removed even if it is not named.
std::string FaultState(const CameraCorrection& correction, const CalibrationReport& report) {
  const auto found = std::ranges::find(report.faults, kCameraFaults[correction.fault], &FaultReport::fault);
  const bool is_named = found != report.faults.end() && IsFault(found->verdict);
  std::string state = is_named ? "named" : "not named";
  const CameraFaultText& text = FindFaultText(kCameraFaults[correction.fault]);
  const std::string unit = *text.unit ? std::string(" ") + text.unit : "";
  if (correction.removed != 0.0)
    state += fmt::format(": {:.3g}{} is removed", text.per_unit * correction.removed, unit);
  if (correction.uncertainty > 0.0)
    state += fmt::format(", +-{:.2g}{} is left", text.per_unit * correction.uncertainty, unit);
  return state;
}

void AddFaultRows(const NoiseCalibration& calibration, std::vector<NoiseRow>* rows) {
  const std::int64_t pairs = calibration.faults.num_pairs;
  rows->push_back({"camera_faults",
                   "camera faults, all together",
                   "",
                   {calibration.faults.p_value},
                   DescribeCalibration(calibration.faults),
                   pairs});
  for (const CameraCorrection& each : calibration.noise.corrections) {
    const CameraFaultText& text = FindFaultText(kCameraFaults[each.fault]);
    const double half = 1.96 * each.estimate.standard_error;
    PooledParameter as_pooled;
    as_pooled.value = each.estimate.value;
    as_pooled.interval = {each.estimate.value - half, each.estimate.value + half};
    rows->push_back({text.name, text.words, text.unit, EstimateFrom(as_pooled, text.per_unit),
                     FaultState(each, calibration.faults), pairs});
  }
}

std::vector<NoiseRow> MakeNoiseRows(const NoiseCalibration& calibration) {
  const CameraNoise& noise = calibration.noise;
  std::vector<NoiseRow> rows = {
      {"sigma_px", "noise sigma", "px", RootEstimate(calibration.variance), "", noise.num_matches}};
  if (std::isfinite(calibration.size_exponent.value)) {
    const bool grows = !calibration.size_exponent.interval.Contains(0.0);
    rows.push_back({"size_exponent", "grows with size to the", "", EstimateFrom(calibration.size_exponent),
                    grows ? "depends on the stated size" : "no dependence seen", noise.num_matches});
  }
  for (const SigmaOfSize& of : calibration.sizes) {
    const std::string range = std::isinf(of.to) ? fmt::format("from {:g}", of.from)
                              : of.from == 0.0  ? fmt::format("below {:g}", of.to)
                                                : fmt::format("{:g} to {:g}", of.from, of.to);
    rows.push_back({fmt::format("sigma_px_size_from_{:g}", of.from), "size " + range, "px",
                    RootEstimate(of.variance), "", of.num_matches});
  }
  AddSharedRows(calibration, &rows);
  AddFaultRows(calibration, &rows);
  const DisplacementCells& cells = calibration.systematic;
  if (std::isfinite(cells.p_value)) {
    const bool is_found = noise.systematic.columns > 0;
    rows.push_back({"systematic_px",
                    "displacement of all images",
                    "px",
                    {cells.rms_px},
                    fmt::format("{}found (p = {:.2g}){}", is_found ? "" : "not ", cells.p_value,
                                is_found ? ": removed" : ""),
                    noise.num_pairs});
  }
  return rows;
}

std::string DescribeEvidence(const NoiseCalibration& calibration, const std::string& name) {
  const CameraNoise& noise = calibration.noise;
  return fmt::format(
      "{}: {} matches of {} pairs, worth {:.2g} pairs of equal weight; of {} pairs {} are of another camera "
      "than "
      "the first and {} have no motion",
      name, noise.num_matches, noise.num_pairs, noise.effective_pairs, calibration.num_given,
      calibration.num_other_cameras, calibration.num_unanswered);
}

std::string NoiseCalibrationAsText(const NoiseCalibration& calibration, const std::string& name) {
  using R = const NoiseRow&;
  const Table table = MakeTable<NoiseRow>({{Column::Key("quantity"), [](R r) { return r.heading; }},
                                           {Column::Estimated("value"), [](R r) { return r.estimate; }},
                                           {Column::Text("unit"), [](R r) { return r.unit; }},
                                           {Column::Text("verdict"), [](R r) { return r.verdict; }},
                                           {Column::Count("n"), [](R r) { return r.n; }}},
                                          MakeNoiseRows(calibration));
  return FormatParagraph(DescribeEvidence(calibration, name)) + "\n" + RenderText(table) +
         FormatParagraph(
             "sigma: standard deviation per coordinate of a key point of the median size, with all that is "
             "shared. Sizes are the stated noise over the median of the pair. The displacement field is drawn "
             "anew in every image, its correlation exp(-d / reach); that of all images is the same in each, "
             "over 6x4 cells. Intervals 95 %, by the scatter of pairs; found: at 5 %. n: matches of the noise, "
             "pairs of the rest. The value of a fault is estimated beside all other faults. is removed: its "
             "mean over the sets of faults that explain the pairs, most of which lack some; it may therefore "
             "differ from the value. is left: root mean square of what the pairs leave open of a fault, after "
             "what is removed; covariances are widened by it. Faults: rcme help validate.");
}

// A row per quantity, for files.
Table MakeNoiseTable(const NoiseCalibration& calibration) {
  using R = const NoiseRow&;
  return MakeTable<NoiseRow>(
      {{Column::Key("quantity"), [](R r) { return r.name; }},
       {Column::Number("value"), [](R r) { return r.estimate.value; }},
       {{"lower,upper", ColumnType::kInterval}, [](R r) { return r.estimate.interval; }},
       {Column::Text("unit"), [](R r) { return r.unit; }},
       {Column::Count("n"), [](R r) { return r.n; }},
       {Column::Text("verdict"), [](R r) { return r.verdict; }}},
      MakeNoiseRows(calibration));
}

Table MakeReachTable(const NoiseCalibration& calibration) {
  using V = const VarianceByReach&;
  return MakeTable<VarianceByReach>(
      {{Column::Number("reach_px"), [](V v) { return v.reach_px; }},
       {Column::Number("value"), [](V v) { return v.variance.value; }},
       {{"lower,upper", ColumnType::kInterval}, [](V v) { return v.variance.interval; }},
       {Column::Number("gain"), [](V v) { return v.gain; }}},
      calibration.shared.by_reach);
}

}  // namespace

CommandResult MakeNoiseCalibrationResult(const NoiseCalibration& calibration, const std::string& name) {
  const CameraNoise& noise = calibration.noise;
  const auto count = [](auto n) { return static_cast<std::int64_t>(n); };
  return MakeResult(NoiseCalibrationAsText(calibration, name), kNoiseCalibrationFormat,
                    {{"name", name},
                     {"pairs", count(noise.num_pairs)},
                     {"matches", count(noise.num_matches)},
                     {"effective_pairs", noise.effective_pairs},
                     {"pairs_given", count(calibration.num_given)},
                     {"pairs_of_other_cameras", count(calibration.num_other_cameras)},
                     {"pairs_without_motion", count(calibration.num_unanswered)}},
                    MakeNoiseTable(calibration), {{"variance_by_reach", MakeReachTable(calibration)}});
}

}  // namespace rcme
