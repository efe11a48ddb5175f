#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "estimator/estimator_registry.h"
#include "experiments/audit/claims/claim_table.h"
#include "experiments/commands/command_tree.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/plot_options.h"
#include "experiments/run/store/result_store.h"
#include "experiments/statistics/summarize.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

std::string Joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

// The first sentence of a description, without characters that break quoting in a shell.
std::string InShort(const std::string& text) {
  std::string words = text.substr(0, std::min(text.find('\n'), text.find("; ")));
  std::ranges::replace(words, ':', ',');
  std::erase_if(words,
                [](char c) { return std::string_view("'`\"[]\\$").find(c) != std::string_view::npos; });
  return words;
}

bool TakesPositionalFiles(const DescribedCommand& command) {
  return std::ranges::any_of(command.options,
                             [](const DescribedOption& o) { return o.is_positional && o.takes_files; });
}

// Candidate values of its positional arguments besides files.
std::vector<std::string> PositionalValues(const DescribedCommand& command) {
  std::vector<std::string> values;
  for (const DescribedOption& option : command.options) {
    if (option.is_positional) values.insert(values.end(), option.values.begin(), option.values.end());
  }
  return values;
}

// Of the scripts that draw, which know their options themselves.
void AddPlotOptions(std::vector<DescribedOption>* options) {
  DescribedOption kind;
  kind.names = {"kind"};
  kind.description = "kind of figure";
  kind.is_positional = true;
  kind.values = PlotKinds();
  options->insert(options->begin(), kind);
  for (const PlotOption& option : PlotOptions()) {
    DescribedOption& described = options->emplace_back();
    described.names = {option.name};
    described.description = option.doc;
    described.takes_value = option.takes_value;
    described.values = option.values;
    if (option.name == "--quantities")
      for (const QuantityHelp& quantity : SummaryQuantities()) described.values.push_back(quantity.name);
    described.takes_files = described.values.empty();
  }
}

// What `audit --only` takes.
std::vector<std::string> ClaimNames() {
  std::set<std::string> names;
  for (const Claim& claim : AllClaims(EstimatorRegistry())) names.insert({claim.family(), claim.id});
  return {names.begin(), names.end()};
}

void SetClaims(std::vector<DescribedOption>* options) {
  for (DescribedOption& option : *options) {
    if (option.names.front() != "--only") continue;
    option.values = ClaimNames();
    option.takes_files = false;
  }
}

// The program itself stands first; its arguments are the commands.
std::vector<DescribedCommand> TreeFor(const CLI::App& app) {
  std::vector<DescribedCommand> tree = DescribedTree(app);
  for (DescribedCommand& command : tree) {
    if (command.name == "help" || command.name == "man") {
      command.options.front().values = CommandNames(app);
      command.options.front().takes_files = false;
    }
    if (command.name == "plot") AddPlotOptions(&command.options);
    if (command.name == "audit") SetClaims(&command.options);
  }
  return tree;
}

std::string Bash(const CLI::App& app) {
  const std::vector<DescribedCommand> tree = TreeFor(app);
  std::string text =
      "# Completion of rcme for bash, made by `rcme completion bash`.\n"
      "_rcme() {\n"
      "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}\n"
      "  local command=${COMP_WORDS[1]} options= values= files= labels= word\n"
      "  [ \"$COMP_CWORD\" -eq 1 ] && command=\n"
      "  case $command in\n";
  for (const DescribedCommand& command : tree) {
    const std::vector<std::string> values =
        command.name.empty() ? CommandNames(app) : PositionalValues(command);
    text += fmt::format("    {})\n      options='{}'\n      values='{}'{}\n      case $previous in\n",
                        command.name.empty() ? "''" : command.name, Joined(OptionNames(command)),
                        Joined(values), TakesPositionalFiles(command) ? " files=yes" : "");
    for (const DescribedOption& option : command.options) {
      if (option.is_positional || !option.takes_value) continue;
      text += fmt::format("        {}) options= values='{}' files={}{} ;;\n", fmt::join(option.names, "|"),
                          Joined(option.values), option.takes_files ? "yes" : "",
                          option.is_label ? " labels=yes" : "");
    }
    text += "      esac ;;\n";
  }
  return text +
         "  esac\n"
         "  if [ -n \"$labels\" ]; then\n"
         "    for word in \"${COMP_WORDS[@]:2}\"; do\n"
         "      case $word in *.sqlite)\n"
         "        labels=$(\"${COMP_WORDS[0]}\" completion labels \"$word\" 2>/dev/null) && values=$labels\n"
         "        break ;;\n"
         "      esac\n"
         "    done\n"
         "  fi\n"
         "  case $current in\n"
         "    -*) COMPREPLY=($(compgen -W \"$options\" -- \"$current\")) ;;\n"
         "    *) COMPREPLY=($(compgen -W \"$values\" -- \"$current\"))\n"
         "       [ \"$previous\" = --set ] && { compopt -o nospace 2>/dev/null; return; }\n"
         "       [ -n \"$command\" ] && [ -n \"$files\" ] && COMPREPLY+=($(compgen -f -- \"$current\")) ;;\n"
         "  esac\n"
         "}\n"
         "complete -o filenames -F _rcme rcme\n";
}

std::string Zsh(const CLI::App& app) {
  std::string commands, cases;
  for (const DescribedCommand& command : TreeFor(app)) {
    if (command.name.empty()) continue;
    commands += fmt::format("    '{}:{}'\n", command.name, InShort(command.description));
    cases += fmt::format("    {})\n      _arguments", command.name);
    for (const DescribedOption& option : command.options) {
      const std::string list = option.values.empty() ? "" : "compadd -- " + Joined(option.values);
      const std::string values = option.values.empty() ? "_files"
                                 : option.is_label     ? "{ _rcme_labels " + Joined(option.values) + " }"
                                 : option.takes_files  ? "{ " + list + "; _files }"
                                                       : "(" + Joined(option.values) + ")";
      const std::string either = " \\\n        '*:" + InShort(option.names.front()) + ":{ " + list +
                                 (option.takes_files ? "; _files }'" : " }'");
      if (option.is_positional) {
        cases += option.values.empty() ? " \\\n        '*:file:_files'" : either;
        continue;
      }
      for (const std::string& name : option.names) {
        cases += fmt::format(" \\\n        '*{}[{}]{}'", name, InShort(option.description),
                             option.takes_value ? ":value:" + values : "");
      }
    }
    cases += " ;;\n";
  }
  return "#compdef rcme\n# Completion of rcme for zsh, made by `rcme completion zsh`.\n"
         "_rcme_labels() {\n"  // the estimators of the result file on the line, else those named
         "  local word labels\n"
         "  for word in $words; do\n"
         "    [[ $word = *.sqlite ]] && labels=$(rcme completion labels $word 2>/dev/null) && break\n"
         "  done\n"
         "  [[ -n $labels ]] && compadd -- ${(f)labels} || compadd -- $@\n"
         "}\n"
         "_rcme() {\n"
         "  local -a commands=(\n" +
         commands +
         "  )\n"
         "  if (( CURRENT == 2 )); then\n    _describe 'command' commands\n    return\n  fi\n"
         "  local command=$words[2]\n  shift words\n  (( CURRENT-- ))\n  case $command in\n" +
         cases + "  esac\n}\n_rcme \"$@\"\n";
}

std::string Fish(const CLI::App& app) {
  std::string text =
      "# Completion of rcme for fish, made by `rcme completion fish`.\n"
      "function __rcme_labels\n"
      "  for word in (commandline -opc)\n"
      "    string match -q '*.sqlite' -- $word\n"
      "    and rcme completion labels $word 2>/dev/null\n"
      "    and return\n"
      "  end\n"
      "  printf '%s\\n' $argv\n"
      "end\n";
  for (const DescribedCommand& command : TreeFor(app)) {
    if (command.name.empty()) continue;
    text += fmt::format("complete -c rcme -n __fish_use_subcommand -f -a {} -d '{}'\n", command.name,
                        InShort(command.description));
    const std::string here =
        fmt::format("complete -c rcme -n '__fish_seen_subcommand_from {}'", command.name);
    for (const DescribedOption& option : command.options) {
      std::string line = here;
      if (!option.is_positional) {
        for (const std::string& name : option.names) {
          line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
        }
        line += fmt::format(" -d '{}'", InShort(option.description));
        if (option.takes_value) line += option.takes_files ? " -r" : " -x";
      }
      if (option.is_label) {
        line += fmt::format(" -a '(__rcme_labels {})'", Joined(option.values));
      } else if (!option.values.empty()) {
        line += fmt::format(" -a '{}'", Joined(option.values));
      }
      if (line != here) text += line + "\n";
    }
  }
  return text;
}

// One a line: what the scripts offer where an option names an estimator of a result file.
void PrintLabels(const std::string& run) {
  if (run.empty()) throw InputError("completion labels: give the result file of `rcme run`");
  for (const EstimatorSpec& estimator : ResultStore::OpenForReading(run).StoredStudy().estimators)
    fmt::print("{}\n", estimator.label);
}

}  // namespace

void AddCompletionCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "completion", "Print a script that completes commands, options and names in your shell");
  command->footer(R"(If rcme is installed, its scripts are too, and every new shell uses them. Otherwise:

Examples:
  bash   rcme completion bash > ~/.local/share/bash-completion/completions/rcme
  zsh    rcme completion zsh > _rcme      in a folder of $fpath
  fish   rcme completion fish > ~/.config/fish/completions/rcme.fish)");
  auto shell = std::make_shared<std::string>(), run = std::make_shared<std::string>();
  command
      ->add_option("shell", *shell,
                   "bash, zsh or fish; labels: the labels of a run's estimators, which these scripts ask for")
      ->required()
      ->check(MakeChoiceValidator({"bash", "zsh", "fish", "labels"}));
  command->add_option("run", *run, "with labels: result file of `rcme run`");
  command->callback([&app, shell, run] {
    if (*shell == "labels") return PrintLabels(*run);
    if (!run->empty()) throw InputError(fmt::format("completion {}: takes no file", *shell));
    fmt::print("{}", *shell == "bash" ? Bash(app) : *shell == "zsh" ? Zsh(app) : Fish(app));
  });
}

}  // namespace rcme
