// Processes that misbehave at their first problem, each with the status that it gets, and then answer as they
// should: what follows is not touched by it, and nothing that a process has started outlives it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "estimator/estimator_registry.h"
#include "experiments/trial/answer_check.h"
#include "tests/peers/process_entry.h"
#include "tests/test_support/descendants.h"
#include "tests/test_support/random_problem.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using Status = MotionStatus;

MotionProblem MakeProblem(std::uint64_t seed) {
  RandomStream rng({seed, 0, 1, 0});
  MotionProblem problem = MakeRandomProblem(rng, {.num_matches = 20}).problem;
  AddNoise(problem.sigma_px, rng, &problem);
  return problem;
}

// What the scripts are written with: `ask` reads a problem, `answer` answers it, `well` goes on to the end.
constexpr const char* kWords = R"sh(
R='[1,0,0,0,1,0,0,0,1]' t='[2,0,0]' e=0.0001
cov="[$e,0,0,0,0,0, 0,$e,0,0,0,0, 0,0,$e,0,0,0, 0,0,0,$e,0,0, 0,0,0,0,$e,0, 0,0,0,0,0,$e]"
rest="\"R\":$R,\"t\":$t,\"pose_cov\":$cov,\"inliers\":[0,1,2,3,4,5,6]"
ask() { IFS= read -r line || exit 0; id=${line#*\"id\":\"}; id=${id%%\"*}; }
say() { printf '%s\n' "$1"; }
answer() { say "{\"id\":\"$id\",$rest}"; }
well() { while ask; do answer; done; }
)sh";

struct Case {
  std::string name;
  std::string script;            // misbehaves at the first problem
  std::vector<Status> statuses;  // of the first problems; the next one is answered
  std::string words = "";        // in the message of the first refusal
};

const std::vector<Case>& Cases() {
  static const std::vector<Case> cases = {
      // Silence.
      {"never_answers", "ask; sleep 300", {Status::kTimedOut}, "in time"},
      {"never_reads", "sleep 300", {Status::kTimedOut}},
      {"half_a_line", "ask; printf '{\"id\":\"'; sleep 300", {Status::kTimedOut}},
      {"a_byte_at_a_time", "ask; while :; do printf x; sleep 0.1; done", {Status::kTimedOut}},
      {"stops_itself", "ask; kill -STOP $$", {Status::kTimedOut}},
      {"ignores_signals", "trap '' TERM INT HUP PIPE; ask; sleep 300; sleep 300", {Status::kTimedOut}},
      {"hangs_in_a_session_of_its_own", "ask; setsid sh -c 'sleep 300; exit' & wait", {Status::kTimedOut}},
      {"hangs_as_a_daemon", "ask; (setsid sh -c 'sleep 300 & sleep 300' &) ; sleep 300", {Status::kTimedOut}},
      {"a_chain_of_children",
       "ask; sh -c 'sh -c \"setsid sh -c \\\"sleep 300; :\\\" ; :\"; :'",
       {Status::kTimedOut}},
      // The end.
      {"exit_code_0", "ask; exit 0", {Status::kNoAnswer}, "exit code 0"},
      {"exit_code_1", "ask; exit 1", {Status::kNoAnswer}, "exit code 1"},
      {"exit_code_127", "ask; no_such_program_at_all; exit", {Status::kNoAnswer}, "exit code 127"},
      {"ends_before_it_reads", "exit 3", {Status::kNoAnswer}, "exit code 3"},
      {"killed", "ask; kill -9 $$", {Status::kNoAnswer}, "signal 9"},
      {"segmentation_fault", "ask; kill -11 $$", {Status::kNoAnswer}, "signal 11"},
      {"half_a_line_and_the_end", "ask; printf '{\"id\"'; exit 0", {Status::kNoAnswer}, "exit code 0"},
      {"one_answer_and_the_end", "ask; answer; exit 4", {Status::kOk, Status::kNoAnswer}, "exit code 4"},
      {"closes_its_output", "ask; exec >&-; sleep 300", {Status::kNoAnswer}, "closed"},
      {"closes_its_input", "ask; answer; exec <&-; sleep 300", {Status::kOk, Status::kNoAnswer}, "closed"},
      {"closes_its_input_unread", "sleep 0.2; exec <&-; sleep 300", {Status::kNoAnswer}, "closed"},
      {"kills_its_group", "ask; kill -9 0", {Status::kNoAnswer}, "signal 9"},
      {"kills_its_supervisor", "ask; kill -9 $PPID; exec sleep 300", {Status::kNoAnswer}},
      // No answers.
      {"words", "ask; say hello; well", {Status::kUnreadableAnswer}, "hello"},
      {"an_empty_line", "ask; say ''; well", {Status::kUnreadableAnswer}},
      {"a_list", "ask; say '[1, 2]'; well", {Status::kUnreadableAnswer}},
      {"half_an_object", "ask; say '{\"id\":'; well", {Status::kUnreadableAnswer}},
      {"bytes_that_are_no_text", "ask; printf '\\377\\376\\200\\001\\n'; well", {Status::kUnreadableAnswer}},
      {"zero_bytes", "ask; printf '{\"id\":\"%s\\000\"}\\n' $id; well", {Status::kUnreadableAnswer}},
      {"a_line_of_70_megabytes",
       "ask; head -c 70000000 /dev/zero; well",
       {Status::kUnreadableAnswer},
       "long"},
      {"a_flood", "ask; yes", {Status::kUnreadableAnswer}},
      {"deep_nesting",
       "ask; say \"{\\\"id\\\":\\\"$id\\\",\\\"R\\\":[[[[[[[1]]]]]]]}\"; well",
       {Status::kUnreadableAnswer},
       "lists"},
      {"a_key_twice",
       "ask; say \"{\\\"id\\\":\\\"$id\\\",$rest,\\\"t\\\":[0,1,0]}\"; well",
       {Status::kUnreadableAnswer},
       "twice"},
      {"not_a_number",
       "R='[NaN,0,0,0,1,0,0,0,1]'; ask; say \"{\\\"id\\\":\\\"$id\\\",\\\"R\\\":$R}\"; well",
       {Status::kUnreadableAnswer}},
      {"a_number_too_large",
       "ask; say \"{\\\"id\\\":\\\"$id\\\",\\\"R\\\":$R,\\\"t\\\":[1e999,0,0]}\"; well",
       {Status::kUnreadableAnswer}},
      {"R_of_8_numbers",
       "ask; say \"{\\\"id\\\":\\\"$id\\\",\\\"R\\\":[1,0,0,0,1,0,0,0],\\\"t\\\":$t}\"; well",
       {Status::kUnreadableAnswer},
       "R"},
      {"t_of_2_numbers",
       "ask; say \"{\\\"id\\\":\\\"$id\\\",\\\"R\\\":$R,\\\"t\\\":[1,0]}\"; well",
       {Status::kUnreadableAnswer},
       "t"},
      {"a_covariance_of_5_numbers",
       "ask; say \"{\\\"id\\\":\\\"$id\\\",\\\"R\\\":$R,\\\"t\\\":$t,\\\"pose_cov\\\":[1,2,3,4,5]}\"; well",
       {Status::kUnreadableAnswer},
       "pose_cov"},
      {"a_status_of_the_judge",
       "ask; say \"{\\\"id\\\":\\\"$id\\\",\\\"status\\\":\\\"invalid_motion\\\"}\"; well",
       {Status::kUnreadableAnswer},
       "allowed"},
      // Answers to something else.
      {"no_id", "ask; say \"{$rest}\"; well", {Status::kUnreadableAnswer}, "no id; expected"},
      {"an_id_that_is_null",
       "ask; say \"{\\\"id\\\":null,$rest}\"; well",
       {Status::kUnreadableAnswer},
       "no id"},
      {"an_id_that_is_a_number",
       "ask; say \"{\\\"id\\\":3,$rest}\"; well",
       {Status::kUnreadableAnswer},
       "id"},
      {"another_id",
       "ask; id=0123456789abcdef; answer; well",
       {Status::kUnreadableAnswer},
       "'0123456789abcdef'; expected"},
      {"the_answer_before",
       "ask; answer; old=$id; ask; id=$old; answer; well",
       {Status::kOk, Status::kUnreadableAnswer},
       "expected"},
      {"two_answers_at_once",
       "ask; a=$(answer); printf '%s\\n%s\\n' \"$a\" \"$a\"; well",
       {Status::kUnreadableAnswer},
       "one answer"},
      {"the_answer_again_and_late",
       "ask; answer; sleep 0.2; answer; well",
       {Status::kOk, Status::kUnreadableAnswer}},
      {"a_line_late",
       "ask; answer; sleep 0.2; say loading; well",
       {Status::kOk, Status::kUnreadableAnswer},
       "loading"},
      {"an_answer_unasked", "id=0; answer; well", {Status::kUnreadableAnswer}},
      {"a_greeting", "say ready; well", {Status::kUnreadableAnswer}, "ready"},
      // Answers that are not valid: the judge's. The process stays.
      {"a_matrix_that_is_no_rotation",
       "ask; rest=\"\\\"R\\\":[2,0,0,0,2,0,0,0,2],\\\"t\\\":$t\" answer; well",
       {Status::kInvalidMotion}},
      {"a_reflection",
       "ask; rest=\"\\\"R\\\":[1,0,0,0,1,0,0,0,-1],\\\"t\\\":$t\" answer; well",
       {Status::kInvalidMotion}},
      {"no_direction", "ask; rest=\"\\\"R\\\":$R,\\\"t\\\":[0,0,0]\" answer; well", {Status::kInvalidMotion}},
      {"a_match_that_is_none",
       "ask; rest=\"\\\"R\\\":$R,\\\"t\\\":$t,\\\"inliers\\\":[99]\" "
       "answer; well",
       {Status::kInvalidMotion}},
      // Allowed, if odd.
      {"byte_order_mark", "ask; printf '\\357\\273\\277'; answer; well", {Status::kOk}},
      {"lines_that_end_as_in_windows", "ask; printf '%s\\r\\n' \"$(answer)\"; well", {Status::kOk}},
      {"a_flood_of_messages", "ask; head -c 3000000 /dev/zero >&2; answer; well", {Status::kOk}},
      {"children_that_stay", "ask; sleep 300 & answer; well", {Status::kOk}},
      {"a_refusal",
       "ask; say \"{\\\"id\\\":\\\"$id\\\",\\\"status\\\":\\\"too_uncertain\\\"}\"; well",
       {Status::kTooUncertain}},
  };
  return cases;
}

// What the case gives, and then two more problems.
void Try(const Case& c, const std::string& folder) {
  SCOPED_TRACE(c.name);
  const std::string script = folder + "/" + c.name + ".sh", flag = folder + "/" + c.name + ".flag";
  std::ofstream(script) << "exec 2>/dev/null\nexport RCME_CASE='" << script << "'\n"
                        << kWords << "if mkdir '" << flag << "'; then " << c.script << "; exit; fi; well\n";
  const bool is_late = c.statuses.back() == Status::kTimedOut;
  const auto process = MakeEstimator(
      ProcessEntryName(), {{"command", "exec sh '" + script + "'"}, {"timeout_s", is_late ? "2" : "60"}});
  bool is_told = c.words.empty();
  for (std::uint64_t i = 0; i < c.statuses.size() + 2; ++i) {
    const MotionProblem problem = MakeProblem(i + 1);
    RandomStream rng({i + 1, 0, 0, 0});
    const MotionEstimate estimate = Judged(process->Estimate(problem, rng), problem.matches.size());
    const Status expected = i < c.statuses.size() ? c.statuses[i] : Status::kOk;
    EXPECT_EQ(StatusName(estimate.status), StatusName(expected))
        << "problem " << i << ": " << estimate.message;
    if (expected != Status::kOk && !is_told) {
      EXPECT_THAT(estimate.message, HasSubstr(c.words));
      is_told = true;
    }
    const bool is_killed = expected == Status::kTimedOut;
    if (is_killed) {
      EXPECT_THAT(ProcessesLeft(script, std::chrono::milliseconds(500)), testing::IsEmpty());
    }
  }
}

// Fails where a status, the process after it, or the end of what it has started is another.
TEST(MisbehavingProcesses, EachHasItsStatusAndTheNextProblemIsAnswered) {
  const TempFolder folder;
  const std::string path = folder.Path(".");
  ProcessEntryName();
  const auto start = std::chrono::steady_clock::now();
  std::atomic<size_t> next = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 8; ++t) {
      threads.emplace_back([&] {
        for (size_t i = next++; i < Cases().size(); i = next++) Try(Cases()[i], path);
      });
    }
  }
  EXPECT_GE(Cases().size(), 35u);
  EXPECT_THAT(ProcessesLeft(path), testing::IsEmpty());
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::minutes(2));
}

// The attack: an estimator that returns the truth, and a line 50 ms late. It cost every trial that followed.
TEST(MisbehavingProcesses, ALineTooManyCostsOneAnswer) {
  const TempFolder folder;
  for (const std::string line :
       {"loading", R"({"R":[1,0,0,0,1,0,0,0,1],"t":[0,0,1]})", R"({"id":"'$first'"})"}) {
    const std::string script = folder.Path("late.sh");
    std::ofstream(script) << kWords << "ask; answer; first=$id; (sleep 0.05; say '" << line
                          << "') & while ask; do sleep 0.02; answer; done\n";
    const auto process =
        MakeEstimator(ProcessEntryName(), {{"command", "sh " + script}, {"timeout_s", "60"}});
    int num_ok = 0, num_unreadable = 0;
    for (std::uint64_t i = 1; i <= 8; ++i) {
      RandomStream rng({i, 0, 0, 0});
      const MotionEstimate estimate = process->Estimate(MakeProblem(i), rng);
      num_ok += estimate.status == Status::kOk && estimate.cam2_from_cam1.t == Eigen::Vector3d::UnitX();
      num_unreadable += estimate.status == Status::kUnreadableAnswer;
    }
    // Each process has one such line; the answers before and after are those of their problems.
    EXPECT_EQ(num_ok + num_unreadable, 8);
    EXPECT_GE(num_ok, 4);
    EXPECT_GE(num_unreadable, 1);
  }
}

// The line is written once the first answer is there, and the next problem is asked once the line is: it is
// seen before the question, whose answer would be right.
TEST(MisbehavingProcesses, ALineBetweenTwoProblemsIsSeenBeforeTheNextIsAsked) {
  const TempFolder folder;
  const std::string script = folder.Path("between.sh"), go = folder.Path("go"), said = folder.Path("said");
  std::ofstream(script) << kWords << "ask; answer; while ! [ -e '" << go
                        << "' ]; do sleep 0.01; done; say loading; mkdir '" << said << "'; well\n";
  const auto process = MakeEstimator(ProcessEntryName(), {{"command", "sh " + script}, {"timeout_s", "60"}});
  const auto ask = [&](std::uint64_t i) {
    RandomStream rng({i, 0, 0, 0});
    return process->Estimate(MakeProblem(i), rng);
  };
  EXPECT_EQ(ask(1).status, Status::kOk);
  std::ofstream(go) << "go\n";
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!std::filesystem::exists(said) && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const MotionEstimate second = ask(2);
  EXPECT_EQ(second.status, Status::kUnreadableAnswer) << second.message;
  EXPECT_THAT(second.message, HasSubstr("was written before the process was asked"));
}

// The same problem twice, as a check of the contract asks: two questions, two ids.
TEST(MisbehavingProcesses, AProblemAskedAgainHasAnotherId) {
  const TempFolder folder;
  const std::string script = folder.Path("again.sh"), ids = folder.Path("ids");
  std::ofstream(script) << kWords << "while ask; do echo $id >> '" << ids << "'; answer; done\n";
  {
    const auto process =
        MakeEstimator(ProcessEntryName(), {{"command", "sh " + script}, {"timeout_s", "60"}});
    for (const std::uint64_t seed : {1, 1, 1, 2, 1}) {
      RandomStream rng({seed, 0, 0, 0});
      EXPECT_EQ(process->Estimate(MakeProblem(seed), rng).status, Status::kOk);
    }
  }
  std::ifstream file(ids);
  std::vector<std::string> given;
  for (std::string id; file >> id;) given.push_back(id);
  ASSERT_EQ(given.size(), 5u);
  EXPECT_EQ(given[1], given[0] + "-2");
  EXPECT_EQ(given[2], given[0] + "-3");
  EXPECT_EQ(given[4], given[0]);
  EXPECT_NE(given[3], given[0]);
}

// Half a second for what it has to put in order once its input has ended, of which this one takes a tenth.
TEST(MisbehavingProcesses, OneThatBehavesEndsByItself) {
  const TempFolder folder;
  const std::string script = folder.Path("ends.sh"), ended = folder.Path("ended");
  std::ofstream(script) << kWords << "trap 'sleep 0.05; echo yes > " << ended << "' EXIT; well\n";
  {
    const auto process =
        MakeEstimator(ProcessEntryName(), {{"command", "exec sh " + script}, {"timeout_s", "60"}});
    RandomStream rng({1, 0, 0, 0});
    EXPECT_EQ(process->Estimate(MakeProblem(1), rng).status, Status::kOk);
  }
  EXPECT_EQ(ReadBytes(ended), "yes\n");
}

// The end is soon although one of them does not end by itself, and it is gone then.
TEST(MisbehavingProcesses, EndWithTheirEstimator) {
  const TempFolder folder;
  const std::string script = folder.Path("stays.sh");
  std::ofstream(script) << "export RCME_CASE='" << script << "'\n"
                        << kWords << "trap '' TERM HUP; setsid sleep 300 & ask; answer; sleep 300\n";
  std::chrono::steady_clock::time_point start;
  {
    const auto process =
        MakeEstimator(ProcessEntryName(), {{"command", "sh " + script}, {"timeout_s", "60"}});
    RandomStream rng({1, 0, 0, 0});
    EXPECT_EQ(process->Estimate(MakeProblem(1), rng).status, Status::kOk);
    EXPECT_FALSE(ProcessesNaming(script).empty()) << "the test sees them while they live";
    start = std::chrono::steady_clock::now();
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  EXPECT_THAT(ProcessesLeft(script, std::chrono::milliseconds(0)), testing::IsEmpty());
}

}  // namespace
}  // namespace rcme
