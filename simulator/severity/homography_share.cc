#include "simulator/severity/homography_share.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <vector>

namespace rcme {
namespace {

constexpr int kNumPlanes = 64;
constexpr std::uint32_t kMaxPoints = 200;

struct ImagedPoint {
  Eigen::Vector3d ray1;  // third component 1
  Eigen::Vector2d x2_px;
};

std::vector<ImagedPoint> ImageSome(const ViewPair& view, std::span<const Eigen::Vector3d> points,
                                   RandomStream& rng) {
  const auto n = static_cast<std::uint32_t>(points.size());
  std::vector<ImagedPoint> imaged;
  for (std::uint32_t i = 0; i < std::min(n, kMaxPoints); ++i) {
    const Eigen::Vector3d& point = points[n <= kMaxPoints ? i : rng.IntegerBelow(n)];
    imaged.push_back({point / point.z(), view.camera2.Project(view.InCamera2(point))});
  }
  return imaged;
}

// The plane m' X = 1 maps ray1 to R ray1 + baseline t (m' ray1) in camera 2.
double ShareOnPlane(const ViewPair& view, const std::vector<ImagedPoint>& points, const Eigen::Vector3d& m,
                    double max_distance_px) {
  const RelativePose& pose = view.cam2_from_cam1_true;
  const Eigen::Matrix3d H = pose.R + view.baseline_m * pose.t * m.transpose();
  int num_explained = 0;
  for (const ImagedPoint& point : points) {
    const Eigen::Vector3d ray2 = H * point.ray1;
    num_explained +=
        (view.camera2.Project(ray2) - point.x2_px).squaredNorm() <= max_distance_px * max_distance_px;
  }
  return num_explained / static_cast<double>(points.size());
}

}  // namespace

double HomographyShare(const ViewPair& view, std::span<const Eigen::Vector3d> points_in_cam1,
                       double max_distance_px, RandomStream& rng) {
  if (points_in_cam1.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<ImagedPoint> imaged = ImageSome(view, points_in_cam1, rng);
  double best = ShareOnPlane(view, imaged, Eigen::Vector3d::Zero(), max_distance_px);
  const auto n = static_cast<std::uint32_t>(points_in_cam1.size());
  for (int plane = 0; plane < kNumPlanes && best < 1.0 && n >= 3; ++plane) {
    Eigen::Matrix3d three;  // one point per row: three * m = 1
    for (int row = 0; row < 3; ++row) three.row(row) = points_in_cam1[rng.IntegerBelow(n)].transpose();
    const Eigen::Vector3d m = three.inverse() * Eigen::Vector3d::Ones();
    if (m.allFinite()) best = std::max(best, ShareOnPlane(view, imaged, m, max_distance_px));
  }
  return best;
}

}  // namespace rcme
