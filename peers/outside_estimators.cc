// Estimators outside the program that a study can name: a process that answers lines of JSON, and a file of
// answers made elsewhere.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "estimator/conform/conform_estimator.h"
#include "estimator/estimator_registry.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/text_lines.h"
#include "peers/answer_json.h"
#include "peers/child_process.h"
#include "peers/peer_registry.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* kNone = "none";

// A process and the last problem it was asked.
struct AskedProcess {
  AskedProcess(ProcessKeeper* keeper, const std::string& command) : process(keeper, command) {}

  // The id that the answer must have: that of the problem, with a number appended if the same problem is
  // asked again.
  std::string NextId(const std::string& problem) {
    num_times = problem == last_problem ? num_times + 1 : 1;
    last_problem = problem;
    return num_times == 1 ? problem : fmt::format("{}-{}", problem, num_times);
  }

  ChildProcess process;
  std::string last_problem;
  int num_times = 0;
};

// One process per calling thread, each answering one problem after the other. A process that gave no answer
// is replaced by a new one.
class ProcessEstimator : public MotionEstimator {
 public:
  ProcessEstimator(std::string command, double timeout_s)
      : command_(std::move(command)), timeout_s_(timeout_s) {}
  ~ProcessEstimator() override {
    const Clock::time_point deadline = Clock::now() + kTimeToEnd;
    for (const auto& idle : idle_) idle->process.CloseInput();
    for (const auto& idle : idle_) idle->process.WaitForEnd(deadline);
  }

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return CallOutside(problem, [&] { return Ask(problem, SeedForOutside(rng)); });
  }

  // Throws NoOutsideAnswer.
  OutsideAnswer Ask(const MotionProblem& problem, std::uint32_t seed) const {
    if (command_ == kNone) throw NoOutsideAnswer(MotionStatus::kNoAnswer, "no command is given");
    const Clock::time_point start = Clock::now();
    const auto timeout =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_s_));
    std::unique_ptr<AskedProcess> asked = Take();
    const std::string id = asked->NextId(ProblemId(problem, seed));
    const std::string line = asked->process.Ask(ProblemAsJson(problem, seed, id), start + timeout);
    OutsideAnswer answer = ReadableAnswerTo(id, AnswerFromJson(line));
    Give(std::move(asked));
    if (!(answer.seconds >= 0.0))
      answer.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return answer;
  }

 private:
  static constexpr std::chrono::milliseconds kTimeToEnd{500};  // after their input is closed

  std::unique_ptr<AskedProcess> Take() const {
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<AskedProcess> asked = std::move(idle_.back());
        idle_.pop_back();
        return asked;
      }
    }
    return std::make_unique<AskedProcess>(&keeper_, command_);
  }
  void Give(std::unique_ptr<AskedProcess> asked) const {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(asked));
  }

  std::string command_;
  double timeout_s_;
  mutable ProcessKeeper keeper_;  // outlives the processes
  mutable std::mutex mutex_;      // guards idle_
  mutable std::vector<std::unique_ptr<AskedProcess>> idle_;
};

class ProcessModel : public EstimatorModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {
        Parameter::Text("command", &command_, "a command of the shell", "answers each line of JSON with one"),
        Parameter::Real("timeout_s", &timeout_s_, {1e-3, 1e5}, "s", "a slower answer is none")};
  }
  std::unique_ptr<MotionEstimator> Make() const override {
    return std::make_unique<ProcessEstimator>(command_, timeout_s_);
  }

 private:
  std::string command_ = kNone;
  double timeout_s_ = 10.0;
};

// A problem of noise-free matches; the second camera is a tenth of the greatest depth to the right.
MotionProblem MakeFirstProblem() {
  const Camera camera{500.0, 500.0, 319.5, 239.5, 640, 480};
  MotionProblem problem;
  problem.camera1 = problem.camera2 = camera;
  problem.sigma_px = 0.5;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector2d point(120.0 + 100.0 * (i % 5), 90.0 + 100.0 * (i / 5));
    const double disparity_px = 50.0 + 10.0 * ((7 * i) % 11);
    problem.matches.push_back({point, point - Eigen::Vector2d(disparity_px, 0.0)});
  }
  return problem;
}

// Limits of a file of answers; `rcme export` writes at most this many problems.
constexpr size_t kMaxFileBytes = size_t{1} << 31, kMaxLineBytes = size_t{16} << 20, kMaxAnswers = 1'000'000;

struct AnswersFile {
  std::map<std::string, AnswerLine> answers;  // by the id of their problem
  std::string digest;
};

// Reads the next bytes; throws if a read fails, which is not the end of the file.
size_t BytesFrom(std::ifstream* file, const std::string& path, char* buffer, size_t size) {
  file->read(buffer, static_cast<std::streamsize>(size));
  if (file->bad()) throw InputError(fmt::format("answers: {} cannot be read", Quoted(path)));
  return static_cast<size_t>(file->gcount());
}

// Throws InputError that names the line without a valid answer, without an id, or with a duplicate id.
std::shared_ptr<const AnswersFile> ReadAnswers(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    throw InputError(fmt::format("answers: {} is not a file; give a file of answers", Quoted(path)));
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(fmt::format("answers: {} cannot be read", Quoted(path)));
  TextLines lines(path, [&](char* buffer, size_t size) { return BytesFrom(&file, path, buffer, size); },
                  {kMaxLineBytes, kMaxFileBytes});
  auto read = std::make_shared<AnswersFile>();
  Fnv1a hash;
  for (std::string_view line; lines.Next(&line);) {
    hash.Add("\n");
    hash.Add(line);
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    AnswerLine answer = AnswerFromJson(line);
    if (answer.id.empty())
      lines.Fail(answer.fault.empty() ? "no id; give that of the problem" : answer.fault);
    const std::string id = answer.id;
    if (!read->answers.emplace(id, std::move(answer)).second)
      lines.Fail(fmt::format("id {} stands twice", Quoted(id)));
    if (read->answers.size() > kMaxAnswers)
      lines.Fail(fmt::format("too many answers; at most {} are allowed in a file", kMaxAnswers));
  }
  read->digest = fmt::format("{:016x}", hash.value());
  return read;
}

class AnswersEstimator : public MotionEstimator {
 public:
  explicit AnswersEstimator(std::shared_ptr<const AnswersFile> file) : file_(std::move(file)) {}

  MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const override {
    return CallOutside(problem, [&] {
      const std::string id = ProblemId(problem, SeedForOutside(rng));
      const auto found = file_->answers.find(id);
      if (found == file_->answers.end())
        throw NoOutsideAnswer(MotionStatus::kNoAnswer, "the file has no answer to problem " + id);
      return Readable(found->second);
    });
  }

 private:
  std::shared_ptr<const AnswersFile> file_;
};

class AnswersModel : public EstimatorModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Text("file", &file_, "the path of a file of answers",
                            "lines of JSON, for problems of `rcme export`"),
            Parameter::Text("digest", &digest_, "16 hexadecimal digits",
                            "of the file; a changed file is refused")};
  }
  std::unique_ptr<MotionEstimator> Make() const override {
    if (file_ == kNone) return std::make_unique<AnswersEstimator>(std::make_shared<AnswersFile>());
    std::shared_ptr<const AnswersFile> file = ReadAnswers(file_);
    if (digest_ != kNone && digest_ != file->digest)
      throw InputError(fmt::format("answers: {} has changed since (digest {}, not {})", Quoted(file_),
                                   file->digest, digest_));
    return std::make_unique<AnswersEstimator>(std::move(file));
  }

 private:
  std::string file_ = kNone, digest_ = kNone;
};

}  // namespace

std::string DigestOfAnswers(const std::string& path) { return ReadAnswers(path)->digest; }

void RequireCommandAnswers(const std::string& command, double timeout_s) {
  constexpr double kLongStart_s = 10.0;  // a process that has not ended by then counts as started
  constexpr int kNumTries = 2;
  std::string end;
  for (int i = 0; i < kNumTries; ++i) {
    try {
      ProcessEstimator(command, std::min(timeout_s, kLongStart_s)).Ask(MakeFirstProblem(), 1);
      return;
    } catch (const NoOutsideAnswer& none) {
      if (none.status() != MotionStatus::kNoAnswer) return;
      end = none.what();
    }
  }
  throw InputError(fmt::format(
      "process: {} cannot be used: asked a problem of twenty matches, {} without an answer. Its messages are "
      "above; try it as sh would: rcme export STUDY --trials 1 --out FOLDER, then COMMAND < "
      "FOLDER/problems.jsonl",
      Quoted(command), end));
}

void AddOutsideEstimators() {
  AddEstimator({"process", "your process, which answers lines of JSON",
                [] { return std::make_unique<ProcessModel>(); }, /*is_peer=*/false, /*is_audited=*/false});
  AddEstimator({"answers", "a file of answers made elsewhere (rcme import)",
                [] { return std::make_unique<AnswersModel>(); }, /*is_peer=*/false, /*is_audited=*/false});
  AddEstimator({kConformEstimator, "another estimator, calibrated by rcme conform", ConformModel,
                /*is_peer=*/false, /*is_audited=*/false, /*uses_noise_scale=*/false,
                /*takes_common_options=*/false});
}

}  // namespace rcme
