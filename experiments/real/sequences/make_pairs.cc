#include "experiments/real/sequences/make_pairs.h"

#include <fmt/format.h>

#include <cmath>
#include <deque>
#include <filesystem>
#include <memory>

#include "experiments/core/files/file_output.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/core/work/progress.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/data/camera_plausibility.h"
#include "parameters/input_error.h"
#include "stats/constants.h"
#include "stats/fnv1a.h"

namespace rcme {
namespace {

constexpr std::uint32_t kGatePurpose = 0x6761;  // of the gate's random stream; trials do not use it

// Returns the upper 48 bits of the hash of a pair's name.
std::uint64_t HashPairId(const std::string& pair_id) {
  Fnv1a hash;
  hash.Add(pair_id);
  return hash.value() >> 16;
}

void StopIfRequested(const PairJournal& journal) {
  if (IsStopRequested())
    throw Stopped(
        fmt::format("stopped after {} pairs; the same command goes on from here", journal.rows().size()));
}

// Throws InputError if a source of a pair was written after the match file that was made of it.
void RequireOlder(const std::filesystem::path& source, const PairsOptions& options,
                  const std::string& pair_id) {
  const std::filesystem::path made = std::filesystem::path(options.out) / (pair_id + ".csv");
  std::error_code no_source, not_made;  // a pair that was not kept has no file
  const auto written = std::filesystem::last_write_time(source, no_source);
  if (no_source || written <= std::filesystem::last_write_time(made, not_made) || not_made) return;
  throw InputError(fmt::format("{}: is newer than {}, which was made of it; remove {} or give another --out",
                               source.string(), made.string(), options.out));
}

bool IsDirectionWeak(const PairsOptions& options, double baseline) {
  return options.truth_sd.value_or(PoseSd()).IsDirectionWeak(baseline);
}

// Judges a pair, writes its file if it is kept, and adds it to the journal.
void Decide(MatchFile file, PairRow row, const PairsOptions& options, PairJournal* journal) {
  RandomStream rng({.seed = 1, .condition = HashPairId(row.pair_id), .purpose = kGatePurpose});
  const KeyFrameVerdict verdict =
      JudgePair({file.matches, file.camera1, file.camera2, options.gate.sigma_px}, options.gate, rng);
  row.reason = verdict.reason;
  row.num_inliers = verdict.num_inliers;
  row.parallax_deg = verdict.parallax_deg;
  row.num_matches = static_cast<int>(file.matches.size());
  if (file.cam2_from_cam1_true) {
    row.rotation_deg =
        RotationAngleBetween(file.cam2_from_cam1_true->R, Eigen::Matrix3d::Identity()) / kRadPerDeg;
    file.baseline = row.baseline;
    if (options.truth_sd && !std::isnan(row.baseline) && row.baseline > 0.0)
      file.truth_sd = SdOfMotion(*options.truth_sd, row.baseline);
  }
  if (row.reason == kKeptPair)
    WriteMatchFile(file, (std::filesystem::path(options.out) / (row.pair_id + ".csv")).string());
  journal->Add(row);
}

// An image being processed.
struct LoadedFrame {
  size_t number = 0;
  const Frame* frame = nullptr;
  std::shared_ptr<const ImageFeatures> image;        // null: not needed yet
  std::vector<std::optional<Eigen::Vector2d>> x_px;  // of its key points, undistorted
};

// Rounds to a ten-thousandth of a pixel, which is precise enough and halves the file.
Eigen::Vector2d Rounded(const Eigen::Vector2d& x_px) {
  return {std::round(1e4 * x_px.x()) / 1e4, std::round(1e4 * x_px.y()) / 1e4};
}

// Makes the pairs of one sequence.
class SequencePairs {
 public:
  SequencePairs(const Sequence& sequence, const PairsOptions& options, FeatureCache* cache,
                PairJournal* journal)
      : sequence_(sequence), options_(options), cache_(cache), journal_(journal) {}

  void Run(Progress* progress) {
    for (size_t i = 0; i < sequence_.frames.size(); i += static_cast<size_t>(options_.every)) {
      StopIfRequested(*journal_);
      LoadedFrame frame{i, &sequence_.frames[i], nullptr, {}};
      options_.window > 0 ? MeetAll(&frame) : Meet(&frame);
      progress->Advance(1);
    }
  }

 private:
  // Pairs the next image with the waiting ones; the latest is last.
  void Meet(LoadedFrame* frame) {
    if (journal_->FindDamaged(sequence_.name, frame->frame->name)) return;
    if (waiting_.empty()) {
      if (Load(frame)) waiting_.push_back(*frame);
      return;
    }
    const PairRow* row = Pair(&waiting_.back(), frame);
    if (!row) return;  // damaged
    const std::string reason = row->reason;
    if (reason == kTooFewMatches) waiting_.clear();
    if (reason == kTooFewMatches || reason == kKeptPair) {
      for (size_t k = 0; k + 1 < waiting_.size(); ++k) Pair(&waiting_[k], frame);
      waiting_.push_back(*frame);
      if (waiting_.size() > static_cast<size_t>(options_.neighbours)) waiting_.pop_front();
    }
  }

  // Pairs the next image with those of the window before it; the latest is last.
  void MeetAll(LoadedFrame* frame) {
    if (journal_->FindDamaged(sequence_.name, frame->frame->name)) return;
    if (waiting_.empty() && !Load(frame)) return;
    for (LoadedFrame& before : waiting_) {
      if (!Pair(&before, frame)) return;  // damaged
    }
    waiting_.push_back(*frame);
    if (waiting_.size() > static_cast<size_t>(options_.window)) waiting_.pop_front();
  }

  // Returns the row of the two images; null if the second is damaged. The first was read before.
  const PairRow* Pair(LoadedFrame* frame1, LoadedFrame* frame2) {
    const std::string pair_id = fmt::format("{}_{:06}_{:06}", FileName(), frame1->number, frame2->number);
    if (const PairRow* row = journal_->Find(pair_id)) {
      for (const LoadedFrame* frame : {frame1, frame2}) RequireOlder(frame->frame->path, options_, pair_id);
      return row;
    }
    if (!Load(frame1) || !Load(frame2)) return nullptr;
    PairRow row;
    row.pair_id = pair_id;
    row.scene = sequence_.name;
    row.image1 = frame1->frame->name;
    row.image2 = frame2->frame->name;
    row.time1_s = frame1->frame->time_s;
    row.time2_s = frame2->frame->time_s;
    MatchFile file = Match(*frame1, *frame2);
    file.seconds_between = row.time2_s - row.time1_s;
    if (frame1->frame->pose_true && frame2->frame->pose_true) {
      const TrueMotion12 motion = MotionBetween(*frame1->frame->pose_true, *frame2->frame->pose_true);
      file.cam2_from_cam1_true = motion.cam2_from_cam1;
      row.baseline = motion.baseline;
      row.is_direction_weak = IsDirectionWeak(options_, motion.baseline);
    }
    Decide(std::move(file), row, options_, journal_);
    return journal_->Find(pair_id);
  }

  MatchFile Match(const LoadedFrame& frame1, const LoadedFrame& frame2) const {
    MatchFile file;
    file.scene = sequence_.name;
    file.camera1 = file.camera2 = sequence_.lens.camera;
    file.image1 = frame1.frame->name;
    file.image2 = frame2.frame->name;
    if (options_.has_scores) file.better_score = BetterScore::kLower;
    const Features &features1 = frame1.image->features, &features2 = frame2.image->features;
    for (const FeatureMatch& match : MatchFeatures(features1, features2, options_.matcher)) {
      const auto &x1 = frame1.x_px[match.at1], &x2 = frame2.x_px[match.at2];
      if (!x1 || !x2) continue;
      file.matches.push_back({Rounded(*x1), Rounded(*x2)});
      if (options_.has_scores) file.scores.push_back(std::round(1e4 * match.ratio) / 1e4);
      const double sigma_px = SigmaOfMatch(options_.detector.detector, features1.key_points[match.at1],
                                           features2.key_points[match.at2], features1.scale, features2.scale);
      file.sigma_px.push_back(std::round(1e4 * sigma_px) / 1e4);
    }
    return file;
  }

  // Returns false if the image is damaged or skipped, and adds that to the journal.
  bool Load(LoadedFrame* frame) {
    if (frame->image) return true;
    const Camera& camera = sequence_.lens.camera;
    try {
      if (!frame->frame->why_skipped.empty()) throw InputError(frame->frame->why_skipped);
      frame->image = std::make_shared<ImageFeatures>(cache_->Get(frame->frame->path, options_.detector));
    } catch (const InputError& error) {
      journal_->Add(DamagedImage{sequence_.name, frame->frame->name, error.what()});
      return false;
    }
    if (frame->image->width != camera.width || frame->image->height != camera.height)
      throw InputError(fmt::format("{}: is of {} x {} px; the sequence's images must be of {} x {} px",
                                   frame->frame->path, frame->image->width, frame->image->height,
                                   camera.width, camera.height));
    for (const KeyPoint& point : frame->image->features.key_points)
      frame->x_px.push_back(Undistort(sequence_.lens, {point.x_px, point.y_px}));
    return true;
  }

  // Scenes may have names such as KITTI/00.
  std::string FileName() const {
    std::string name = sequence_.name;
    for (char& c : name) {
      if (c == '/' || c == ' ') c = '-';
    }
    return name;
  }

  const Sequence& sequence_;
  const PairsOptions& options_;
  FeatureCache* cache_;
  PairJournal* journal_;
  std::deque<LoadedFrame> waiting_;
};

}  // namespace

void MakePairsOfImages(const std::vector<Sequence>& sequences, const PairsOptions& options,
                       PairJournal* journal) {
  const auto every = static_cast<size_t>(options.every);
  std::int64_t num_frames = 0;
  for (const Sequence& sequence : sequences)
    num_frames += static_cast<std::int64_t>((sequence.frames.size() + every - 1) / every);
  Progress progress("images", num_frames);
  FeatureCache cache(options.cache);
  InputWarnings warnings;
  for (const Sequence& sequence : sequences)
    warnings.Add(FindCameraDoubts(sequence.lens.camera, sequence.name + ": K", sequence.lens.model));
  warnings.Print();
  for (const Sequence& sequence : sequences) SequencePairs(sequence, options, &cache, journal).Run(&progress);
}

void MakeListedPairs(ListedPairs& pairs, const PairsOptions& options, PairJournal* journal) {
  Progress progress("pairs", static_cast<std::int64_t>(pairs.size()), journal->num_before());
  InputWarnings warnings;
  for (size_t i = 0; i < pairs.size(); ++i) {
    StopIfRequested(*journal);
    PairRow row;
    row.pair_id = pairs.PairId(i);
    if (journal->Find(row.pair_id)) {
      RequireOlder(pairs.Source(i), options, row.pair_id);
      continue;
    }
    ListedPair listed = pairs.Read(i);
    warnings.Add(FindPairDoubts(listed.file.camera1, listed.file.camera2, listed.file.matches,
                                {row.pair_id + ": camera 1", row.pair_id + ": camera 2"}));
    row.scene = listed.file.scene;
    row.image1 = listed.file.image1;
    row.image2 = listed.file.image2;
    row.baseline = listed.baseline;
    row.is_direction_weak = listed.is_direction_weak ||
                            (!std::isnan(listed.baseline) && IsDirectionWeak(options, listed.baseline));
    Decide(std::move(listed.file), row, options, journal);
    progress.Advance(1);
  }
  warnings.Print();
}

CommandResult WritePairTables(const PairJournal& journal, const std::vector<std::string>& notes,
                              const std::string& out) {
  const std::filesystem::path folder(out);
  std::string text = PairsAsTable(journal.rows(), journal.damaged());
  for (const std::string& note : notes) {
    if (!note.empty()) text += note + "\n";
  }
  const Table index = MakeIndexTable(journal.rows());
  WriteFileWhole((folder / "INDEX.csv").string(), RenderCsv(index));
  WriteFileWhole((folder / "pairs.txt").string(), text);
  using D = const DamagedImage&;
  const Table damaged = MakeTable<DamagedImage>({{Column::Text("scene"), [](D d) { return d.scene; }},
                                                 {Column::Text("image"), [](D d) { return d.image; }},
                                                 {Column::Text("message"), [](D d) { return d.message; }}},
                                                journal.damaged());
  return MakeResult(text, kPairsFormat, {{"folder", out}}, index, {{"damaged_images", damaged}});
}

}  // namespace rcme
