#include "experiments/run/store/counts_tables.h"

#include <fmt/format.h>

#include "experiments/core/files/checksum.h"

namespace rcme {
namespace {

std::int64_t ChecksumOfRow(const ResultFile& file, std::uint32_t condition, const CountedPlaces& row) {
  return ComputeChecksum({file.description.identity, std::to_string(condition), row.shard, row.places});
}

std::int64_t ChecksumOfRow(const ResultFile& file, std::uint32_t condition, const CountedQuantity& row) {
  return ComputeChecksum({file.description.identity, std::to_string(condition), std::to_string(row.estimator),
                          row.quantity, std::to_string(row.n), row.sum, row.sum_squares, row.cells});
}

std::uint32_t NumberBelow(const SQLite::Column& column, const char* table, size_t end) {
  const std::int64_t number = IntegerIn(column, table);
  if (number < 0 || number >= static_cast<std::int64_t>(end)) ThrowOutOfRange(column, table);
  return static_cast<std::uint32_t>(number);
}

template <typename Row>
void CheckRow(const ResultFile& file, std::uint32_t condition, const Row& row, std::int64_t checksum,
              const char* table) {
  if (ChecksumOfRow(file, condition, row) == checksum) return;
  throw Damage(fmt::format("condition {}: the checksum of a row of table {} is another", condition, table));
}

}  // namespace

std::vector<StoredCounts> ReadStoredCounts(const ResultFile& file) {
  std::vector<StoredCounts> counts(file.description.conditions.size());
  SQLite::Statement places(file.database, "SELECT * FROM counted ORDER BY condition, shard");
  while (places.executeStep()) {
    const std::uint32_t condition = NumberBelow(places.getColumn(0), "counted", counts.size());
    const CountedPlaces row{TextIn(places.getColumn(1), "counted"), TextIn(places.getColumn(2), "counted")};
    CheckRow(file, condition, row, IntegerIn(places.getColumn(3), "counted"), "counted");
    counts[condition].places.push_back(row);
  }
  SQLite::Statement sums(file.database, "SELECT * FROM counts ORDER BY condition, estimator, quantity");
  while (sums.executeStep()) {
    const auto text = [&](int column) { return TextIn(sums.getColumn(column), "counts"); };
    const std::uint32_t condition = NumberBelow(sums.getColumn(0), "counts", counts.size());
    const std::uint32_t estimator =
        NumberBelow(sums.getColumn(1), "counts", file.description.estimators.size() + 1);
    const CountedQuantity row{estimator, text(2), IntegerIn(sums.getColumn(3), "counts"),
                              text(4),   text(5), text(6)};
    CheckRow(file, condition, row, IntegerIn(sums.getColumn(7), "counts"), "counts");
    counts[condition].quantities.push_back(row);
  }
  return counts;
}

void WriteStoredCounts(ResultFile* file, std::uint32_t condition, const StoredCounts& counts) {
  for (const char* table : {"counted", "counts"})
    file->database.exec(fmt::format("DELETE FROM {} WHERE condition = {}", table, condition));
  SQLite::Statement places(file->database, "INSERT INTO counted VALUES (?, ?, ?, ?)");
  for (const CountedPlaces& row : counts.places)
    Execute(places, condition, row.shard, row.places, ChecksumOfRow(*file, condition, row));
  SQLite::Statement sums(file->database, "INSERT INTO counts VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  for (const CountedQuantity& row : counts.quantities)
    Execute(sums, condition, row.estimator, row.quantity, row.n, row.sum, row.sum_squares, row.cells,
            ChecksumOfRow(*file, condition, row));
}

}  // namespace rcme
