// A part file as JSON, {"format", "work", ..., "pieces": [{"group", "piece", "seconds", "result"}, ...]}, and
// with something changed in it by whoever can compute its checksums.
#pragma once

#include <fmt/format.h>

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "experiments/core/files/checksum.h"
#include "experiments/core/files/file_output.h"

namespace rcme {

inline nlohmann::ordered_json PartAsJson(const std::string& path) {
  std::ifstream file(path);
  nlohmann::ordered_json part;
  for (std::string line; std::getline(file, line);) {
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(line);
    json.erase("checksum");
    if (part.is_null()) {
      part = json;
      part["pieces"] = nlohmann::ordered_json::array();
    } else {
      part["pieces"].push_back(json);
    }
  }
  return part;
}

// The fields of an object as they stand in a line behind its checksum.
inline std::string FieldsOfLine(const nlohmann::ordered_json& object) {
  std::string text;
  for (const auto& [key, value] : object.items())
    text += fmt::format("{}\"{}\": {}", text.empty() ? "" : ", ", key, value.dump());
  return text + "}";
}

inline void WriteJsonAsPart(const std::string& path, nlohmann::ordered_json part) {
  const nlohmann::ordered_json pieces = part.at("pieces"), format = part.at("format");
  part.erase("pieces");
  part.erase("format");
  part["num_pieces"] = pieces.size();
  const std::string first = FieldsOfLine(part),
                    checksum = fmt::format("{:08x}", ComputeChecksum({"", first}));
  std::string text =
      fmt::format("{{\"format\": {}, \"checksum\": \"{}\", {}\n", format.dump(), checksum, first);
  for (const nlohmann::ordered_json& piece : pieces) {
    const std::string fields = FieldsOfLine(piece);
    text += fmt::format("{{\"checksum\": \"{:08x}\", {}\n", ComputeChecksum({checksum, fields}), fields);
  }
  WriteFileWhole(path, text);
}

// The path of the changed copy, beside the file; one at a time.
inline std::string ChangedPart(const std::string& path,
                               const std::function<void(nlohmann::ordered_json*)>& change) {
  nlohmann::ordered_json part = PartAsJson(path);
  change(&part);
  std::string changed = path;
  changed += ".changed";
  WriteJsonAsPart(changed, part);
  return changed;
}

}  // namespace rcme
