// What kind of problem is it? One verdict for any estimator: Type A (no translation, or too little of it to
// be seen), Type B (all points on a plane), or neither (Torr, Fitzgibbon & Zisserman 1999).
//
// A criterion chooses among rotation, homography and epipolar geometry, each fitted to the matches
// (two_view_models.h). The rotation chosen: rotation_only. Otherwise the parallax is looked at: the rotation
// that fits the chosen model's inliers best is held against each of them, and one that lies beyond its chi2_2
// quantile shows parallax. Where fewer than a share of the inliers do, there is too little of it. Otherwise a
// homography is planar, an epipolar geometry general.
//
// With the defaults, one in a hundred of a rotation's matches shows parallax by chance, and of matches that
// all have a parallax of delta standard deviations (beyond what the best rotation takes of it) a tenth does
// at delta = 1.5, where 1 / (1 + delta^2) = 31 % of what determines the direction is noise: near the bound of
// `direction_not_observable`, 25 % (kMostNoiseInDirection, observability.h). A tenth, not a half: far points
// do not make a problem hopeless.
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
  kOrbSlam2,  // orb_slam2.h; knows no rotation: where there is one, too_little_parallax
  kAic,       // criteria.h
  kGic,
  kGric,
  kGricOfInliers,  // of the matches that agree with one of the models
  kPlunderDl,
};
const std::vector<std::pair<std::string, ModelCriterion>>& CriterionNames();

struct ModelChoiceOptions {
  ModelCriterion criterion = ModelCriterion::kGric;
  double parallax_significance_level = 0.01;  // a rotation's match shows parallax with this probability
  double least_parallax_share = 0.1;          // of the inliers that have to show parallax
};
// Those of the parallax; the criterion is named where it is chosen (gate.h).
std::vector<Parameter> ParallaxParameters(ModelChoiceOptions& options);

struct ModelChoice {
  // kOk: there is a verdict. Otherwise why there is none: kInvalidInput, kTooFewMatches (fewer than six
  // distinct ones), kDegenerateMatches, or kNotBetterThanChance: no more matches agree with the chosen model
  // than would agree with one of its kind if all were random (motion_chance.h, NFA above 0.001).
  MotionStatus status = MotionStatus::kInvalidInput;
  std::string message;  // one sentence for a person
  SceneVerdict verdict = SceneVerdict::kGeneral;

  TwoViewModel model = TwoViewModel::kEssential;  // chosen: of the least score, the smaller one at a tie
  // In the order of kTwoViewModels, in the criterion's own units; infinite: not compared.
  std::array<double, 3> scores{};
  int num_inliers = 0;          // of the chosen model, at 99.9 %
  double parallax_share = 0.0;  // of these; NaN where the rotation was chosen
};

// The verdict of one criterion. Never throws for bad matches. A pure function of the problem and the stream's
// name. `fits`, where it is wanted, gets the models where there is a verdict.
ModelChoice ChooseModel(const MotionProblem& problem, const ModelChoiceOptions& options, RandomStream& rng,
                        TwoViewFits* fits = nullptr);

// The verdicts under several options, from one fit of the models: each what ChooseModel gives.
std::vector<ModelChoice> ChooseModels(const MotionProblem& problem,
                                      const std::vector<ModelChoiceOptions>& options, RandomStream& rng,
                                      TwoViewFits* fits = nullptr);

}  // namespace rcme
