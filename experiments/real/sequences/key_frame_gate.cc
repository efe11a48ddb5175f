#include "experiments/real/sequences/key_frame_gate.h"

#include <algorithm>
#include <functional>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/geometry/triangulation.h"
#include "stats/constants.h"

namespace rcme {
namespace {

constexpr size_t kLeastInFront = 50;  // minTriangulated in the program
constexpr double kShareInFront = 0.9;
constexpr double kInlierLevelOfGate = 0.05;  // chi-square at 95 %, as in the program

// Returns the angles (rad) between the two rays of the matches in front of both cameras, for the best of the
// four motions.
std::vector<double> AnglesInFront(const MotionProblem& problem, const TwoViewFits& fits,
                                  const std::vector<int>& inliers) {
  std::vector<double> best;
  for (const RelativePose& motion : PosesFromEssential(ProjectToEssential(fits.essential.matrix))) {
    std::vector<double> angles;
    for (const int i : inliers) {
      const Correspondence& match = problem.matches[static_cast<size_t>(i)];
      const Eigen::Vector3d ray1 = problem.camera1.Ray(match.x1_px), ray2 = problem.camera2.Ray(match.x2_px);
      if (IsInFrontOfBothCameras(motion, ray1, ray2)) angles.push_back(AngleBetween(motion.R * ray1, ray2));
    }
    if (angles.size() > best.size()) best = std::move(angles);
  }
  return best;
}

}  // namespace

KeyFrameVerdict JudgePair(const MotionProblem& problem, const KeyFrameGate& gate, RandomStream& rng) {
  KeyFrameVerdict verdict{kKeptPair};
  if (!gate.criterion) return verdict;
  if (problem.matches.size() < static_cast<size_t>(gate.least_matches)) return {kTooFewMatches};
  MotionProblem with_sigma = problem;
  with_sigma.sigma_px = gate.sigma_px;
  TwoViewFits fits;
  const ModelChoice choice = ChooseModel(with_sigma, {.criterion = *gate.criterion}, rng, &fits);
  verdict.num_inliers = choice.num_inliers;
  if (choice.status != MotionStatus::kOk) {
    verdict.reason = StatusName(choice.status);
  } else if (choice.verdict != SceneVerdict::kGeneral) {
    verdict.reason = choice.verdict == SceneVerdict::kPlanar ? "planar_scene" : Name(choice.verdict);
  } else {
    const std::vector<int> inliers =
        FindInliers(fits.essential, TwoViewModel::kEssential, kInlierLevelOfGate);
    std::vector<double> angles = AnglesInFront(with_sigma, fits, inliers);
    if (angles.size() < kLeastInFront ||
        static_cast<double>(angles.size()) < kShareInFront * static_cast<double>(inliers.size()))
      return {"too_few_in_front", choice.num_inliers};
    std::ranges::nth_element(angles, angles.begin() + kLeastInFront - 1, std::greater<>());
    verdict.parallax_deg = kDegPerRad * angles[kLeastInFront - 1];
    if (verdict.parallax_deg <= gate.least_parallax_deg) verdict.reason = "too_little_parallax";
  }
  return verdict;
}

}  // namespace rcme
