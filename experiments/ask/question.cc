#include "experiments/ask/question.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <istream>
#include <numbers>
#include <ostream>

#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"
#include "simulator/motion_registry.h"
#include "simulator/outlier_registry.h"
#include "simulator/scene_registry.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

double ReadNumber(const char* option, const std::string& text, double least, double greatest) {
  double value = 0.0;
  if (ParseReal(text, &value) && value >= least && value <= greatest) return value;
  throw InputError(fmt::format("{}: {} is not allowed; give a number in [{:g}, {:g}]", option, Quoted(text),
                               least, greatest));
}

double ReadShare(const char* option, const std::string& text, double greatest) {
  double share = 0.0;
  if (ParseShare(text, &share) && share >= 0.0 && share <= greatest) return share;
  throw InputError(fmt::format("{}: {} is not allowed; give a share in [0, {:g}], such as 0.4 or 40%", option,
                               Quoted(text), greatest));
}

// The numbers of "1280x720", "1280 x 720", "1280 720".
std::vector<std::string> SplitSize(const std::string& text) {
  const char* const separators = "xX* \t";
  std::vector<std::string> numbers;
  for (size_t begin = text.find_first_not_of(separators); begin != std::string::npos;) {
    const size_t end = std::min(text.find_first_of(separators, begin), text.size());
    numbers.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(separators, end);
  }
  return numbers;
}

void ReadSize(const std::string& text, int* width, int* height) {
  const auto read = [](const std::string& number, int* pixels) {
    long long value = 0;
    const bool is_allowed = ParseInteger(number, &value) && value >= 16 && value <= 100'000;
    if (is_allowed) *pixels = static_cast<int>(value);
    return is_allowed;
  };
  const std::vector<std::string> numbers = SplitSize(text);
  if (numbers.size() == 2 && read(numbers[0], width) && read(numbers[1], height)) return;
  throw InputError(fmt::format(
      "--image: {} is not allowed; give WIDTHxHEIGHT in px, each in [16, 100000], such as 1280x720",
      Quoted(text)));
}

// Throws InputError unless a pinhole with this image and focal length has a plausible horizontal view.
void CheckView(const Question& q) {
  constexpr double kDeg = std::numbers::pi / 180.0;
  const double view_deg = 2.0 * std::atan(0.5 * q.image_width / q.focal_px) / kDeg;
  if (view_deg >= kLeastViewDeg && view_deg <= kGreatestViewDeg) return;
  const auto focal_of = [&](double deg) { return 0.5 * q.image_width / std::tan(0.5 * deg * kDeg); };
  throw InputError(fmt::format(
      "--focal: {:g} px gives {} px of image width a view of {:.3g} deg, which is not allowed; give the focal "
      "length in px, in [{:.0f}, {:.0f}] for a view of {:g} to {:g} deg; from mm it is the focal length in mm * {} "
      "/ the width of the sensor in mm",
      q.focal_px, q.image_width, view_deg, std::ceil(focal_of(kGreatestViewDeg)),
      std::floor(focal_of(kLeastViewDeg)), kLeastViewDeg, kGreatestViewDeg, q.image_width));
}

// Checks the view if the size of the image, which is read first, is known.
void ReadFocal(const std::string& text, Question* question) {
  question->focal_px = ReadNumber("--focal", text, 1.0, 1e6);
  if (question->image_width > 0) CheckView(*question);
}

// Reads the name of an entry of a registry; `kind`: "a scene".
template <typename Entry>
std::string ReadName(const char* option, const char* kind, const std::vector<Entry>& registry,
                     const std::string& text) {
  const std::vector<std::string> names = ListNames(registry);
  if (std::ranges::count(names, text) > 0) return text;
  throw InputError(fmt::format("{}: {} is not {}{}; give one of: {}", option, Quoted(text), kind,
                               DidYouMean(text, names), fmt::join(names, ", ")));
}

struct AskedText {
  const char *option, *question;
  std::string AskedTexts::*text;
  void (*read)(const std::string& text, Question* question);
  bool is_needed = true;
};
constexpr AskedText kAskedTexts[] = {
    {"--image", "Size of an image in px, such as 1280x720", &AskedTexts::image,
     [](const std::string& text, Question* q) { ReadSize(text, &q->image_width, &q->image_height); }},
    {"--focal", "Focal length in px, such as 900", &AskedTexts::focal_px, ReadFocal},
    {"--noise", "Noise of a point in px, per coordinate, such as 0.7", &AskedTexts::sigma_px,
     [](const std::string& text, Question* q) { q->sigma_px = ReadNumber("--noise", text, 0.001, 100.0); }},
    {"--scene", "Scene, such as corridor, room, street, plane or uniform_volume", &AskedTexts::scene,
     [](const std::string& text, Question* q) {
       q->scene = ReadName("--scene", "a scene", SceneRegistry(), text);
     }},
    {"--wrong", "Share of wrong matches, such as 0.4 or 40%", &AskedTexts::wrong,
     [](const std::string& text, Question* q) { q->outlier_ratio = ReadShare("--wrong", text, 0.95); }},
    {"--motion", "Motion, such as forward or sideways; Enter: the scene's usual one", &AskedTexts::motion,
     [](const std::string& text, Question* q) {
       q->motion = ReadName("--motion", "a motion", MotionRegistry(), text);
     },
     false},
    {"--outliers", "Kind of wrong matches, such as clustered_both; Enter: uniform", &AskedTexts::outliers,
     [](const std::string& text, Question* q) {
       q->outliers = ReadName("--outliers", "a kind of wrong matches", OutlierRegistry(), text);
     },
     false}};

// Reads the answer of a person; if it cannot be used, says on `out` why and returns false.
bool ReadAnswer(const AskedText& asked, const std::string& text, std::ostream& out, Question* question) {
  if (text.empty()) return false;
  try {
    asked.read(text, question);
    return true;
  } catch (const InputError& error) {
    out << error.what() << '\n';
    return false;
  }
}

// Reads a line without its end and without blanks around it; false at the end of input.
bool ReadTypedLine(std::istream& in, std::string* line) {
  bool is_there = false;
  line->clear();
  for (char c = 0; in.get(c); *line += c) {
    is_there = true;
    if (c == '\n') break;
  }
  const size_t begin = line->find_first_not_of(" \t\r"), end = line->find_last_not_of(" \t\r");
  *line = begin == std::string::npos ? "" : line->substr(begin, end - begin + 1);
  return is_there;
}

// Asks for one text until it can be used, or is empty and not needed. False at the end of input.
bool AskFor(const AskedText& asked, std::istream& in, std::ostream& out, std::string* text,
            Question* question) {
  do {
    out << asked.question << ": " << std::flush;
    if (!ReadTypedLine(in, text)) return false;
    if (text->empty() && !asked.is_needed) return true;
  } while (!ReadAnswer(asked, *text, out, question));
  return true;
}

}  // namespace

std::vector<std::string> MissingOptions(const AskedTexts& texts) {
  std::vector<std::string> missing;
  for (const AskedText& asked : kAskedTexts) {
    if (asked.is_needed && (texts.*asked.text).empty()) missing.emplace_back(asked.option);
  }
  return missing;
}

void AskForMissing(std::istream& in, std::ostream& out, AskedTexts* texts) {
  if (MissingOptions(*texts).empty()) return;
  Question so_far;
  ReadTexts(*texts, &so_far);
  for (const AskedText& asked : kAskedTexts) {
    std::string& text = texts->*asked.text;
    if (!text.empty() || AskFor(asked, in, out, &text, &so_far)) continue;
    if (!asked.is_needed) return;
    throw InputError(
        fmt::format("ask: give {}, or answer at a terminal", fmt::join(MissingOptions(*texts), ", ")));
  }
}

bool ParseShare(const std::string& text, double* share) {
  if (!text.ends_with('%')) return ParseReal(text, share);
  const size_t end = text.find_last_not_of(" %");
  if (end == std::string::npos || !ParseReal(text.substr(0, end + 1), share)) return false;
  *share /= 100.0;
  return true;
}

void ReadTexts(const AskedTexts& texts, Question* question) {
  for (const AskedText& asked : kAskedTexts) {
    const std::string& text = texts.*asked.text;
    if (!text.empty()) asked.read(text, question);
  }
}

void CheckOutliers(const Question& question) {
  if (question.outliers != "repeated_texture" || question.scene == "lattice") return;
  throw InputError(fmt::format(
      "--outliers: 'repeated_texture' is not allowed with --scene {}, in which nothing is repeated; give --scene "
      "lattice, or other outliers such as clustered_both",
      question.scene));
}

std::string DescribeQuestion(const Question& q) {
  const std::string error = q.focal_error == 0.0
                                ? ""
                                : fmt::format(" (assumed {:g} % too {})", 100.0 * std::abs(q.focal_error),
                                              q.focal_error > 0.0 ? "great" : "small");
  return fmt::format("{} x {} px, f {:g} px{}, noise {:g} px; {}{}; {:g} % wrong ({}) of {} matches",
                     q.image_width, q.image_height, q.focal_px, error, q.sigma_px, q.scene,
                     q.motion.empty() ? "" : ", motion " + q.motion, 100.0 * q.outlier_ratio, q.outliers,
                     q.num_matches);
}

std::string MakeFolderName(const Question& q) {
  Fnv1a32 hash;
  hash.Add(MakeStudyText(q, /*trials=*/1));
  return fmt::format("answer_{}_f{:g}_wrong{:g}_{:08x}", q.scene, q.focal_px, 100.0 * q.outlier_ratio,
                     hash.value());
}

bool HasDirection(const Question& question) { return question.motion != "pure_rotation"; }

std::string MakeStudyText(const Question& q, int trials) {
  return fmt::format(
      R"(# Written by `rcme ask`. Change it as you like: rcme list settings, rcme list estimators.
name: asked
description: >-
  {}.
seed: {}
trials: {}
data:
  scene: {}
  cameras: pinhole
  image_width: {}
  image_height: {}
  focal_px: {}
  num_matches: {}
  sigma_px: {}
  outliers: {}
{}{}factors:
  outlier_ratio: [{}]
estimators:
  - {{name: rcme_calibrated}}
  - {{file: rcme_tuned}}
  - {{name: msac, label: msac_five_point, options: {{solver: five_point}}}}
  - {{file: opencv_magsac}}
  - {{name: opengv_ransac}}
failure:
  max_rotation_error_deg: {}
  max_direction_error_deg: {}
)",
      DescribeQuestion(q), q.seed, trials, q.scene, q.image_width, q.image_height, q.focal_px, q.num_matches,
      q.sigma_px, q.outliers, q.motion.empty() ? "" : "  motion: " + q.motion + "\n",
      q.focal_error == 0.0 ? "" : fmt::format("  focal_error: {}\n", q.focal_error), q.outlier_ratio,
      q.max_rotation_error_deg, q.max_direction_error_deg);
}

}  // namespace rcme
