// What became of every pair of images that was looked at: kept or dropped, and why. The index of a folder of
// pairs, and the journal from which work that was cut off goes on.
#pragma once

#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "experiments/core/table/table.h"

namespace rcme {

struct PairRow {
  std::string pair_id, scene, image1, image2;
  std::string reason;  // "kept", or why it was dropped
  int num_matches = 0, num_inliers = 0;
  double time1_s = std::numeric_limits<double>::quiet_NaN(),
         time2_s = time1_s;  // NaN: not known, here and below
  double parallax_deg = time1_s;
  double rotation_deg = time1_s, baseline = time1_s;  // of the true motion
  bool is_direction_weak = false;                     // its direction is not to be scored
};

// An image that could not be unpacked, or is not of the size that K is of.
struct DamagedImage {
  std::string scene, image, message;
};

// In the folder OUT: pairs.journal, a line of JSON per row, the first of which says what is being made. A row
// is there once the file of its pair is; a last line without an end was cut off and does not count.
class PairJournal {
 public:
  // Reads what is there. Throws InputError: the folder cannot be written, or holds pairs of another
  // `identity`, or match files of somebody else's.
  PairJournal(const std::string& folder, const std::string& identity);
  ~PairJournal();
  PairJournal(const PairJournal&) = delete;
  PairJournal& operator=(const PairJournal&) = delete;

  // What was decided of a pair and found of an image before; null: nothing.
  const PairRow* Find(const std::string& pair_id) const;
  const DamagedImage* FindDamaged(const std::string& scene, const std::string& image) const;
  void Add(const PairRow& row);
  void Add(const DamagedImage& image);

  const std::vector<PairRow>& rows() const { return rows_; }  // in the order of the work
  const std::vector<DamagedImage>& damaged() const { return damaged_; }
  int num_before() const { return num_before_; }

 private:
  void AddLine(const std::string& line);
  void Read(const std::string& text, const std::string& identity);

  std::string path_;
  std::FILE* file_ = nullptr;
  std::vector<PairRow> rows_;
  std::vector<DamagedImage> damaged_;
  std::map<std::string, size_t> row_at_;
  int num_before_ = 0;
};

// INDEX.csv: a row per pair, kept or dropped. pair_id and t_gt_weak are what studies read (match_folder.h).
Table MakeIndexTable(const std::vector<PairRow>& rows);

// Why no pair was kept, as a sentence: how many pairs were dropped for which reason, and images skipped.
std::string DescribeWhyNone(const std::vector<PairRow>& rows, const std::vector<DamagedImage>& damaged);

// Per scene how many pairs were kept, and dropped why; then the damaged images.
std::string PairsAsTable(const std::vector<PairRow>& rows, const std::vector<DamagedImage>& damaged);

}  // namespace rcme
