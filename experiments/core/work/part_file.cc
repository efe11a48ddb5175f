#include "experiments/core/work/part_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "experiments/core/files/checksum.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/files/regular_file.h"
#include "experiments/core/text/json_output.h"
#include "parameters/input_error.h"
#include "parameters/text_lines.h"
#include "stats/constants.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kFormatStart = "{\"format\": \"rcme part ", kChecksumKey = "\"checksum\": \"";
constexpr size_t kMaxPartBytes = size_t{1} << 30;  // the outcomes of a whole audit have 100 MB
constexpr int kMaxPieceDepth = 8;                  // of lists within lists; the deepest piece has three
constexpr size_t kMaxRestOfPiece = 256;            // bytes of an item's line besides its result
constexpr size_t kMaxFirstValues = 64;             // of the first line, which has ten
constexpr const char* kAgain = "run the command that wrote it again: it keeps what is sound";
constexpr const char* kAllAgain = "remove the file and run the command again";

std::string QuotedAsJson(const std::string& text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string FirstLine(const Part& part, size_t num_items) {
  return fmt::format(
      "\"work\": {}, \"program\": {}, \"instruction_set\": {}, \"shard\": {}, \"num_shards\": {}, "
      "\"num_pieces\": {}, \"identity\": {}}}",
      QuotedAsJson(part.work), QuotedAsJson(part.origin.program), QuotedAsJson(part.origin.instruction_set),
      part.shard.number, part.shard.count, num_items, QuotedAsJson(part.identity));
}

std::string PieceLine(const ItemPlace& place, const ItemResult& result) {
  return fmt::format("\"group\": {}, \"piece\": {}, \"seconds\": {:.6f}, \"result\": {}}}", place.group,
                     place.item, result.seconds, result.json);
}

std::string DescribeLongPiece() {
  return fmt::format("the piece is too long; at most {} bytes are allowed", kMaxPieceBytes);
}

// The checksum of a line, from its text after the checksum. `of_first`: the first line's checksum; empty for
// the first line itself.
std::string LineChecksum(const std::string& of_first, std::string_view text) {
  return fmt::format("{:08x}", ComputeChecksum({of_first, std::string(text)}));
}

// Reads the fields of a text in a fixed order.
class FixedText {
 public:
  explicit FixedText(std::string_view rest) : rest_(rest) {}

  bool Skip(std::string_view text) {
    const bool is_next = rest_.starts_with(text);
    if (is_next) rest_.remove_prefix(text.size());
    return is_next;
  }
  std::string_view Take(size_t size) {
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(taken.size());
    return taken;
  }
  template <typename Number>
  bool Read(Number* number) {
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), *number);
    if (error != std::errc()) return false;
    rest_.remove_prefix(static_cast<size_t>(end - rest_.data()));
    return true;
  }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

// Reads the lines of one part, each checked before anything of it is used.
class PartReader {
 public:
  PartReader(const std::string& name, TextLines::Source source)
      : name_(name), lines_(name, std::move(source), {kMaxPartLineBytes, kMaxPartBytes}) {}

  Part Read() {
    ReadFirst();
    for (std::string_view line; lines_.Next(&line);) ReadPiece(line);
    if (part_.results.size() != num_pieces_)
      throw InputError(fmt::format("{}: damaged: it has {} pieces, not {}; {}", name_, part_.results.size(),
                                   num_pieces_, kAgain));
    return std::move(part_);
  }

  SalvagedPart Salvage() {
    SalvagedPart salvaged;
    ReadFirst();
    const auto note = [&](const InputError& error) {
      const std::string words = error.what();  // without what to do: that is done
      if (salvaged.damage.empty()) salvaged.damage = words.substr(0, words.find(std::string("; ") + kAgain));
    };
    try {
      for (std::string_view line; lines_.Next(&line);) {
        try {
          ReadPiece(line);
        } catch (const InputError& error) {
          note(error);
        }
      }
    } catch (const InputError& error) {  // no line: it is too long, or has a byte that no text has
      note(error);
    }
    if (part_.results.size() != num_pieces_)
      note(InputError(
          fmt::format("{}: damaged: it has {} pieces, not {}", name_, part_.results.size(), num_pieces_)));
    salvaged.num_lost = num_pieces_ - std::min(num_pieces_, part_.results.size());
    salvaged.part = std::move(part_);
    return salvaged;
  }

 private:
  [[noreturn]] void FailDamaged(const std::string& what) const {
    lines_.Fail(fmt::format("damaged: {}; {}", what, is_first_read_ ? kAgain : kAllAgain));
  }

  void RequireChecksum(FixedText* line) {
    if (!line->Skip(kChecksumKey)) FailDamaged("the line has no checksum");
    const std::string checksum(line->Take(8));
    if (!line->Skip("\", ") || checksum != LineChecksum(first_checksum_, line->rest()))
      FailDamaged("the checksum is not that of the line");
    if (first_checksum_.empty()) first_checksum_ = checksum;
  }

  void ReadFirst() {
    std::string_view text;
    lines_.Next(&text);
    if (!text.starts_with(kFormatStart))
      throw InputError(fmt::format("{}: is not a part that --shard writes", name_));
    FixedText line(text);
    line.Skip("{\"format\": \"");
    if (!line.Skip(fmt::format("{}\", ", kPartFormat)))
      throw InputError(fmt::format(
          "{}: its format is '{}', not '{}': another version of the program wrote it; run its shard "
          "again, into a new file",
          name_, line.rest().substr(0, line.rest().find('"')).substr(0, 40), kPartFormat));
    RequireChecksum(&line);
    try {
      TakeFirst("{" + std::string(line.rest()));
    } catch (const nlohmann::json::exception& error) {
      FailDamaged(error.what());
    } catch (const std::invalid_argument& error) {
      FailDamaged(error.what());
    }
    is_first_read_ = true;
  }

  void TakeFirst(const std::string& text) {
    size_t num_values = 0;
    const auto is_flat = [&](int depth, Json::parse_event_t, Json&) {
      if (depth > 1 || ++num_values > kMaxFirstValues) throw std::invalid_argument("it describes no part");
      return true;
    };
    const Json json = Json::parse(text, is_flat);
    part_.work = json.at("work").get<std::string>();
    part_.identity = json.at("identity").get<std::string>();
    part_.origin = {json.at("program").get<std::string>(), json.at("instruction_set").get<std::string>()};
    part_.shard = {static_cast<std::uint32_t>(CountFrom(json.at("shard"), kMaxShards)),
                   static_cast<std::uint32_t>(CountFrom(json.at("num_shards"), kMaxShards))};
    if (part_.shard.number > part_.shard.count || part_.shard.count < 1)
      throw std::invalid_argument(
          fmt::format("there is no shard {} of {}", part_.shard.number, part_.shard.count));
    num_pieces_ =
        static_cast<size_t>(CountFrom(json.at("num_pieces"), static_cast<std::int64_t>(kMaxPartBytes)));
  }

  void ReadPiece(std::string_view text) {
    FixedText line(text);
    if (text.size() > kMaxPieceBytes) lines_.Fail(DescribeLongPiece());
    if (!line.Skip("{")) FailDamaged("the line is no piece");
    RequireChecksum(&line);
    ItemPlace place;
    ItemResult result;
    const bool has_form = line.Skip("\"group\": ") && line.Read(&place.group) && line.Skip(", \"piece\": ") &&
                          line.Read(&place.item) && line.Skip(", \"seconds\": ") &&
                          line.Read(&result.seconds) && line.Skip(", \"result\": ") &&
                          line.rest().ends_with('}');
    if (!has_form || !(result.seconds >= 0.0) || std::isinf(result.seconds))
      FailDamaged("the line is no piece");
    if (!part_.results.empty() && !(part_.results.rbegin()->first < place))
      FailDamaged(
          fmt::format("piece {} of group {} is there twice, or out of order", place.item, place.group));
    result.json = line.rest().substr(0, line.rest().size() - 1);
    part_.results.emplace_hint(part_.results.end(), place, std::move(result));
  }

  const std::string name_;
  TextLines lines_;
  Part part_;
  std::string first_checksum_;
  size_t num_pieces_ = 0;
  bool is_first_read_ = false;
};

}  // namespace

std::string AsStored(const std::string& text) { return Json::parse(QuotedAsJson(text)).get<std::string>(); }

Json NumberAsJson(double x) { return std::isfinite(x) ? Json(x) : Json(fmt::format("{}", x)); }

double NumberFrom(const Json& json) {
  if (json.is_number()) return json.get<double>();
  for (const double x : {kInfinity, -kInfinity, kNaN, std::copysign(kNaN, -1.0)}) {
    if (json.get<std::string>() == fmt::format("{}", x)) return x;
  }
  throw std::invalid_argument("a number that is none");
}

Json NumbersAsJson(std::span<const double> numbers) {
  Json json = Json::array();
  for (const double x : numbers) json.push_back(NumberAsJson(x));
  return json;
}

std::vector<double> NumbersFrom(const Json& json) {
  if (!json.is_array()) throw std::invalid_argument("it is no list of numbers");
  std::vector<double> numbers;
  for (const Json& x : json) numbers.push_back(NumberFrom(x));
  return numbers;
}

Json ParsePiece(const std::string& json) {
  return Json::parse(json, [](int depth, Json::parse_event_t, Json&) {
    if (depth > kMaxPieceDepth) throw std::invalid_argument("lists within lists within lists");
    return true;
  });
}

std::int64_t CountFrom(const Json& json, std::int64_t most) {
  if (!json.is_number_integer()) throw std::invalid_argument("a count that is no whole number");
  const bool is_possible = json.is_number_unsigned()
                               ? json.get<std::uint64_t>() <= static_cast<std::uint64_t>(most)
                               : json.get<std::int64_t>() >= 0 && json.get<std::int64_t>() <= most;
  if (!is_possible)
    throw std::invalid_argument(fmt::format("a count of {}, not of 0 to {}", json.dump(), most));
  return json.get<std::int64_t>();
}

void RequireSize(const Json& json, size_t size) {
  if (!json.is_array() || json.size() != size)
    throw std::invalid_argument(fmt::format("it is no list of {}", size));
}

void RequirePossible(bool is_possible, const char* of, const char* what) {
  if (!is_possible) throw std::invalid_argument(fmt::format("its {} cannot be: {}", of, what));
}

std::string PartAsText(const Part& part, const ItemResults& results) {
  const std::string first = FirstLine(part, results.size()), checksum = LineChecksum("", first);
  std::string text =
      fmt::format("{{\"format\": \"{}\", {}{}\", {}\n", kPartFormat, kChecksumKey, checksum, first);
  for (const auto& [place, result] : results) {
    const std::string line = PieceLine(place, result);
    text += fmt::format("{{{}{}\", {}\n", kChecksumKey, LineChecksum(checksum, line), line);
  }
  return text;
}

void WritePart(const std::string& path, const Part& part, const ItemResults& results) {
  for (const auto& [place, result] : results) {
    if (result.json.size() + kMaxRestOfPiece > kMaxPieceBytes)
      throw PartIsTooLong(
          fmt::format("{}: piece {} of group {}: {}", path, place.item, place.group, DescribeLongPiece()));
  }
  const std::string text = PartAsText(part, results);
  if (text.size() > kMaxPartBytes)
    throw PartIsTooLong(fmt::format("{}: the part has more than {} MiB; divide the work into more shards",
                                    path, kMaxPartBytes >> 20));
  WriteFileWhole(path, text);
}

Part ReadPart(const std::string& path) {
  RegularFile file(path, {"part", "a part that --shard writes"});
  return PartReader(path, [&](char* buffer, size_t size) { return file.Read(size).copy(buffer, size); })
      .Read();
}

SalvagedPart SalvagePart(const std::string& path) {
  RegularFile file(path, {"part", "a part that --shard writes"});
  return PartReader(path, [&](char* buffer, size_t size) { return file.Read(size).copy(buffer, size); })
      .Salvage();
}

bool IsPart(const std::string& path) {
  try {
    return RegularFile(path, {"file", "a file"}).Read(kFormatStart.size()) == kFormatStart;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace rcme
