#include "experiments/real/sequences/timed_frames.h"

#include <fmt/format.h>

#include <optional>
#include <set>

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

}  // namespace

void AddTimedFrames(const DatasetOptions& options, const TimedFiles& files, Sequence* sequence) {
  TimedPoses truth;
  if (fs::exists(files.truth)) {
    truth = ReadTimedPoses(files);
    if (!truth.ambiguous_s.empty())
      sequence->note = fmt::format("{}: {} times stand there more than once; their poses are not used",
                                   files.truth.string(), truth.ambiguous_s.size());
  } else {
    sequence->note = fmt::format("no truth: {} is not there", files.truth.string());
  }
  for (TableFile table(files.images, files.images_origin, files.separator, TableFile::kMaxImages);
       table.Next();) {
    table.Need(2, "timestamp, filename");
    const double time_s = files.seconds_per_unit * table.Number(0);
    const std::string name = table.fields()[1];
    sequence->frames.push_back({name, (files.images_folder / name).string(), time_s,
                                truth.trajectory.At(time_s, files.longest_gap_s)});
  }
  FinishSequence(options, files.images, sequence);
}

}  // namespace rcme
