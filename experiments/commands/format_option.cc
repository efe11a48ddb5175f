#include "experiments/commands/format_option.h"

#include "experiments/commands/number_option.h"
#include "experiments/core/files/file_output.h"

namespace rcme {

CLI::Option* AddFormatOption(CLI::App* command, std::string* format) {
  return command
      ->add_option("--format", *format,
                   "of what is printed: table (for people), csv, json, latex (booktabs) or markdown")
      ->check(MakeChoiceValidator(ListResultFormats()))
      ->capture_default_str();
}

void PrintResult(const CommandResult& result, const std::string& format, const std::string& out) {
  PrintOrWrite(out, RenderResult(result, format));
}

void WriteResultFiles(const CommandResult& result, const std::string& stem) {
  WriteFileWhole(stem + ".txt", RenderResult(result, "table"));
  WriteFileWhole(stem + ".csv", RenderResult(result, "csv"));
  WriteFileWhole(stem + ".json", RenderResult(result, "json"));
}

}  // namespace rcme
