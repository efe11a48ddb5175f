#include <fstream>

#include "experiments/statistics/summary_output.h"
#include "experiments/core/files/scratch_folder.h"
#include "experiments/run/run_study.h"
#include "experiments/study/study_file.h"
#include "tests/fuzz/harness/only_input_error.h"

namespace rcme {
namespace {

// A sound result file of two estimators and eight trials, made once.
std::string SoundFile(const std::string& path) {
  const StudyPlan plan =
      MakePlan(ParseStudy("trials: 4\n"
                          "data: {scene: uniform_volume, num_matches: 30}\n"
                          "factors: {outlier_ratio: [0, 0.2]}\n"
                          "estimators: [{name: standard, options: {num_iterations: 5}}, {name: rcme, "
                          "options: {num_iterations: 5}}]\n",
                          "sound.yaml"));
  {
    ResultStore store = ResultStore::OpenForRun(path, plan);
    RunStudy(plan, 1, &store);
  }
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Each three bytes of `data` are a place (of 65,536) and what stands there from then on.
std::string Changed(std::string bytes, const std::uint8_t* data, size_t size) {
  for (size_t i = 0; i + 3 <= size; i += 3) {
    const size_t place = data[i] * size_t{256} + data[i + 1];
    bytes[place * bytes.size() / 65'536] = static_cast<char>(data[i + 2]);
  }
  return bytes;
}

}  // namespace
}  // namespace rcme

// A result file of which some bytes have changed: opened, summarized, its study made ready to run.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size) {
  using namespace rcme;
  static const ScratchFolder folder;
  static const std::string path = folder.path() + "/run.sqlite";
  static const std::string sound = SoundFile(folder.path() + "/sound.sqlite");
  std::ofstream(path, std::ios::binary) << Changed(sound, data, size);
  return OnlyInputError([&] {
    const ResultStore store = ResultStore::OpenForReading(path);
    SummaryAsJson(Summarize(store, /*with_times=*/true));
    store.Plan();
  });
}
