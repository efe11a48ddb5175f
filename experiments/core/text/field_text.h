#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace rcme {

// Formats names and numbers for result files. Unknown values become an empty field, or null in JSON.

// Formats a CSV field, quoted where necessary. A text that a spreadsheet would take for a formula (it begins
// with =, +, - or @ and is no number) gets an apostrophe in front, as OWASP's page "CSV Injection"
// recommends.
std::string CsvField(const std::string& text);
// Parses a line of fields that CsvField wrote; returns the original texts.
std::vector<std::string> CsvFields(std::string_view line);
// Formats a number with eight digits or by the given fmt format; empty for NaN.
std::string CsvNumber(double x, const std::string& format = ".8g");
// Like CsvNumber, but infinite numbers are empty as well.
std::string CsvFinite(double x, const std::string& format = ".8g");
// Escapes a text for LaTeX: none of its characters acts as a command, or as an argument of the command
// before it.
std::string LatexText(const std::string& text);
// Escapes a text for an XML element or attribute. Control characters, most of which XML forbids, become
// spaces.
std::string XmlText(const std::string& text);
// A number with all digits; null if it is not finite.
nlohmann::ordered_json JsonNumber(double x);

}  // namespace rcme
