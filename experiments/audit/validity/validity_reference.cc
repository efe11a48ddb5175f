#include "experiments/audit/validity/validity_reference.h"

#include <limits>

#include "experiments/audit/validity/coverage_columns.h"
#include "experiments/audit/validity/sample_family.h"
#include "experiments/core/table/render_table.h"
#include "experiments/trial/covariance_score.h"
#include "stats/consistency.h"
#include "stats/distributions.h"
#include "stats/multivariate_moments.h"
#include "stats/unscented_covariance.h"

namespace rcme {
namespace {

constexpr double kReferenceCoverage = 0.95;
constexpr std::uint32_t kFirstCell = 1'000'000;  // its streams are not used by any cell of the map
constexpr std::array<const char*, 2> kReferenceQuantities = {"f", "pose"};
constexpr std::array<const char*, 4> kCovariances = {"first_order_at_estimate", "first_order_at_truth",
                                                     "unscented_at_truth", "monte_carlo_at_truth"};
constexpr int kFDof = 8, kPoseDof = 5;

// One noise-free sample: the point at which everything "at truth" is evaluated.
struct ExactSample {
  ObservedSample sample;
  LinearMotion motion;
  RelativePose pose_true;

  // Coordinates of the estimate from `problem` in the tangents at the truth: 8 of f, then 5 of p. NaN if
  // there is no estimate; a covariance that such a draw entered covers nothing.
  Eigen::VectorXd ComputeDeviation(const std::optional<LinearMotion>& estimate) const {
    Eigen::VectorXd deviation(kFDof + kPoseDof);
    if (!estimate) {
      deviation.setConstant(std::numeric_limits<double>::quiet_NaN());
    } else {
      deviation << motion.fit.LocalCoordinates(estimate->fit.f),
          LocalCoordinates(pose_true, NearestPose(estimate->poses, pose_true));
    }
    return deviation;
  }
};

Eigen::MatrixXd FirstOrderAtTruth(const ExactSample& exact) {
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(kFDof + kPoseDof, kFDof + kPoseDof);
  covariance.topLeftCorner<kFDof, kFDof>() = exact.motion.LocalCovarianceOfF();
  covariance.bottomRightCorner<kPoseDof, kPoseDof>() =
      CovarianceOfMotion(exact.pose_true, exact.motion.f_cov);
  return covariance;
}

Eigen::MatrixXd UnscentedAtTruth(const ExactSample& exact) {
  MotionProblem moved = exact.sample.problem;
  Eigen::VectorXd coordinates(4 * static_cast<Eigen::Index>(moved.matches.size()));
  for (Eigen::Index k = 0; const Correspondence& match : moved.matches) {
    coordinates.segment<4>(4 * k++) << match.x1_px, match.x2_px;
  }
  const auto deviation = [&](const Eigen::VectorXd& X) {
    for (Eigen::Index k = 0; Correspondence & match : moved.matches) {
      match = {X.segment<2>(4 * k), X.segment<2>(4 * k + 2)};
      ++k;
    }
    return exact.ComputeDeviation(EstimateLinearMotion(moved));
  };
  return UnscentedCovariance(deviation, coordinates, moved.sigma_px);
}

Eigen::MatrixXd MonteCarloAtTruth(const ExactSample& exact, const SampleFamily& family, const Scene& scene,
                                  const StreamName& name, int num_noises) {
  RandomStream noise_rng = StreamFor(name, StreamPurpose::kMonteCarlo);
  MultivariateMoments moments(kFDof + kPoseDof);
  for (int i = 0; i < num_noises; ++i) {
    moments.Add(exact.ComputeDeviation(EstimateLinearMotion(family.Observe(scene, name, noise_rng).problem)));
  }
  return moments.covariance();
}

// Whether f and p of one draw lie within the 95 % regions of a covariance at the truth.
std::array<bool, 2> CoveredAtTruth(const Eigen::VectorXd& deviation, const Eigen::MatrixXd& covariance) {
  const Vector8d of_f = deviation.head<kFDof>();
  const Vector5d of_pose = deviation.tail<kPoseDof>();
  const Matrix8d f_cov = covariance.topLeftCorner<kFDof, kFDof>();
  const Matrix5d pose_cov = covariance.bottomRightCorner<kPoseDof, kPoseDof>();
  return {NormalizedErrorSquared(of_f, f_cov) <= ChiSquareQuantile(kFDof, kReferenceCoverage),
          NormalizedErrorSquared(of_pose, pose_cov) <= ChiSquareQuantile(kPoseDof, kReferenceCoverage)};
}

std::array<bool, 2> CoveredAtEstimate(const std::optional<LinearMotion>& estimate,
                                      const RelativePose& pose_true) {
  if (!estimate) return {false, false};
  const RelativePose pose = NearestPose(estimate->poses, pose_true);
  const Matrix5d pose_cov = CovarianceOfMotion(pose, estimate->f_cov);
  return {
      NormalizedErrorOfF(*estimate, pose_true) <= ChiSquareQuantile(kFDof, kReferenceCoverage),
      NormalizedErrorOfPose(pose, pose_cov, pose_true) <= ChiSquareQuantile(kPoseDof, kReferenceCoverage)};
}

CoveredCounts RunSample(const SampleFamily& family, const StreamName& name,
                        const ValidityReferenceOptions& options) {
  CoveredCounts counts{};
  const Scene scene = family.MakeScene(name);
  ObservedSample sample = family.ObserveExactly(scene, name);
  std::optional<LinearMotion> motion = EstimateLinearMotion(sample.problem);
  if (!motion) return counts;  // nothing is covered
  const ExactSample exact{std::move(sample), std::move(*motion), scene.cam2_from_cam1_true};
  const std::array<Eigen::MatrixXd, 3> at_truth = {
      FirstOrderAtTruth(exact), UnscentedAtTruth(exact),
      MonteCarloAtTruth(exact, family, scene, name, options.num_noises)};

  RandomStream noise_rng = StreamFor(name, StreamPurpose::kNoise);
  for (int draw = 0; draw < options.num_draws; ++draw) {
    const auto estimate = EstimateLinearMotion(family.Observe(scene, name, noise_rng).problem);
    std::array<std::array<bool, 2>, kCovariances.size()> covered;
    covered[0] = CoveredAtEstimate(estimate, exact.pose_true);
    for (size_t c = 0; c < at_truth.size(); ++c) {
      covered[c + 1] = CoveredAtTruth(exact.ComputeDeviation(estimate), at_truth[c]);
    }
    for (size_t q = 0; q < kReferenceQuantities.size(); ++q) {
      for (size_t c = 0; c < kCovariances.size(); ++c) counts[q][c] += covered[c][q] ? 1 : 0;
    }
  }
  return counts;
}

}  // namespace

std::int64_t NumCells(const ValidityReferenceOptions& options) {
  return static_cast<std::int64_t>(options.nums_points.size() * options.sigmas_px.size());
}

CoveredCounts CountCovered(const ValidityReferenceOptions& options, std::uint32_t cell,
                           std::uint32_t sample) {
  const size_t num_sigmas = options.sigmas_px.size();
  const SampleFamily family(options.nums_points[cell / num_sigmas], options.baseline_m,
                            options.sigmas_px[cell % num_sigmas]);
  return RunSample(family, {options.seed, kFirstCell + cell, sample}, options);
}

Table MakeValidityReferenceTable(const ValidityReferenceOptions& options, const CountsOfCell& counts_of) {
  Table table{{Column::Number("sigma_px", MakeCsvFormat("")), Column::Count("num_points"),
               Column::Number("baseline_m", MakeCsvFormat("")), Column::Text("quantity"),
               Column::Text("covariance"), Column::Count("num_samples"), Column::Count("n"),
               Column::Count("num_covered")}};
  table.AddColumns(CoverageColumns());
  const std::int64_t n = std::int64_t{options.num_samples} * options.num_draws;
  std::uint32_t cell = 0;
  for (const int num_points : options.nums_points) {
    for (const double sigma_px : options.sigmas_px) {
      const CoveredCounts counts = counts_of(cell++);
      for (size_t q = 0; q < kReferenceQuantities.size(); ++q) {
        for (size_t c = 0; c < kCovariances.size(); ++c) {
          table.rows.push_back({sigma_px, std::int64_t{num_points}, options.baseline_m,
                                kReferenceQuantities[q], kCovariances[c], std::int64_t{options.num_samples},
                                n, counts[q][c]});
          AddCoverage(counts[q][c], n, &table.rows.back());
        }
      }
    }
  }
  return table;
}

}  // namespace rcme
