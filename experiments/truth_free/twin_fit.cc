#include "experiments/truth_free/twin_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/geometry/sampson.h"
#include "estimator/geometry/triangulation.h"
#include "experiments/base/stop_request.h"
#include "experiments/data/make_data.h"
#include "experiments/trial/answer_check.h"
#include "experiments/trial/trial.h"
#include "experiments/truth_free/residual_correlation.h"
#include "experiments/truth_free/twin.h"
#include "parameters/input_error.h"
#include "simulator/severity/homography_share.h"
#include "stats/median_ratio.h"
#include "stats/spatial_pattern.h"

namespace rcme {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr double kLeastProducts = 100.0;  // of residuals, for a correlation
constexpr size_t kLeastRight = 20;        // of a template
constexpr size_t kMostForFit = 20;        // templates that are redrawn to fit the noise
constexpr double kFarthestDepth = 1e3;    // baselines; beyond, depth is as good as infinite
constexpr double kFarLengthsPx[] = {20.0, 40.0, 80.0, 160.0};
constexpr int kDegreesOfFreedom[] = {0, 20, 10, 6, 4, 3};  // 0: normal
// Mean correlation that a mosaic of side 2.3 px gives pairs of points up to 1 px apart (area-weighted).
constexpr double kNearMeanCorrelation = 0.66;

Eigen::Matrix3d FundamentalAt(const MotionProblem& problem, const RelativePose& pose) {
  return FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2);
}

MotionEstimate Ask(const MotionProblem& problem, const MotionEstimator& estimator, const StreamName& name) {
  RandomStream rng = StreamFor(name, StreamPurpose::kSampling);
  return Judged(estimator.Estimate(problem, rng), problem.matches.size());
}

bool IsWrong(const MotionEstimate& estimate, const TrialData& pair) {
  return HasFailed(Score(estimate, pair, 0.0), FailureBounds());
}

std::optional<TrialData> ExactOf(const TrialData& pair, const MotionEstimate& estimate) {
  const bool takes_answer = estimate.status == MotionStatus::kOk && !IsWrong(estimate, pair);
  if (!takes_answer && !pair.truth.cam2_from_cam1_true) return std::nullopt;
  TrialData exact = pair;
  exact.truth = Truth();
  exact.truth.cam2_from_cam1_true = takes_answer ? estimate.cam2_from_cam1 : *pair.truth.cam2_from_cam1_true;
  const RelativePose& pose = *exact.truth.cam2_from_cam1_true;
  const double sigma_px = takes_answer ? NoiseOf(pair.problem, estimate) : pair.problem.sigma_px;
  const Eigen::Matrix3d F = FundamentalAt(pair.problem, pose);
  // What the answer accepts may lie behind a camera by noise: far points.
  std::vector<bool> is_accepted(exact.problem.matches.size());
  for (const int i : estimate.inliers) is_accepted[static_cast<size_t>(i)] = takes_answer;
  size_t num_right = 0;
  for (size_t i = 0; i < is_accepted.size(); ++i) {
    Correspondence& match = exact.problem.matches[i];
    const double squared = SquaredSampsonDistance(F, match);
    if (!is_accepted[i] && (squared > kRightWithin * sigma_px * kRightWithin * sigma_px ||
                            !IsInFrontOfBothCameras(pose, pair.problem.camera1.Ray(match.x1_px),
                                                    pair.problem.camera2.Ray(match.x2_px))))
      continue;
    match = Snapped(F, match);
    num_right += SquaredSampsonDistance(F, match) < kExactPx * kExactPx;
  }
  if (num_right < kLeastRight) return std::nullopt;
  Redraw::Label(&exact);
  return exact;
}

// What the noise is fitted to, of the answers to some pairs.
struct ResidualPattern {
  double sigma_px = 0.0;    // median
  double tail_ratio = 0.0;  // 95 % point over the median of |r| / sigma, all pairs together
  ResidualProducts products;
};

double QuantileOf(std::vector<double> values, double p) {
  if (values.empty()) return kNaN;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(p * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

class PatternSum {
 public:
  void Add(const MotionProblem& problem, const MotionEstimate& estimate) {
    if (estimate.status != MotionStatus::kOk) return;
    const double sigma_px = NoiseOf(problem, estimate);
    const Eigen::Matrix3d F = FundamentalAt(problem, estimate.cam2_from_cam1);
    sigmas_.push_back(sigma_px);
    for (const int i : estimate.inliers) {
      sizes_.push_back(std::sqrt(SquaredSampsonDistance(F, problem.matches[static_cast<size_t>(i)])) /
                       sigma_px);
    }
    products_ += ProductsOf(problem, estimate);
  }
  ResidualPattern Take() const {
    return {MedianOf(sigmas_), QuantileOf(sizes_, 0.95) / QuantileOf(sizes_, 0.5), products_};
  }

 private:
  std::vector<double> sigmas_, sizes_;
  ResidualProducts products_;
};

// The templates with their pairs' answers, some of which the noise is fitted to.
class NoiseFit {
 public:
  NoiseFit(const TwinSource& source, const MotionEstimator& estimator, std::uint64_t seed)
      : estimator_(estimator), seed_(seed) {
    PatternSum sum;
    for (const AnsweredTrial& answered : source.pairs) {
      if (!answered.exact || answered.estimate.status != MotionStatus::kOk || used_.size() == kMostForFit)
        continue;
      used_.push_back(&answered);
      sum.Add(answered.pair.problem, answered.estimate);
    }
    observed_ = sum.Take();
  }

  RedrawSettings Fit() const {
    RedrawSettings noise;
    noise.noise_px = observed_.sigma_px;
    if (used_.empty() || !(noise.noise_px > 0.0)) return noise;
    FitShares(PatternOf(noise), &noise);
    double least = std::numeric_limits<double>::infinity(), sigma_px = noise.noise_px;
    int best_dof = 0;
    for (const int dof : kDegreesOfFreedom) {
      noise.student_dof = dof;
      const ResidualPattern pattern = PatternOf(noise);
      const double difference = std::abs(pattern.tail_ratio - observed_.tail_ratio);
      if (!(difference < least)) continue;
      least = difference;
      best_dof = dof;
      sigma_px = noise.noise_px * observed_.sigma_px / pattern.sigma_px;
    }
    noise.student_dof = best_dof;
    noise.noise_px = sigma_px;
    return noise;
  }

 private:
  ResidualPattern PatternOf(const RedrawSettings& noise) const {
    const Redraw redraw(noise);
    PatternSum sum;
    for (const AnsweredTrial* answered : used_) {
      const StreamName name{seed_, StreamKeyOf(answered->pair.origin), 0xf17, 0};
      const TrialData drawn = redraw.Draw(*answered->exact, name);
      sum.Add(drawn.problem, Ask(drawn.problem, estimator_, name));
    }
    return sum.Take();
  }

  // What the pairs' residuals have in common beyond those of independent noise: at 1 to 64 px by least
  // squares over lengths, the rest of what is in common below 1 px.
  void FitShares(const ResidualPattern& independent, RedrawSettings* noise) const {
    const auto excess = [&](size_t k) {
      const double difference = observed_.products.Correlation(k) - independent.products.Correlation(k);
      const bool is_known =
          std::min(observed_.products.counts[k], independent.products.counts[k]) >= kLeastProducts;
      return is_known ? difference : 0.0;
    };
    double least = std::numeric_limits<double>::infinity();
    for (const double length_px : kFarLengthsPx) {
      double xy = 0.0, xx = 0.0, yy = 0.0;
      for (size_t k = 1; k < kNumDistances; ++k) {
        const double from = kDistanceEdgesPx[k], to = kDistanceEdgesPx[k + 1];
        const double u = std::min(std::sqrt(0.5 * (from * from + to * to)) / length_px, 1.4);
        const double shape = u < 1.0 ? 1.0 - 4.0 * u / std::numbers::pi + u * u / std::numbers::pi : 0.0;
        xy += shape * excess(k);
        xx += shape * shape;
        yy += excess(k) * excess(k);
      }
      const double share = std::clamp(xy / xx, 0.0, 0.9), misfit = yy - 2.0 * share * xy + share * share * xx;
      if (misfit >= least) continue;
      least = misfit;
      noise->far_share = share;
      noise->far_length_px = length_px;
    }
    noise->near_share =
        std::clamp((excess(0) - noise->far_share) / kNearMeanCorrelation, 0.0, 0.95 - noise->far_share);
  }

  const MotionEstimator& estimator_;
  std::uint64_t seed_;
  std::vector<const AnsweredTrial*> used_;
  ResidualPattern observed_;
};

// Medians over the templates of a scene.
class LayoutFit {
 public:
  void Add(const TrialData& exact, double noise_px, RandomStream& rng) {
    const MotionProblem& problem = exact.problem;
    const RelativePose& pose = *exact.truth.cam2_from_cam1_true;
    std::vector<Eigen::Vector3d> points_in_cam1;
    std::vector<Eigen::Vector2d> key_points;
    std::vector<Correspondence> wrong;
    std::vector<double> parallaxes;
    for (size_t i = 0; i < problem.matches.size(); ++i) {
      const Correspondence& match = problem.matches[i];
      if (!exact.truth.is_inlier_true[i]) {
        wrong.push_back(match);
        continue;
      }
      const Eigen::Vector3d ray1 = problem.camera1.Ray(match.x1_px), ray2 = problem.camera2.Ray(match.x2_px);
      const double depth = 1.0 / std::max(InverseDepth(pose, ray1, ray2), 1.0 / kFarthestDepth);
      key_points.push_back(match.x1_px);
      points_in_cam1.push_back(depth * ray1);
      depths_.push_back(depth);
      parallaxes.push_back(kDegPerRad * AngleBetween(pose.R * ray1, ray2));
    }
    num_matches_.push_back(static_cast<double>(problem.matches.size()));
    wrong_shares_.push_back(static_cast<double>(wrong.size()) / num_matches_.back());
    agreeing_.push_back(AgreeingShare(wrong));
    rotations_.push_back(kDegPerRad * RotationAngleBetween(pose.R, Eigen::Matrix3d::Identity()));
    parallaxes_.push_back(MedianOf(std::move(parallaxes)));
    forwardness_.push_back(std::abs(pose.t.z()));
    const ViewPair view{problem.camera1, problem.camera2, pose, 1.0};
    homographies_.push_back(HomographyShare(view, points_in_cam1, std::sqrt(2.0) * noise_px, rng));
    clark_evans_.push_back(ClarkEvansIndex(key_points, problem.camera1.width, problem.camera1.height));
    twice_.push_back(TwiceShare(key_points));
  }

  void Give(TwinFit* fit) const {
    fit->num_templates = static_cast<int>(num_matches_.size());
    fit->num_matches = static_cast<int>(MedianOf(num_matches_));
    double sum = 0.0;
    for (const double share : wrong_shares_) sum += share / static_cast<double>(wrong_shares_.size());
    fit->wrong_share = sum;
    fit->wrong_agreeing_share = MedianOf(agreeing_);
    fit->rotation_deg = MedianOf(rotations_);
    fit->parallax_deg = MedianOf(parallaxes_);
    fit->forwardness = MedianOf(forwardness_);
    fit->nearest = QuantileOf(depths_, 0.05);
    fit->farthest = QuantileOf(depths_, 0.95);
    fit->homography_share = MedianOf(homographies_);
    fit->clark_evans = MedianOf(clark_evans_);
    fit->twice_share = MedianOf(twice_);
  }

 private:
  static double AgreeingShare(const std::vector<Correspondence>& wrong) {
    if (wrong.empty()) return 0.0;
    int num_agreeing = 0;
    for (size_t i = 0; i < wrong.size(); ++i) {
      for (size_t k = 0; k < wrong.size(); ++k) {
        const Eigen::Vector2d apart = wrong[k].x1_px - wrong[i].x1_px;
        const Eigen::Vector2d moved_apart = wrong[k].x2_px - wrong[i].x2_px - apart;
        if (k == i || apart.norm() > 30.0 || moved_apart.norm() > 10.0) continue;
        ++num_agreeing;
        break;
      }
    }
    return static_cast<double>(num_agreeing) / static_cast<double>(wrong.size());
  }

  static double TwiceShare(const std::vector<Eigen::Vector2d>& points) {
    int num_twice = 0;
    for (size_t i = 0; i < points.size(); ++i) {
      for (size_t k = 0; k < points.size(); ++k) {
        if (k == i || (points[k] - points[i]).squaredNorm() >= 1.0) continue;
        ++num_twice;
        break;
      }
    }
    return static_cast<double>(num_twice) / static_cast<double>(points.size());
  }

  std::vector<double> num_matches_, wrong_shares_, agreeing_, rotations_, parallaxes_, forwardness_, depths_,
      homographies_, clark_evans_, twice_;
};

void Set(Settings* settings, const std::string& key, const std::string& value) {
  settings->emplace_back(key, value);
}
void Set(Settings* settings, const std::string& key, double value) {
  Set(settings, key, fmt::format("{:.4g}", value));
}

void SetCameras(const TwinFit& fit, Settings* data) {
  Set(data, "cameras", "own_intrinsics");
  int number = 1;
  for (const Camera& camera : {fit.camera1, fit.camera2}) {
    Set(data, fmt::format("image{}_width", number), fmt::format("{}", camera.width));
    Set(data, fmt::format("image{}_height", number), fmt::format("{}", camera.height));
    for (const auto& [key, value] : {std::pair{"fx{}_px", camera.fx},
                                     {"fy{}_px", camera.fy},
                                     {"cx{}_px", camera.cx},
                                     {"cy{}_px", camera.cy}})
      Set(data, fmt::format(fmt::runtime(key), number), fmt::format("{}", value));
    ++number;
  }
}

void SetMotion(const TwinFit& fit, Settings* data) {
  const bool turns_about_scene = fit.forwardness < 0.5 && fit.rotation_deg > 0.5 * fit.parallax_deg;
  if (turns_about_scene) {
    Set(data, "motion", "orbit");
    Set(data, "orbit_deg", fit.rotation_deg);
  } else {
    Set(data, "motion", fit.forwardness > 0.9 ? "forward" : fit.forwardness < 0.35 ? "sideways" : "general");
    Set(data, "max_rotation_deg", 2.0 * fit.rotation_deg);  // uniform from 0: its median is half of that
  }
  Set(data, "parallax_deg", fit.parallax_deg);
}

void SetNoise(const TwinFit& fit, double assumed_sigma_px, Settings* data) {
  const RedrawSettings& noise = fit.noise;
  if (noise.far_share >= 0.05) {
    Set(data, "noise", "correlated");
    Set(data, "noise_correlation", noise.far_share);
    Set(data, "noise_correlation_length_px", noise.far_length_px);
  } else if (noise.near_share >= 0.05 && fit.twice_share >= 0.05) {
    Set(data, "noise", "duplicated");
    Set(data, "duplicated_share", 0.5 * fit.twice_share);  // of two alike one is the first
    Set(data, "duplicated_correlation", noise.near_share);
  } else if (noise.student_dof > 0) {
    Set(data, "noise", "student_t");
    Set(data, "student_dof", fmt::format("{}", noise.student_dof));
  }
  Set(data, "sigma_px", noise.noise_px);
  Set(data, "assumed_sigma_px", assumed_sigma_px);
}

void SetScene(const TwinFit& fit, double clustered_share, Settings* data) {
  const double farthest = std::max(fit.farthest, 1.05 * fit.nearest);
  if (fit.homography_share > 0.8) {
    Set(data, "scene", "plane_and_parallax");
    Set(data, "plane_depth_m", 0.5 * (fit.nearest + farthest));
    Set(data, "off_plane_share", 1.0 - fit.homography_share);
    Set(data, "off_plane_m", 0.5 * (farthest - fit.nearest));
  } else {
    Set(data, "scene", "image_clusters");
    Set(data, "min_depth_m", fit.nearest);
    Set(data, "max_depth_m", farthest);
    Set(data, "num_clusters", "20");
    Set(data, "cluster_spread_px", 0.03 * fit.camera1.width);
    Set(data, "clustered_share", clustered_share);
  }
}

Settings SimulatedWith(const TwinFit& fit, double clustered_share, double assumed_sigma_px) {
  Settings data;
  SetScene(fit, clustered_share, &data);
  SetCameras(fit, &data);
  SetMotion(fit, &data);
  SetNoise(fit, assumed_sigma_px, &data);
  Set(&data, "num_matches", fmt::format("{}", fit.num_matches));
  Set(&data, "outlier_ratio", fit.wrong_share);
  Set(&data, "outliers", fit.wrong_agreeing_share > 0.3 ? "clustered_both" : "uniform");
  Set(&data, "severity", "skipped");
  return data;
}

double ClarkEvansOf(const Settings& settings) {
  const std::shared_ptr<const SimulatedData> data = MakeSimulatedData(settings);
  std::vector<double> indices;
  for (std::uint32_t scene_number = 0; scene_number < 7; ++scene_number) {
    const Scene scene = data->DrawScene({1, 0, scene_number, 0});
    std::vector<Eigen::Vector2d> key_points;
    for (const Eigen::Vector3d& point : scene.points_in_cam1)
      key_points.push_back(scene.camera1.Project(point));
    indices.push_back(ClarkEvansIndex(key_points, scene.camera1.width, scene.camera1.height));
  }
  return MedianOf(std::move(indices));
}

}  // namespace

TwinSource AnswerScene(const std::string& scene, const DataSource& data, const ImageNames& images,
                       const MotionEstimator& estimator, std::uint64_t seed) {
  TwinSource source{scene, {}};
  const auto num_pairs = static_cast<std::uint32_t>(data.NumTrials(1));
  for (std::uint32_t number = 0; number < num_pairs; ++number) {
    if (IsStopRequested()) throw Stopped("stopped; nothing more is written");
    AnsweredTrial answered{data.Make({seed, 0, number, 0}), {}, {}, {}, std::nullopt};
    const auto named = images.find(answered.pair.origin);
    if (named != images.end()) std::tie(answered.image1, answered.image2) = named->second;
    answered.estimate =
        Ask(answered.pair.problem, estimator, {seed, StreamKeyOf(answered.pair.origin), 0, 0});
    answered.exact = ExactOf(answered.pair, answered.estimate);
    source.pairs.push_back(std::move(answered));
  }
  return source;
}

TwinFit FitTwin(const TwinSource& source, const MotionEstimator& estimator, std::uint64_t seed) {
  TwinFit fit;
  fit.noise = NoiseFit(source, estimator, seed).Fit();
  RandomStream rng = StreamFor({seed, StreamKeyOf(source.scene), 0, 0}, StreamPurpose::kSeverity);
  LayoutFit layout;
  for (const AnsweredTrial& answered : source.pairs) {
    if (!answered.exact) continue;
    if (fit.camera1.width == 0) {
      fit.camera1 = answered.exact->problem.camera1;
      fit.camera2 = answered.exact->problem.camera2;
    }
    layout.Add(*answered.exact, fit.noise.noise_px, rng);
  }
  if (fit.camera1.width == 0) {
    throw InputError(
        fmt::format("twin: scene {}: none of its {} pairs has a motion with {} matches that agree, by the "
                    "estimator or the "
                    "given truth; there is nothing to resemble",
                    source.scene, source.pairs.size(), kLeastRight));
  }
  if (!(fit.noise.noise_px > 0.0)) fit.noise.noise_px = source.pairs.front().pair.problem.sigma_px;
  layout.Give(&fit);
  return fit;
}

Settings SemiRealData(const TwinFit& fit, const std::string& folder, double assumed_sigma_px) {
  Settings data = {{"scene", kMatchFilesScene}, {"folder", folder}};
  Set(&data, "sigma_px", assumed_sigma_px);
  RedrawSettings noise = fit.noise;
  for (const Parameter& parameter : Parameters(noise)) Set(&data, parameter.name(), parameter.Value());
  return data;
}

Settings SimulatedTwinData(const TwinFit& fit, double assumed_sigma_px) {
  Settings best = SimulatedWith(fit, 0.0, assumed_sigma_px);
  double least = std::abs(ClarkEvansOf(best) - fit.clark_evans);
  if (best.front().second != "image_clusters") return best;
  for (const double share : {0.3, 0.6, 0.9}) {
    const Settings data = SimulatedWith(fit, share, assumed_sigma_px);
    const double difference = std::abs(ClarkEvansOf(data) - fit.clark_evans);
    if (difference >= least) continue;
    least = difference;
    best = data;
  }
  return best;
}

}  // namespace rcme
