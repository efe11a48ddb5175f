#include "experiments/claims/check_result_json.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "experiments/pieces/part_file.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

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

}  // namespace

std::string ResultAsJson(const CheckResult& result) {
  Json json = {{"num_trials", result.num_trials},
               {"verdict", VerdictAsJson(result.verdict)},
               {"targets", Json::array()},
               {"fifths_of_difficulty", Json::array()}};
  for (const TargetResult& target : result.targets) json["targets"].push_back(TargetAsJson(target));
  for (const DifficultyFifth& fifth : result.fifths) {
    json["fifths_of_difficulty"].push_back(FifthAsJson(fifth));
  }
  return json.dump();
}

CheckResult ResultFrom(const std::string& text) {
  const Json json = Json::parse(text);
  CheckResult result;
  result.num_trials = json.at("num_trials").get<std::int64_t>();
  result.verdict = VerdictFrom(json.at("verdict"));
  for (const Json& target : json.at("targets")) result.targets.push_back(TargetFrom(target));
  for (const Json& fifth : json.at("fifths_of_difficulty")) result.fifths.push_back(FifthFrom(fifth));
  return result;
}

}  // namespace rcme
