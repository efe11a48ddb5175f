#include "peers/answer_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "parameters/plain_text.h"
#include "parameters/suggestion.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kProblemFormat = "rcme problem 1";
constexpr int kMaxDepth = 4;  // nesting of an answer: a matrix is a list of lists in an object
const std::vector<std::string> kAnswerKeys = {"id",
                                              "R",
                                              "t",
                                              "status",
                                              "message",
                                              "pose_cov",
                                              "inliers",
                                              "sigma",
                                              "seconds",
                                              "p_failure",
                                              "inlier_probabilities"};

[[noreturn]] void Fail(const std::string& what) {
  throw NoOutsideAnswer(MotionStatus::kUnreadableAnswer, what);
}

Json PointsAsJson(const std::vector<Correspondence>& matches, Eigen::Vector2d Correspondence::*point) {
  Json points = Json::array();
  for (const Correspondence& match : matches) points.push_back({(match.*point).x(), (match.*point).y()});
  return points;
}

Json CameraAsJson(const Camera& c) {
  return {
      {"model", "PINHOLE"}, {"width", c.width}, {"height", c.height}, {"params", {c.fx, c.fy, c.cx, c.cy}}};
}

double NumberIn(const Json& value, const std::string& key) {
  if (!value.is_number()) Fail(fmt::format("{}: {} is no number", key, Quoted(value.dump())));
  return value.get<double>();
}

// Other keys than those of an answer are skipped, but not one that was probably meant to be one of them. Of a
// short key, such as T, F or pose, that cannot be said.
void CheckKey(const std::string& key) {
  constexpr size_t kFewestLetters = 5;
  if (key.size() < kFewestLetters || std::ranges::find(kAnswerKeys, key) != kAnswerKeys.end()) return;
  const std::string meant = DidYouMean(key, kAnswerKeys);
  if (!meant.empty()) Fail(fmt::format("unknown key {}{}", Quoted(key), meant));
}

// A list of `count` numbers, or a matrix with as many, row by row.
std::vector<double> NumbersIn(const Json& value, const std::string& key, size_t count) {
  std::vector<double> numbers;
  if (!value.is_array()) Fail(fmt::format("{}: {} is no list", key, Quoted(value.dump())));
  for (const Json& item : value) {
    if (!item.is_array()) {
      numbers.push_back(NumberIn(item, key));
      continue;
    }
    for (const Json& number : item) numbers.push_back(NumberIn(number, key));
  }
  if (count > 0 && numbers.size() != count)
    Fail(fmt::format("{}: {} numbers; {} are expected", key, numbers.size(), count));
  return numbers;
}

std::vector<int> IndicesIn(const Json& value, const std::string& key) {
  std::vector<int> indices;
  for (const double number : NumbersIn(value, key, 0)) {
    if (number != std::floor(number) || number < 0.0 || number > 1e9)
      Fail(fmt::format("{}: {} is not an index of a match, counted from 0", key, number));
    indices.push_back(static_cast<int>(number));
  }
  return indices;
}

std::string TextIn(const Json& value, const std::string& key) {
  if (!value.is_string()) Fail(fmt::format("{}: {} is no text", key, Quoted(value.dump())));
  return value.get<std::string>();
}

OutsideAnswer AnswerIn(const Json& object) {
  const auto find = [&](const char* key) -> const Json* {
    const auto found = object.find(key);
    return found == object.end() || found->is_null() ? nullptr : &*found;
  };
  OutsideAnswer answer;
  const Json *R = find("R"), *t = find("t"), *status = find("status");
  answer.status = StatusOfOutside(status ? TextIn(*status, "status") : R ? "ok" : "no_candidate");
  if (answer.status == MotionStatus::kOk && !(R && t)) Fail("status is ok, but R or t is missing");
  if (R) {
    const std::vector<double> r = NumbersIn(*R, "R", 9);
    answer.R << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
  }
  if (t) answer.t = Eigen::Map<const Eigen::Vector3d>(NumbersIn(*t, "t", 3).data());
  if (const Json* message = find("message")) answer.message = TextIn(*message, "message");
  if (const Json* cov = find("pose_cov"))
    answer.pose_cov = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(
        NumbersIn(*cov, "pose_cov", 36).data());
  if (const Json* inliers = find("inliers")) answer.inliers = IndicesIn(*inliers, "inliers");
  if (const Json* p = find("p_failure")) answer.failure_probability = NumberIn(*p, "p_failure");
  if (const Json* sigma = find("sigma")) answer.sigma_px = NumberIn(*sigma, "sigma");
  if (const Json* p = find("inlier_probabilities"))
    answer.inlier_probabilities = NumbersIn(*p, "inlier_probabilities", 0);
  if (const Json* seconds = find("seconds")) {
    answer.seconds = NumberIn(*seconds, "seconds");
    if (!(answer.seconds >= 0.0 && answer.seconds < 1e9))
      Fail(fmt::format("seconds: {} is not a time of a call", answer.seconds));
  }
  return answer;
}

}  // namespace

std::string ProblemId(const MotionProblem& problem, std::uint32_t seed) {
  Fnv1a hash;
  for (const Camera& c : {problem.camera1, problem.camera2}) {
    for (const double x : {c.fx, c.fy, c.cx, c.cy, 1.0 * c.width, 1.0 * c.height}) hash.Add(x);
  }
  for (const Correspondence& m : problem.matches) {
    for (const double x : {m.x1_px.x(), m.x1_px.y(), m.x2_px.x(), m.x2_px.y()}) hash.Add(x);
  }
  hash.Add(problem.sigma_px);
  for (const double scale : problem.noise_scale) hash.Add(scale);
  if (problem.prior) {
    for (const double x : ListPriorNumbers(*problem.prior)) hash.Add(x);
  }
  hash.Add(1.0 * seed);
  return fmt::format("{:016x}", hash.value() ^ (hash.value() >> 32));
}

std::string ProblemAsJson(const MotionProblem& problem, std::uint32_t seed) {
  return ProblemAsJson(problem, seed, ProblemId(problem, seed));
}

std::string ProblemAsJson(const MotionProblem& problem, std::uint32_t seed, const std::string& id) {
  Json json = {{"format", kProblemFormat},
               {"id", id},
               {"x1", PointsAsJson(problem.matches, &Correspondence::x1_px)},
               {"x2", PointsAsJson(problem.matches, &Correspondence::x2_px)},
               {"camera1", CameraAsJson(problem.camera1)},
               {"camera2", CameraAsJson(problem.camera2)},
               {"sigma_px", problem.sigma_px},
               {"seed", seed}};
  if (!problem.noise_scale.empty()) json["noise_scale"] = problem.noise_scale;
  return json.dump() + "\n";
}

AnswerLine AnswerFromJson(std::string_view line) {
  // Nesting too deep for an answer is refused while parsing, so recursion is bounded. Duplicate keys are
  // refused, since their value is ambiguous.
  std::set<std::string> keys;
  const auto is_allowed = [&](int depth, Json::parse_event_t event, Json& parsed) {
    if (depth > kMaxDepth) Fail("lists within lists within lists; expected one JSON object");
    if (depth != 1 || event != Json::parse_event_t::key) return true;
    const auto key = parsed.get<std::string>();
    if (!keys.insert(key).second) Fail(fmt::format("key {} stands twice", Quoted(key)));
    CheckKey(key);
    return true;
  };
  AnswerLine read;
  try {
    const Json json = Json::parse(line, is_allowed);
    if (!json.is_object()) Fail(fmt::format("{} is no JSON object", Quoted(line.substr(0, 80))));
    if (const auto id = json.find("id"); id != json.end() && !id->is_null()) read.id = TextIn(*id, "id");
    read.answer = AnswerIn(json);
  } catch (const Json::parse_error& error) {
    read.fault = fmt::format(
        "{} is not a JSON object on one line: byte {} (NaN and Infinity are no JSON; other "
        "output belongs on standard error)",
        Quoted(line.substr(0, 80)), error.byte);
  } catch (const Json::exception&) {
    read.fault = fmt::format("{} is not a JSON object on one line (other output belongs on standard error)",
                             Quoted(line.substr(0, 80)));
  } catch (const NoOutsideAnswer& none) {
    read.fault = none.what();
  }
  return read;
}

const OutsideAnswer& Readable(const AnswerLine& line) {
  if (!line.fault.empty()) Fail(line.fault);
  return line.answer;
}

const OutsideAnswer& ReadableAnswerTo(const std::string& id, const AnswerLine& line) {
  if (!line.id.empty() && line.id != id) {
    Fail(fmt::format("the answer's id is {}; expected {}, that of the problem it was asked", Quoted(line.id),
                     Quoted(id)));
  }
  const OutsideAnswer& answer = Readable(line);
  if (line.id.empty())
    Fail(fmt::format("the answer has no id; expected {}, that of the problem", Quoted(id)));
  return answer;
}

}  // namespace rcme
