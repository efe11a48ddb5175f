#include "experiments/rare/failing_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/data/make_data.h"
#include "parameters/input_error.h"

namespace rcme {
void RequireDrawnScenes(const Study& study) {
  for (const std::vector<std::string>& levels : DesignRows(study)) {
    for (const auto& [key, value] : SettingsOf(study, levels)) {
      if (key == "scene" && value == kMatchFilesScene) {
        throw InputError(
            "rare: scene: match_files is not allowed; rare failures need trials without end, and those of "
            "real "
            "pairs are counted");
      }
    }
  }
}

double ErrorOverBound(const TrialRecord& record, const FailureBounds& bounds) {
  if (IsInvalid(record)) return std::numeric_limits<double>::infinity();
  if (HasRefused(record)) return 0.0;
  const double rotation = record.rotation_error_deg / bounds.max_rotation_error_deg;
  const double direction = record.direction_error_deg / bounds.max_direction_error_deg;
  const double error = std::isnan(direction) ? rotation : std::max(rotation, direction);
  // A quotient is rounded, and 0 / 0 where a bound is 0: the event decides.
  if (HasFailed(record, bounds)) return std::fmax(error, std::nextafter(1.0, 2.0));
  return std::fmin(error, 1.0);
}

FailingMotion::FailingMotion(const StudyPlan& plan, const Condition& condition, size_t estimator)
    : estimator_(plan.estimators[estimator]), bounds_(plan.study.failure), stream_key_(condition.stream_key) {
  RequireDrawnScenes(plan.study);
  data_ = MakeSimulatedData(SettingsOf(plan.study, condition.levels));
  if (!data_->HasNormalNoise()) {
    throw InputError(
        "rare: noise: only gaussian is allowed, for splitting moves normal numbers; for other noise give "
        "--method "
        "stratified");
  }
  for (const auto& [part, name] : data_->ChosenParts())
    has_free_points_ = has_free_points_ || (part == "scene" && name == "uniform_volume");
  RandomStream rng({plan.study.seed, stream_key_, 0, kSplittingPurpose});
  const State first = Draw(rng);
  RandomStream outlier_rng = StreamFor({first.outlier_seed, stream_key_, 0, 0}, StreamPurpose::kOutliers);
  if (data_->MakeFrom(*first.scene, first.noise, outlier_rng).weight != 1.0)
    throw InputError("rare: tilted_to: trials with weights are not allowed; leave it out");
}

std::shared_ptr<const Scene> FailingMotion::DrawScene(RandomStream& rng) const {
  return std::make_shared<const Scene>(data_->DrawScene({rng.Next64(), stream_key_, 0, 0}));
}

std::shared_ptr<const Scene> FailingMotion::WithSomePointsOf(const Scene& scene, double share,
                                                             RandomStream& rng) const {
  const std::shared_ptr<const Scene> fresh = DrawScene(rng);
  Scene mixed = scene;
  for (size_t i = 0; i < mixed.points_in_cam1.size(); ++i) {
    const bool is_chosen = rng.Uniform() < share;
    const Eigen::Vector3d &old_point = scene.points_in_cam1[i], &new_point = fresh->points_in_cam1[i];
    if (is_chosen && scene.Sees(new_point) && fresh->Sees(old_point)) mixed.points_in_cam1[i] = new_point;
  }
  return std::make_shared<const Scene>(std::move(mixed));
}

FailingMotion::State FailingMotion::Draw(RandomStream& rng) const {
  State state;
  state.scene = DrawScene(rng);
  state.noise.resize(4 * state.scene->points_in_cam1.size());
  rng.FillNormal(state.noise);
  state.outlier_seed = rng.Next64();
  state.sampling_seed = rng.Next64();
  return state;
}

FailingMotion::State FailingMotion::Propose(const State& state, double step, RandomStream& rng,
                                            bool& is_local) const {
  State moved = state;
  is_local = false;
  const std::uint32_t kind = rng.IntegerBelow(8);
  switch (kind) {
    case 0:
      moved.scene = DrawScene(rng);
      return moved;
    case 1:
      moved.outlier_seed = rng.Next64();
      return moved;
    case 2:
      moved.sampling_seed = rng.Next64();
      return moved;
    default:
      is_local = true;
  }
  if (kind == 3 && has_free_points_) {
    moved.scene = WithSomePointsOf(*state.scene, 0.5 * step * step, rng);
    return moved;
  }
  rng.FillNormal(moved.noise);
  for (size_t i = 0; i < moved.noise.size(); ++i)
    moved.noise[i] = std::sqrt(1.0 - step * step) * state.noise[i] + step * moved.noise[i];
  return moved;
}

double FailingMotion::Value(const State& state) const {
  RandomStream outlier_rng = StreamFor({state.outlier_seed, stream_key_, 0, 0}, StreamPurpose::kOutliers);
  RandomStream sampling_rng = StreamFor({state.sampling_seed, stream_key_, 0, 0}, StreamPurpose::kSampling);
  const TrialData data = data_->MakeFrom(*state.scene, state.noise, outlier_rng);
  return ErrorOverBound(Score(estimator_->Estimate(data.problem, sampling_rng), data, 0.0), bounds_);
}

}  // namespace rcme
