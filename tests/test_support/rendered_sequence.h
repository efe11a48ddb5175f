// A camera that walks through a textured hall with pillars, rendered: images with known cameras and known
// poses, written as the data sets that `rcme pairs` reads. Some 40 ms for an image of 320 x 240 px.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/pose.h"

namespace rcme {

struct RenderedCamera {
  Camera camera{260.0, 262.0, 158.3, 121.6, 320, 240};
  std::vector<double> radtan;   // k1 k2 p1 p2, as OpenCV's; empty: none
  std::vector<double> fisheye;  // k1 k2 k3 k4, as OpenCV's; empty: none
};

// X_world = R X_cam + center, metres.
struct RenderedPose {
  Eigen::Matrix3d R_world_from_cam = Eigen::Matrix3d::Identity();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
};

// Where the camera is at frame number `u`, any real number in [0, 100]: 0.13 m and up to 1.5 degrees from
// frame to frame.
RenderedPose PoseOnWalk(double u);
RelativePose TrueMotion(const RenderedPose& pose1, const RenderedPose& pose2);

// Grey values row by row. Two rays a pixel, a quarter of it off its centre; the texture's finest waves fade
// where a pixel covers them. Another number is another texture.
std::vector<std::uint8_t> RenderHall(const RenderedCamera& camera, const RenderedPose& pose,
                                     std::uint32_t texture = 0);
void WriteImage(const std::string& path, const Camera& camera,
                std::vector<std::uint8_t> grey);  // by its ending

// A part of the walk, in a hall of a texture.
struct RenderedWalk {
  int first_frame = 0, num_frames = 0;
  std::uint32_t texture = 0;
};

// Frames 0, ..., n - 1 of the walk as each data set has them. All make `folder` and what is in it.
// sequences/NAME/{image_0/*.png, calib.txt, times.txt} and poses/NAME.txt, 10 Hz; the camera must not
// distort.
void WriteKittiSequence(const std::string& folder, const std::string& name, const RenderedWalk& walk,
                        const RenderedCamera& camera = {});
inline void WriteKittiSequence(const std::string& folder, const std::string& name, int num_frames) {
  WriteKittiSequence(folder, name, RenderedWalk{.num_frames = num_frames});
}
// mav0/{cam0/{data/*.png, data.csv, sensor.yaml}, state_groundtruth_estimate0/data.csv}, 20 Hz; the truth is
// that of a body that the camera sits on askew, at 200 Hz and between the images' times.
void WriteEurocSequence(const std::string& folder, int num_frames, const RenderedCamera& camera);
// rgb/*.png, rgb.txt, groundtruth.txt, 30 Hz; the truth at 100 Hz.
void WriteTumSequence(const std::string& folder, int num_frames, const RenderedCamera& camera);
// 0000.png, 0001.png, ...
void WriteImageFolder(const std::string& folder, int num_frames, const RenderedCamera& camera);

}  // namespace rcme
