#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/front_end_options.h"
#include "experiments/core/text/message.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/real/sequences/layouts.h"
#include "experiments/real/sequences/listed_pairs.h"
#include "experiments/real/sequences/make_pairs.h"
#include "parameters/input_error.h"
#include "parameters/suggestion.h"

namespace rcme {
namespace {

struct PairsArguments {
  DatasetOptions dataset;
  PairsOptions pairs;
  std::string layout, lens = "pinhole", gate = "orb_slam2", format = "table";
  std::vector<double> truth_sd;
};

// How a layout is read: as images, or as pairs that it lists.
struct Layout {
  const char* name;
  std::vector<Sequence> (*read)(const DatasetOptions&);
  std::unique_ptr<ListedPairs> (*open)(const DatasetOptions&);
};
constexpr std::array<Layout, 8> kLayouts = {{{"kitti", ReadKitti, nullptr},
                                             {"euroc", ReadEuroc, nullptr},
                                             {"tum", ReadTum, nullptr},
                                             {"images", ReadImageFolder, nullptr},
                                             {"colmap", nullptr, OpenColmap},
                                             {"posebench", nullptr, OpenPosebench},
                                             {"npz", nullptr, OpenNpzPairs},
                                             {"matches", nullptr, OpenMatchFiles}}};

std::vector<std::string> GateNames() {
  std::vector<std::string> names = {"off"};
  for (const auto& [name, criterion] : CriterionNames()) names.push_back(name);
  return names;
}

// Refuses an option that does not apply to the layout.
void CheckApplies(const PairsArguments& arguments) {
  const auto refuse = [&](const char* option, bool is_given, const std::vector<std::string>& layouts) {
    if (!is_given || std::ranges::find(layouts, arguments.layout) != layouts.end()) return;
    throw InputError(fmt::format("{}: does not apply to the layout {}, only to {}", option, arguments.layout,
                                 fmt::join(layouts, ", ")));
  };
  const DatasetOptions& dataset = arguments.dataset;
  const std::vector<std::string> sequences = {"kitti", "euroc", "tum"};
  const std::vector<std::string> images = {"kitti", "euroc", "tum", "images"};
  refuse("--sequence", !dataset.only.empty(), sequences);
  refuse("--K", !dataset.K.empty(), {"tum", "images", "npz"});
  refuse("--distortion", !dataset.distortion.empty(), {"tum", "images", "npz"});
  refuse("--model", !dataset.model.empty(), {"colmap"});
  refuse("--name", !dataset.name.empty(), {"kitti", "euroc", "tum", "images", "colmap", "posebench", "npz"});
  refuse("--max-frames", dataset.max_frames > 0, images);
  refuse("--every", arguments.pairs.every > 1, images);
  refuse("--neighbours", arguments.pairs.neighbours > 1, images);
  refuse("--scores", arguments.pairs.has_scores, images);
  refuse("--subpixel", arguments.pairs.detector.refines_corners, images);
  refuse("--window", arguments.pairs.window > 0, images);
  if (arguments.pairs.window > 0 && arguments.pairs.neighbours > 1)
    throw InputError("--neighbours: does not apply with --window, which pairs all images near each other");
  refuse("--cache", !arguments.pairs.cache.empty(), images);
  refuse("--truth-sd", !arguments.truth_sd.empty(), {"kitti", "euroc", "tum", "colmap"});
}

// Everything that the pairs depend on except the images' contents.
std::string DescribePairsIdentity(const PairsArguments& arguments) {
  const DatasetOptions& d = arguments.dataset;
  const PairsOptions& p = arguments.pairs;
  return fmt::format(
      "{} {} | sequences {} | name {} | K {} | {} {} | model {} | frames {} | detector {} {} | ratio {} {} | "
      "gate {} {} "
      "{} {} | every {} | neighbours {} | truth_sd {}{}{}{}",
      arguments.layout, std::filesystem::weakly_canonical(d.folder).string(), fmt::join(d.only, " "), d.name,
      fmt::join(d.K, " "), arguments.lens, fmt::join(d.distortion, " "), d.model, d.max_frames,
      static_cast<int>(p.detector.detector), p.detector.max_features, p.matcher.max_ratio,
      p.matcher.is_mutual, arguments.gate, p.gate.least_matches, p.gate.least_parallax_deg, p.gate.sigma_px,
      p.every, p.neighbours, fmt::join(arguments.truth_sd, " "), p.has_scores ? " | scores" : "",
      p.window > 0 ? fmt::format(" | window {}", p.window) : "",
      p.detector.refines_corners ? " | subpixel" : "");
}

// The command to suggest next: a study needs true motions; without them motions are estimated and covariances
// checked.
std::string NameNextCommand(const std::vector<PairRow>& rows, const std::string& out) {
  const auto is_kept = [](const PairRow& row) { return row.reason == kKeptPair; };
  const bool has_truth = std::ranges::any_of(
      rows, [&](const PairRow& row) { return is_kept(row) && !std::isnan(row.rotation_deg); });
  if (has_truth) return fmt::format("rcme run real_pairs --set folder={} --out run.sqlite", out);
  const auto first = std::ranges::find_if(rows, is_kept);
  return fmt::format("rcme estimate {} (one motion), or rcme validate {} (are the covariances right?)",
                     (std::filesystem::path(out) / (first->pair_id + ".csv")).string(), out);
}

void RunPairs(PairsArguments arguments) {
  CheckApplies(arguments);
  const StopOnSignals stop;
  for (const auto& [name, model] : LensModelNames()) {
    if (name == arguments.lens) arguments.dataset.lens = model;
  }
  arguments.pairs.gate.criterion.reset();
  for (const auto& [name, criterion] : CriterionNames()) {
    if (name == arguments.gate) arguments.pairs.gate.criterion = criterion;
  }
  if (!arguments.truth_sd.empty()) arguments.pairs.truth_sd = {arguments.truth_sd[0], arguments.truth_sd[1]};
  const auto layout =
      std::ranges::find_if(kLayouts, [&](const Layout& known) { return known.name == arguments.layout; });
  const std::string& out = arguments.pairs.out;
  std::error_code ignored;
  if (std::filesystem::equivalent(out, arguments.dataset.folder, ignored))
    throw InputError("--out: this is the data set itself; give another folder");
  std::vector<Sequence> sequences;
  std::unique_ptr<ListedPairs> listed;
  std::vector<std::string> notes;
  if (layout->read) {
    sequences = layout->read(arguments.dataset);
    for (const Sequence& sequence : sequences) notes.push_back(sequence.note);
  } else {
    listed = layout->open(arguments.dataset);
    notes.push_back(listed->Note());
  }
  PairJournal journal(out, DescribePairsIdentity(arguments));
  if (journal.num_before() > 0) PrintMessage("continues after {} pairs in {}\n", journal.num_before(), out);
  if (listed) {
    MakeListedPairs(*listed, arguments.pairs, &journal);
  } else {
    MakePairsOfImages(sequences, arguments.pairs, &journal);
  }
  PrintResult(WritePairTables(journal, notes, out), arguments.format);
  const bool is_any_kept =
      std::ranges::any_of(journal.rows(), [](const PairRow& row) { return row.reason == kKeptPair; });
  if (!is_any_kept)
    throw InputError(fmt::format("{} ({}/INDEX.csv lists them; --gate off keeps all pairs)",
                                 DescribeWhyNone(journal.rows(), journal.damaged()), out));
  PrintMessage("match files and INDEX.csv -> {}; next: {}\n", out, NameNextCommand(journal.rows(), out));
}

void AddDatasetOptions(CLI::App* command, PairsArguments* arguments) {
  command
      ->add_option("dataset", arguments->dataset.folder,
                   "the data set's folder (colmap: or its database; posebench: a file)")
      ->required();
  command->add_option("--layout", arguments->layout, "layout of the data set, see below")
      ->check(MakeChoiceValidator(ListNames(kLayouts)))
      ->required();
  command
      ->add_option("-o,--out", arguments->pairs.out,
                   "folder for match files, INDEX.csv and pairs.txt; an unfinished one is continued")
      ->required();
  AddFormatOption(command, &arguments->format);
  command
      ->add_option("--sequence", arguments->dataset.only,
                   "kitti, euroc, tum: name of a sequence's folder, repeatable; default: all")
      ->allow_extra_args(false);
  command
      ->add_option("--max-frames", arguments->dataset.max_frames,
                   "only the first images of each sequence; 0: all")
      ->transform(WholeNumberIn(0, 100'000'000));
  command->add_option("--name", arguments->dataset.name,
                      "scene of the pairs (images, colmap, npz), or prefix of the sequence's name (KITTI/)");
  command
      ->add_option("--K", arguments->dataset.K,
                   "images, npz, tum: fx fy cx cy in px, where (0, 0) is the centre of the first pixel")
      ->transform(NumberIn())
      ->expected(4);
  command->add_option("--lens", arguments->lens, "images, npz, tum: the distortion of --K; default: pinhole")
      ->check(MakeChoiceValidator({"pinhole", "radtan", "fisheye"}));
  command
      ->add_option("--distortion", arguments->dataset.distortion,
                   "coefficients in OpenCV's order: radtan k1 k2 p1 p2 [k3 [k4 k5 k6]], fisheye k1 k2 k3 k4")
      ->transform(NumberIn())
      ->expected(4, 8);
  command->add_option("--model", arguments->dataset.model,
                      "colmap: reconstruction whose poses are the truth; default: sparse/0 if present");
  command
      ->add_option(
          "--truth-sd", arguments->truth_sd,
          "standard deviations of the data set's poses per axis: in degrees, and in its unit of length")
      ->transform(NumberIn({0.0, 1e6}))
      ->expected(2);
}

void AddGateOptions(CLI::App* command, PairsArguments* arguments) {
  KeyFrameGate& gate = arguments->pairs.gate;
  command
      ->add_option("--gate", arguments->gate,
                   "test that pairs must pass; off keeps all pairs; default: orb_slam2")
      ->check(MakeChoiceValidator(GateNames()));
  command->add_option("--least-matches", gate.least_matches, "gate: least number of matches")
      ->transform(WholeNumberIn(8, 1'000'000))
      ->capture_default_str();
  command
      ->add_option("--least-parallax", gate.least_parallax_deg,
                   "gate: least parallax of the 50th match, degrees")
      ->transform(NumberIn({0.0, 90.0}))
      ->capture_default_str();
  command->add_option("--sigma", gate.sigma_px, "gate: noise it assumes, px")
      ->transform(NumberIn({0.01, 100.0}))
      ->capture_default_str();
  command->add_option("--every", arguments->pairs.every, "use every n-th image")
      ->transform(WholeNumberIn(1, 1'000'000))
      ->capture_default_str();
  command
      ->add_option("--neighbours", arguments->pairs.neighbours,
                   "pair each key frame with this many before it; 2 gives `rcme validate` triples")
      ->transform(WholeNumberIn(1, 100))
      ->capture_default_str();
  command
      ->add_option("--window", arguments->pairs.window,
                   "pair every image, key frame or not, with each of so many before it; 0: off")
      ->transform(WholeNumberIn(0, 100))
      ->capture_default_str();
}

}  // namespace

void AddPairsCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("pairs", "Turn a data set of images into a folder of match files for studies");
  command->footer(R"(Layouts, as downloaded:
  kitti      KITTI odometry, grey: dataset/sequences/NN/{image_0/*.png, calib.txt,
             times.txt} and dataset/poses/NN.txt
  euroc      EuRoC MAV: NAME/mav0/cam0/{data.csv, data/*.png, sensor.yaml} and
             NAME/mav0/state_groundtruth_estimate0/data.csv
  tum        TUM RGB-D: NAME/{rgb.txt, rgb/*.png, groundtruth.txt}; the camera follows
             from freiburg1, 2 or 3 in the name, or from --K
  images     *.png, *.jpg, ... of one folder, by name; needs --K, and skips images of
             another size
  colmap     database.db {cameras, images, keypoints, matches}; sparse/0, if present,
             gives the truth and the cameras
  posebench  FILE.h5, a group per pair {x1, x2, R, t, camera1, camera2}
  npz        *.npz of learned features, one a pair: keypoints0, keypoints1, matches [n0]
             (-1: none) and match_confidence or matching_scores, or matches [m, 2] and
             scores; needs --K, of both cameras
  matches    match files, tested by the gate and indexed again

Pairs are chosen as the initialiser of ORB-SLAM2 chooses them, which the paper used. An
image waits as the first of a pair until a later image makes a pair with it that passes
the gate; then the later image waits. The gate drops pairs with too_few_matches,
planar_scene, rotation_only, too_little_parallax or too_few_in_front (of both cameras),
and pairs that no model explains (not_better_than_chance, ...). INDEX.csv lists all
pairs, kept or not, with the names of their images. If the layout has ground truth, the
match files state it; the gate does not use it.

Damaged images are skipped and named. Anything missing or contradictory ends the command
with its path and exit code 2, and so does a folder of which no pair is kept. A K that
does not fit the size of the images gives a warning. Images of more than 4096 x 4096 px
are scaled down to find key points; the key points are in the original pixels. Key points
are undistorted. Each match has a column sigma_px: its noise relative to the other
matches, from the sizes of its key points.

If the command is cut off, run it again to continue. --cache keeps features (1 MB per
image), so that you can try other options of the gate.

Examples:
  rcme pairs dataset --layout kitti --name KITTI/ --out kitti_pairs
  rcme pairs MH_01_easy --layout euroc --detector orb --out euroc_pairs
  rcme pairs corridor --layout images --K 520 520 320 240 --lens radtan \
      --distortion -0.2 0.1 0 0 --out pairs
  rcme pairs project/database.db --layout colmap --gate off --out colmap_pairs)");
  auto arguments = std::make_shared<PairsArguments>();
  AddDatasetOptions(command, arguments.get());
  AddFrontEndOptions(command, &arguments->pairs.detector, &arguments->pairs.matcher,
                     &arguments->pairs.has_scores);
  command->add_option("--cache", arguments->pairs.cache,
                      "folder for features, which are found again by the content of the image");
  AddGateOptions(command, arguments.get());
  command->callback([arguments] { RunPairs(*arguments); });
}

}  // namespace rcme
