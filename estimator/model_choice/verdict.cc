#include "estimator/model_choice/verdict.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimator/model_choice/homography.h"
#include "estimator/model_choice/orb_slam2.h"
#include "estimator/motion_chance.h"
#include "estimator/observability.h"
#include "estimator/problem_check.h"
#include "estimator/reference_matches.h"
#include "estimator/refinement/rotation_mle.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/moments.h"

namespace rcme {
namespace {

// One more than a minimal sample: five matches leave an epipolar geometry no residual.
constexpr int kLeastMatches = 6;

constexpr double kInlierLevel = 0.001;   // significance level of a model's inliers
constexpr double kChanceLevel = 0.001;   // bound of the NFA
constexpr double kAgreeingLevel = 0.01;  // significance level of the matches that kGricOfInliers uses

using Criterion = double (*)(std::span<const double>, const ModelDimensions&);

std::array<double, 3> ScoresBy(Criterion score, const TwoViewFits& fits) {
  std::array<double, 3> scores{};
  for (size_t m = 0; m < kTwoViewModels.size(); ++m) {
    scores[m] = score(fits[kTwoViewModels[m]].squared_residuals, FindDimensions(kTwoViewModels[m]));
  }
  return scores;
}

// S_H / (S_H + S_F) > c means c S_F < (1 - c) S_H; with both sides negated, the least score wins.
std::array<double, 3> OrbSlam2Scores(const MotionProblem& problem, const TwoViewFits& fits) {
  constexpr double c = kOrbSlam2HomographyShare;
  return {kInfinity, -(1.0 - c) * OrbSlam2HomographyScore(problem, fits.homography.matrix),
          -c * OrbSlam2EpipolarScore(problem, fits.essential.matrix)};
}

TwoViewFits OfMatchesThatAgree(const TwoViewFits& fits) {
  std::vector<bool> agrees(fits.rotation.squared_residuals.size(), false);
  for (const TwoViewModel model : kTwoViewModels) {
    for (const int i : FindInliers(fits[model], model, kAgreeingLevel)) agrees[static_cast<size_t>(i)] = true;
  }
  TwoViewFits part;
  for (size_t i = 0; i < agrees.size(); ++i) {
    if (!agrees[i]) continue;
    part.rotation.squared_residuals.push_back(fits.rotation.squared_residuals[i]);
    part.homography.squared_residuals.push_back(fits.homography.squared_residuals[i]);
    part.essential.squared_residuals.push_back(fits.essential.squared_residuals[i]);
  }
  return part;
}

std::array<double, 3> ComputeScores(ModelCriterion criterion, const MotionProblem& problem,
                                    const TwoViewFits& fits) {
  switch (criterion) {
    case ModelCriterion::kAic:
      return ScoresBy(AicScore, fits);
    case ModelCriterion::kGic:
      return ScoresBy(GicScore, fits);
    case ModelCriterion::kGric:
      return ScoresBy(GricScore, fits);
    case ModelCriterion::kGricOfInliers:
      return ScoresBy(GricScore, OfMatchesThatAgree(fits));
    case ModelCriterion::kPlunderDl:
      return ScoresBy(PlunderDlScore, fits);
    case ModelCriterion::kOrbSlam2:
      break;
  }
  return OrbSlam2Scores(problem, fits);
}

const ModelFamily& FindModelFamily(TwoViewModel model) {
  switch (model) {
    case TwoViewModel::kRotation:
      return kRotations;
    case TwoViewModel::kHomography:
      return kHomographies;
    case TwoViewModel::kEssential:
      break;
  }
  return kMotions;
}

// Mean of sqrt(det C) over the matches, in units of sigma^2 (homography.h).
double MeanRootDeterminant(const MotionProblem& problem, const Eigen::Matrix3d& H) {
  const RayMatches all(problem);
  Moments roots;
  for (const RayMatch& match : all.matches) {
    const std::optional<Transfer> transfer = EvaluateTransfer(H, match, all.noise);
    if (transfer) roots.Add(1.0 / std::sqrt(transfer->information.determinant()));
  }
  return roots.mean() / (all.noise.x2 * all.noise.y2);
}

// The probability that a random match agrees with the model.
double ComputeModelChance(TwoViewModel model, const MotionProblem& problem, const TwoViewFits& fits) {
  const double threshold = ChiSquareQuantile(FindDimensions(model).codimension(), 1.0 - kInlierLevel);
  if (model == TwoViewModel::kEssential) return ChanceOfAgreement(problem, fits.motion, threshold);
  return ChanceOfAgreementInEllipse(problem, threshold, MeanRootDeterminant(problem, fits[model].matrix));
}

// The number of inliers beyond the chi2_2 quantile of the rotation that fits the inliers best.
int CountParallax(const MotionProblem& problem, const std::vector<int>& inliers, const Eigen::Matrix3d& R,
                  double significance_level) {
  const ReferenceMatches matches(problem, RefinementError::kSampson);
  const double fit_threshold = TailThreshold(static_cast<int>(problem.matches.size()), significance_level);
  const RotationFit rotation = FitRotation(matches, inliers, R, fit_threshold);
  const double threshold = ChiSquareQuantile(2, 1.0 - significance_level);
  const std::vector<int> rotated = matches.Intersect(matches.FindRotated(rotation.R, threshold), inliers);
  return static_cast<int>(inliers.size() - rotated.size());
}

std::string DescribeChoice(const ModelChoice& choice, size_t num_matches) {
  switch (choice.verdict) {
    case SceneVerdict::kRotationOnly:
      return fmt::format("a rotation alone explains {} of {} matches: there is no translation to be seen",
                         choice.num_inliers, num_matches);
    case SceneVerdict::kTooLittleParallax:
      return fmt::format("{:.1f} % of the {} matches that agree show parallax beyond the noise",
                         100.0 * choice.parallax_share, choice.num_inliers);
    case SceneVerdict::kPlanar:
      return fmt::format("a homography explains {} of {} matches: the points lie on a plane",
                         choice.num_inliers, num_matches);
    case SceneVerdict::kGeneral:
      break;
  }
  return fmt::format("an epipolar geometry explains {} of {} matches, and no smaller model does",
                     choice.num_inliers, num_matches);
}

// The verdict that follows from the chosen model.
void Decide(const MotionProblem& problem, const TwoViewFits& fits, const ModelChoiceOptions& options,
            ModelChoice* choice) {
  const std::vector<int> inliers = FindInliers(fits[choice->model], choice->model, kInlierLevel);
  choice->num_inliers = static_cast<int>(inliers.size());
  const double log_false_alarms =
      LogFalseAlarms(FindModelFamily(choice->model), static_cast<int>(problem.matches.size()),
                     choice->num_inliers, ComputeModelChance(choice->model, problem, fits));
  if (log_false_alarms > std::log(kChanceLevel)) {
    choice->status = MotionStatus::kNotBetterThanChance;
    choice->message = fmt::format("{} of {} matches agree with the best model, no more than chance explains",
                                  inliers.size(), problem.matches.size());
    return;
  }
  choice->status = MotionStatus::kOk;
  if (choice->model == TwoViewModel::kRotation) {
    choice->verdict = SceneVerdict::kRotationOnly;
    choice->parallax_share = std::numeric_limits<double>::quiet_NaN();
  } else {
    const int num_parallax =
        CountParallax(problem, inliers, fits.rotation.matrix, options.parallax_significance_level);
    choice->parallax_share = static_cast<double>(num_parallax) / choice->num_inliers;
    choice->verdict = choice->parallax_share < options.least_parallax_share ? SceneVerdict::kTooLittleParallax
                      : choice->model == TwoViewModel::kHomography          ? SceneVerdict::kPlanar
                                                                            : SceneVerdict::kGeneral;
  }
  choice->message = DescribeChoice(*choice, problem.matches.size());
}

}  // namespace

const std::string& Name(SceneVerdict verdict) {
  static const std::vector<std::string> names = {"general", "planar", "rotation_only", "too_little_parallax"};
  return names[static_cast<size_t>(verdict)];
}

const std::vector<std::pair<std::string, ModelCriterion>>& CriterionNames() {
  static const std::vector<std::pair<std::string, ModelCriterion>> names = {
      {"orb_slam2", ModelCriterion::kOrbSlam2},
      {"aic", ModelCriterion::kAic},
      {"gic", ModelCriterion::kGic},
      {"gric", ModelCriterion::kGric},
      {"gric_of_inliers", ModelCriterion::kGricOfInliers},
      {"plunder_dl", ModelCriterion::kPlunderDl}};
  return names;
}

std::vector<Parameter> ParallaxParameters(ModelChoiceOptions& options) {
  return {Parameter::Real("parallax_significance_level", &options.parallax_significance_level, {1e-9, 0.5},
                          "", "model_choice: level at which a match shows parallax"),
          Parameter::Real("least_parallax_share", &options.least_parallax_share, {0.0, 1.0}, "",
                          "model_choice: too_little_parallax if fewer agreeing matches show parallax")};
}

std::vector<ModelChoice> ChooseModels(const MotionProblem& problem,
                                      const std::vector<ModelChoiceOptions>& options, RandomStream& rng,
                                      TwoViewFits* wanted_fits) {
  std::vector<ModelChoice> choices(options.size());
  if (const std::optional<MotionEstimate> refusal = RefuseUnsolvable(problem, kLeastMatches)) {
    for (ModelChoice& choice : choices) {
      choice.status = refusal->status;
      choice.message = refusal->message;
    }
    return choices;
  }
  const TwoViewFits fits = FitTwoViewModels(problem, rng);
  for (size_t i = 0; i < options.size(); ++i) {
    choices[i].scores = ComputeScores(options[i].criterion, problem, fits);
    choices[i].model = kTwoViewModels[static_cast<size_t>(std::ranges::min_element(choices[i].scores) -
                                                          choices[i].scores.begin())];
    Decide(problem, fits, options[i], &choices[i]);
  }
  if (wanted_fits) *wanted_fits = fits;
  return choices;
}

ModelChoice ChooseModel(const MotionProblem& problem, const ModelChoiceOptions& options, RandomStream& rng,
                        TwoViewFits* fits) {
  return ChooseModels(problem, {options}, rng, fits).front();
}

}  // namespace rcme
