#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/run/store/distinct_trials.h"
#include "experiments/statistics/forecast_output.h"

namespace rcme {

void AddReliabilityCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "reliability", "Test whether motions fail as often as their stated probabilities say");
  command->footer(R"(For each estimator, over the answers whose truth is known: Brier and logarithmic score
with intervals and their parts (miscalibration, discrimination, uncertainty), expected
calibration error, calibration slope and intercept, area under the ROC and the
risk-coverage curve, and failures among the sure answers. Where even right probabilities
would not give 0, the table shows what they would give.

A pure rotation has no direction of the translation that could be right or wrong. What is
stated of it is not judged; the table counts such answers.

If an estimator states no probability, its share of inliers is used, recalibrated by
isotonic regression on the other half of the scenes of the run.

Examples:
  rcme reliability run.sqlite
  rcme reliability run.sqlite --by outlier_ratio
  rcme reliability indoor.sqlite outdoor.sqlite
  rcme reliability run.sqlite --format json --out reliability.json
  rcme plot reliability reliability.json --out figure)");
  struct Arguments {
    std::vector<std::string> runs;
    std::string by, format = "table", out;
  };
  auto arguments = std::make_shared<Arguments>();
  command
      ->add_option("runs", arguments->runs,
                   "result files of `rcme run`; the trials of several are taken together")
      ->required();
  command->add_option("--by", arguments->by,
                      "factor of the study: a line per level instead of one for all trials");
  AddFormatOption(command, &arguments->format);
  command->add_option("-o,--out", arguments->out, "write here instead of standard output");
  command->callback([arguments] {
    RequireDistinctTrials(arguments->runs);
    std::vector<ResultStore> runs;
    std::vector<std::string> studies;
    for (const std::string& path : arguments->runs) {
      runs.push_back(ResultStore::OpenForReading(path));
      studies.push_back(runs.back().Description().study);
    }
    const std::vector<ForecastMeasures> measures = MeasureFailureForecasts(runs, arguments->by);
    PrintResult(MakeForecastResult(fmt::format("{}", fmt::join(studies, ", ")), arguments->by, measures),
                arguments->format, arguments->out);
  });
}

}  // namespace rcme
