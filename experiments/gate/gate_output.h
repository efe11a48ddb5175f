#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/gate/gate.h"

namespace rcme {

// What a gate found, with what a reader has to know of how.
struct GateReport {
  std::string study, old_label, new_label;  // the second is empty where only limits are tested
  std::int64_t num_conditions = 0;
  GateLook look;
  bool is_out_of_time = false;
  std::vector<std::string> assumptions;  // sentences: what the guarantee needs, what it is for
  std::vector<ChangedTrial> changed;     // those for the worse first
  // A result file or a study with its options, as `rcme show` takes them; that of the old version is empty
  // where one shows both.
  std::string show_new, show_old;
};

// Assumptions that every gate has, with those of its tests.
std::vector<std::string> ListAssumptions(const ReadableRun& run, const std::vector<GateTest>& tests);

// One sentence: the verdict, of what, after how many trials.
std::string GateSentence(const GateReport& report);

// The command that computes and draws a changed trial again; of the old version if it has one of its own.
std::string ShowCommand(const GateReport& report, const ChangedTrial& trial, bool of_old = false);

std::string GateAsText(const GateReport& report);
// For the page of a pull request.
std::string GateAsMarkdown(const GateReport& report);
std::string GateAsJson(const GateReport& report);
// A test case per test: worse is a failure, undecided an error, what was not measured is skipped.
std::string GateAsJUnit(const GateReport& report);

CommandResult MakeGateResult(const GateReport& report);

}  // namespace rcme
