#include "experiments/run/store/trial_checksum.h"

#include "experiments/core/files/checksum.h"
#include "experiments/trial/trial_columns.h"

namespace rcme {
namespace {

// A visitor of the fields of records. A NaN is NULL in the file.
class FieldBytes {
 public:
  explicit FieldBytes(size_t expected_size) : bytes_(expected_size) {}

  template <typename Field>
  void operator()(const StoredColumn&, const Field& field) {
    Add(field);
  }
  void Add(MotionStatus status) { bytes_.Add(std::string(StatusName(status))); }
  void Add(double number) { bytes_.Add(number); }
  template <typename Integer>
  void Add(Integer number) {
    bytes_.Add(static_cast<std::uint64_t>(number));
  }

  std::uint32_t Checksum() const { return bytes_.Checksum(); }

 private:
  ChecksumBytes bytes_;
};

}  // namespace

std::uint32_t ChecksumOfTrial(std::uint32_t identity, const ProblemRecord& problem,
                              std::span<const TrialRecord> records) {
  FieldBytes bytes(200 + 300 * records.size());
  bytes.Add(identity);
  VisitColumns(problem, bytes);
  for (const TrialRecord& record : records) VisitColumns(record, bytes);
  return bytes.Checksum();
}

}  // namespace rcme
