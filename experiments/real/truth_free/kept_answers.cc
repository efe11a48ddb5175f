#include "experiments/real/truth_free/kept_answers.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "experiments/core/files/checksum.h"
#include "experiments/trial/answer_check.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

template <typename Matrix>
Json MatrixAsJson(const Matrix& matrix) {
  return NumbersAsJson({matrix.data(), static_cast<size_t>(matrix.size())});
}

template <typename Matrix>
void ReadMatrix(const Json& json, Matrix* matrix) {
  RequireSize(json, static_cast<size_t>(matrix->size()));
  std::ranges::copy(NumbersFrom(json), matrix->data());
}

MotionStatus StatusFrom(const Json& json) {
  const std::vector<MotionStatus>& all = AllStatuses();
  const auto found = std::ranges::find(all, json.get<std::string>(), StatusName);
  if (found == all.end()) throw std::invalid_argument("an unknown status");
  return *found;
}

void AddCamera(const Camera& camera, ChecksumBytes* bytes) {
  for (const double x : {camera.fx, camera.fy, camera.cx, camera.cy}) bytes->Add(x);
  for (const int size : {camera.width, camera.height}) bytes->Add(static_cast<std::uint64_t>(size));
}

}  // namespace

Json AnswerAsJson(const MotionEstimate& estimate) {
  return Json::array({StatusName(estimate.status), MatrixAsJson(estimate.cam2_from_cam1.R),
                      MatrixAsJson(estimate.cam2_from_cam1.t), MatrixAsJson(estimate.pose_cov),
                      estimate.inliers, NumberAsJson(estimate.failure_probability),
                      NumberAsJson(estimate.sigma_estimated_px), NumbersAsJson(estimate.inlier_probabilities),
                      NumberAsJson(estimate.calibration_error_probability),
                      MatrixAsJson(estimate.pose_cov_without_errors)});
}

MotionEstimate AnswerFrom(const Json& json, size_t num_matches) {
  RequireSize(json, 10);
  MotionEstimate estimate;
  estimate.status = StatusFrom(json[0]);
  ReadMatrix(json[1], &estimate.cam2_from_cam1.R);
  ReadMatrix(json[2], &estimate.cam2_from_cam1.t);
  ReadMatrix(json[3], &estimate.pose_cov);
  if (!json[4].is_array()) throw std::invalid_argument("no list of inliers");
  for (const Json& index : json[4])
    estimate.inliers.push_back(static_cast<int>(CountFrom(index, std::numeric_limits<int>::max())));
  estimate.failure_probability = NumberFrom(json[5]);
  estimate.sigma_estimated_px = NumberFrom(json[6]);
  estimate.inlier_probabilities = NumbersFrom(json[7]);
  estimate.calibration_error_probability = NumberFrom(json[8]);
  ReadMatrix(json[9], &estimate.pose_cov_without_errors);
  if (const auto fault = FindFault(estimate, num_matches)) throw std::invalid_argument(fault->message);
  return estimate;
}

Json ProductsAsJson(const ResidualProducts& products) {
  return Json::array({NumbersAsJson(products.sums), NumbersAsJson(products.counts)});
}

ResidualProducts ProductsFrom(const Json& json) {
  RequireSize(json, 2);
  ResidualProducts products;
  for (size_t i = 0; i < 2; ++i) {
    RequireSize(json[i], kNumDistances);
    std::ranges::copy(NumbersFrom(json[i]), (i == 0 ? products.sums : products.counts).begin());
  }
  return products;
}

MotionEstimate TakeAnswer(const MotionProblem& problem, const MotionEstimator& estimator,
                          const StreamName& name, KeptSteps* steps) {
  return TakeStep<MotionEstimate>(
      steps, [&] { return AnswerTo(problem, estimator, name); },
      {[](const MotionEstimate& answer) { return AnswerAsJson(answer).dump(); },
       [&](const std::string& json) { return AnswerFrom(ParsePiece(json), problem.matches.size()); }});
}

ResidualPattern TakePattern(const std::function<ResidualPattern()>& compute, KeptSteps* steps) {
  return TakeStep<ResidualPattern>(
      steps, compute,
      {[](const ResidualPattern& pattern) {
         return Json::array({NumberAsJson(pattern.sigma_px), NumberAsJson(pattern.tail_ratio),
                             ProductsAsJson(pattern.products)})
             .dump();
       },
       [](const std::string& text) {
         const Json json = ParsePiece(text);
         RequireSize(json, 3);
         return ResidualPattern{NumberFrom(json[0]), NumberFrom(json[1]), ProductsFrom(json[2])};
       }});
}

std::string DescribePairs(const PairSet& set) {
  ChecksumBytes bytes(0);
  for (const NamedPair& pair : set.pairs) {
    for (const std::string& name : {pair.name, pair.image1, pair.image2}) bytes.Add(name);
    bytes.Add(pair.seconds_between);
    bytes.Add(pair.problem.sigma_px);
    AddCamera(pair.problem.camera1, &bytes);
    AddCamera(pair.problem.camera2, &bytes);
    bytes.Add(std::uint64_t{pair.problem.matches.size()});
    for (const Correspondence& match : pair.problem.matches) {
      for (const double x : {match.x1_px.x(), match.x1_px.y(), match.x2_px.x(), match.x2_px.y()})
        bytes.Add(x);
    }
    for (const double scale : pair.problem.noise_scale) bytes.Add(scale);
    for (const double quality : pair.problem.match_quality) bytes.Add(quality);
  }
  return fmt::format("{}: {} pairs, checksum {:08x}", set.name, set.pairs.size(), bytes.Checksum());
}

}  // namespace rcme
