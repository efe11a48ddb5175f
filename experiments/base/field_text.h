#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace rcme {

// Names and numbers as the result files hold them; what is not known is an empty field, or null.

// Quoted where it has to be.
std::string CsvField(const std::string& text);
// Eight digits; empty for NaN.
std::string CsvNumber(double x);
// The same, empty for infinite ones too.
std::string CsvFinite(double x);
// As LaTeX prints it: no character of it is a command, or an argument of the command before it.
std::string LatexText(const std::string& text);
// All digits; null for what is not finite.
nlohmann::ordered_json JsonNumber(double x);

}  // namespace rcme
