#include "experiments/real/sequences/timed_frames.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

namespace rcme {
namespace {

namespace fs = std::filesystem;

struct TimedPoses {
  Trajectory trajectory;
  std::set<double> ambiguous_s;  // times with several poses; none of these is used
};

TimedPoses ReadTimedPoses(const TimedFiles& files) {
  const auto& [w, x, y, z] = files.wxyz;
  TimedPoses truth;
  std::optional<std::pair<double, CameraPose>> last;
  const auto add_last = [&] {
    if (last && !truth.ambiguous_s.contains(last->first)) truth.trajectory.Add(last->first, last->second);
  };
  for (TableFile table(files.truth, "", files.separator); table.Next();) {
    table.Need(8, files.truth_fields);
    const double time_s = files.seconds_per_unit * table.Number(0);
    const Eigen::Matrix3d R = RotationFromFields(table, w, x, y, z);
    const Eigen::Vector3d p(table.Number(1), table.Number(2), table.Number(3));
    if (last && time_s < last->first)
      table.Fail("the time is before that of the row before; times must grow");
    if (last && time_s == last->first) truth.ambiguous_s.insert(time_s);
    add_last();
    last = {time_s, {R * files.body_from_cam.R_world_from_cam, R * files.body_from_cam.center + p}};
  }
  add_last();
  return truth;
}

// What a reader should know about the true poses of the frames, or empty.
std::string DescribeTruth(const TimedFiles& files, const TimedPoses& truth,
                          const std::vector<Frame>& frames) {
  const std::string file = files.truth.string();
  if (!fs::exists(files.truth)) return fmt::format("no truth: {} is not there", file);
  std::vector<std::string> notes;
  if (!truth.ambiguous_s.empty())
    notes.push_back(fmt::format("{}: {} times stand there more than once; their poses are not used", file,
                                truth.ambiguous_s.size()));
  const auto num_without = std::ranges::count_if(frames, [](const Frame& f) { return !f.pose_true; });
  if (num_without > 0)
    notes.push_back(
        fmt::format("{}: {} of {} images have no true pose: their times are before the first pose, after the "
                    "last, or between two poses more than {:g} s apart",
                    file, num_without, frames.size(), files.longest_gap_s));
  return fmt::format("{}", fmt::join(notes, "; "));
}

}  // namespace

void AddTimedFrames(const DatasetOptions& options, const TimedFiles& files, Sequence* sequence) {
  TimedPoses truth;
  if (fs::exists(files.truth)) truth = ReadTimedPoses(files);
  for (TableFile table(files.images, files.images_origin, files.separator, TableFile::kMaxImages);
       table.Next();) {
    table.Need(2, "timestamp, filename");
    const double time_s = files.seconds_per_unit * table.Number(0);
    const std::string name = table.fields()[1];
    sequence->frames.push_back({name, (files.images_folder / name).string(), time_s,
                                truth.trajectory.At(time_s, files.longest_gap_s)});
  }
  FinishSequence(options, files.images, sequence);
  sequence->note = DescribeTruth(files, truth, sequence->frames);
}

}  // namespace rcme
