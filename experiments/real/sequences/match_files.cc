#include "experiments/data/match_folder.h"
#include "experiments/real/sequences/listed_pairs.h"

namespace rcme {
namespace {

class MatchFilePairs : public ListedPairs {
 public:
  explicit MatchFilePairs(const std::string& folder)
      : paths_(MatchFilesIn(folder)), weak_(PairsWithWeakDirection(folder, paths_)) {}

  size_t size() const override { return paths_.size(); }
  std::string PairId(size_t i) const override { return ExtractPairId(paths_.at(i)); }
  std::filesystem::path Source(size_t i) const override { return paths_.at(i); }
  ListedPair Read(size_t i) override {
    ListedPair listed;
    listed.file = ReadMatchFile(paths_.at(i).string());
    listed.baseline = listed.file.baseline;
    listed.is_direction_weak = weak_.contains(PairId(i));
    return listed;
  }

 private:
  std::vector<std::filesystem::path> paths_;
  std::set<std::string> weak_;
};

}  // namespace

std::unique_ptr<ListedPairs> OpenMatchFiles(const DatasetOptions& options) {
  return std::make_unique<MatchFilePairs>(options.folder);
}

}  // namespace rcme
