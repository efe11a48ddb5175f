// From the settings of a condition to where its matches come from.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "experiments/data/data_source.h"
#include "experiments/data/settings.h"
#include "experiments/data/simulated_data.h"

namespace rcme {

// One data source, or several: a folder of real pairs makes one per scene it holds, with the level that names
// it.
struct DataSources {
  std::string implied_factor;  // name of the factor that tells the sources apart; empty: there is only one
  std::vector<std::pair<std::string, std::shared_ptr<const DataSource>>> sources;  // level, source
};

// When the baseline is found that gives a parallax, which takes some hundred scenes.
enum class BaselineSearch { kNow, kWithFirstScene };

// The sources for the settings of a condition, `scene` among them. Throws InputError that names key and
// value.
DataSources MakeDataSources(const Settings& settings, BaselineSearch search = BaselineSearch::kNow);

// Every parameter of the scene with its value, `scene` first. Throws InputError that names key and value.
Settings ResolveSettings(const Settings& settings);

// Those of the resolved settings that are not at their defaults, `scene` and the other choices first; with
// `of_scene` those that shape the scene alone, without noise, outliers and assumed calibration. Equal for two
// data blocks that mean the same. Not among them: where a folder lies, and what is only measured.
Settings DistinctiveSettings(const Settings& settings, bool of_scene);

// The keys of a `data:` block that choose a part of the simulation by name; the choice decides which other
// keys there are.
bool IsChoice(const std::string& key);

// " (needs cameras: pinhole)": the choices that bring a key, for messages about one that is not there; empty:
// none does.
std::string ChoicesWith(const std::string& key);

// Every key a `data:` block with these settings may hold, with its value.
std::vector<SettingHelp> DescribeSettings(const Settings& settings);

// The key that names a list of pairs whose truth is in doubt (truth_doubts.h); without it no text of a study
// has it.
inline constexpr const char* kTruthInDoubtKey = "truth_in_doubt";

// The scene name that stands for a folder of match files.
inline constexpr const char* kMatchFilesScene = "match_files";

// Simulated data for the settings, `scene` among them. Throws InputError that names key and value.
std::shared_ptr<const SimulatedData> MakeSimulatedData(const Settings& settings,
                                                       BaselineSearch search = BaselineSearch::kNow);

}  // namespace rcme
