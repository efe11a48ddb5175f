// The question of a user with a given camera: which estimator to use, how far to trust it, and how many
// trials are needed to know.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace rcme {

// The user's input as text; empty: not given yet.
struct AskedTexts {
  std::string image;     // "1280x720" or "1280 720", px
  std::string focal_px;  // focal length, for fx and fy
  std::string sigma_px;  // standard deviation of the noise per coordinate
  std::string scene;     // see `rcme list scenes`
  std::string wrong;     // share of wrong matches, "0.4" or "40%"
  // Not needed: the scene has a usual motion, and wrong matches are uniform.
  std::string motion = {};    // see `rcme list motions`
  std::string outliers = {};  // see `rcme list outliers`
};

struct Question {
  int image_width = 0, image_height = 0;  // px
  double focal_px = 0.0, sigma_px = 0.0;
  double focal_error = 0.0;  // relative error of the focal length that estimators assume; as the study's key
  std::string scene;
  std::string motion;  // empty: the scene's usual one
  double outlier_ratio = 0.0;
  std::string outliers = "uniform";  // see `rcme list outliers`
  int num_matches = 500;
  double max_rotation_error_deg = 3.0, max_direction_error_deg = 15.0;
  std::uint64_t seed = 1;
};

// The horizontal view, in deg, of a pinhole that `ask` answers for.
inline constexpr double kLeastViewDeg = 1.0, kGreatestViewDeg = 150.0;

// Asks on `out` for each missing text and reads it as a line of `in`; says why a text cannot be used and asks
// again. If a needed text is missing, it asks for the others too, which may stay empty. Throws InputError
// that names the options of the missing texts if `in` ends early.
void AskForMissing(std::istream& in, std::ostream& out, AskedTexts* texts);

// The options of the needed texts that are missing: {"--focal"}.
std::vector<std::string> MissingOptions(const AskedTexts& texts);

// Parses a share, also in percent: 0.4 for "0.4", "40%" and "40 %". Returns false if the text is not a share.
bool ParseShare(const std::string& text, double* share);

// Parses the texts that are given into `question`. Throws InputError that names the option and the allowed
// values, also if a pinhole has no such view (a focal length in mm).
void ReadTexts(const AskedTexts& texts, Question* question);

// Throws InputError if the scene cannot have such wrong matches.
void CheckOutliers(const Question& question);

// Whether the true motion has a direction of translation, without which nobody can find one.
bool HasDirection(const Question& question);

// The study that answers the question, as YAML: one condition with `trials` trials, for rcme_calibrated and
// its usual alternatives. Unknown names are refused when the study is read.
std::string MakeStudyText(const Question& question, int trials);

// The name of the folder of this question, alike for all numbers of trials: "answer_corridor_f900_wrong40_"
// and eight digits, a hash of the study.
std::string MakeFolderName(const Question& question);

// "1280 x 720 px, f 900 px, noise 0.7 px; corridor; 40 % wrong (clustered_both) of 500 matches".
std::string DescribeQuestion(const Question& question);

}  // namespace rcme
