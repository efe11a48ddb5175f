#include "experiments/pieces/part_file.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "experiments/base/json_output.h"
#include "experiments/base/regular_file.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

std::string QuotedAsJson(const std::string& text) {
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

Part PartFrom(const Json& json) {
  Part part;
  part.work = json.at("work").get<std::string>();
  part.identity = json.at("identity").get<std::string>();
  part.shard = {json.at("shard").get<std::uint32_t>(), json.at("num_shards").get<std::uint32_t>()};
  if (part.shard.count < 1 || part.shard.count > kMaxShards || part.shard.number > part.shard.count)
    throw std::invalid_argument(
        fmt::format("there is no shard {} of {}", part.shard.number, part.shard.count));
  part.origin = {json.at("program").get<std::string>(), json.at("instruction_set").get<std::string>()};
  for (const Json& piece : json.at("pieces")) {
    const PiecePlace place{piece.at("group").get<size_t>(), piece.at("piece").get<size_t>()};
    const PieceResult result{piece.at("result").dump(), piece.at("seconds").get<double>()};
    if (!part.results.emplace(place, result).second)
      throw std::invalid_argument(
          fmt::format("piece {} of group {} is there twice", place.piece, place.group));
  }
  return part;
}

}  // namespace

std::string AsStored(const std::string& text) { return Json::parse(QuotedAsJson(text)).get<std::string>(); }

Json NumberAsJson(double x) { return std::isfinite(x) ? Json(x) : Json(fmt::format("{}", x)); }

double NumberFrom(const Json& json) {
  if (json.is_number()) return json.get<double>();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const double x : {kInfinity, -kInfinity, kNaN, std::copysign(kNaN, -1.0)}) {
    if (json.get<std::string>() == fmt::format("{}", x)) return x;
  }
  throw std::invalid_argument("a number that is none");
}

// A line for each piece.
std::string PartAsJson(const Part& part) {
  std::string text = fmt::format(
      "{{\"format\": \"{}\", \"work\": {}, \"program\": {}, \"instruction_set\": {},\n\"shard\": {}, "
      "\"num_shards\": {}, \"identity\": {},\n\"pieces\": [",
      kPartFormat, QuotedAsJson(part.work), QuotedAsJson(part.origin.program),
      QuotedAsJson(part.origin.instruction_set), part.shard.number, part.shard.count,
      QuotedAsJson(part.identity));
  const char* separator = "\n";
  for (const auto& [place, result] : part.results) {
    text += fmt::format("{}{{\"group\": {}, \"piece\": {}, \"seconds\": {:.6f}, \"result\": {}}}", separator,
                        place.group, place.piece, result.seconds, result.json);
    separator = ",\n";
  }
  return text + "\n]}\n";
}

Part ReadPart(const std::string& path) {
  constexpr size_t kMaxBytes = size_t{1} << 32;
  RegularFile file(path, {"part", "a part that --shard writes"});
  try {
    const Json json = Json::parse(file.Read(kMaxBytes));
    const std::string format = json.at("format").get<std::string>();
    if (format != kPartFormat)
      throw std::invalid_argument(fmt::format("its format is '{}', not '{}'", format, kPartFormat));
    return PartFrom(json);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: not a whole part that --shard writes ({})", path, error.what()));
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: damaged, or not a part that --shard writes ({})", path, error.what()));
  }
}

bool IsPart(const std::string& path) {
  try {
    const std::string begin = fmt::format("{{\"format\": \"{}\"", kPartFormat);
    return RegularFile(path, {"file", "a file"}).Read(begin.size()) == begin;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace rcme
