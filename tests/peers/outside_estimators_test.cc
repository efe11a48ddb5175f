// The interface for estimators outside the program: their covariance, their lines of JSON, and processes that
// answer, are late, crash or talk nonsense. The processes are scripts of the shell.
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "estimator/estimator_registry.h"
#include "parameters/input_error.h"
#include "peers/answer_json.h"
#include "peers/peer_registry.h"
#include "tests/peers/process_entry.h"
#include "tests/test_support/random_problem.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

using testing::HasSubstr;

MotionProblem DrawNoisyProblem(std::uint64_t seed) {
  RandomStream rng({seed, 0, 1, 0});
  MotionProblem problem = MakeRandomProblem(rng, {.num_matches = 20}).problem;
  AddNoise(problem.sigma_px, rng, &problem);
  return problem;
}

// Answers every line with the same one, which is no JSON object.
std::string Always(const std::string& answer) {
  std::string script = "while read -r line; do echo '";
  script += answer;
  script += "'; done";
  return script;
}

// Answers every line with these keys and values beside the problem's id.
std::string AlwaysWithId(const std::string& keys) {
  std::string script = R"(while read -r line; do id=$(printf %.80s "$line"); id=${id#*\"id\":\"}; )"
                       R"(printf '{"id":"%s"' "${id%%\"*}"; echo ')";
  script += keys;
  script += "}'; done";
  return script;
}
constexpr const char* kAnswer =
    R"(, "R": [[1,0,0],[0,1,0],[0,0,1]], "t": [2,0,0], "inliers": [4,1,2,3,0,7,9])";

std::unique_ptr<MotionEstimator> Process(const std::string& command, const std::string& timeout_s = "20") {
  return MakeEstimator(ProcessEntryName(), {{"command", command}, {"timeout_s", timeout_s}});
}

MotionEstimate Ask(const MotionEstimator& estimator, std::uint64_t seed = 1) {
  RandomStream rng({seed, 0, 0, 0});
  return estimator.Estimate(DrawNoisyProblem(seed), rng);
}

TEST(OutsideCovariance, AMessageSaysWhoseItIs) {
  OutsideAnswer answer;
  answer.t << 1.0, 0.0, 0.0;
  const auto message = [&] { return CallOutside(DrawNoisyProblem(1), [&] { return answer; }).message; };
  EXPECT_EQ(message(), kCovarianceOfRcme);
  answer.message = "found";
  EXPECT_EQ(message(), "found; " + std::string(kCovarianceOfRcme));
  answer.pose_cov = Matrix6d::Identity();
  EXPECT_EQ(message(), "found");
}

TEST(OutsideCovariance, IsThatOfTheTangent) {
  const RelativePose pose{RotationFromVector({0.1, -0.2, 0.05}),
                          Eigen::Vector3d(0.3, -0.8, 0.4).normalized()};
  const Matrix5d root = Matrix5d::Random();
  const Matrix5d pose_cov = root * root.transpose();
  const Matrix6d whole = CovarianceWithTranslation(pose_cov, pose.t);
  EXPECT_NEAR((TangentCovariance(whole, pose.t) - pose_cov).norm(), 0.0, 1e-12);
  // In another length of t, and with anything along t.
  Matrix6d scaled = whole;
  scaled.topRightCorner<3, 3>() *= 3.0;
  scaled.bottomLeftCorner<3, 3>() *= 3.0;
  scaled.bottomRightCorner<3, 3>() *= 9.0;
  scaled.bottomRightCorner<3, 3>() += 5.0 * pose.t * pose.t.transpose();
  EXPECT_NEAR((TangentCovariance(scaled, 3.0 * pose.t) - pose_cov).norm(), 0.0, 1e-12);
}

// w and dt as the interface says, by LocalCoordinates of a pose a small step away.
TEST(OutsideCovariance, OrderAndSignsOfTheSixComponents) {
  const RelativePose pose{RotationFromVector({0.1, -0.2, 0.05}),
                          Eigen::Vector3d(0.3, -0.8, 0.4).normalized()};
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 6; ++k) {
    Eigen::Matrix<double, 6, 1> step = Eigen::Matrix<double, 6, 1>::Zero();
    step(k) = kStep;
    const RelativePose other{RotationFromVector(step.head<3>()) * pose.R,
                             (pose.t + step.tail<3>()).normalized()};
    const Vector5d tangent = LocalCoordinates(pose, other);
    const Matrix5d expected = tangent * tangent.transpose();
    const Matrix5d given = TangentCovariance(step * step.transpose(), pose.t);
    EXPECT_NEAR((given - expected).norm(), 0.0, 1e-5 * kStep * kStep) << k;
  }
}

TEST(AnswerJson, ProblemsAreReadBackBitForBit) {
  const MotionProblem problem = DrawNoisyProblem(3);
  const std::string line = ProblemAsJson(problem, 7);
  EXPECT_EQ(line.back(), '\n');
  EXPECT_EQ(line.find('\n'), line.size() - 1);
  EXPECT_THAT(line, HasSubstr("\"id\":\"" + ProblemId(problem, 7) + "\""));
  EXPECT_NE(ProblemId(problem, 7), ProblemId(problem, 8));
  MotionProblem other = problem;
  other.matches[3].x2_px.y() = std::nextafter(other.matches[3].x2_px.y(), 1e9);
  EXPECT_NE(ProblemId(problem, 7), ProblemId(other, 7));
  EXPECT_THAT(line, Not(HasSubstr("noise_scale")));
  other = problem;
  other.noise_scale.assign(20, 0.75);
  EXPECT_THAT(ProblemAsJson(other, 7), HasSubstr("\"noise_scale\":[0.75,0.75,"));
  EXPECT_NE(ProblemId(problem, 7), ProblemId(other, 7));
}

TEST(AnswerJson, WhatIsNoAnswerHasAFault) {
  const std::string pose = R"("R": [1,0,0,0,1,0,0,0,1], "t": [1,0,0])";
  const auto line = [&](const std::string& more) {
    std::string text = "{" + pose;
    text += more + "}";
    return text;
  };
  EXPECT_EQ(AnswerFromJson(line("")).fault, "");
  for (const char* skipped : {"iterations", "T", "F", "E", "K", "pose"})
    EXPECT_EQ(AnswerFromJson(line(fmt::format(R"(, "{}": 3)", skipped))).fault, "");
  for (const std::string& text : {std::string(""),
                                  std::string("hello"),
                                  std::string("[1, 2]"),
                                  std::string("{"),
                                  std::string("3"),
                                  std::string(R"({"R": [1,0,0]})"),
                                  std::string(R"({"R": "x", "t": [1,0,0]})"),
                                  std::string(R"({"R": [1,0,0,0,1,0,0,0,1]})"),
                                  std::string(R"({"R": [1,0,0,0,1,0,0,0,1,0], "t": [1,0,0]})"),
                                  std::string(R"({"R": [1,0,0,0,1,0,0,0,1], "t": [1,0,0,0]})"),
                                  std::string(R"({"status": "ok"})"),
                                  std::string(R"({"status": "fine"})"),
                                  std::string(R"({"status": 3})"),
                                  std::string(100'000, '['),
                                  line(R"(, "pose_cov": [1, 2])"),
                                  line(fmt::format(R"(, "pose_cov": {})", std::vector<int>(37, 1))),
                                  line(R"(, "inliers": [0.5])"),
                                  line(R"(, "inliers": [-1])"),
                                  line(R"(, "inliers": 3)"),
                                  line(R"(, "p_failure": "x")"),
                                  line(R"(, "seconds": -1)"),
                                  line(R"(, "status": "invalid_motion")"),
                                  line(R"(, "status": "not_simulated")"),
                                  line(R"(, "status": "truth_in_doubt")"),
                                  line(R"(, "message": 3)"),
                                  line(R"(, "t": [1,0,0])"),
                                  line(R"(, "pose_covv": [1])"),
                                  line(R"(, "p_failures": 0.1)"),
                                  line(R"(, "id": 3)")}) {
    EXPECT_NE(AnswerFromJson(text).fault, "") << text.substr(0, 60);
  }
}

// Row by row, as a list and as a list of rows.
TEST(AnswerJson, MatricesAreReadRowByRow) {
  std::string pose_cov;
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < 6; ++col)
      pose_cov += fmt::format("{}{}", row + col == 0 ? "" : ",", 6 * row + col);
  }
  for (const char* R : {"[1,2,3,4,5,6,7,8,9]", "[[1,2,3],[4,5,6],[7,8,9]]"}) {
    const AnswerLine line =
        AnswerFromJson(fmt::format(R"({{"R": {}, "t": [10,11,12], "pose_cov": [{}]}})", R, pose_cov));
    ASSERT_EQ(line.fault, "");
    EXPECT_EQ(line.answer.R, (Eigen::Matrix3d() << 1, 2, 3, 4, 5, 6, 7, 8, 9).finished());
    EXPECT_EQ(line.answer.t, Eigen::Vector3d(10, 11, 12));
    EXPECT_EQ((*line.answer.pose_cov)(2, 5), 17.0);
    EXPECT_EQ((*line.answer.pose_cov)(5, 2), 32.0);
  }
}

// Three lists within the object pass, also under a key that nobody asks for; a fourth one does not.
TEST(AnswerJson, ListsAreNestedUpToThreeDeep) {
  const std::string pose = R"({"R": [1,0,0,0,1,0,0,0,1], "t": [1,0,0], "note": )";
  EXPECT_EQ(AnswerFromJson(pose + "[[[1]]]}").fault, "");
  EXPECT_THAT(AnswerFromJson(pose + "[[[[1]]]]}").fault, HasSubstr("lists within lists"));
}

MotionEstimate EstimateWithAnswer(const OutsideAnswer& answer) {
  return CallOutside(DrawNoisyProblem(1), [&] { return answer; });
}

// Of inliers that are none of the 20 matches, or one of them twice, no covariance is made.
TEST(CallOutside, InliersThatAreNotValidGiveNoCovariance) {
  OutsideAnswer answer;
  answer.t = Eigen::Vector3d::UnitX();
  answer.inliers = {19, 1, 2, 3, 4, 5, 6, 7};
  EXPECT_GT(EstimateWithAnswer(answer).pose_cov(0, 0), 0.0);
  for (const int wrong : {20, 7, -1}) {
    answer.inliers->front() = wrong;
    MotionEstimate estimate;
    ASSERT_NO_THROW(estimate = EstimateWithAnswer(answer)) << wrong;
    EXPECT_EQ(estimate.pose_cov, MotionEstimate().pose_cov) << wrong;
    EXPECT_THAT(estimate.inliers, testing::Contains(wrong));
  }
}

// At most 1,000 bytes of it, and how many are left out between its ends; and as one line.
TEST(CallOutside, MessagesAreShortAndPrintable) {
  const std::string half(500, 'x'), shortened = fmt::format("{}[... 4000 bytes ...]{}", half, half);
  OutsideAnswer answer;
  answer.status = MotionStatus::kTooUncertain;
  answer.message = std::string(5000, 'x');
  EXPECT_EQ(EstimateWithAnswer(answer).message, shortened);
  answer.message = "a\nb\033";
  EXPECT_EQ(EstimateWithAnswer(answer).message, "a\\nb\\x1B");
  const MotionEstimate none = CallOutside(DrawNoisyProblem(1), []() -> OutsideAnswer {
    throw NoOutsideAnswer(MotionStatus::kNoAnswer, std::string(5000, 'x'));
  });
  EXPECT_EQ(none.status, MotionStatus::kNoAnswer);
  EXPECT_EQ(none.message, shortened);
}

TEST(CallOutside, TheTimeElsewhereIsTheAnswers) {
  OutsideAnswer answer;
  answer.t = Eigen::Vector3d::UnitX();
  EXPECT_TRUE(std::isnan(EstimateWithAnswer(answer).seconds_elsewhere));
  answer.seconds = 0.25;
  EXPECT_EQ(EstimateWithAnswer(answer).seconds_elsewhere, 0.25);
}

TEST(AnswerJson, AnAnswerBelongsToTheProblemOfItsId) {
  const std::string pose = R"("R": [1,0,0,0,1,0,0,0,1], "t": [1,0,0]})";
  const auto message = [](const std::string& line) {
    try {
      ReadableAnswerTo("a", AnswerFromJson(line));
    } catch (const NoOutsideAnswer& none) {
      EXPECT_EQ(none.status(), MotionStatus::kUnreadableAnswer);
      return std::string(none.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(R"({"id": "a", )" + pose), "");
  EXPECT_THAT(message(R"({"id": "b", )" + pose), HasSubstr("'b'; expected 'a'"));
  EXPECT_THAT(message(R"({"id": "aa", )" + pose), HasSubstr("expected 'a'"));
  EXPECT_THAT(message(R"({"id": "", )" + pose), HasSubstr("expected 'a'"));
  EXPECT_THAT(message("{" + pose), HasSubstr("no id; expected 'a'"));
  EXPECT_THAT(message(R"({"id": "a", "R": [1]})"), HasSubstr("R"));
}

TEST(ProcessEstimator, AnswersAreEstimates) {
  const auto process = Process(AlwaysWithId(kAnswer));
  for (const std::uint64_t seed : {1, 2, 3}) {
    const MotionEstimate estimate = Ask(*process, seed);
    ASSERT_EQ(estimate.status, MotionStatus::kOk) << estimate.message;
    EXPECT_EQ(estimate.cam2_from_cam1.t, Eigen::Vector3d::UnitX());
    EXPECT_EQ(estimate.inliers, (std::vector<int>{0, 1, 2, 3, 4, 7, 9}));
    EXPECT_GT(estimate.pose_cov(0, 0), 0.0);
    EXPECT_GE(estimate.seconds_elsewhere, 0.0);
  }
}

TEST(ProcessEstimator, TimeOutsCrashesAndNonsenseAreStatuses) {
  struct Ending {
    std::string command;
    MotionStatus status;
    std::string words;
  };
  for (const Ending& c :
       {Ending{"sleep 60", MotionStatus::kTimedOut, "in time"},
        Ending{"read -r line; sleep 60", MotionStatus::kTimedOut, "in time"},
        Ending{"exit 3", MotionStatus::kNoAnswer, "exit code 3"},
        Ending{"read -r line; exit 0", MotionStatus::kNoAnswer, "exit code 0"},
        Ending{"read -r line; kill -9 $$", MotionStatus::kNoAnswer, "signal 9"},
        Ending{"no_such_program_at_all 2>/dev/null", MotionStatus::kNoAnswer, "exit code 127"},
        Ending{Always("hello"), MotionStatus::kUnreadableAnswer, "hello"},
        Ending{Always("{}\n{}"), MotionStatus::kUnreadableAnswer, ""},
        Ending{Always("{}"), MotionStatus::kUnreadableAnswer, "no id"},
        Ending{AlwaysWithId(R"(, "status": "too_uncertain", "message": "no")"), MotionStatus::kTooUncertain,
               "no"},
        Ending{AlwaysWithId(""), MotionStatus::kNoCandidate, ""}}) {
    const auto process = Process(c.command, c.status == MotionStatus::kTimedOut ? "0.5" : "20");
    const auto start = std::chrono::steady_clock::now();
    for (int call = 0; call < 2; ++call) {  // what gave no answer is begun again
      const MotionEstimate estimate = Ask(*process);
      EXPECT_EQ(estimate.status, c.status) << c.command << ": " << estimate.message;
      EXPECT_THAT(estimate.message, HasSubstr(c.words));
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30)) << c.command;
  }
}

// A problem of some hundred kilobytes, which no socket holds, that is read, and one that is not.
TEST(ProcessEstimator, AProblemLargerThanAnyBuffer) {
  MotionProblem problem = DrawNoisyProblem(1);
  const std::vector<Correspondence> few = problem.matches;
  while (problem.matches.size() < 10'000)
    problem.matches.insert(problem.matches.end(), few.begin(), few.end());
  RandomStream rng({1, 0, 0, 0});
  EXPECT_EQ(Process(AlwaysWithId(kAnswer))->Estimate(problem, rng).status, MotionStatus::kOk);
  EXPECT_EQ(Process("sleep 60", "0.3")->Estimate(problem, rng).status, MotionStatus::kTimedOut);
}

TEST(ProcessEstimator, SeveralThreadsHaveAProcessEach) {
  const auto process = Process(AlwaysWithId(kAnswer));
  std::atomic<int> num_ok = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&] {
        for (std::uint64_t seed = 1; seed <= 10; ++seed)
          num_ok += Ask(*process, seed).status == MotionStatus::kOk;
      });
    }
  }
  EXPECT_EQ(num_ok, 40);
}

TEST(AnswersEstimator, LooksUpTheProblemById) {
  const TempFolder folder;
  const std::string path = folder.Path("answers.jsonl");
  RandomStream rng({1, 0, 0, 0});
  const std::string id = ProblemId(DrawNoisyProblem(1), SeedForOutside(rng));
  std::string line = "{\"id\": \"" + id;
  line += "\", \"R\": [1,0,0,0,1,0,0,0,1], \"t\": [1,0,0]}\n";
  std::ofstream(path) << line << "{\"id\": \"other\", \"R\": [1]}\n";
  ProcessEntryName();
  const auto answers = MakeEstimator("answers", {{"file", path}, {"digest", DigestOfAnswers(path)}});
  EXPECT_NE(Ask(*answers, 1).status, MotionStatus::kNoAnswer);
  EXPECT_EQ(Ask(*answers, 2).status, MotionStatus::kNoAnswer);
  std::ofstream(path, std::ios::app) << line;
  EXPECT_THROW(DigestOfAnswers(path), InputError);  // twice
  std::ofstream(path) << "{\"R\": [1,0,0,0,1,0,0,0,1], \"t\": [1,0,0]}\n";
  EXPECT_THROW(DigestOfAnswers(path), InputError);  // no id
  EXPECT_THROW(DigestOfAnswers(folder.Path("none")), InputError);
}

}  // namespace
}  // namespace rcme
