// Problems and answers as lines of JSON, for estimators in any language. The schema is in
// docs/estimators_in_any_language.md.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "peers/outside_answer.h"

namespace rcme {

// The id of a problem and seed: 16 hexadecimal digits, a hash of all their numbers.
std::string ProblemId(const MotionProblem& problem, std::uint32_t seed);

// {"format", "id", "x1", "x2", "camera1", "camera2", "sigma_px", "seed"}, "noise_scale" if the problem has
// one, and a line end. Numbers are written such that they are read back bit for bit.
std::string ProblemAsJson(const MotionProblem& problem, std::uint32_t seed, const std::string& id);
std::string ProblemAsJson(const MotionProblem& problem, std::uint32_t seed);  // with its ProblemId

// One line of answers.
struct AnswerLine {
  std::string id;  // empty: not given
  OutsideAnswer answer;
  std::string fault;  // reason why the answer cannot be read; empty if it can
};
AnswerLine AnswerFromJson(std::string_view line);

// The answer of a line. Throws NoOutsideAnswer (unreadable_answer) if it cannot be read.
const OutsideAnswer& Readable(const AnswerLine& line);
// The same; also throws if the line's id is not `id`.
const OutsideAnswer& ReadableAnswerTo(const std::string& id, const AnswerLine& line);

}  // namespace rcme
