#include "experiments/core/text/json_output.h"

#include <nlohmann/json.hpp>
#include <utility>

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

std::string Dump(const Json& json) { return json.dump(1, ' ', false, Json::error_handler_t::replace); }

// Formats a row of an array within an object: on a line of its own, two levels deep.
void AppendRow(const Json& row, std::string* text) {
  *text += "\n  ";
  for (const char c : Dump(row)) {
    *text += c;
    if (c == '\n') *text += "  ";
  }
}

}  // namespace

std::string JsonText(const char* format, const Json& object) {
  Json stamped = {{"format", format}};
  stamped.update(object);
  return Dump(stamped) + "\n";
}

void WriteJson(const char* format, const Json& object, const std::string& key,
               const std::function<Json()>& next_rows, const WriteText& write) {
  const std::string text = JsonText(format, object);
  const std::string empty = "\n " + Json(key).dump() + ": []";  // no JSON string contains a line end
  const size_t inside = text.find(empty) + empty.size() - 1;
  write(text.substr(0, inside));
  bool is_first = true;
  for (Json rows = next_rows(); !rows.empty(); rows = next_rows()) {
    std::string piece;
    for (const Json& row : rows) {
      if (!std::exchange(is_first, false)) piece += ',';
      AppendRow(row, &piece);
    }
    write(piece);
  }
  write((is_first ? "" : "\n ") + text.substr(inside));
}

}  // namespace rcme
