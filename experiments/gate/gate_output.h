#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/gate/gate.h"

namespace rcme {

// The result of a gate with what its reader needs to judge it.
struct GateReport {
  std::string study, old_label, new_label;  // old_label is empty if only limits are tested
  std::int64_t num_conditions = 0;
  GateLook look;
  bool is_out_of_time = false;
  std::vector<std::string> assumptions;  // sentences: what the guarantee assumes, and its scope
  std::vector<ChangedTrial> changed;     // changes for the worse first
  // Arguments of `rcme show`: a result file, or a study with its options. show_old is empty if show_new shows
  // both versions.
  std::string show_new, show_old;
};

// The assumptions common to all gates, followed by those of these tests.
std::vector<std::string> ListAssumptions(const ReadableRun& run, const std::vector<GateTest>& tests);

// One sentence: the verdict, what was compared, and the number of trials.
std::string GateSentence(const GateReport& report);

// The `rcme show` command that recomputes and draws a changed trial. `of_old`: with the old version, if that
// has a command of its own.
std::string ShowCommand(const GateReport& report, const ChangedTrial& trial, bool of_old = false);

std::string GateAsText(const GateReport& report);
// For a comment on a pull request.
std::string GateAsMarkdown(const GateReport& report);
std::string GateAsJson(const GateReport& report);
// One test case per test: "worse" is a failure, "undecided" an error, "not measured" is skipped.
std::string GateAsJUnit(const GateReport& report);

CommandResult MakeGateResult(const GateReport& report);

}  // namespace rcme
