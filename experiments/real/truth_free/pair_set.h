// Image pairs that are validated without ground truth.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "estimator/motion_problem.h"
#include "experiments/study/study_plan.h"

namespace rcme {

struct NamedPair {
  std::string name;
  std::string image1, image2;  // equal names are the same image; empty: not known
  MotionProblem problem;
  double seconds_between = std::numeric_limits<double>::quiet_NaN();  // between the images; NaN: not known
};

// Pairs of one scene, or of one condition of a study.
struct PairSet {
  std::string name;
  std::vector<NamedPair> pairs;
};

// One set for each scene named in the headers of a folder's match files. sigma_px: the assumed noise level,
// in place of that of the files. Throws InputError (match_folder.h, match_file.h), also if it is not given
// and the files of a scene state different ones.
std::vector<PairSet> PairSetsOfFolder(const std::string& folder, std::optional<double> sigma_px);
// One set for each condition of a study, one pair for each trial.
std::vector<PairSet> PairSetsOfStudy(const StudyPlan& plan);
// One set for each condition. Each trial is a sequence of images (experiments/data/simulated_sequence.h), and
// its pairs name their images. Throws InputError for a study of real pairs.
std::vector<PairSet> SequencesOfStudy(const StudyPlan& plan, int num_images);

}  // namespace rcme
