#include "peers/peer_registry.h"

#include <fmt/format.h>

#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>

#include "estimator/estimator_registry.h"
#include "peers/peers.h"

namespace rcme {
namespace {

void AddOpenCv() {
  cv::setNumThreads(1);
  const std::string version = cv::getVersionString();
  const auto add = [&](const char* name, const char* words, std::unique_ptr<EstimatorModel> (*make)()) {
    AddEstimator({name, fmt::format("OpenCV {}: {}", version, words), make, /*is_peer=*/true});
  };
  add("opencv_usac", "findEssentialMat with UsacParams, recoverPose", OpenCvUsacModel);
  add("opencv_ransac", "findFundamentalMat with FM_RANSAC, recoverPose", OpenCvRansacModel);
  add("opencv_lmeds", "findFundamentalMat with FM_LMEDS, recoverPose", OpenCvLmedsModel);
}

}  // namespace

void AddPeers() {
  AddOpenCv();
  AddEstimator({"opengv_ransac",
                "OpenGV " RCME_OPENGV_VERSION
                ": Ransac of CentralRelativePoseSacProblem, nonlinear refinement",
                OpenGvRansacModel, /*is_peer=*/true});
#ifdef RCME_POSELIB_VERSION
  AddEstimator({"poselib", "PoseLib " RCME_POSELIB_VERSION ": estimate_relative_pose", PoseLibModel,
                /*is_peer=*/true});
#endif
#ifdef RCME_POSELIB_HAS_GRAVITY
  AddEstimator({"poselib_gravity",
                "PoseLib " RCME_POSELIB_VERSION
                ": as poselib, with samples of three where gravity is measured",
                PoseLibGravityModel, /*is_peer=*/true});
#endif
}

}  // namespace rcme
