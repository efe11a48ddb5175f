// The question of somebody with a camera: which estimator, how far can it be trusted, how many trials?
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

namespace rcme {

// What the question needs, as text; empty: not said yet.
struct AskedTexts {
  std::string image;     // "1280x720" or "1280 720", px
  std::string focal_px;  // of fx and fy
  std::string sigma_px;  // noise per coordinate
  std::string scene;     // of `rcme list scenes`
  std::string wrong;     // share of wrong matches, "0.4" or "40%"
};

struct Question {
  int image_width = 0, image_height = 0;  // px
  double focal_px = 0.0, sigma_px = 0.0;
  std::string scene;
  std::string motion;  // empty: the scene's usual one
  double outlier_ratio = 0.0;
  std::string outliers = "uniform";  // of `rcme list outliers`
  int num_matches = 500;
  double max_rotation_error_deg = 3.0, max_direction_error_deg = 15.0;
  std::uint64_t seed = 1;
};

// Asks on `out` for each text that is missing and reads a line of `in` for it. Throws InputError that names
// the options if `in` ends before.
void AskForMissing(std::istream& in, std::ostream& out, AskedTexts* texts);

// Those of the options that are missing: {"--focal"}.
std::vector<std::string> MissingOptions(const AskedTexts& texts);

// A share, also of a text in percent: 0.4 of "0.4", "40%" and "40 %". False: the text is none.
bool ParseShare(const std::string& text, double* share);

// Fills in what the texts say. Throws InputError that names the option and what is allowed.
void ReadTexts(const AskedTexts& texts, Question* question);

// The study of so many trials that answers the question, as YAML: its one condition, rcme_calibrated and
// those one would take instead. Names that the program does not have are refused by whoever reads it.
std::string MakeStudyText(const Question& question, int trials);

// "1280 x 720, f 900 px, noise 0.7 px; corridor; 40 % wrong (clustered_both), 500 matches".
std::string DescribeQuestion(const Question& question);

}  // namespace rcme
