// Makes the data source of a condition from its settings.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "experiments/data/data_source.h"
#include "experiments/data/settings.h"
#include "experiments/data/simulated_data.h"

namespace rcme {

// One data source, or several: a folder of real pairs makes one for each scene in it, with the level that
// names it.
struct DataSources {
  std::string implied_factor;  // factor that distinguishes the sources; empty: there is only one
  std::vector<std::pair<std::string, std::shared_ptr<const DataSource>>> sources;  // (level, source)
};

// When to search the baseline for a given parallax, which takes some hundred scenes.
enum class BaselineTiming { kNow, kWithFirstScene };

// Makes the sources for the settings of a condition, which include `scene`. Throws InputError that names key
// and value.
DataSources MakeDataSources(const Settings& settings, BaselineTiming search = BaselineTiming::kNow);

// Returns the choices, `scene` first, and every parameter with its value. Throws InputError that names key
// and value.
Settings ResolveSettings(const Settings& settings);

// Returns the choices, `scene` first, and those resolved settings that are not at their defaults; with
// `of_scene`, only settings that shape the scene, without noise, outliers and assumed calibration. The
// result is equal for equivalent data blocks. It omits the path of a folder and settings that only concern
// measurements.
Settings DistinctiveSettings(const Settings& settings, bool of_scene);

// Returns whether a key of a `data:` block chooses a part of the simulation by name. Such a choice
// determines which other keys exist.
bool IsChoice(const std::string& key);

// Returns the choices that have a key, for messages about an unknown key: " (needs cameras: pinhole)". Empty
// if no choice has it.
std::string ChoicesWith(const std::string& key);

// Returns every key that a `data:` block with these settings may have, with its value.
std::vector<SettingHelp> DescribeSettings(const Settings& settings);

// The key that names a list of pairs whose truth is in doubt (truth_doubts.h). Texts of studies have it only
// if it is set.
inline constexpr const char* kTruthInDoubtKey = "truth_in_doubt";
// Keys of match files that resolved settings have only if they are given.
inline constexpr const char* kGivenPairKeys[] = {"sigma_px", kTruthInDoubtKey};

// The scene name for a folder of match files.
inline constexpr const char* kMatchFilesScene = "match_files";

// Makes simulated data for the settings, which include `scene`. Throws InputError that names key and value.
std::shared_ptr<const SimulatedData> MakeSimulatedData(const Settings& settings,
                                                       BaselineTiming search = BaselineTiming::kNow);

}  // namespace rcme
