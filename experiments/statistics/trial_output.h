// One trial for people: the data of its picture, and a short summary as text.
#pragma once

#include <string>
#include <vector>

#include "experiments/study/study_plan.h"
#include "experiments/trial/trial.h"

namespace rcme {

// Returns the estimator to show by default: the first that failed or refused, else the first.
size_t MostTelling(const StudyPlan& plan, const TrialResult& result);

// Returns the data that plots/show_trial.py draws, as one JSON object. Lists over matches have the order of
// the matches; matrices are row-major lists of nine; unknown or undefined values are null.
//
//   study, seed, condition, trial, trials_planned, origin, sigma_px (assumed)
//   factors, parts     [name, level] each; parts are scene, cameras, motion, noise, outliers
//   bounds, severity   by name
//   cameras            the true ones, image 1 first
//   matches            [x1, y1, x2, y2] each, px
//   kinds              "inlier", "outlier", or "undetectable": wrong, but on the true epipolar line
//   points_in_cam1_m   the scene point from which each match was made
//   views              per camera: its centre_in_cam1_m, and edges_in_cam1: the rays of the left, right,
//                      upper and lower edge of the image, straight beside the principal point
//   truth              R, t, baseline_m, F; t and F are null if the direction is not known
//   selected           up to eight matches, spread over image 1, whose epipolar lines are drawn
//   drawn              indices of the estimators to draw, in this order
//   estimators         all of them: label, status, message, outcome (success, failure, refusal, not_scored),
//                      errors, inliers, R, t, F, and centre2_in_cam1_m: the estimated centre of camera 2 for
//                      the true baseline length
//
// Real pairs have no kinds, points and views. F of the truth is between the true cameras; F of an estimate
// is between the cameras that the estimators assume.
std::string TrialAsJson(const StudyPlan& plan, const TrialResult& result, const std::vector<size_t>& drawn);

// Describes the condition and the difficulty of the problem, with a row per estimator.
std::string TrialAsText(const StudyPlan& plan, const TrialResult& result);

}  // namespace rcme
