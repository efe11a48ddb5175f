#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/commands/number_option.h"
#include "experiments/commands/process_option.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_name.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/files/scratch_folder.h"
#include "experiments/core/text/message.h"
#include "experiments/real/answer/why.h"
#include "experiments/run/store/result_store.h"
#include "experiments/statistics/trial_output.h"
#include "parameters/input_error.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

struct ShowArguments {
  std::string study, out, json;
  StudyChanges changes;
  std::uint32_t condition = 0, trial = 0;
  std::vector<std::string> estimators;
};

// Whether a file begins as every SQLite file does: a result of `rcme run`, not a study.
bool IsResultFile(const std::string& path) {
  constexpr std::string_view kBeginning("SQLite format 3\0", 16);
  std::string bytes(kBeginning.size(), ' ');
  if (!std::filesystem::is_regular_file(path)) return false;
  std::ifstream(path, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes == kBeginning;
}

StudyPlan PlanFrom(const ShowArguments& arguments) {
  if (!IsResultFile(arguments.study)) {
    return PlanOf(LoadChangedStudy(arguments.study, arguments.changes), arguments.study);
  }
  if (arguments.changes.AreAny()) {
    throw InputError(
        fmt::format("{}: a result file has a study and a seed of its own; --set, --add-estimator "
                    "and --seed go with a study file (YAML)",
                    arguments.study));
  }
  return PlanOfStored(ResultStore::OpenForReading(arguments.study), arguments.changes.allow_process);
}

// Numbers of the estimators with these labels, each once, in the order asked for.
std::vector<size_t> EstimatorsOf(const Study& study, const std::vector<std::string>& labels) {
  std::vector<size_t> chosen;
  for (const std::string& label : labels) {
    const auto spec = std::ranges::find(study.estimators, label, &EstimatorSpec::label);
    if (spec == study.estimators.end()) {
      std::vector<std::string> allowed;
      for (const EstimatorSpec& other : study.estimators) allowed.push_back(other.label);
      throw InputError(fmt::format("--estimators: study '{}' has no estimator '{}'{}; allowed: {}",
                                   study.name, label, DidYouMean(label, allowed), fmt::join(allowed, ", ")));
    }
    const auto e = static_cast<size_t>(spec - study.estimators.begin());
    if (std::ranges::count(chosen, e) == 0) chosen.push_back(e);
  }
  return chosen;
}

// In the working directory.
std::string DefaultOut(const StudyPlan& plan, const ShowArguments& arguments) {
  return fmt::format("trial_{}_c{}_t{}", MakeFileName(plan.study.name), arguments.condition, arguments.trial);
}

// What cannot be written at the end had better be known before the trial is run.
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
  std::vector<size_t> drawn = EstimatorsOf(plan.study, arguments.estimators);
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
      app.add_subcommand("show", "Draw one trial: images, matches, epipolar lines, scene from above");
  command->footer(
      "The trial is run again, from the study, its seed and the two numbers: nothing has to be stored.\n"
      "A trial beyond those the study asks for is what more trials would add. For a folder of real pairs,\n"
      "trial t is pair t modulo the number of pairs; there is no scene to draw then.\n"
      "\n"
      "The picture (PNG and PDF) has both images for each estimator drawn: every match by what it is and\n"
      "what the estimator took it for, and in image 2 the epipolar lines of up to eight numbered points,\n"
      "of the truth (broad) and of the estimate (dashed). Below, the scene from above, how hard the\n"
      "problem is, and all estimators of the study in a table. Without --estimators one is drawn: the\n"
      "first that failed or refused, else the first of the study. Standard output gets a summary, and why\n"
      "answers are wrong: whether the true motion, had it been found, would have scored better than the\n"
      "answer by the estimator's own score (the search failed: more samples help) or not (the model cannot\n"
      "tell: they do not), with the parallax, the planar share and the runner-up.\n"
      "\n"
      "Examples:\n"
      "  rcme show studies/failure_vs_outliers.yaml --condition 6 --trial 17\n"
      "  rcme show run.sqlite --condition 6 --trial 17 --estimators standard,rcme_rank_aware --out figure\n"
      "  rcme show study.yaml --condition 0 --trial 3 --seed 5 --set motion=forward --set outlier_ratio=0.4\n"
      "The trials worth a look: `rcme report` names the first failure and refusal of every condition.");
  auto arguments = std::make_shared<ShowArguments>();
  command
      ->add_option("study", arguments->study, "study file (YAML) or its name, or result file of `rcme run`")
      ->required();
  command
      ->add_option("--condition", arguments->condition, "condition, from 0 (column condition of the summary)")
      ->transform(WholeNumberIn(0, std::numeric_limits<std::uint32_t>::max()))
      ->required();
  command->add_option("--trial", arguments->trial, "trial, from 0")
      ->transform(WholeNumberIn(0, std::numeric_limits<std::uint32_t>::max()))
      ->required();
  command->add_option("--estimators", arguments->estimators, "labels a,b,...: one row of images each")
      ->delimiter(',')
      ->allow_extra_args(false);
  CLI::Option* out = command->add_option("-o,--out", arguments->out,
                                         "where to draw, without suffix; default: trial_STUDY_cC_tT here");
  command->add_option("--json", arguments->json, "also keep what is drawn, as JSON, in this file");
  AddStudyOptions(command, &arguments->changes);
  AddProcessOption(command, &arguments->changes.allow_process);
  command->callback([arguments, out] { Show(*arguments, out->count() > 0); });
}

}  // namespace rcme
