
#include <limits>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/statistics/failing_trials.h"
#include "experiments/trial/trial_event.h"

namespace rcme {

void AddFailuresCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("failures", "List the trials of a run in which estimators failed");
  command->footer(R"(One line per answer: where it is, how it ended, its errors, and the probability of
failure that the estimator stated. Errors of refusals are unknown.

Examples:
  rcme failures run.sqlite
  rcme failures run.sqlite --estimators standard --condition 6
  rcme failures run.sqlite --of failure_or_refusal --limit 0 --format csv --out failures.csv
  rcme show run.sqlite --condition 6 --trial 17            one of them as a picture
  rcme replay run.sqlite --condition 6 --trial 17 --emit-cpp trial.cc
                                                           one of them for a debugger)");
  struct Arguments {
    std::string run, format = "table", out;
    FailureQuery query;
    std::uint32_t condition = 0;
  };
  auto arguments = std::make_shared<Arguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  command->add_option("--of", arguments->query.event, "failure, refusal or failure_or_refusal")
      ->check(MakeChoiceValidator(TrialEventNames()))
      ->capture_default_str();
  AddEstimatorsOption(command, &arguments->query.estimators);
  CLI::Option* condition =
      command
          ->add_option("--condition", arguments->condition,
                       "condition, from 0 (column condition of the summary); default: all")
          ->transform(WholeNumberIn(0, std::numeric_limits<std::uint32_t>::max()));
  command->add_option("--limit", arguments->query.limit, "list so many; 0: all")
      ->transform(WholeNumberIn(0))
      ->capture_default_str();
  AddFormatOption(command, &arguments->format);
  command->add_option("-o,--out", arguments->out, "write here instead of standard output");
  command->callback([arguments, condition] {
    if (condition->count() > 0) arguments->query.condition = arguments->condition;
    const ResultStore store = ResultStore::OpenForReading(arguments->run);
    const FailingTrials trials = ListFailingTrials(store, arguments->query);
    PrintResult(MakeFailuresResult(trials, arguments->run), arguments->format, arguments->out);
  });
}

}  // namespace rcme
