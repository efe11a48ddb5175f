#include "experiments/core/text/field_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "parameters/parameter.h"

namespace rcme {
namespace {

// The first characters of a formula; East Asian spreadsheets also accept them in full width.
constexpr std::string_view kFormulaBeginnings[] = {"=", "+", "-", "@", "\t", "\r", "＝", "＋", "－", "＠"};

// Returns whether a formula begins after leading apostrophes and blanks. A text that already has an
// apostrophe gets another one, so that reading removes exactly what writing added.
bool LooksLikeFormula(std::string_view text) {
  const std::string_view rest = text.substr(std::min(text.find_first_not_of("' "), text.size()));
  const auto begins = [&](std::string_view beginning) { return rest.starts_with(beginning); };
  double number = 0.0;
  return std::ranges::any_of(kFormulaBeginnings, begins) && !ParseReal(std::string(text), &number);
}

// Undoes the apostrophe that CsvField added.
std::string TextOfField(const std::string& field) {
  const bool is_marked = field.starts_with('\'') && LooksLikeFormula(field);
  return is_marked ? field.substr(1) : field;
}

}  // namespace

std::string CsvField(const std::string& text) {
  const bool is_marked = LooksLikeFormula(text);
  if (!is_marked && text.find_first_of(",;\"\n\r\t") == std::string::npos) return text;
  std::string quoted = is_marked ? "\"'" : "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::string> CsvFields(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  std::vector<std::string> fields = {""};
  bool is_quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    const bool is_quote = line[i] == '"';
    if (is_quote && is_quoted && line.substr(i + 1).starts_with('"')) {
      fields.back() += line[++i];
    } else if (is_quote) {
      is_quoted = !is_quoted;
    } else if (line[i] == ',' && !is_quoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  for (std::string& field : fields) field = TextOfField(field);
  return fields;
}

std::string CsvNumber(double x, const std::string& format) {
  return std::isnan(x) ? std::string() : fmt::format(fmt::runtime("{:" + format + "}"), x);
}

std::string CsvFinite(double x, const std::string& format) {
  return std::isfinite(x) ? CsvNumber(x, format) : "";
}

std::string LatexText(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '\\':
        escaped += "\\textbackslash{}";
        break;
      case '~':
        escaped += "\\textasciitilde{}";
        break;
      case '^':
        escaped += "\\textasciicircum{}";
        break;
      case '<':
        escaped += "\\textless{}";
        break;
      case '>':
        escaped += "\\textgreater{}";
        break;
      case '|':
        escaped += "\\textbar{}";
        break;
      case '"':
        escaped += "\\char34{}";
        break;
      case '[':  // after the end of a row these two would be its argument
      case '*':
        escaped += {'{', c, '}'};
        break;
      case '{':
      case '}':
      case '$':
      case '&':
      case '#':
      case '%':
      case '_':
        escaped += {'\\', c};
        break;
      default:
        escaped += static_cast<unsigned char>(c) < ' ' || c == '\x7f' ? ' ' : c;
    }
  }
  return escaped;
}

std::string XmlText(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += static_cast<unsigned char>(c) < ' ' || c == '\x7f' ? ' ' : c;
    }
  }
  return escaped;
}

nlohmann::ordered_json JsonNumber(double x) {
  return std::isfinite(x) ? nlohmann::ordered_json(x) : nlohmann::ordered_json();
}

}  // namespace rcme
