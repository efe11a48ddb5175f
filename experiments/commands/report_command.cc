#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/files/regular_file.h"
#include "experiments/core/files/scratch_folder.h"
#include "experiments/core/text/message.h"
#include "experiments/statistics/report_data.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr size_t kMaxPageBytes = size_t{1} << 32;

struct ReportArguments {
  std::vector<std::string> runs;
  std::string against, out;
};

// Checks before the figures are drawn that the report can be written.
void CheckReportFolder(const std::string& out) {
  const std::filesystem::path parent = std::filesystem::path(out).parent_path();
  if (out.empty()) throw InputError("--out: '' is not allowed; give the path of a page");
  if (std::filesystem::is_directory(out)) throw InputError(fmt::format("{}: is a folder, not a page", out));
  if (!parent.empty() && !std::filesystem::is_directory(parent)) {
    throw InputError(fmt::format("{}: folder '{}' does not exist", out, parent.string()));
  }
}

std::string PageFrom(const std::string& folder) {
  const std::string page = folder + "/report.html";
  DrawOrThrow("report", "report", {folder, "--out", page});
  return RegularFile(page, {"page", "a page"}).Read(kMaxPageBytes);
}

void WriteReport(const ReportArguments& arguments) {
  CheckReportFolder(arguments.out);
  CheckCanBeWritten(arguments.out);
  const ScratchFolder folder;
  for (size_t i = 0; i < arguments.runs.size(); ++i) {
    const std::string run_folder = fmt::format("{}/run_{:04}", folder.path(), i + 1);
    std::filesystem::create_directory(run_folder);
    WriteReportData(arguments.runs[i], arguments.against, run_folder);
  }
  WriteFileWhole(arguments.out, PageFrom(folder.path()));
  PrintMessage("done: {}\n", arguments.out);
}

}  // namespace

void AddReportCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "report", "Write one HTML page about one or more runs: findings, figures, numbers, commands");
  command->footer(R"(The page is one self-contained HTML file: no network, no further files. For each run it
starts with the findings and the figures, and how hard the problems are. Then follow
tables that fold and sort: the rates with exact 95 % intervals and n, every quantity of
`rcme summarize`, and the paired comparisons of `rcme compare`. At the end are the study
in full and the commands that repeat the numbers of every condition. The page suits
wide and narrow screens, light and dark, and paper. Equal runs give equal bytes. Needs
Python with matplotlib and pandas.

Examples:
  rcme report run.sqlite --out report.html
  rcme report outliers.sqlite noise.sqlite --against rcme_rank_aware --out report.html)");
  auto arguments = std::make_shared<ReportArguments>();
  command->add_option("runs", arguments->runs, "result files of `rcme run`")->required();
  command->add_option("--against", arguments->against,
                      "label of the reference estimator, in every run; default: each study's first");
  command->add_option("-o,--out", arguments->out, "page to write (HTML)")->required();
  command->callback([arguments] { WriteReport(*arguments); });
}

}  // namespace rcme
