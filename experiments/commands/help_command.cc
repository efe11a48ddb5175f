#include <fmt/format.h>

#include <memory>

#include "experiments/commands/command_tree.h"
#include "experiments/commands/commands.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"

namespace rcme {

void AddHelpCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("help", "Print the help of a command, like its --help");
  command->footer(R"(Examples:
  rcme help
  rcme help estimate)");
  auto name = std::make_shared<std::string>();
  command->add_option("command", *name, "name of a command; default: the program itself");
  command->callback([&app, name] {
    if (name->empty()) {
      // Not app.help(), which would be that of the command that was given.
      fmt::print("{}", app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal));
      return;
    }
    const std::vector<std::string> names = CommandNames(app);
    if (std::ranges::count(names, *name) == 0) {
      const std::string footer = app.get_footer();
      throw InputError(fmt::format("help: {} is not a command{}; give one of: {}{}{}", Quoted(*name),
                                   DidYouMean(*name, names), fmt::join(names, ", "),
                                   footer.empty() ? "" : ". ", footer));
    }
    fmt::print("{}", app.get_subcommand(*name)->help(app.get_name()));
  });
}

}  // namespace rcme
