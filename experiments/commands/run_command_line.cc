#include "experiments/commands/run_command_line.h"

#include <fmt/format.h>
#include <glog/logging.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <string_view>
#include <utility>

#include "experiments/commands/command_tree.h"
#include "experiments/commands/commands.h"
#include "experiments/core/files/scratch_folder.h"
#include "experiments/core/files/shared_files.h"
#include "experiments/core/text/columns.h"
#include "experiments/core/text/message.h"
#include "experiments/core/text/program_name.h"
#include "experiments/core/work/runner.h"
#include "experiments/core/work/stop_request.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/text_lines.h"

namespace rcme {
namespace {

// Names and paths of the command line go into tables, result files and pages, and onto the terminal.
void CheckIsPlain(int argc, const char* const* argv) {
  for (int i = 1; i < argc; ++i) {
    if (FindNotPlain(argv[i]) == std::string::npos) continue;
    throw InputError(fmt::format("argument {}: {} is not allowed; give UTF-8 without control characters", i,
                                 Quoted(argv[i])));
  }
}

// Whether words that the parser did not expect say more than its error: a command that there is not before
// --help, and a misspelt option where another is missing too.
bool IsOfUnexpectedWords(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  if (dynamic_cast<const CLI::CallForHelp*>(&error)) return chosen.empty() && !app.remaining().empty();
  if (!dynamic_cast<const CLI::RequiredError*>(&error)) return false;
  return !(chosen.empty() ? app.remaining() : chosen.front()->remaining()).empty();
}

// Memory that is not to be had, wherever it was asked for: not an abort, and no message that needs some
// itself.
[[noreturn]] void EndWithoutMemory() {
  constexpr std::string_view kMessage =
      "rcme: there is not enough memory; give it more, or a smaller input, study or number of threads\n";
  static_cast<void>(!write(STDERR_FILENO, kMessage.data(), kMessage.size()));
  std::_Exit(2);
}

// An exception that nobody can catch: thrown by a destructor, or by a thread of a library's.
[[noreturn]] void Terminate() {
  try {
    if (const std::exception_ptr thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    EndWithoutMemory();
  } catch (...) {
  }
  std::abort();
}

// Help in lines of kTextWidth: an option's names and what it allows, then what it does, in a column.
class NarrowHelp : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    return FormatEntry(make_option_name(option, is_positional) + make_option_opts(option),
                       make_option_desc(option));
  }
  std::string make_subcommand(const CLI::App* command) const override {
    return FormatEntry(command->get_display_name(true), command->get_description());
  }
  // Indented and empty lines are kept; other lines are set as paragraphs.
  std::string make_footer(const CLI::App* app) const override {
    std::string text, paragraph;
    const auto end_paragraph = [&] {
      if (!paragraph.empty()) text += FormatParagraph(std::exchange(paragraph, ""));
    };
    for (const std::string& line : SplitText(app->get_footer(), '\n')) {
      if (!line.empty() && line.front() != ' ') {
        paragraph += line + " ";
        continue;
      }
      end_paragraph();
      text += line + "\n";
    }
    end_paragraph();
    return text;
  }

 private:
  // Long lists of allowed words are broken after a comma.
  static std::string BreakName(const std::string& name) {
    std::string text, line = " ", word;
    for (size_t i = 0; i < name.size(); ++i) {
      word += name[i];
      if (i + 1 < name.size() && name[i] != ',' && name[i + 1] != ' ') continue;
      if (line.size() + word.size() > kTextWidth) {
        text += line + "\n";
        line = std::string(6, ' ');
      }
      line += (line == " " ? " " : "") + std::exchange(word, "");
    }
    return text + line;
  }

  std::string FormatEntry(const std::string& name, const std::string& description) const {
    const size_t column = get_column_width();
    std::string text = BreakName(name);
    if (description.empty()) return text + "\n";
    const bool is_beside = text.size() < column;
    if (is_beside)
      text.resize(column, ' ');
    else
      text += '\n';
    std::string indent(is_beside ? 0 : column, ' ');
    for (const std::string& line : BreakLines(description, kTextWidth - column)) {
      text += indent + line + "\n";
      indent.assign(column, ' ');
    }
    return text;
  }
};

}  // namespace

int RunCommandLine(int argc, const char* const* argv, const CommandSet& commands,
                   const char* installed_share) {
  HoldStandardStreams();
  if (FindShare().empty()) UseShare(installed_share);
  if (argc > 0) NameProgram(argv[0]);
  RemoveAbandonedScratchFolders();
  std::set_terminate(Terminate);
  std::signal(SIGXFSZ, SIG_IGN);           // a file-size limit is an error message, not a kill
  FLAGS_minloglevel = google::GLOG_FATAL;  // Ceres reports through its summary; outcomes have names here
  CLI::App app{
      fmt::format("Measures how often two-view motion estimators are wrong, and whether they know it.\n\n"
                  "A first session:\n{}",
                  commands.first_session),
      "rcme"};
  app.set_version_flag("--version", "rcme " RCME_VERSION);
  app.formatter(std::make_shared<NarrowHelp>());
  app.get_formatter()->column_width(30);
  app.failure_message([](const CLI::App* parsed, const CLI::Error& error) {
    return "rcme: " + CLI::FailureMessage::simple(parsed, error);
  });
  app.require_subcommand(0, 1);  // of `rcme plot audit` the second word is no command
  commands.add(app);
  app.footer(commands.footer);  // not of each command
  try {
    CheckIsPlain(argc, argv);
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) throw CLI::RequiredError::Subcommand(1);
    if (std::fflush(stdout) != 0) throw InputError("standard output cannot be written");
    return 0;
  } catch (const CLI::ExtrasError&) {
    PrintMessage("{}", DescribeUnexpected(app));
    return 2;
  } catch (const CLI::ParseError& error) {
    const bool is_of_count = dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr;
    if (const std::string repeated = FindRepeatedOption(app); is_of_count && !repeated.empty()) {
      PrintMessage("rcme: {} is given twice; give it once\n", repeated);
      return 2;
    }
    if (IsOfUnexpectedWords(app, error)) {
      PrintMessage("{}", DescribeUnexpected(app));
      return 2;
    }
    if (app.exit(error) != 0) {
      PrintMessage("{}", SuggestionsFor(app));
      return 2;
    }
    if (std::cout.flush()) return 0;
    PrintMessage("rcme: standard output cannot be written\n");
    return 2;
  } catch (const EndWith& end) {
    return end.exit_code;
  } catch (const ItemsAreMissing& missing) {
    PrintMessage("{}\n", missing.message);
    fmt::print("{}\n", missing.shards);
    return kTryAgain;
  } catch (const Stopped& stopped) {
    PrintMessage("{}\n", stopped.what());
    return StopExitCode();
  } catch (const InputError& error) {
    PrintMessage("rcme: {}\n", Printable(error.what()));
    return 2;
  } catch (const std::filesystem::filesystem_error& error) {
    PrintMessage("rcme: {}\n", Printable(error.what()));
    return 2;
  } catch (const std::bad_alloc&) {
    std::fflush(stdout);
    EndWithoutMemory();
  } catch (const std::exception& error) {
    if (std::ferror(stdout)) {
      PrintMessage("rcme: standard output cannot be written ({})\n", error.what());
      return 2;
    }
    PrintMessage("rcme: internal error: {}\n", Printable(error.what()));
    return 1;
  }
}

}  // namespace rcme
