// Describes the program's commands and options as plain data, for completion scripts and manual pages.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace rcme {

struct DescribedOption {
  std::vector<std::string> names;  // "-o", "--out"; for a positional argument its name only
  std::string description;
  std::string default_value;  // empty: none
  bool is_positional = false;
  bool is_required = false;
  bool takes_value = true;
  std::vector<std::string> values;  // candidate values, if there is a list of them
  bool takes_files = true;          // a file is a value as well
  bool is_label = false;            // of an estimator of the result file on the line
};

struct DescribedCommand {
  std::string name;  // empty: the program itself
  std::string description, footer;
  std::vector<DescribedOption> options;  // positional arguments first
};

DescribedCommand Described(const CLI::App& command);
// The program, then its commands in the order of their names.
std::vector<DescribedCommand> DescribedTree(const CLI::App& app);
std::vector<std::string> CommandNames(const CLI::App& app);
// "-o", "--out": of all options but positional ones.
std::vector<std::string> OptionNames(const DescribedCommand& command);

// Suggests a command or option for each word that the parser did not expect; one sentence each.
std::string SuggestionsFor(const CLI::App& app);
// Returns the name of an option of one value, such as "--focal", that the chosen command was given several
// times; empty if there is none.
std::string FindRepeatedOption(const CLI::App& app);

// An error message that lists the unexpected words in the order given, with these suggestions.
std::string DescribeUnexpected(const CLI::App& app);

}  // namespace rcme
