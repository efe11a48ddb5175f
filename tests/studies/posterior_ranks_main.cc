// Simulation-based calibration of rcme_calibrated's posterior (estimator/calibrated/motion_posterior.h): in
// every trial of a study, where the truth lies among draws of it.
//   rcme_posterior_ranks STUDY [SEED] [TRIALS] [CONDITIONS] > CSV
// CONDITIONS is the number of draws of a study of a population.
// One row per answer that can be scored:
//   condition, trial              of the study
//   rotation_rank, direction_rank share of 999 draws nearer to the answer than the truth; "none of these" is
//                                 drawn uniformly over all motions. Uniform if the posterior is right.
//   nees_rank                     the same of the squared Mahalanobis distance by the stated covariance
//   rotation_error_deg, direction_error_deg
//   failure_probability           as stated, for 3 and 15 deg
//   p_R_D                         by the posterior, for a rotation of R and a direction of D deg
//   weight_of_none, narrowed      of the posterior
//   is_weak                       whether the direction has cells
//   is_verified                   whether the stated probability is in its domain
#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>

#include "estimator/estimators/rcme_calibrated.h"
#include "experiments/run/run_trials.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/simulate_draw.h"
#include "experiments/trial/trial.h"
#include "peers/peer_registry.h"
#include "stats/constants.h"

namespace rcme {
namespace {

constexpr int kDraws = 999;
constexpr std::array<MotionBounds, 5> kBoundsDeg = {{{1, 5}, {2, 10}, {3, 15}, {5, 20}, {10, 40}}};

Eigen::Vector3d UniformDirection(RandomStream& rng) {
  Eigen::Vector3d v;
  for (double& x : v) x = rng.Normal();
  return v.normalized();
}

// Of the rotation by a uniform unit quaternion.
RelativePose UniformMotion(RandomStream& rng) {
  Eigen::Vector4d q;
  for (double& x : q) x = rng.Normal();
  q.normalize();
  return {Eigen::Quaterniond(q).toRotationMatrix(), UniformDirection(rng)};
}

struct Ranks {
  double rotation = 0.0, direction = 0.0, nees = 0.0;
};

Ranks FindRanks(const MotionEstimate& estimate, const MotionPosterior& posterior,
                const RelativePose& pose_true, RandomStream& rng) {
  const RelativePose& answer = estimate.cam2_from_cam1;
  const Eigen::LDLT<Matrix5d> ldlt(estimate.pose_cov);
  const auto nees = [&](const RelativePose& pose) {
    const Vector5d away = LocalCoordinates(answer, pose);
    return away.dot(ldlt.solve(away));
  };
  const double rotation = RotationAngleBetween(answer.R, pose_true.R),
               direction = AngleBetween(answer.t, pose_true.t), distance = nees(pose_true);
  Ranks ranks;
  for (int k = 0; k < kDraws; ++k) {
    std::optional<RelativePose> pose = Draw(posterior, rng);
    if (!pose) pose = UniformMotion(rng);
    ranks.rotation += RotationAngleBetween(answer.R, pose->R) < rotation;
    ranks.direction += AngleBetween(answer.t, pose->t) < direction;
    ranks.nees += nees(*pose) < distance;
  }
  return {ranks.rotation / kDraws, ranks.direction / kDraws, ranks.nees / kDraws};
}

void PrintHeader() {
  fmt::print(
      "condition,trial,rotation_rank,direction_rank,nees_rank,rotation_error_deg,direction_error_deg,"
      "failure_probability");
  for (const MotionBounds& b : kBoundsDeg) fmt::print(",p_{}_{}", b.rotation_rad, b.direction_rad);
  fmt::print(",weight_of_none,narrowed,is_weak,is_verified\n");
}

void PrintTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial,
                const WeightInspection& estimator) {
  const StreamName name = NameOfTrial(plan, condition, trial);
  const auto simulated = SimulateDraw(plan.study, [&] { return condition.source->Make(name); });
  if (!simulated.made) return;
  const TrialData& data = *simulated.made;
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  std::optional<MotionPosterior> found;
  const MotionEstimate estimate = estimator.EstimateWithPosterior(data.problem, rng, &found);
  const TrialRecord record = Score(estimate, data, 0.0);
  if (estimate.status != MotionStatus::kOk || !data.truth.is_direction_known || !IsScored(record)) return;
  const MotionPosterior& posterior = *found;
  RandomStream draw_rng = StreamFor(name, StreamPurpose::kMonteCarlo);
  const Ranks ranks = FindRanks(estimate, posterior, *data.truth.cam2_from_cam1_true, draw_rng);
  fmt::print("{},{},{:.4f},{:.4f},{:.4f},{:.6g},{:.6g},{:.6g}", condition.index, trial, ranks.rotation,
             ranks.direction, ranks.nees, record.rotation_error_deg, record.direction_error_deg,
             estimate.failure_probability);
  const PosteriorDistances distances(posterior, estimate.cam2_from_cam1);
  for (const MotionBounds& b : kBoundsDeg) {
    const MotionBounds bounds{kRadPerDeg * b.rotation_rad, kRadPerDeg * b.direction_rad};
    fmt::print(",{:.6g}", distances.FailureProbability(bounds));
  }
  fmt::print(",{:.6g},{:.4g},{:d},{:d}\n", posterior.weight_of_none, posterior.narrowed,
             !posterior.cells.empty(), estimate.probability_domain == ProbabilityDomain::kVerified);
}

int Run(int argc, char** argv) {
  AddPeers();  // which a study may name; only rcme_calibrated is asked
  Study study = LoadStudy(argv[1]);
  if (argc > 4) Override(&study, "conditions.number", argv[4]);
  if (argc > 2) study.seed = std::strtoull(argv[2], nullptr, 10);
  if (argc > 3) study.trials = std::atoi(argv[3]);
  const StudyPlan plan = MakePlan(study, PlanEstimators::kNotMade);
  const std::unique_ptr<MotionEstimator> estimator = MakeRcmeCalibrated({});
  const WeightInspection* inspection = FindWeightInspection(*estimator);
  PrintHeader();
  ForEachTrial(plan, {0, static_cast<std::uint32_t>(study.trials)},
               [&](const Condition& condition, std::uint32_t trial, std::int64_t) {
                 PrintTrial(plan, condition, trial, *inspection);
               });
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace rcme

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: rcme_posterior_ranks STUDY [SEED] [TRIALS] [CONDITIONS]\n");
    return 2;
  }
  try {
    return rcme::Run(argc, argv);
  } catch (const rcme::InputError& error) {
    fmt::print(stderr, "rcme_posterior_ranks: {}\n", error.what());
    return 2;
  }
}
