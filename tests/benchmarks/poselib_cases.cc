// PoseLib is not a Debian package; where CMake finds it, its relative pose (LO-RANSAC over five-point
// samples, then refinement) is timed beside ours, all its options default.
#include "tests/benchmarks/benchmark_cases.h"

#ifdef RCME_HAS_POSELIB
#include <PoseLib/poselib.h>
#include <benchmark/benchmark.h>
#endif

namespace rcme {

#ifdef RCME_HAS_POSELIB
namespace {

poselib::Camera MakePoseLibCamera(const Camera& camera) {
  return {"PINHOLE", {camera.fx, camera.fy, camera.cx, camera.cy}, -1, -1};
}

// Up to 2.0.5 the options are two structs, later one.
template <typename Points, typename PoseLibCamera>
auto CallPoseLib(const Points& x1, const Points& x2, const PoseLibCamera& camera1,
                 const PoseLibCamera& camera2) {
  poselib::CameraPose pose;
  std::vector<char> inliers;
  if constexpr (requires {
                  poselib::estimate_relative_pose(x1, x2, camera1, camera2, {}, {}, &pose, &inliers);
                }) {
    return poselib::estimate_relative_pose(x1, x2, camera1, camera2, {}, {}, &pose, &inliers);
  } else {
    return poselib::estimate_relative_pose(x1, x2, camera1, camera2, {}, &pose, &inliers);
  }
}

void EstimateRelativePose(const BenchmarkTrial& trial) {
  const MotionProblem& problem = trial.data.problem;
  std::vector<poselib::Point2D> x1, x2;
  for (const Correspondence& match : problem.matches) {
    x1.push_back(match.x1_px);
    x2.push_back(match.x2_px);
  }
  benchmark::DoNotOptimize(
      CallPoseLib(x1, x2, MakePoseLibCamera(problem.camera1), MakePoseLibCamera(problem.camera2)));
}

}  // namespace

std::vector<BenchmarkCase> PoseLibCases() {
  return {{"peer", "poselib_relative_pose", EstimateRelativePose}};
}

#else

std::vector<BenchmarkCase> PoseLibCases() { return {}; }

#endif

}  // namespace rcme
