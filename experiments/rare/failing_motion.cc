#include "experiments/rare/failing_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/protection_level.h"
#include "experiments/core/text/pick_name.h"
#include "experiments/data/make_data.h"
#include "experiments/trial/simulate_draw.h"
#include "parameters/input_error.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// The event decides on which side of 1 the result lies, because the quotient is rounded, and 0 / 0 if a bound
// is 0.
double DecideQuotient(double quotient, bool has_happened) {
  return has_happened ? std::fmax(quotient, std::nextafter(1.0, 2.0)) : std::fmin(quotient, 1.0);
}

Motion ReadMotion(const Scene& scene) { return {scene.cam2_from_cam1_true, scene.baseline_m}; }

bool SeesAll(const Scene& scene, const std::vector<Eigen::Vector3d>& points) {
  return std::ranges::all_of(points, [&](const Eigen::Vector3d& point) { return scene.Sees(point); });
}

}  // namespace

const char* Name(RareEvent::Kind kind) {
  return PickName(kind, {"failure", "misleading_rotation", "misleading_direction"});
}

double ErrorOverBound(const TrialRecord& record, const FailureBounds& bounds) {
  if (IsInvalid(record)) return std::numeric_limits<double>::infinity();
  if (HasRefused(record)) return 0.0;
  const double rotation = record.rotation_error_deg / bounds.max_rotation_error_deg;
  const double direction = record.direction_error_deg / bounds.max_direction_error_deg;
  return DecideQuotient(std::isnan(direction) ? rotation : std::max(rotation, direction),
                        HasFailed(record, bounds));
}

double ErrorOverLevel(const MotionEstimate& estimate, const TrialRecord& record, const RareEvent& event) {
  if (record.status != MotionStatus::kOk) return 0.0;
  const bool is_rotation = event.kind == RareEvent::Kind::kMisleadingRotation;
  const double error_deg = is_rotation ? record.rotation_error_deg : record.direction_error_deg;
  if (std::isnan(error_deg)) return 0.0;
  const ProtectionLevels levels = ComputeProtectionLevels(estimate, event.risk);
  const double level_deg = kDegPerRad * (is_rotation ? levels.rotation_rad : levels.direction_rad);
  return DecideQuotient(error_deg / level_deg, error_deg > level_deg);
}

double ComputeNearness(const MotionEstimate& estimate, const TrialRecord& record, const RareEvent& event,
                       const FailureBounds& bounds) {
  return event.kind == RareEvent::Kind::kFailure ? ErrorOverBound(record, bounds)
                                                 : ErrorOverLevel(estimate, record, event);
}

void RequireDrawnScenes(const Study& study) {
  RequireFixedOptions(study, "rcme rare");
  for (const std::vector<std::string>& levels : DesignRows(study)) {
    for (const auto& [key, value] : CombineSettings(study, levels)) {
      if (key == "scene" && value == kMatchFilesScene) {
        throw InputError(
            "rare: scene: match_files is not allowed; real pairs give too few trials for rare failures");
      }
    }
  }
}

FailingMotion::FailingMotion(const StudyPlan& plan, const Condition& condition, size_t estimator,
                             const RareEvent& event)
    : estimator_(plan.estimators[estimator]),
      study_(plan.study),
      event_(event),
      stream_key_(condition.stream_key) {
  RequireDrawnScenes(plan.study);
  data_ = MakeSimulatedData(CombineSettings(plan.study, condition.levels), BaselineTiming::kWithFirstScene);
  if (!data_->HasNormalNoise()) {
    throw InputError("rare: noise: splitting needs gaussian noise; for other noise give --method stratified");
  }
  for (const auto& [part, name] : data_->ChosenParts())
    has_free_points_ = has_free_points_ || (part == "scene" && name == "uniform_volume");
  RandomStream rng({plan.study.seed, stream_key_, 0, kSplittingPurpose});
  if (study_.population) TryDraws(rng);
  if (num_not_simulated_ == kNumTried) return;
  if (MakeData(Draw(rng)).weight != 1.0)
    throw InputError("rare: tilted_to: weighted trials are not allowed; leave it out");
}

void FailingMotion::TryDraws(RandomStream& rng) {
  for (int i = 0; i < kNumTried; ++i) {
    const SimulatedDraw<State> drawn = SimulateDraw(study_, [&] { return DrawOnce(rng); });
    if (drawn.made) continue;
    if (num_not_simulated_++ == 0) why_not_simulated_ = drawn.why_not;
  }
}

std::shared_ptr<const Scene> FailingMotion::DrawScene(RandomStream& rng) const {
  return std::make_shared<const Scene>(data_->DrawScene({rng.Next64(), stream_key_, 0, 0}));
}

std::shared_ptr<const Scene> FailingMotion::WithSomePoints(const Scene& scene, double share,
                                                           RandomStream& rng) const {
  const Scene fresh = data_->DrawSceneWithMotion(ReadMotion(scene), rng);
  Scene mixed = scene;
  for (size_t i = 0; i < mixed.points_in_cam1.size(); ++i) {
    if (rng.Uniform() < share) mixed.points_in_cam1[i] = fresh.points_in_cam1[i];
  }
  return std::make_shared<const Scene>(std::move(mixed));
}

// Each point has the density f(x) [both images see x] / Z(motion), with unknown Z. The exchange algorithm
// (Murray, Ghahramani & MacKay 2006) does not need Z: it draws fresh points of the new motion. If the points
// of either scene are all visible under the motion of the other, f and Z cancel and the Metropolis-Hastings
// ratio is 1, else 0. Several tries are a power of one reversible move, hence reversible.
std::shared_ptr<const Scene> FailingMotion::WithMotionNear(const Scene& scene, double step,
                                                           RandomStream& rng) const {
  constexpr int kTries = 3;
  constexpr double kStepOfMotion = 0.3;
  Scene moved = scene;
  for (int i = 0; i < kTries; ++i) {
    const std::optional<Scene> fresh = data_->DrawSceneNear(ReadMotion(moved), kStepOfMotion * step, rng);
    if (!fresh || !SeesAll(*fresh, moved.points_in_cam1) || !SeesAll(moved, fresh->points_in_cam1)) continue;
    moved.cam2_from_cam1_true = fresh->cam2_from_cam1_true;
  }
  return std::make_shared<const Scene>(std::move(moved));
}

FailingMotion::State FailingMotion::Draw(RandomStream& rng) const {
  for (;;) {
    SimulatedDraw<State> drawn = SimulateDraw(study_, [&] { return DrawOnce(rng); });
    if (drawn.made) return *std::move(drawn.made);
  }
}

FailingMotion::State FailingMotion::DrawOnce(RandomStream& rng) const {
  State state;
  state.scene = DrawScene(rng);
  state.noise.resize(4 * state.scene->points_in_cam1.size());
  rng.FillNormal(state.noise);
  state.outlier_seed = rng.Next64();
  state.sampling_seed = rng.Next64();
  if (study_.population) MakeData(state);  // throws if it cannot be simulated
  return state;
}

TrialData FailingMotion::MakeData(const State& state) const {
  RandomStream outlier_rng = StreamFor({state.outlier_seed, stream_key_, 0, 0}, StreamPurpose::kOutliers);
  return data_->MakeFrom(*state.scene, state.noise, outlier_rng);
}

// Makes the move of the scene with this number.
std::shared_ptr<const Scene> FailingMotion::ProposeScene(const State& state, std::uint32_t kind, double step,
                                                         RandomStream& rng) const {
  const auto simulated = SimulateDraw(study_, [&] {
    if (kind == 0) return DrawScene(rng);
    return kind <= 5 ? WithSomePoints(*state.scene, 0.5 * step * step, rng)
                     : WithMotionNear(*state.scene, step, rng);
  });
  return simulated.made.value_or(nullptr);
}

FailingMotion::State FailingMotion::Propose(const State& state, double step, RandomStream& rng,
                                            bool& is_local) const {
  State moved = state;
  is_local = false;
  const std::uint32_t kind = rng.IntegerBelow(16);
  if (kind == 0) {
    moved.scene = ProposeScene(state, kind, step, rng);
    return moved;
  }
  if (kind == 1) {
    moved.sampling_seed = rng.Next64();
    return moved;
  }
  if (kind <= 3) {
    moved.outlier_seed = rng.Next64();
    return moved;
  }
  is_local = true;
  if (kind <= 7 && has_free_points_) {
    moved.scene = ProposeScene(state, kind, step, rng);
    return moved;
  }
  rng.FillNormal(moved.noise);
  for (size_t i = 0; i < moved.noise.size(); ++i)
    moved.noise[i] = std::sqrt(1.0 - step * step) * state.noise[i] + step * moved.noise[i];
  return moved;
}

double FailingMotion::Value(const State& state) const {
  constexpr double kNoTrial = -std::numeric_limits<double>::infinity();
  if (!state.scene) return kNoTrial;
  const SimulatedDraw<TrialData> simulated = SimulateDraw(study_, [&] { return MakeData(state); });
  if (!simulated.made) return kNoTrial;
  const TrialData& data = *simulated.made;
  RandomStream sampling_rng = StreamFor({state.sampling_seed, stream_key_, 0, 0}, StreamPurpose::kSampling);
  const MotionEstimate estimate = estimator_->Estimate(data.problem, sampling_rng);
  return ComputeNearness(estimate, Score(estimate, data, 0.0), event_, study_.failure);
}

}  // namespace rcme
