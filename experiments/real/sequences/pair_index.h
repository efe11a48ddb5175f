// Records for every pair of images whether it was kept, or why it was dropped: the index of a folder of
// pairs, and the journal from which interrupted work continues.
#pragma once

#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/core/table/table.h"

namespace rcme {

struct PairRow {
  std::string pair_id, scene, image1, image2;
  std::string reason;  // "kept", or why it was dropped
  int num_matches = 0;
  std::optional<int> num_inliers = std::nullopt;  // of the gate's model; none if it fitted none
  // NaN: not known, here and below.
  double time1_s = std::numeric_limits<double>::quiet_NaN(), time2_s = time1_s;
  double parallax_deg = time1_s;
  double rotation_deg = time1_s, baseline = time1_s;  // of the true motion
  bool is_direction_weak = false;                     // its direction is not scored
};

// An image that could not be decoded, or whose size is not that of K.
struct DamagedImage {
  std::string scene, image, message;
};

// The file pairs.journal in the folder OUT has a line of JSON per row; the first line says what is being
// made. The row of a pair is written after its file. A last line without an end was cut off and is ignored.
class PairJournal {
 public:
  // Reads an existing journal. Throws InputError if the folder cannot be written, holds pairs with another
  // `identity`, or holds match files from elsewhere.
  PairJournal(const std::string& folder, const std::string& identity);
  ~PairJournal();
  PairJournal(const PairJournal&) = delete;
  PairJournal& operator=(const PairJournal&) = delete;

  // Returns the earlier result for a pair or an image; null if there is none.
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

// Makes INDEX.csv: a row per pair, kept or dropped. Studies read pair_id and t_gt_weak (match_folder.h).
Table MakeIndexTable(const std::vector<PairRow>& rows);

// Explains in one sentence why no pair was kept: number of dropped pairs by reason, and skipped images.
std::string DescribeWhyNone(const std::vector<PairRow>& rows, const std::vector<DamagedImage>& damaged);

// For each scene, the number of pairs kept and of pairs dropped by reason; then the damaged images.
std::string PairsAsTable(const std::vector<PairRow>& rows, const std::vector<DamagedImage>& damaged);

}  // namespace rcme
