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
#include <string_view>
#include <vector>

#include "experiments/core/text/program_name.h"
#include "experiments/core/work/work_plan.h"
#include "parameters/input_error.h"

namespace rcme {

struct ItemResult {
  std::string json;  // what the item gave: the text of a JSON value on one line, equal where the results are
  double seconds = 0.0;  // of processor time; what the item gave does not depend on it
};
using ItemResults = std::map<ItemPlace, ItemResult>;

struct Part {
  std::string work, identity;  // as WorkPlan, the latter as DescribeIdentity
  Shard shard;                 // number 0: of several
  TrialOrigin origin;
  ItemResults results;  // of the items that are done
};

// Of a file. The first line of the largest study (100,000 conditions) has some 60 MB, the largest piece (a
// tuning of 20,000 settings) 300 kB, the outcomes of a whole audit 100 MB.
inline constexpr size_t kMaxPartBytes = size_t{1} << 30;
inline constexpr size_t kMaxPartLineBytes = size_t{64} << 20;
inline constexpr size_t kMaxPieceBytes = size_t{8} << 20;

// A text as the file holds it: what is no UTF-8 is replaced.
std::string AsStored(const std::string& text);

// JSON has finite numbers alone; these come back to their last bit whatever they are. NaN has a sign: tables
// print it. NumberFrom throws std::invalid_argument for what is no number.
nlohmann::ordered_json NumberAsJson(double x);
double NumberFrom(const nlohmann::ordered_json& json);
nlohmann::ordered_json NumbersAsJson(std::span<const double> numbers);
std::vector<double> NumbersFrom(const nlohmann::ordered_json& json);

// What a piece gave, for who counts it. Throws std::exception for what is no JSON, or lists within lists
// deeper than any piece has them.
nlohmann::ordered_json ParsePiece(const std::string& json);
// One of the whole numbers in it. Throws std::exception for what is none in 0, ..., most.
std::int64_t CountFrom(const nlohmann::ordered_json& json, std::int64_t most);
// Throws std::invalid_argument where `json` is no list of so many.
void RequireSize(const nlohmann::ordered_json& json, size_t size);
// What no trials can have given is damage, whatever the checksums say: throws std::invalid_argument "its
// counts cannot be: ...", where `of` is "counts".
void RequirePossible(bool is_possible, const char* of, const char* what);

// With these results in place of its own.
std::string PartAsText(const Part& part, const ItemResults& results);

// Throws InputError where it cannot be written, PartIsTooLong where it could not be read again: the file, or
// the result of one item, is too long.
class PartIsTooLong : public InputError {
  using InputError::InputError;
};
void WritePart(const std::string& path, const Part& part, const ItemResults& results);

// Throws InputError that names the path, the line and what is wrong for a file that is no such part, is
// damaged, or is longer than a part can be. Memory is that of what is kept, and a line.
Part ReadPart(const std::string& path);
// The same of its text; `name` is what messages call it.
Part ParsePart(std::string_view text, const std::string& name);

// A part of which some lines may be damaged, for who can make their items again. Every line has a checksum of
// its own, so that the others are as sound as those of a whole part.
struct SalvagedPart {
  Part part;            // with the results of the sound lines
  std::string damage;   // the first: path, line and what is wrong; empty: there is none
  size_t num_lost = 0;  // items that the first line counts and no sound line has
};
// Throws InputError as ReadPart where the first line is damaged: nothing says what the others are of.
SalvagedPart SalvagePart(const std::string& path);
SalvagedPart ParseSalvagedPart(std::string_view text, const std::string& name);

// Whether the file begins as a part does, of whatever format; false where it cannot be read.
bool IsPart(const std::string& path);

}  // namespace rcme
