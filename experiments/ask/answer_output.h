// An answer (answer.h) for people and for programs.
#pragma once

#include <string>

#include "experiments/ask/answer.h"
#include "experiments/core/table/command_result.h"

namespace rcme {

// For people: each part of the answer on a line of its own. `folder` holds study.yaml and run.sqlite.
std::string AnswerAsText(const Answer& answer, const std::string& question, const std::string& folder);
std::string AnswerAsJson(const Answer& answer, const std::string& question);

CommandResult MakeAnswerResult(const Answer& answer, const std::string& question, const std::string& folder);

}  // namespace rcme
