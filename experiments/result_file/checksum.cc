#include "experiments/result_file/checksum.h"

#include <zlib.h>

#include <bit>
#include <cmath>

#include "experiments/trial/trial_fields.h"

namespace rcme {
namespace {

// The fields as bytes, little-endian whatever the machine, in which nothing can pass for something else.
class Bytes {
 public:
  explicit Bytes(size_t expected_size) { bytes_.reserve(expected_size); }

  void operator()(const char*, const std::string& text) {
    (*this)("", text.size());
    bytes_ += text;
  }
  void operator()(const char*, MotionStatus status) { (*this)("", StatusName(status)); }
  void operator()(const char*, double number) {  // every NaN is NULL in the file
    AppendWord(std::isnan(number) ? ~std::uint64_t{0} : std::bit_cast<std::uint64_t>(number));
  }
  template <typename Integer>
  void operator()(const char*, Integer number) {
    AppendWord(static_cast<std::uint64_t>(number));
  }

  std::uint32_t Checksum() const {
    const auto* data = reinterpret_cast<const Bytef*>(bytes_.data());
    return static_cast<std::uint32_t>(crc32_z(0, data, bytes_.size()));
  }

 private:
  void AppendWord(std::uint64_t word) {
    char bytes[8];
    for (int i = 0; i < 8; ++i) bytes[i] = static_cast<char>(word >> (8 * i));
    bytes_.append(bytes, sizeof(bytes));
  }

  std::string bytes_;
};

}  // namespace

std::uint32_t ChecksumOf(const std::vector<std::string>& texts) {
  Bytes bytes(0);
  for (const std::string& text : texts) bytes("", text);
  return bytes.Checksum();
}

std::uint32_t ChecksumOfTrial(std::uint32_t identity, const ProblemRecord& problem,
                              std::span<const TrialRecord> records) {
  Bytes bytes(200 + 300 * records.size());
  bytes("", identity);
  VisitProblemFields(problem, bytes);
  for (const TrialRecord& record : records) VisitFields(record, bytes);
  return bytes.Checksum();
}

}  // namespace rcme
