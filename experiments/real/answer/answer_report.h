// The answers to many pairs as one result.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/data/camera_plausibility.h"
#include "experiments/real/answer/estimate_output.h"

namespace rcme {

// What becomes of a file.
struct FileAnswer {
  std::string path, error = {};          // error: why it could not be read; else empty
  std::vector<CameraDoubt> doubts = {};  // about the file's cameras
  PairAnswer answer = {};
};

// What all answers have in common.
struct AnswerTerms {
  EstimatorSpec spec;
  std::vector<FailureBounds> bounds;     // a probability is asked for each
  std::optional<double> integrity_risk;  // nothing: no protection levels are asked for
};

// The object of one file: AnswerAsJson, with the doubts about its cameras if there are any.
nlohmann::ordered_json FileAnswerAsJson(const FileAnswer& file, const AnswerTerms& terms);

// A row per file, with motion and deviations in numbers.
Table MakeFileAnswerTable(const std::vector<FileAnswer>& files, const AnswerTerms& terms);

// For people a line per file that could be read, with how many ended how; for programs a row per file.
CommandResult MakeAnswersResult(const std::vector<FileAnswer>& files, const AnswerTerms& terms);

}  // namespace rcme
