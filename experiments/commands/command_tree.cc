#include "experiments/commands/command_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "estimator/estimator_registry.h"
#include "experiments/core/files/shared_files.h"
#include "experiments/data/make_data.h"
#include "experiments/statistics/summarize.h"
#include "experiments/study/study.h"
#include "parameters/plain_text.h"
#include "parameters/suggestion.h"
#include "simulator/camera_registry.h"
#include "simulator/motion_registry.h"
#include "simulator/noise_registry.h"
#include "simulator/outlier_registry.h"
#include "simulator/scene_registry.h"

namespace rcme {
namespace {

std::vector<const CLI::App*> ListSubcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

// "{a,b,c}" as MakeChoiceValidator (common_options.h) describes what it allows; empty: something else.
std::vector<std::string> WordsIn(const std::string& allowed) {
  std::vector<std::string> words;
  if (!allowed.starts_with('{') || !allowed.ends_with('}')) return words;
  std::string word;
  for (const char c : allowed.substr(1)) {
    if (c != ',' && c != '}') {
      word += c;
    } else {
      words.push_back(std::exchange(word, {}));
    }
  }
  return words;
}

template <typename Entry>
void AddParameterNames(const std::vector<Entry>& registry, std::set<std::string>* names) {
  for (const Entry& entry : registry) {
    const auto model = entry.make();
    for (const Parameter& parameter : model->Parameters()) names->insert(parameter.name() + "=");
  }
}

// "sigma_px=": the keys of --set, of the data of every simulation and the options of every estimator.
std::vector<std::string> SettingNames() {
  std::set<std::string> names = {"scene=", "cameras=", "motion=", "noise=", "outliers="};
  AddParameterNames(SceneRegistry(), &names);
  AddParameterNames(CameraRegistry(), &names);
  AddParameterNames(MotionRegistry(), &names);
  AddParameterNames(NoiseRegistry(), &names);
  AddParameterNames(OutlierRegistry(), &names);
  AddParameterNames(EstimatorRegistry(), &names);
  for (const SettingHelp& help : DescribeSettings({{"scene", SceneRegistry().front().name}}))
    names.insert(help.name + "=");
  FailureBounds bounds;
  for (const Parameter& parameter : Parameters(bounds)) names.insert(parameter.name() + "=");
  return {names.begin(), names.end()};
}

// What `solve --over` takes: a key of --set without its "=".
std::vector<std::string> KeyNames() {
  std::vector<std::string> names = SettingNames();
  for (std::string& name : names) name.pop_back();
  return names;
}

bool TakesFiles(const CLI::Option& option) {
  const std::string name = option.get_single_name();
  return name == "estimator-file" || name == "add-estimator" || name == "study";
}

// Whether the option names an estimator of a result file, which has labels of its own.
bool TakesLabels(const CLI::App& command, const CLI::Option& option) {
  const std::string name = option.get_single_name();
  const bool reads_run = command.get_option_no_throw("run") != nullptr || command.get_name() == "show";
  return reads_run && (name == "estimators" || name == "estimator" || name == "against");
}

std::vector<std::string> ListOptionValues(const CLI::App& command, const CLI::Option& option) {
  const std::string name = option.get_single_name();
  if (command.get_name() == "ask" && name == "scene") return ListNames(SceneRegistry());
  if (command.get_name() == "solve" && name == "over") return KeyNames();
  if (TakesLabels(command, option)) return ListNames(EstimatorRegistry());
  if (name == "set") return SettingNames();
  if (name == "shard") return {"1/2", "auto", "auto/8"};
  if (name == "estimators") return ListNames(EstimatorRegistry());
  if (name == "quantities") return ListNames(SummaryQuantities());
  if (name == "estimator") return ListNames(EstimatorRegistry());
  if (name == "estimator-file" || name == "add-estimator") return NamesIn(SharedFolder::kEstimators);
  if (name == "study") return NamesIn(SharedFolder::kStudies);
  for (const std::string& part : {option.get_type_name()}) {
    const size_t begin = part.find('{');
    if (begin != std::string::npos) return WordsIn(part.substr(begin));
  }
  return {};
}

DescribedOption DescribeOption(const CLI::App& command, const CLI::Option& option) {
  DescribedOption described;
  for (const std::string& name : option.get_snames()) described.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) described.names.push_back("--" + name);
  described.is_positional = described.names.empty();
  if (described.is_positional) described.names.push_back(option.get_name(true));
  described.description = option.get_description();
  described.default_value = option.get_default_str();
  described.is_required = option.get_required();
  described.takes_value = option.get_items_expected_max() > 0;
  if (described.takes_value) described.values = ListOptionValues(command, option);
  described.takes_files = described.values.empty() || TakesFiles(option);
  described.is_label = TakesLabels(command, option);
  return described;
}

}  // namespace

std::vector<std::string> OptionNames(const DescribedCommand& command) {
  std::vector<std::string> names;
  for (const DescribedOption& option : command.options) {
    if (!option.is_positional) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

DescribedCommand Described(const CLI::App& command) {
  DescribedCommand described{
      command.get_parent() ? command.get_name() : "", command.get_description(), command.get_footer(), {}};
  for (const CLI::Option* option : command.get_options())
    described.options.push_back(DescribeOption(command, *option));
  std::stable_partition(described.options.begin(), described.options.end(),
                        [](const DescribedOption& o) { return o.is_positional; });
  return described;
}

std::vector<DescribedCommand> DescribedTree(const CLI::App& app) {
  std::vector<DescribedCommand> commands;
  for (const CLI::App* command : ListSubcommands(app)) commands.push_back(Described(*command));
  std::ranges::sort(commands, {}, &DescribedCommand::name);
  commands.insert(commands.begin(), Described(app));
  return commands;
}

std::vector<std::string> CommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : ListSubcommands(app)) names.push_back(command->get_name());
  return names;
}

std::string SuggestionsFor(const CLI::App& app) {
  std::string sentences;
  const auto suggest = [&](const CLI::App& command, const std::vector<std::string>& words) {
    for (const std::string& word : words) {
      const bool is_option = word.starts_with('-');
      const std::string bare = word.substr(0, word.find('='));
      const std::string suggestion =
          is_option ? DidYouMean(bare, OptionNames(Described(command))) : DidYouMean(word, CommandNames(app));
      if (!suggestion.empty() && (is_option || app.get_subcommands().empty()))
        sentences += Quoted(word) + suggestion + "\n";
    }
  };
  for (const CLI::App* command : app.get_subcommands()) suggest(*command, command->remaining());
  if (app.get_subcommands().empty()) suggest(app, app.remaining());
  return sentences;
}

std::string FindRepeatedOption(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands()) {
    for (const CLI::Option* option : command->get_options()) {
      const bool is_of_one = !option->get_positional() && option->get_items_expected_max() == 1;
      if (is_of_one && option->results().size() > 1) return option->get_name();
    }
  }
  return {};
}

std::string DescribeUnexpected(const CLI::App& app) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  const std::vector<std::string> words = (chosen.empty() ? &app : chosen.front())->remaining();
  const std::string footer = chosen.empty() ? app.get_footer() : "";
  const bool is_command = chosen.empty() && !words.empty() && !words.front().starts_with('-');
  return fmt::format(
      "{}{}{}{}{}\n",
      is_command ? fmt::format("rcme: there is no command {}\n", Quoted(words.front()))
                 : fmt::format("rcme: the following arguments were not expected: {}\n",
                               Printable(fmt::format("{}", fmt::join(words, " ")))),
      SuggestionsFor(app), footer, footer.empty() ? "" : "\n",
      is_command ? "rcme --help lists the commands." : "Run with --help for more information.");
}

}  // namespace rcme
