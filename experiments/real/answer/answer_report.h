// Makes one result from the answers to many pairs.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/data/input_doubt.h"
#include "experiments/real/answer/estimate_output.h"

namespace rcme {

// The answer for one file, or why it could not be read.
struct FileAnswer {
  std::string path, error = {};         // error: why it could not be read, or empty
  std::vector<InputDoubt> doubts = {};  // about the file's cameras
  PairAnswer answer = {};
};

// The settings common to all answers.
struct AnswerTerms {
  EstimatorSpec spec;
  std::vector<FailureBounds> bounds;     // a failure probability is requested for each
  std::optional<double> integrity_risk;  // empty: no protection levels are requested
};

// Returns the JSON object of one file: AnswerAsJson, and the doubts about its cameras if there are any.
nlohmann::ordered_json FileAnswerAsJson(const FileAnswer& file, const AnswerTerms& terms);

// Makes a row per file, with motion and standard deviations as numbers.
Table MakeFileAnswerTable(const std::vector<FileAnswer>& files, const AnswerTerms& terms);

// For people: a line per file that could be read, and the number of answers by status. For programs: a row
// per file.
CommandResult MakeAnswersResult(const std::vector<FileAnswer>& files, const AnswerTerms& terms);

}  // namespace rcme
