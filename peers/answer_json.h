// Problems and answers as lines of JSON, for estimators in any language; docs/estimators_in_any_language.md
// is the schema.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "peers/outside_answer.h"

namespace rcme {

// Names a problem and its seed: 16 hexadecimal digits of all their numbers.
std::string ProblemId(const MotionProblem& problem, std::uint32_t seed);

// {"format", "id", "x1", "x2", "camera1", "camera2", "sigma_px", "seed"}, "noise_scale" where the problem has
// one, and a line end; numbers such that they are read back bit for bit.
std::string ProblemAsJson(const MotionProblem& problem, std::uint32_t seed, const std::string& id);
std::string ProblemAsJson(const MotionProblem& problem, std::uint32_t seed);  // with its ProblemId

// What stands on one line.
struct AnswerLine {
  std::string id;  // empty: none is given
  OutsideAnswer answer;
  std::string fault;  // not empty: why the answer cannot be read
};
AnswerLine AnswerFromJson(std::string_view line);

// The answer; throws NoOutsideAnswer (unreadable_answer) where it cannot be read.
const OutsideAnswer& Readable(const AnswerLine& line);
// The same for the answer to the question of that id; another's cannot be read either.
const OutsideAnswer& ReadableAnswerTo(const std::string& id, const AnswerLine& line);

}  // namespace rcme
