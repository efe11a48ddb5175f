// Converts a data set to a folder of match files. Every image is read once, and few images' features are
// kept in memory. The file of a pair is written before its entry in the journal (pair_index.h), so
// interrupted work can be continued.
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
  int every = 1;            // use every n-th image
  int neighbours = 1;       // pair each key frame with this many key frames before it
  int window = 0;           // pair each image with this many before it; 0: pair key frames
  std::optional<PoseSd> truth_sd;
};

// Makes the pairs of image sequences. As in ORB-SLAM2, an image waits as the first of a pair until a later
// image makes a pair with it that the gate keeps; that image then waits instead. If too few matches join a
// later image to the waiting one, it also takes its place. Without a criterion every image makes a pair with
// the one before. With a window every image makes a pair with each of the last `window` readable images, and
// the gate judges each pair separately. Throws InputError, and Stopped after a stop request.
void MakePairsOfImages(const std::vector<Sequence>& sequences, const PairsOptions& options,
                       PairJournal* journal);

// Makes the pairs that a data set lists; each is judged separately.
void MakeListedPairs(ListedPairs& pairs, const PairsOptions& options, PairJournal* journal);

// Writes INDEX.csv and pairs.txt of the folder, each completely or not at all, and returns both.
CommandResult WritePairTables(const PairJournal& journal, const std::vector<std::string>& notes,
                              const std::string& out);

}  // namespace rcme
