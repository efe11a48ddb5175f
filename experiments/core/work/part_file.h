// The file that keeps the results of a work plan (core/work/work_plan.h): a shard's part, several parts
// joined into one, or the checkpoint of a stopped command. It holds the result of each item, every number to
// its last bit, and the identity of the work. Lines of JSON: the first line describes the part and counts its
// items, which it calls pieces; each further line is one item, ordered by group and number.
//
// Every line begins with a checksum (CRC-32) of the rest of the line; an item's also covers the checksum of
// the first line, so that a line of another part, or of another state of this one, is detected. Like the
// checksums of result files it detects accidents, not forgery: whoever counts the results checks them again.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "experiments/core/text/program_name.h"
#include "experiments/core/work/work_plan.h"
#include "parameters/input_error.h"

namespace rcme {

struct ItemResult {
  std::string json;      // a JSON value on one line; equal results have equal texts
  double seconds = 0.0;  // processor time
};
using ItemResults = std::map<ItemPlace, ItemResult>;

struct Part {
  std::string work, identity;  // WorkPlan::work and DescribeIdentity
  Shard shard;                 // number 0: joined from several shards
  TrialOrigin origin;
  ItemResults results;  // of the finished items
};

// Limits of a file's lines. For comparison: the first line of the largest study (100,000 conditions) has
// about 60 MB, the largest piece (a tuning of 20,000 settings) 300 kB.
inline constexpr size_t kMaxPartLineBytes = size_t{64} << 20;
inline constexpr size_t kMaxPieceBytes = size_t{8} << 20;

// The text as the file stores it: bytes that are not UTF-8 are replaced.
std::string AsStored(const std::string& text);

// JSON has finite numbers only. These functions also store infinities and NaN, with its sign since tables
// print it; finite numbers come back to their last bit. NumberFrom throws std::exception for other values.
nlohmann::ordered_json NumberAsJson(double x);
double NumberFrom(const nlohmann::ordered_json& json);
nlohmann::ordered_json NumbersAsJson(std::span<const double> numbers);
std::vector<double> NumbersFrom(const nlohmann::ordered_json& json);

// Parses the result of a piece. Throws std::exception if it is not JSON or is nested deeper than any piece.
nlohmann::ordered_json ParsePiece(const std::string& json);
// Reads a count. Throws std::exception if it is not a whole number in 0, ..., most.
std::int64_t CountFrom(const nlohmann::ordered_json& json, std::int64_t most);
// Throws std::invalid_argument unless `json` is a list with `size` elements.
void RequireSize(const nlohmann::ordered_json& json, size_t size);
// Throws std::invalid_argument "its counts cannot be: ...", with "counts" for `of`, unless is_possible.
// Values that no trials can give are damage even if the checksums match.
void RequirePossible(bool is_possible, const char* of, const char* what);

// The text of the part with `results` in place of its own.
std::string PartAsText(const Part& part, const ItemResults& results);

// WritePart throws InputError if the file cannot be written. It throws PartIsTooLong if the file or the
// result of one item exceeds the limits of reading.
class PartIsTooLong : public InputError {
  using InputError::InputError;
};
void WritePart(const std::string& path, const Part& part, const ItemResults& results);

// Throws InputError with the path, the line and the error if the file is not a part of this format, is
// damaged, or is too long. Needs memory for the results and one line.
Part ReadPart(const std::string& path);

// A part some lines of which may be damaged, for callers that can compute the lost items again. Every line
// has its own checksum, so the other lines are as reliable as those of an undamaged part.
struct SalvagedPart {
  Part part;            // with the results of the sound lines
  std::string damage;   // path, line and error of the first damage; empty: no damage
  size_t num_lost = 0;  // the items counted by the first line minus the sound ones
};
// Throws InputError as ReadPart does if the first line is damaged: the work is then unknown.
SalvagedPart SalvagePart(const std::string& path);

// Whether the file begins like a part of any format version; false if it cannot be read.
bool IsPart(const std::string& path);

}  // namespace rcme
