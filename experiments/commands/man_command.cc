#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>

#include "experiments/commands/command_tree.h"
#include "experiments/commands/commands.h"
#include "experiments/core/files/file_output.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"
#include "parameters/text_lines.h"

namespace rcme {
namespace {

// Escapes a text for roff: backslashes, minus signs, and lines that would begin like a request.
std::string Roff(const std::string& text) {
  std::string roff;
  bool begins_line = true;
  for (const char c : text) {
    if (begins_line && (c == '.' || c == '\'')) roff += "\\&";
    if (c == '\\') {
      roff += "\\e";
    } else if (c == '-') {
      roff += "\\-";
    } else {
      roff += c;
    }
    begins_line = c == '\n';
  }
  return roff;
}

std::string Upper(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string PageName(const std::string& command) { return command.empty() ? "rcme" : "rcme-" + command; }

std::string Synopsis(const DescribedCommand& command) {
  std::string text = "\\fBrcme\\fR";
  if (command.name.empty()) return text + " \\fICOMMAND\\fR ...\n";
  text += " \\fB" + Roff(command.name) + "\\fR";
  for (const DescribedOption& option : command.options) {
    if (!option.is_positional) continue;
    const std::string name = "\\fI" + Roff(option.names.front()) + "\\fR";
    text += option.is_required ? " " + name : " [" + name + "]";
  }
  return text + " [\\fIOPTIONS\\fR]\n";
}

std::string OptionText(const DescribedOption& option) {
  std::string text = ".TP\n";
  const char font = option.is_positional ? 'I' : 'B';
  for (size_t i = 0; i < option.names.size(); ++i)
    text += fmt::format("{}\\f{}{}\\fR", i > 0 ? ", " : "", font, Roff(option.names[i]));
  if (option.takes_value && !option.is_positional) text += " \\fIVALUE\\fR";
  text += "\n" + Roff(option.description);
  if (!option.default_value.empty()) text += " [" + Roff(option.default_value) + "]";
  return text + "\n";
}

// Indented and empty lines, such as examples, are kept; other lines are set as text.
std::string FooterText(const std::string& footer) {
  std::string text;
  bool is_literal = false;
  for (const std::string& line : SplitText(footer, '\n')) {
    const bool wants_literal = line.starts_with(' ');
    if (wants_literal != is_literal) text += wants_literal ? ".PP\n.nf\n" : ".fi\n.PP\n";
    is_literal = wants_literal;
    if (line.empty() && !is_literal) {
      if (!text.empty() && !text.ends_with(".PP\n")) text += ".PP\n";
    } else {
      text += Roff(line) + "\n";
    }
  }
  return is_literal ? text + ".fi\n" : text;
}

std::string Page(const DescribedCommand& command, const std::vector<DescribedCommand>& tree) {
  const std::string name = PageName(command.name);
  // Of the program the description is a sentence and the examples of a first session.
  const size_t end = std::min(command.description.find("\n\n"), command.description.size());
  const std::string sentence = command.description.substr(0, end);
  std::string text = fmt::format(".TH {} 1 \"\" \"rcme {}\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n",
                                 Upper(Roff(name)), RCME_VERSION, Roff(name), Roff(sentence));
  text += Synopsis(command);
  const std::string rest =
      end < command.description.size() ? command.description.substr(end + 2) : command.footer;
  if (!rest.empty()) text += ".SH DESCRIPTION\n" + FooterText(rest);
  text += ".SH OPTIONS\n";
  for (const DescribedOption& option : command.options) text += OptionText(option);
  if (command.name.empty()) {
    text += ".SH COMMANDS\n";
    for (const DescribedCommand& other : tree) {
      if (!other.name.empty())
        text += fmt::format(".TP\n\\fB{}\\fR(1)\n{}\n", Roff(PageName(other.name)), Roff(other.description));
    }
    text +=
        ".SH EXIT STATUS\n0: done; 2: usage or bad input; 75: more to do, run again; "
        "130 and 143: stopped by Ctrl\\-C and SIGTERM; 1: other errors.\n";
    return text;
  }
  return text + ".SH SEE ALSO\n.BR rcme (1)\n";
}

void WriteMan(const CLI::App& app, const std::string& command, const std::string& folder) {
  const std::vector<DescribedCommand> tree = DescribedTree(app);
  if (!folder.empty()) {
    MakeResultFolder(folder);
    for (const DescribedCommand& each : tree)
      WriteFileWhole(folder + "/" + PageName(each.name) + ".1", Page(each, tree));
    return;
  }
  const auto found = std::ranges::find(tree, command, &DescribedCommand::name);
  if (found != tree.end()) {
    fmt::print("{}", Page(*found, tree));
    return;
  }
  const std::vector<std::string> names = CommandNames(app);
  throw InputError(fmt::format("man: {} is not a command{}; give one of: {}", Quoted(command),
                               DidYouMean(command, names), fmt::join(names, ", ")));
}

}  // namespace

void AddManCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("man", "Write manual pages for man(1)");
  command->footer(R"(If rcme is installed, so are its manual pages: man rcme, man rcme-run. Otherwise:

Examples:
  rcme man run | man -l -
  rcme man --out man1)");
  auto name = std::make_shared<std::string>(), folder = std::make_shared<std::string>();
  CLI::Option* of = command->add_option("command", *name, "name of a command; default: the program itself");
  command->add_option("-o,--out", *folder, "folder to write the pages of all commands into")->excludes(of);
  command->callback([&app, name, folder] { WriteMan(app, *name, *folder); });
}

}  // namespace rcme
