// The file of one shard's part of a work (JSON), or of several that were put together: what each piece gave,
// every number to its last bit, and of which work it is.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "experiments/pieces/piece_plan.h"
#include "experiments/study/run_description.h"

namespace rcme {

struct PieceResult {
  std::string json;      // what the piece gave: the text of a JSON value, equal where the results are
  double seconds = 0.0;  // of processor time; what the piece gave does not depend on it
};

struct Part {
  std::string work, identity;  // as PiecePlan, the latter as IdentityOf
  Shard shard;                 // number 0: of several
  TrialOrigin origin;
  std::map<PiecePlace, PieceResult> results;  // of the pieces that are done
};

// A text as the file holds it: what is no UTF-8 is replaced.
std::string AsStored(const std::string& text);

// JSON has finite numbers alone; these come back to their last bit whatever they are. NaN has a sign: tables
// print it. NumberFrom throws std::invalid_argument for what is no number.
nlohmann::ordered_json NumberAsJson(double x);
double NumberFrom(const nlohmann::ordered_json& json);

std::string PartAsJson(const Part& part);

// Throws InputError that names the path for a file that is no such part, or not a whole one.
Part ReadPart(const std::string& path);

// Whether the file begins as a part does; false where it cannot be read.
bool IsPart(const std::string& path);

}  // namespace rcme
