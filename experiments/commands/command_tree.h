// The program's commands and options as plain data, for completion scripts and manual pages.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace rcme {

struct DescribedOption {
  std::vector<std::string> names;  // "-o", "--out"; a positional argument has its name alone
  std::string description;
  std::string default_value;  // empty: none
  bool is_positional = false;
  bool is_required = false;
  bool takes_value = true;
  std::vector<std::string> values;  // what it may be, where that is a short list
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

// What the words that the parser did not expect may have meant, a sentence each: of commands and options.
std::string SuggestionsFor(const CLI::App& app);
// The same with the words themselves, in the order in which they were given.
std::string DescribeUnexpected(const CLI::App& app);

}  // namespace rcme
