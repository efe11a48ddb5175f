// The file that `rcme conform` writes: a ConformRule as JSON, with its guarantees in words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "estimator/conform/conform_rule.h"

namespace rcme {

inline constexpr size_t kMaxConformBytes = size_t{4} << 20;

struct ConformFile {
  ConformRule rule;
  std::string digest;  // of the text: 16 hexadecimal digits
};

// Throws InputError that names the file and the fault: missing file, too long, no JSON, wrong format, a key
// that is missing or not allowed, numbers that form no rule.
ConformFile ReadConformFile(const std::string& path);
ConformFile ParseConformFile(std::string_view text, const std::string& path);

// The text of the file, from which ParseConformFile restores the rule to the last bit. `guarantees`:
// sentences that say what is promised, and for which problems.
std::string ConformFileText(const ConformRule& rule, const std::vector<std::string>& guarantees);

}  // namespace rcme
