
#include <filesystem>
#include <memory>
#include <optional>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/estimator_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/real/truth_check/truth_check_output.h"
#include "experiments/study/estimator_spec.h"

namespace rcme {
namespace {

struct CheckTruthArguments {
  std::vector<std::string> folders;
  std::string out, bounds = "3,15", format = "table";
  EstimatorChoice estimator;
  std::optional<double> sigma_px;  // nothing: that of the files
  std::int64_t seed = 1;
  int threads = 0;
};

void RunCheckTruth(const CheckTruthArguments& arguments) {
  CheckIsNoInput(arguments.out, arguments.folders);
  const StopOnSignals stop;
  const TruthCheckOptions options{ParseFailureBounds(arguments.bounds), arguments.sigma_px,
                                  static_cast<std::uint64_t>(arguments.seed), arguments.threads};
  const EstimatorSpec spec = ChosenEstimator(arguments.estimator);
  CheckProcessEstimators({spec});
  const std::vector<CheckedPair> pairs = CheckTruths(arguments.folders, *Make(spec), options);
  const CommandResult result = MakeTruthCheckResult(pairs, options);
  if (!arguments.out.empty()) {
    MakeResultFolder(arguments.out);
    const std::filesystem::path folder(arguments.out);
    WriteResultFiles(result, (folder / "truth_check").string());
    WriteFileWhole((folder / "truth_in_doubt.csv").string(), TruthDoubtsAsCsv(pairs));
  }
  PrintResult(result, arguments.format);
}

}  // namespace

void AddCheckTruthCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("check-truth", "Find real pairs whose given true motion their matches contradict");
  command->footer(R"(PAIRS is a folder of match files. Give several, each of another front end with the same
names of files: all have to agree. Each front end's matches are divided into two halves
that share no neighbourhood of the image. The motion that is found in one half and the
truth, moved as far as it may be off (# truth_sd and the intrinsics; without # truth_sd
anywhere within the failure bounds), are compared on the other half, and the other way
round. The truth is in doubt if the motion is beyond a failure bound and explains more
matches, in more parts of the image, than chance allows (p <= 0.01 each), half as many
again as the truth and at least 10, and if nothing stands up for the truth. A front end
that finds too few matches is silent.

OUT has truth_check.txt, .csv and .json, and truth_in_doubt.csv, the list of the pairs in
doubt. A study that names the list (data: truth_in_doubt) lists these pairs and does not
score them.

Examples:
  rcme check-truth PAIRS --out checked
  rcme check-truth pairs/sift pairs/orb --bounds 1,5 --out checked
  rcme run real_pairs --set folder=PAIRS \
      --set truth_in_doubt=checked/truth_in_doubt.csv --out run.sqlite)");
  auto arguments = std::make_shared<CheckTruthArguments>();
  command->add_option("pairs", arguments->folders, "folders of match files, one per front end")->required();
  AddEstimatorOptions(command, &arguments->estimator);
  command->add_option("-o,--out", arguments->out, "folder for the tables and the list, created if missing");
  command
      ->add_option("--bounds", arguments->bounds,
                   "R,D: a motion is another one if its rotation is off by more than R deg or its direction "
                   "by more than D deg")
      ->capture_default_str();
  AddSigmaOption(command, &arguments->sigma_px);
  AddSeedOption(command, &arguments->seed);
  AddThreadsOption(command, &arguments->threads);
  AddFormatOption(command, &arguments->format);
  command->callback([arguments] { RunCheckTruth(*arguments); });
}

}  // namespace rcme
