
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/statistics/marginals_output.h"

namespace rcme {

void AddMarginalsCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("marginals", "Find the regimes in which estimators are not what they claim");
  command->footer(R"(For each level of each factor of a run (with --pairs also of two factors), and each
estimator:
  failed - P              share of the answers that failed, less the mean of their stated
                          probabilities of failure; claimed: 0
  failed - P at P <= 0.1  the same of the answers that the estimator was sure of
  coverage                truth within the stated 95 % region, of answers with P <= 0.01, or
                          of successes if the estimator states no probability; claimed: 95 %.
                          Beside it sd_over_crb, how sharp these regions are
  failure                 share of the trials that failed; nothing is claimed
A factor with more than eight levels that are numbers is divided into fifths of its
conditions. Conditions count as a random sample of a population, as in a study with a
block `conditions`. All intervals hold together, so that you may look for the worst.

Examples:
  rcme marginals run.sqlite
  rcme marginals run.sqlite --estimators rcme_calibrated --pairs --top 50
  rcme marginals run.sqlite --format csv --out marginals.csv)");
  struct Arguments {
    std::string run, format = "table", out;
    MarginalOptions options;
    int num_shown = 20;
  };
  auto arguments = std::make_shared<Arguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  command->add_flag("--pairs", arguments->options.with_pairs, "also levels of two factors together");
  AddEstimatorsOption(command, &arguments->options.estimators);
  command->add_option("--top", arguments->num_shown, "rows of the table's second part")
      ->transform(WholeNumberIn(1, 100'000))
      ->capture_default_str();
  AddFormatOption(command, &arguments->format);
  command->add_option("-o,--out", arguments->out, "write here instead of standard output");
  command->callback([arguments] {
    const ResultStore run = ResultStore::OpenForReading(arguments->run);
    const Marginals marginals = MeasureMarginals(run, arguments->options);
    const std::string study = run.Description().study;
    PrintResult(MakeMarginalsResult(study, marginals, static_cast<size_t>(arguments->num_shown)),
                arguments->format, arguments->out);
  });
}

}  // namespace rcme
