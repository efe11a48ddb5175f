#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace rcme {

// Names and numbers as the result files hold them; what is not known is an empty field, or null.

// Quoted where it has to be. A text that a spreadsheet would take for a formula (one that begins with =, +,
// -, @ and is no number) gets an apostrophe in front, as OWASP's page "CSV Injection" says.
std::string CsvField(const std::string& text);
// The fields of a line as CsvField wrote them, each as it was.
std::vector<std::string> CsvFields(std::string_view line);
// Eight digits, or as a format of fmt says; empty for NaN.
std::string CsvNumber(double x, const std::string& format = ".8g");
// The same, empty for infinite ones too.
std::string CsvFinite(double x, const std::string& format = ".8g");
// As LaTeX prints it: no character of it is a command, or an argument of the command before it.
std::string LatexText(const std::string& text);
// As XML holds it in an element or an attribute; control characters, of which XML allows few, become spaces.
std::string XmlText(const std::string& text);
// All digits; null for what is not finite.
nlohmann::ordered_json JsonNumber(double x);

}  // namespace rcme
