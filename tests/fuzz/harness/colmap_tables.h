#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <string>

#include "experiments/real/sequences/listed_pairs.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {

// A database with two images of one camera, whose numbers and blobs are an input's bytes.
class ColmapTables {
 public:
  ColmapTables() : path_(folder_.Path("database.db")) {
    SQLite::Database database(path_, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    database.exec(
        "PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF;"
        "CREATE TABLE cameras (camera_id, model, width, height, params);"
        "CREATE TABLE images (image_id, name, camera_id);"
        "CREATE TABLE keypoints (image_id, rows, cols, data);"
        "CREATE TABLE matches (pair_id, rows, cols, data)");
  }
  const std::string& path() const { return path_; }

  // Numbers are of one byte, or of eight behind a byte of 255, and blobs of as many bytes as a byte says:
  // what mutations find easily.
  void Write(const std::uint8_t* data, size_t size) {
    data_ = data;
    size_ = size;
    SQLite::Database database(path_, SQLite::OPEN_READWRITE);
    database.exec(
        "PRAGMA journal_mode = MEMORY; PRAGMA synchronous = OFF; BEGIN; DELETE FROM cameras; DELETE FROM "
        "images;"
        "DELETE FROM keypoints; DELETE FROM matches");
    Insert(database, "cameras", 1, 3);
    for (const std::int64_t image : {1, 2}) {
      SQLite::Statement row(database, "INSERT INTO images VALUES (?, ?, 1)");
      row.bind(1, image);
      row.bind(2, Blob());
      row.exec();
      Insert(database, "keypoints", image, 2);
    }
    Insert(database, "matches", 2147483647LL + 2, 2);
    database.exec("COMMIT");
  }

 private:
  void Insert(SQLite::Database& database, const std::string& table, std::int64_t id, int num_numbers) {
    std::string values = "?";
    for (int i = 0; i <= num_numbers; ++i) values += ", ?";
    SQLite::Statement row(database, "INSERT INTO " + table + " VALUES (" + values + ")");
    row.bind(1, id);
    for (int i = 0; i < num_numbers; ++i) row.bind(2 + i, Number());
    const std::string blob = Blob();
    row.bind(2 + num_numbers, blob.data(), static_cast<int>(blob.size()));
    row.exec();
  }
  std::uint8_t Byte() {
    if (size_ == 0) return 0;
    --size_;
    return *data_++;
  }
  std::int64_t Number() {
    const std::uint8_t first = Byte();
    if (first < 255) return first;
    std::uint64_t number = 0;
    for (int i = 0; i < 8; ++i) number = number << 8 | Byte();
    return static_cast<std::int64_t>(number);
  }
  std::string Blob() {
    std::string blob(Byte(), '\0');
    for (char& c : blob) c = static_cast<char>(Byte());
    return blob;
  }

  TempFolder folder_;
  std::string path_;
  const std::uint8_t* data_ = nullptr;
  size_t size_ = 0;
};

// What its readers make of an input.
inline void ReadColmapTablesInput(const std::uint8_t* data, size_t size) {
  static ColmapTables tables;
  tables.Write(data, size);
  DatasetOptions options;
  options.folder = tables.path();
  const auto pairs = OpenColmap(options);
  for (size_t i = 0; i < pairs->size(); ++i) pairs->Read(i);
}

}  // namespace rcme
