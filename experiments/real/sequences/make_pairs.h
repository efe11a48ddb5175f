// From a data set to a folder of match files: every image is read once, features are kept of few, and each
// pair is written before it is entered in the journal (pair_index.h), so that work that was cut off goes on
// where it was.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/real/images/feature_cache.h"
#include "experiments/real/sequences/key_frame_gate.h"
#include "experiments/real/sequences/listed_pairs.h"
#include "experiments/real/sequences/pair_index.h"
#include "experiments/real/sequences/sequence.h"

namespace rcme {

struct PairsOptions {
  std::string out, cache;
  DetectorOptions detector;
  MatcherOptions matcher;
  KeyFrameGate gate;
  bool has_scores = false;  // match files get the ratio of distances of each match
  int every = 1;            // of the images every n-th
  int neighbours = 1;       // pairs of a key frame with that many before it
  int window = 0;           // pairs of every image with that many before it; 0: of key frames
  std::optional<PoseSd> truth_sd;
};

// The pairs of image sequences. As in ORB-SLAM2 an image waits as the first of a pair until a later one makes
// a pair with it that the gate keeps; that one then waits in its place. An image that too few matches join to
// the one that waits takes its place too. Without a criterion every image makes a pair with the one before.
// With a window every image makes a pair with each of the last `window` images that can be read, and the gate
// judges each pair by itself.
// Throws InputError, and Stopped when that is requested.
void MakePairsOfImages(const std::vector<Sequence>& sequences, const PairsOptions& options,
                       PairJournal* journal);

// The pairs that a data set lists, each judged by itself.
void MakeListedPairs(ListedPairs& pairs, const PairsOptions& options, PairJournal* journal);

// INDEX.csv and pairs.txt of the folder, whole; returns both.
CommandResult WritePairTables(const PairJournal& journal, const std::vector<std::string>& notes,
                              const std::string& out);

}  // namespace rcme
