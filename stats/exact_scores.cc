#include "stats/exact_scores.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace rcme {
namespace {

constexpr std::int64_t kWhole = std::int64_t{1} << 26;  // 2^63 / kWhole = 1.4e11 scores fit without overflow
constexpr int kNumSteps = ScoreMean::kNumSteps;

}  // namespace

void ExactScores::Add(double score) {
  if (!(score >= 0.0 && score <= 1.0)) throw std::invalid_argument("exact scores: a score outside of [0, 1]");
  if (parts_.empty()) parts_.assign(kNumSteps + 1, 0);
  const double at = kNumSteps * score;
  const int below = std::min(static_cast<int>(at), kNumSteps - 1);
  const std::int64_t above = std::llround((at - below) * static_cast<double>(kWhole));
  parts_[static_cast<size_t>(below)] += kWhole - above;
  parts_[static_cast<size_t>(below) + 1] += above;
  moments_.Add(score);
}

void ExactScores::Merge(const ExactScores& other) {
  if (other.parts_.empty()) return;
  if (parts_.empty()) parts_.assign(kNumSteps + 1, 0);
  for (size_t i = 0; i < parts_.size(); ++i) parts_[i] += other.parts_[i];
  moments_.Merge(other.moments_);
}

ScoreMean ExactScores::Scores() const {
  std::vector<double> counts;
  for (const std::int64_t part : parts_)
    counts.push_back(static_cast<double>(part) / static_cast<double>(kWhole));
  return ScoreMean::OnGrid(counts, moments_.n(), moments_.mean() * static_cast<double>(moments_.n()));
}

std::vector<std::string> ExactScores::Texts() const {
  std::vector<std::string> texts = moments_.Texts();
  std::string parts;
  for (const std::int64_t part : parts_) {
    if (!parts.empty()) parts += ' ';
    parts += std::to_string(part);
  }
  texts.push_back(parts);
  return texts;
}

ExactScores ExactScores::FromTexts(const std::vector<std::string>& texts) {
  if (texts.size() != 4) throw std::invalid_argument("exact scores: not four texts");
  ExactScores scores;
  scores.moments_ = ExactMoments::FromTexts({texts[0], texts[1], texts[2]});
  std::istringstream words(texts[3]);
  for (std::int64_t part = 0; words >> part;) scores.parts_.push_back(part);
  const bool is_whole =
      words.eof() && std::ranges::all_of(scores.parts_, [](auto part) { return part >= 0; });
  const size_t num_points = scores.moments_.n() == 0 ? 0 : kNumSteps + 1;
  if (!is_whole || scores.parts_.size() != num_points || scores.moments_.n() > (std::int64_t{1} << 36) ||
      std::reduce(scores.parts_.begin(), scores.parts_.end()) != scores.moments_.n() * kWhole)
    throw std::invalid_argument("exact scores: other parts than their number");
  return scores;
}

}  // namespace rcme
