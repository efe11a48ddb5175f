// Classifies a problem, independently of any estimator: Type A (no translation, or too little to be
// observed), Type B (all points on a plane), or neither (Torr, Fitzgibbon & Zisserman 1999).
//
// A criterion chooses among rotation, homography and epipolar geometry, each fitted to the matches
// (two_view_models.h). If it chooses the rotation, the verdict is rotation_only. Otherwise the parallax is
// measured: the rotation that best fits the inliers of the chosen model is compared with each of them, and an
// inlier beyond its chi2_2 quantile shows parallax. If fewer than a given share of the inliers do, the
// verdict is too_little_parallax. Otherwise a homography is planar and an epipolar geometry general.
//
// The defaults: 1 % of the matches of a rotation show parallax by chance. If all matches have a parallax of
// delta standard deviations (beyond what the best rotation absorbs), a tenth of them show it at delta = 1.5.
// There 1 / (1 + delta^2) = 31 % of the information about the direction is noise, near the bound of
// `direction_not_observable`, 25 % (kMostNoiseInDirection, observability.h). The share is a tenth rather than
// a half because far points do not make a problem unsolvable.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "estimator/model_choice/two_view_models.h"
#include "estimator/motion_estimate.h"
#include "parameters/parameter.h"

namespace rcme {

enum class SceneVerdict { kGeneral, kPlanar, kRotationOnly, kTooLittleParallax };
inline constexpr std::array<SceneVerdict, 4> kSceneVerdicts = {SceneVerdict::kGeneral, SceneVerdict::kPlanar,
                                                               SceneVerdict::kRotationOnly,
                                                               SceneVerdict::kTooLittleParallax};
// "general", "planar", "rotation_only", "too_little_parallax".
const std::string& Name(SceneVerdict verdict);

enum class ModelCriterion {
  kOrbSlam2,  // orb_slam2.h; has no rotation model: a pure rotation is too_little_parallax
  kAic,       // criteria.h
  kGic,
  kGric,
  kGricOfInliers,  // over the matches that agree with at least one model
  kPlunderDl,
};
const std::vector<std::pair<std::string, ModelCriterion>>& CriterionNames();

struct ModelChoiceOptions {
  ModelCriterion criterion = ModelCriterion::kGric;
  double parallax_significance_level = 0.01;  // probability that a match of a rotation shows parallax
  double least_parallax_share = 0.1;          // least share of the inliers that show parallax
};
// The options of the parallax test; gate.h adds the criterion.
std::vector<Parameter> ParallaxParameters(ModelChoiceOptions& options);

struct ModelChoice {
  // kOk: there is a verdict. Otherwise the reason why there is none: kInvalidInput, kTooFewMatches (fewer
  // than six distinct ones), kDegenerateMatches, or kNotBetterThanChance: chance explains as many agreeing
  // matches for some model of the chosen kind (motion_chance.h, NFA above 0.001).
  MotionStatus status = MotionStatus::kInvalidInput;
  std::string message;  // one sentence for a person
  SceneVerdict verdict = SceneVerdict::kGeneral;

  // The chosen model, of least score; of equal ones the smaller model.
  TwoViewModel model = TwoViewModel::kEssential;
  // In the order of kTwoViewModels, in the criterion's own units; infinite: not compared.
  std::array<double, 3> scores{};
  int num_inliers = 0;          // of the chosen model, within the 99.9 % quantile
  double parallax_share = 0.0;  // of these; NaN if the rotation was chosen
};

// The verdict of one criterion. Never throws for bad matches. A pure function of the problem and the stream's
// name. `fits`, if not null, receives the models if there is a verdict.
ModelChoice ChooseModel(const MotionProblem& problem, const ModelChoiceOptions& options, RandomStream& rng,
                        TwoViewFits* fits = nullptr);

// The verdicts under several options from one fit of the models; each equals that of ChooseModel.
std::vector<ModelChoice> ChooseModels(const MotionProblem& problem,
                                      const std::vector<ModelChoiceOptions>& options, RandomStream& rng,
                                      TwoViewFits* fits = nullptr);

}  // namespace rcme
