// What the layouts have in common: tables of numbers, folders of sequences, checks that name a path.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/core/files/gzip_lines.h"
#include "experiments/real/sequences/sequence.h"

namespace rcme {

// The rows of a text file: its lines without blank ones and those that begin with '#'.
class TableFile {
 public:
  // Fields are separated by commas, or by spaces and tabs. Throws InputError as GzipLines does; `origin` says
  // where a missing file comes from.
  enum class Separator { kComma, kSpace };
  static constexpr int kMaxImages = 200'000, kMaxRows = 1'000'000;
  TableFile(const std::filesystem::path& path, const std::string& origin, Separator separator,
            int max_rows = kMaxRows);

  bool Next();  // false after the last row; throws InputError after max_rows
  const std::vector<std::string>& fields() const { return fields_; }
  // The row has at least this many fields.
  void Need(size_t num_fields, const std::string& what) const;
  // Field i as a finite number.
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

// The folder itself where it holds `marker`, else the folders in it that do, by name and restricted to
// `only`. Throws InputError that names what is missing.
std::vector<std::filesystem::path> SequenceFolders(const DatasetOptions& options, const std::string& marker,
                                                   const std::string& origin);

// The name of a folder, also where its path ends with a slash or is a dot.
std::string FolderName(const std::filesystem::path& folder);

// A rotation from a quaternion of length 1 to within 1e-2, at fields w, x, y, z of a table.
Eigen::Matrix3d RotationFromFields(const TableFile& table, size_t w, size_t x, size_t y, size_t z);

// Images of another size than the camera's contradict a data set; of a folder of anybody's photographs they
// are skipped.
enum class OtherSizes { kRefused, kSkipped };

// Cuts the sequence to max_frames and checks it: two frames at least, times that grow, every image there and
// of the camera's size as its header says it. A camera without a size gets that of the first image; where
// others are skipped, that of the images, the more of them the rather, whose centre is nearest to the
// principal point. Damaged headers pass: such images are skipped when their turn comes. `times` is the file
// the times are from.
void FinishSequence(const DatasetOptions& options, const std::filesystem::path& times, Sequence* sequence,
                    OtherSizes other_sizes = OtherSizes::kRefused);

}  // namespace rcme
