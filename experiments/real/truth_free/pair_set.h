// Image pairs that are validated without ground truth, and an estimator's answers to them.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "estimator/motion_estimate.h"
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

// An estimator's answers to the pairs of a set and to their twins.
struct Answered {
  NamedPair pair;
  MotionEstimate estimate;
  bool IsOk() const { return estimate.status == MotionStatus::kOk; }
};

struct PairAnswers {
  Answered whole;
  std::vector<Answered> twins;  // empty if the pair itself has no motion
};

// Numbers the images of each pair for stats/shared_members.h. A pair that does not name its images has one
// number of its own for both.
struct ImageNumbers {
  std::int64_t image1 = 0, image2 = 0;
};
std::vector<ImageNumbers> NumberImages(const std::vector<PairAnswers>& answers);

}  // namespace rcme
