// One trial's matches and all that its stages take and give, made beforehand so that each stage can be timed
// alone.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "estimator/kernels/block_search.h"
#include "estimator/kernels/five_point_block.h"
#include "estimator/refinement/motion_search.h"
#include "estimator/solvers/eight_point.h"
#include "estimator/solvers/five_point.h"
#include "experiments/data/data_source.h"

namespace rcme {

inline constexpr int kNumMatches = 500;
inline constexpr int kNumHypotheses = 200;
inline constexpr int kNumBenchmarkTrials = 8;

// Scene uniform_volume, 20 % outliers, sigma 0.5 px.
struct BenchmarkTrial {
  BenchmarkTrial(int num_matches, std::uint32_t trial);

  StreamName name;
  TrialData data;
  MatchBlocks blocks;
  std::vector<cv::Point2f> x1, x2;  // for OpenCV: in the type it works with

  // The hypotheses of the samples, eight at a time and one by one, and the models of the former.
  std::vector<Sample> samples;
  std::vector<HypothesisBlock> hypothesis_blocks;
  std::vector<Hypothesis<EightPoint>> hypotheses;
  std::vector<WhitenedModel> models;
  std::vector<VariancePolynomial> variances;

  // The first five matches of every sample, eight samples at a time and one by one.
  struct FiveRays {
    FivePoint::Rays first, second;
  };
  std::vector<FivePointSamples> five_point_samples;
  std::vector<FiveRays> five_rays;

  // The hypothesis with most inliers by the known-pose test, and these.
  HypothesisId winner;
  MatchMask support;

  // The right matches, a start off the true motion by 0.01 rad in each coordinate, and the fit from there.
  std::vector<int> inliers;
  MatchMask inlier_mask;
  RelativePose start;
  RefinedMotion refined;

 private:
  void MakeHypotheses(int num_matches);
  void MakeFivePointSamples();
  void FindWinner();
};

// Trials 0, 1, ... of the scene.
std::vector<BenchmarkTrial> MakeBenchmarkTrials(int num_matches, int num_trials);
const std::vector<BenchmarkTrial>& BenchmarkTrials();  // kNumBenchmarkTrials with kNumMatches matches each

TrialData MakeBenchmarkData(int num_matches, std::uint32_t trial, const std::string& outlier_ratio = "0.2");

}  // namespace rcme
