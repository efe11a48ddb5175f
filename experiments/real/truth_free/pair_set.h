// The image pairs that are validated without a truth.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "estimator/motion_problem.h"
#include "experiments/study/study_plan.h"

namespace rcme {

struct NamedPair {
  std::string name;
  std::string image1, image2;  // equal names: the same image; empty: not known
  MotionProblem problem;
  double seconds_between = std::numeric_limits<double>::quiet_NaN();  // of one video; NaN: not said
};

// Pairs of one scene, or of one condition of a study.
struct PairSet {
  std::string name;
  std::vector<NamedPair> pairs;
};

// Every match file of a folder, by the scenes of their headers; the assumed noise level is sigma_px. Throws
// InputError (match_folder.h, match_file.h).
std::vector<PairSet> PairSetsOfFolder(const std::string& folder, double sigma_px);
// Every trial of every condition of a study.
std::vector<PairSet> PairSetsOfStudy(const StudyPlan& plan);
// Each trial a sequence of images (experiments/data/simulated_sequence.h), whose pairs name them. Throws
// InputError for a study of real pairs.
std::vector<PairSet> SequencesOfStudy(const StudyPlan& plan, int num_images);

}  // namespace rcme
