#include <fmt/format.h>

#include <memory>

#include "experiments/analysis/summary_output.h"
#include "experiments/base/file_output.h"
#include "experiments/commands/commands.h"

namespace rcme {

void AddSummarizeCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "summarize", "Rates with exact 95 % intervals and means with standard errors, from a result file");
  struct Arguments {
    std::string run, format = "table", out;
    bool with_times = false;
  };
  auto arguments = std::make_shared<Arguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  command->add_option("--format", arguments->format, "table (for people), csv or json (every quantity)")
      ->check(CLI::IsMember({"table", "csv", "json"}))
      ->capture_default_str();
  command->add_option("-o,--out", arguments->out, "write here instead of standard output");
  command->add_flag("--times", arguments->with_times,
                    "add the time per call; without it, equal studies give equal bytes");
  command->callback([arguments] {
    const Summary summary = Summarize(ResultStore::OpenForReading(arguments->run), arguments->with_times);
    const std::string text = arguments->format == "csv"    ? SummaryAsCsv(summary)
                             : arguments->format == "json" ? SummaryAsJson(summary)
                                                           : SummaryAsTable(summary);
    PrintOrWrite(arguments->out, text);
  });
}

}  // namespace rcme
