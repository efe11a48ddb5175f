#include "experiments/audit/claims/case.h"

#include <fmt/format.h>

#include "estimator/uncertainty/motion_covariance.h"
#include "experiments/data/make_data.h"
#include "parameters/settings.h"
#include "simulator/exact_match.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

Settings WithDefaults(const Settings& settings) {
  Settings all = {{"scene", "uniform_volume"}, {"outlier_ratio", "0"}, {"severity", "skipped"}};
  all.insert(all.end(), settings.begin(), settings.end());
  return all;
}

}  // namespace

std::optional<Matrix5d> CramerRaoBound(const Case& made) {
  const MotionProblem& problem = made.problem();
  std::vector<Correspondence> exact;
  for (size_t i = 0; i < made.data.scene_point.size(); ++i) {
    if (!made.data.truth.is_inlier_true[i]) continue;
    const Eigen::Vector3d& point = made.scene.points_in_cam1[made.data.scene_point[i]];
    exact.push_back(PinholeMatch(made.scene, point));
  }
  if (exact.size() < 5) return std::nullopt;
  return FirstOrderMotionCovariance(made.pose_true(), problem.camera1, problem.camera2, exact,
                                    problem.sigma_px);
}

CaseMaker CasesFrom(std::shared_ptr<const SimulatedData> simulated) {
  return [simulated = std::move(simulated)](const StreamName& name) {
    Case made{name, simulated->DrawScene(name), {}, StreamFor(name, StreamPurpose::kCheck)};
    made.data = simulated->MakeFrom(made.scene, name);
    made.sigma_px_true = simulated->sigma_px();
    return made;
  };
}

CaseMaker SimulatedCases(const Settings& settings) {
  return CasesFrom(MakeSimulatedData(WithDefaults(settings)));
}

Settings ResolveCaseSettings(const Settings& settings) { return ResolveSettings(WithDefaults(settings)); }

Check MakeCheck(const Settings& settings, const Statistic& statistic, const std::vector<Target>& targets,
                const TrialLimits& limits) {
  Check check;
  check.conditions = settings;
  if (const auto sigma_px = FindSetting(settings, "sigma_px")) check.sigma_px = std::stod(*sigma_px);
  check.targets = targets;
  check.limits = limits;
  check.trial = [cases = SimulatedCases(settings), statistic](const StreamName& name) {
    Case made = cases(name);
    return statistic(made);
  };
  return check;
}

std::vector<Check> ChecksAtNoiseLevels(const std::vector<double>& sigmas_px, const Settings& settings,
                                       const Statistic& statistic, const std::vector<Target>& targets,
                                       const TrialLimits& limits) {
  std::vector<Check> checks;
  for (const double sigma_px : sigmas_px) {
    Settings at_sigma = settings;
    at_sigma.emplace_back("sigma_px", fmt::format("{}", sigma_px));
    checks.push_back(MakeCheck(at_sigma, statistic, targets, limits));
  }
  return checks;
}

std::vector<Target> CoverageTargets(int degrees_of_freedom, const ScaleTolerance& tolerance) {
  constexpr double kFirstAlpha = 0.05;
  std::vector<Target> targets;
  for (const double alpha : {0.5, 0.2, 0.1, 0.05, 0.01}) {
    Target target{fmt::format("coverage at alpha {}", alpha),
                  Target::Kind::kCoverage,
                  1.0 - alpha,
                  CoverageWithin(degrees_of_freedom, alpha, tolerance.coverage),
                  ChiSquareQuantile(degrees_of_freedom, 1.0 - alpha),
                  0,
                  degrees_of_freedom};
    targets.insert(alpha == kFirstAlpha ? targets.begin() : targets.end(), std::move(target));
  }
  targets.push_back({"mean PIT", Target::Kind::kMeanPit, 0.5,
                     MeanPitWithin(degrees_of_freedom, tolerance.mean_pit),
                     std::numeric_limits<double>::quiet_NaN(), 0, degrees_of_freedom});
  return targets;
}

Target IdentityTarget(const std::string& quantity, double tolerance) {
  return {quantity, Target::Kind::kCoverage, 1.0, AllowedRate(1.0, kIdentity.margin), tolerance};
}

Claim OnBuiltInScene(const CaseClaim& claim, const std::vector<Settings>& settings) {
  Claim on_scene = claim.words;
  for (const Settings& each : settings) {
    on_scene.checks.push_back(MakeCheck(each, claim.statistic, claim.targets, claim.limits));
    on_scene.checks.back().difficulty_statistic = claim.difficulty_statistic;
    on_scene.checks.back().not_stated = claim.not_stated;
  }
  return on_scene;
}

Claim AtNoiseLevels(const CaseClaim& claim, const std::vector<double>& sigmas_px, const Settings& settings) {
  Claim on_scene = claim.words;
  on_scene.checks = ChecksAtNoiseLevels(sigmas_px, settings, claim.statistic, claim.targets, claim.limits);
  return on_scene;
}

}  // namespace rcme
