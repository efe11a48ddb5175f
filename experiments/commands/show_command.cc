#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_name.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/files/scratch_folder.h"
#include "experiments/core/text/message.h"
#include "experiments/real/answer/why.h"
#include "experiments/run/store/result_store.h"
#include "experiments/statistics/trial_output.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct ShowArguments {
  std::string study, out, json;
  StudyChanges changes;
  std::uint32_t condition = 0, trial = 0;
  std::vector<std::string> estimators;
};

StudyPlan PlanFrom(const ShowArguments& arguments) {
  if (!IsResultFile(arguments.study)) {
    return MakePlan(LoadChangedStudy(arguments.study, arguments.changes), arguments.study);
  }
  if (arguments.changes.AreAny()) {
    throw InputError(
        fmt::format("{}: a result file has its own study and seed; use --set, --add-estimator and --seed "
                    "with a study file (YAML)",
                    arguments.study));
  }
  return PlanOfStored(ResultStore::OpenForReading(arguments.study), arguments.changes.allow_process);
}

// Indices of the estimators with these labels, each once, in the order given.
std::vector<size_t> NumbersOfEstimators(const Study& study, const std::vector<std::string>& labels) {
  std::vector<size_t> chosen;
  for (const std::string& label : labels) {
    const size_t e =
        FindEstimator(study.estimators, label, fmt::format("--estimators: study '{}'", study.name));
    if (std::ranges::count(chosen, e) == 0) chosen.push_back(e);
  }
  return chosen;
}

// In the working directory.
std::string DefaultOut(const StudyPlan& plan, const ShowArguments& arguments) {
  return fmt::format("trial_{}_c{}_t{}", MakeFileName(plan.study.name), arguments.condition, arguments.trial);
}

// Checks before the trial is run that the output can be written.
void CheckOut(const std::string& out) {
  const std::filesystem::path path(out), parent = path.parent_path();
  if (path.filename().empty() || out.ends_with(".png") || out.ends_with(".pdf")) {
    throw InputError(fmt::format(
        "--out: '{}' is not allowed; give a file path without .png or .pdf; both are written", out));
  }
  if (!parent.empty() && !std::filesystem::is_directory(parent)) {
    throw InputError(fmt::format("{}: folder '{}' does not exist", out, parent.string()));
  }
  for (const char* suffix : {".png", ".pdf"}) {
    if (std::filesystem::is_directory(out + suffix))
      throw InputError(fmt::format("{}{}: is a folder, not a picture", out, suffix));
  }
}

void Show(const ShowArguments& arguments, bool has_out) {
  const StudyPlan plan = PlanFrom(arguments);
  const std::string out = has_out ? arguments.out : DefaultOut(plan, arguments);
  CheckOut(out);
  const Condition& condition = ChosenCondition(plan, arguments.condition);
  std::vector<size_t> drawn = NumbersOfEstimators(plan.study, arguments.estimators);
  const TrialResult result = RunTrial(plan, condition, arguments.trial);
  if (drawn.empty()) drawn = {MostTelling(plan, result)};

  const std::string json = TrialAsJson(plan, result, drawn);
  fmt::print("{}{}", TrialAsText(plan, result), WhyAsText(plan, result));
  if (!arguments.json.empty()) WriteFileWhole(arguments.json, json);
  const ScratchFolder folder;
  WriteFileWhole(folder.path() + "/trial.json", json);
  DrawOrThrow("show", "show_trial", {folder.path() + "/trial.json", "--out=" + out});
  PrintMessage("done: {0}.png, {0}.pdf\n", out);
}

}  // namespace

void AddShowCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("show", "Draw one trial: images, matches, epipolar lines, and the scene from above");
  command->footer(R"(Computes the trial again from the study, its seed and the two numbers, so nothing has to
be stored. You can also show trials beyond the number that the study asks for. In a
folder of real pairs, trial t is pair t modulo the number of pairs, and no scene is drawn.

The figure (PNG and PDF) has both images for each estimator. It marks every match by
what it is and by what the estimator took it for. In image 2 it draws the epipolar lines
of up to eight numbered points, of the truth (broad) and of the estimate (dashed). Below
are the scene from above, how hard the problem is, and a table of all estimators.
Without --estimators it draws the first that failed or refused, or else the first of the
study.

Standard output gets a summary and the causes of wrong answers, with the parallax, the
planar share and the runner-up. If the true motion would have had a better score than
the answer, by the estimator's own score, then the search failed and more samples help.
Otherwise the model cannot distinguish them and more samples do not help.

Examples:
  rcme show failure_vs_outliers --condition 6 --trial 17
  rcme show run.sqlite --condition 6 --trial 17 --estimators standard,rcme_rank_aware
  rcme show study.yaml --condition 0 --trial 3 --seed 5 --set outlier_ratio=0.4
`rcme report` names the first failure and refusal of every condition.)");
  auto arguments = std::make_shared<ShowArguments>();
  command
      ->add_option("study", arguments->study, "study file (YAML) or its name, or result file of `rcme run`")
      ->required();
  AddTrialChoice(command, &arguments->condition, &arguments->trial);
  AddEstimatorsOption(command, &arguments->estimators,
                      "labels a,b,... of the estimators to draw, a row of images each");
  CLI::Option* out = command->add_option("-o,--out", arguments->out,
                                         "figure to write, without suffix; default: trial_STUDY_cC_tT");
  command->add_option("--json", arguments->json, "also write the data of the figure to this JSON file");
  AddStudyOptions(command, &arguments->changes);
  AddProcessOption(command, &arguments->changes.allow_process);
  command->callback([arguments, out] { Show(*arguments, out->count() > 0); });
}

}  // namespace rcme
