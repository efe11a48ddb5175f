// Common to the layouts: tables of numbers, folders of sequences, and checks that name a path.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/core/files/gzip_lines.h"
#include "experiments/real/sequences/sequence.h"

namespace rcme {

// Reads the rows of a text file: its lines except blank ones and those that begin with '#'.
class TableFile {
 public:
  // Fields are separated by commas, or by spaces and tabs. Throws InputError as GzipLines does; `origin`
  // tells where to get a missing file.
  enum class Separator { kComma, kSpace };
  static constexpr int kMaxImages = 200'000, kMaxRows = 1'000'000;
  TableFile(const std::filesystem::path& path, const std::string& origin, Separator separator,
            int max_rows = kMaxRows);

  bool Next();  // false after the last row; throws InputError after max_rows
  const std::vector<std::string>& fields() const { return fields_; }
  // Throws InputError unless the row has this many fields.
  void Need(size_t num_fields, const std::string& what) const;
  // Returns field i as a finite number.
  double Number(size_t i) const;
  [[noreturn]] void Fail(const std::string& what) const { lines_.Fail(what); }

 private:
  GzipLines lines_;
  Separator separator_;
  int rows_left_;
  std::vector<std::string> fields_;
};

// Throws InputError "PATH: is not there; ORIGIN" if nothing is at the path.
void CheckIsThere(const std::filesystem::path& path, const std::string& origin);

// Returns the data set's folder if it contains `marker`, else its subfolders that do, ordered by name and
// restricted to options.only. Throws InputError that names what is missing.
std::vector<std::filesystem::path> SequenceFolders(const DatasetOptions& options, const std::string& marker,
                                                   const std::string& origin);

// Returns the name of a folder, even if the path ends with a slash or is a dot.
std::string FolderName(const std::filesystem::path& folder);

// Reads a rotation from a quaternion at fields w, x, y, z of a table; its length must be 1 within 1e-2.
Eigen::Matrix3d RotationFromFields(const TableFile& table, size_t w, size_t x, size_t y, size_t z);

// How to treat images whose size differs from the camera's: in a data set this is an error; in a folder of
// arbitrary photographs they are skipped.
enum class OtherSizes { kRefused, kSkipped };

// Cuts the sequence to max_frames and checks it: it needs two frames or more, increasing times, and images
// that exist and, by their headers, have the size of the camera. A camera without a size gets that of the
// first image. With kSkipped, it gets the image size whose centre is nearest to the principal point; of
// sizes about equally near, the most frequent. Damaged headers pass here; such images are skipped when they
// are read. `times` is the file with the times.
void FinishSequence(const DatasetOptions& options, const std::filesystem::path& times, Sequence* sequence,
                    OtherSizes other_sizes = OtherSizes::kRefused);

}  // namespace rcme
