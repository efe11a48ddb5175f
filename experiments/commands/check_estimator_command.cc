#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "experiments/audit/contract/estimator_contract.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/estimator_source.h"
#include "experiments/core/text/program_name.h"
#include "experiments/core/text/shell_word.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

struct EstimatorCheckArguments {
  EstimatorChoice estimator;
  std::vector<std::string> only;
  std::string problem;
  std::int64_t seed = 1;
  double seconds_per_call = ContractOptions{}.seconds_per_call;
  bool is_in_process = false;
};

// The command that repeats this check, to be pasted into a shell.
std::string FormatRepeatCommand(const EstimatorCheckArguments& arguments, const std::string& check,
                                const std::string& problem) {
  const EstimatorChoice& choice = arguments.estimator;
  std::string command = QuoteForShell(CommandName()) + " check-estimator " +
                        (choice.conform ? "--conform " + QuoteForShell(*choice.conform)
                         : choice.file  ? "--estimator-file " + QuoteForShell(*choice.file)
                                        : QuoteForShell(choice.name));
  for (const std::string& text : choice.overrides) command += " --set " + QuoteForShell(text);
  command += fmt::format(" --seed {} --only {}", arguments.seed, check);
  if (!problem.empty()) command += " --problem " + QuoteForShell(problem);
  if (choice.allow_process) command += " --allow-process";
  return command;
}

void Print(const EstimatorCheckArguments& arguments, const ContractCheck& check,
           const ContractResult& result) {
  const std::string at = result.problem.empty() ? "" : fmt::format("on '{}': ", result.problem);
  fmt::print("{:<7} {:<12} {}{}\n", result.has_passed ? "ok" : "FAILED", check.name, at,
             Printable(result.finding));
  if (!result.has_passed) {
    fmt::print("{:<20} required:  {}\n{:<20} reproduce: {}\n", "", check.doc, "",
               FormatRepeatCommand(arguments, check.name, result.problem));
  }
  std::fflush(stdout);
}

void RunChecks(const EstimatorCheckArguments& arguments) {
  const EstimatorSpec spec = ChosenEstimator(arguments.estimator);
  const EstimatorMaker make = [&] { return Make(spec); };
  make();  // options that contradict each other are found here
  ContractOptions options;
  options.seed = static_cast<std::uint64_t>(arguments.seed);
  options.seconds_per_call = arguments.seconds_per_call;
  options.problem = arguments.problem;
  options.is_isolated = !arguments.is_in_process;
  int num_checks = 0, num_passed = 0;
  for (const ContractCheck& check : ContractChecks()) {
    if (!arguments.only.empty() && std::ranges::count(arguments.only, check.name) == 0) continue;
    const ContractResult result = RunContractCheck(check.name, make, options);
    Print(arguments, check, result);
    ++num_checks;
    num_passed += result.has_passed;
  }
  fmt::print("{}: {} of {} checks passed\n", spec.label, num_passed, num_checks);
  if (num_passed < num_checks) throw EndWith{1};
}

}  // namespace

void AddCheckEstimatorCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "check-estimator", "Test that an estimator obeys the contract that every command relies on");
  std::string checks;
  for (const ContractCheck& check : ContractChecks())
    checks += fmt::format("  {:<12} {}\n", check.name, check.doc);
  command->footer(
      R"(Use it on your own estimator (examples/own_estimator) before you audit it or put it in a study. The
contract is in estimator/motion_estimator.h and motion_estimate.h. The checks:
)" + checks +
      R"(Each check runs in its own process, so a crash or a call that never returns fails the check. A
failed check names its problem and the command that reproduces it. The checks do not test whether
motions are precise and covariances right: `rcme audit` does.

Exit code: 0 if all checks pass, 1 if one fails.

Examples:
  rcme check-estimator rcme --set reading=rank_aware
  own_rcme check-estimator opencv
  gdb --args own_rcme check-estimator opencv --only bad_input --problem 'no match' --in-process)");
  auto arguments = std::make_shared<EstimatorCheckArguments>();
  arguments->estimator.name.clear();
  CLI::Option* name =
      command->add_option("estimator", arguments->estimator.name, "see `rcme list estimators`");
  AddEstimatorOptions(command, name, &arguments->estimator);
  CLI::Option* only = command->add_option("--only", arguments->only, "checks a,b,...")
                          ->delimiter(',')
                          ->allow_extra_args(false)
                          ->check(MakeChoiceValidator(ListNames(ContractChecks())));
  command
      ->add_option("--problem", arguments->problem,
                   "only the problem with this name, as printed by a failed check")
      ->needs(only);
  AddSeedOption(command, &arguments->seed, "the problems and of the random samples");
  command
      ->add_option("--seconds-per-call", arguments->seconds_per_call,
                   "a call that takes longer counts as hanging, s")
      ->transform(NumberIn({0.01, 1e6}))
      ->capture_default_str();
  command->add_flag("--in-process", arguments->is_in_process,
                    "run the checks in this process, for a debugger; a crash then ends the program");
  command->callback([arguments] {
    const EstimatorChoice& choice = arguments->estimator;
    if (choice.name.empty() && !choice.file && !choice.conform)
      throw InputError("check-estimator: give the name of an estimator, --estimator-file or --conform");
    RunChecks(*arguments);
  });
}

}  // namespace rcme
