#include "experiments/commands/front_end_options.h"

#include <string>
#include <vector>

#include "experiments/commands/common_options.h"

namespace rcme {

void AddFrontEndOptions(CLI::App* command, DetectorOptions* detector, MatcherOptions* matcher,
                        bool* has_scores) {
  std::vector<std::string> names;
  for (const auto& [name, value] : DetectorNames()) names.push_back(name);
  command
      ->add_option_function<std::string>(
          "--detector",
          [detector](const std::string& chosen) {
            for (const auto& [name, value] : DetectorNames()) {
              if (name == chosen) detector->detector = value;
            }
          },
          "detector and descriptor of key points; default: sift")
      ->check(MakeChoiceValidator(names));
  command
      ->add_option("--max-features", detector->max_features,
                   "number of strongest key points to keep per image; 0: all of sift and akaze, 2,000 of orb")
      ->transform(WholeNumberIn(0, 1'000'000))
      ->capture_default_str();
  command->add_flag(
      "--subpixel", detector->refines_corners,
      "with orb: move key points of the two finest scales to the corner nearby, by parts of a pixel");
  command
      ->add_option("--ratio", matcher->max_ratio,
                   "keep a match if nearest / second nearest is below this; 1: no such test")
      ->transform(NumberIn({0.01, 1.0}))
      ->capture_default_str();
  command->add_flag_callback(
      "--one-way", [matcher] { matcher->is_mutual = false; },
      "also keep matches that are nearest in one direction only; "
      "a key point of image 2 may then have several");
  command->add_flag("--scores", *has_scores,
                    "write nearest / second nearest of each match as a column score, the lower the better");
}

}  // namespace rcme
