#include "experiments/claims/audit_part_file.h"

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

// JSON has finite numbers alone, and they come back as they were. A NaN keeps its sign: tables print it.
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

Json IntervalAsJson(const Interval& interval) {
  return {NumberAsJson(interval.lower), NumberAsJson(interval.upper)};
}

Interval IntervalFrom(const Json& json) { return {NumberFrom(json.at(0)), NumberFrom(json.at(1))}; }

Json VerdictAsJson(const std::optional<Verdict>& verdict) { return verdict ? Json(Name(*verdict)) : Json(); }

std::optional<Verdict> VerdictFrom(const Json& json) {
  if (json.is_null()) return std::nullopt;
  for (const Verdict verdict : {Verdict::kHolds, Verdict::kDoesNotHold, Verdict::kUndecided}) {
    if (json.get<std::string>() == Name(verdict)) return verdict;
  }
  throw std::invalid_argument("a verdict that is none");
}

Json TargetAsJson(const TargetResult& target) {
  return {{"measured", NumberAsJson(target.measured)},
          {"interval", IntervalAsJson(target.interval)},
          {"n", target.n},
          {"verdict", VerdictAsJson(target.verdict)},
          {"trials_to_decide", NumberAsJson(target.trials_to_decide)}};
}

TargetResult TargetFrom(const Json& json) {
  return {NumberFrom(json.at("measured")), IntervalFrom(json.at("interval")),
          json.at("n").get<std::int64_t>(), VerdictFrom(json.at("verdict")),
          NumberFrom(json.at("trials_to_decide"))};
}

Json FifthAsJson(const DifficultyFifth& fifth) {
  return {{"easiest", NumberAsJson(fifth.easiest)},
          {"hardest", NumberAsJson(fifth.hardest)},
          {"measured", NumberAsJson(fifth.measured)},
          {"interval", IntervalAsJson(fifth.interval)},
          {"n", fifth.n}};
}

DifficultyFifth FifthFrom(const Json& json) {
  return {NumberFrom(json.at("easiest")), NumberFrom(json.at("hardest")), NumberFrom(json.at("measured")),
          IntervalFrom(json.at("interval")), json.at("n").get<std::int64_t>()};
}

Json ResultAsJson(const CheckResult& result) {
  Json json = {{"num_trials", result.num_trials},
               {"verdict", VerdictAsJson(result.verdict)},
               {"targets", Json::array()},
               {"fifths_of_difficulty", Json::array()}};
  for (const TargetResult& target : result.targets) json["targets"].push_back(TargetAsJson(target));
  for (const DifficultyFifth& fifth : result.fifths) {
    json["fifths_of_difficulty"].push_back(FifthAsJson(fifth));
  }
  return json;
}

CheckResult ResultFrom(const Json& json) {
  CheckResult result;
  result.num_trials = json.at("num_trials").get<std::int64_t>();
  result.verdict = VerdictFrom(json.at("verdict"));
  for (const Json& target : json.at("targets")) result.targets.push_back(TargetFrom(target));
  for (const Json& fifth : json.at("fifths_of_difficulty")) result.fifths.push_back(FifthFrom(fifth));
  return result;
}

AuditPart PartFrom(const Json& json) {
  AuditPart part;
  part.identity = json.at("audit").get<std::string>();
  part.shard = {json.at("shard").get<std::uint32_t>(), json.at("num_shards").get<std::uint32_t>()};
  part.origin = {json.at("program").get<std::string>(), json.at("instruction_set").get<std::string>()};
  for (const Json& check : json.at("checks")) {
    const CheckPlace place{check.at("claim").get<size_t>(), check.at("check").get<size_t>()};
    if (!part.results.emplace(place, ResultFrom(check.at("result"))).second)
      throw std::invalid_argument("a check that is there twice");
  }
  return part;
}

}  // namespace

std::string ResultAsText(const CheckResult& result) { return ResultAsJson(result).dump(); }

std::string PartAsJson(const AuditPart& part) {
  Json json = {{"program", part.origin.program}, {"instruction_set", part.origin.instruction_set},
               {"shard", part.shard.number},     {"num_shards", part.shard.count},
               {"audit", part.identity},         {"checks", Json::array()}};
  for (const auto& [place, result] : part.results) {
    json["checks"].push_back(
        {{"claim", place.claim}, {"check", place.check}, {"result", ResultAsJson(result)}});
  }
  return JsonText(kAuditPartFormat, json);
}

AuditPart ReadAuditPart(const std::string& path) {
  constexpr size_t kMaxBytes = size_t{1} << 30;
  RegularFile file(path, {"part of an audit", "a part of an audit"});
  try {
    const Json json = Json::parse(file.Read(kMaxBytes));
    const std::string format = json.at("format").get<std::string>();
    if (format != kAuditPartFormat)
      throw std::invalid_argument(fmt::format("its format is '{}', not '{}'", format, kAuditPartFormat));
    return PartFrom(json);
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: not a whole part of an audit ({})", path, error.what()));
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: not a part of an audit ({})", path, error.what()));
  }
}

}  // namespace rcme
