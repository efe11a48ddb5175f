#include "experiments/study/study_lock.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <map>
#include <set>

#include "experiments/core/files/sha256.h"
#include "experiments/core/files/yaml_input.h"
#include "experiments/core/text/program_name.h"
#include "experiments/data/make_data.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"
#include "parameters/settings.h"
#include "parameters/text_lines.h"

namespace rcme {
namespace {

constexpr const char* kLockFormat = "rcme lock 1";
constexpr const char* kTextLine = "text: |2";      // the following lines begin with two blanks
constexpr size_t kMaxLockBytes = size_t{1} << 20;  // as much as ParseYaml accepts, so any study fits
constexpr size_t kMaxLockLine = 200;               // of the lines before the text

const FileKind& LockFileKind() {
  static const FileKind kind = {"lock file", "a lock"};
  return kind;
}

// Returns the lines of an identity with the digests of real pairs.
std::vector<std::string> DigestsIn(const std::string& text, bool is_of_real_pairs) {
  std::vector<std::string> lines = is_of_real_pairs ? SplitText(text, '\n') : std::vector<std::string>();
  std::erase_if(lines, [](const std::string& line) { return !line.starts_with("# condition "); });
  return lines;
}

bool HasRealPairs(const YAML::Node& study) {
  const YAML::Node data = study["data"];
  return data && data.IsMap() && data["scene"] && data["scene"].IsScalar() &&
         data["scene"].Scalar() == kMatchFilesScene;
}

// Flattens the text of a study to (path of the key, value), in order. The parts of estimators have their
// label in the path.
void Flatten(const YAML::Node& node, const std::string& path, Settings* flat) {
  const std::string prefix = path.empty() ? "" : path + ".";
  if (node.IsMap()) {
    for (const auto& entry : node) Flatten(entry.second, prefix + entry.first.Scalar(), flat);
  } else if (node.IsSequence() && node.size() > 0 && node[0].IsMap()) {
    for (size_t i = 0; i < node.size(); ++i) {
      const YAML::Node label = node[i]["label"];
      Flatten(node[i], prefix + (label ? label.Scalar() : fmt::format("{}", i + 1)), flat);
    }
  } else if (node.IsSequence()) {
    std::vector<std::string> items;
    for (const YAML::Node& item : node) items.push_back(item.IsScalar() ? item.Scalar() : YAML::Dump(item));
    flat->emplace_back(path, fmt::format("[{}]", fmt::join(items, ", ")));
  } else {
    flat->emplace_back(path, node.IsScalar() ? node.Scalar() : "");
  }
}

std::vector<std::string> LabelsIn(const YAML::Node& study) {
  std::vector<std::string> labels;
  for (const YAML::Node& estimator : study["estimators"]) labels.push_back(estimator["label"].Scalar());
  return labels;
}

// Omits the estimators with these labels, and the folder.
Settings FlatStudy(const YAML::Node& study, const std::vector<std::string>& without) {
  const std::set<std::string> left_out(without.begin(), without.end());
  Settings flat;
  for (const auto& entry : study) {
    const std::string key = entry.first.Scalar();
    if (key != "estimators") Flatten(entry.second, key, &flat);
  }
  for (const YAML::Node& estimator : study["estimators"]) {
    const std::string label = estimator["label"].Scalar();
    if (!left_out.contains(label)) Flatten(estimator, "estimators." + label, &flat);
  }
  std::erase_if(flat, [](const auto& entry) { return entry.first == "data.folder"; });
  return flat;
}

// Returns the elements of one list that the other lacks.
std::vector<std::string> OnlyIn(const std::vector<std::string>& one, const std::vector<std::string>& other) {
  const std::set<std::string> known(other.begin(), other.end());
  std::vector<std::string> only;
  for (const std::string& text : one) {
    if (!known.contains(text)) only.push_back(text);
  }
  return only;
}

// Compares the values key by key. A key that occurs twice, which ToYaml never writes, is a difference.
std::map<std::string, std::string> ByKey(const Settings& flat, std::vector<std::string>* differences) {
  std::map<std::string, std::string> values;
  for (const auto& [path, value] : flat) {
    if (!values.emplace(path, value).second) differences->push_back(path + ": stands twice");
  }
  return values;
}

std::vector<std::string> ListStudyDifferences(const YAML::Node& locked, const YAML::Node& run) {
  const std::vector<std::string> added = OnlyIn(LabelsIn(run), LabelsIn(locked));
  const std::vector<std::string> gone = OnlyIn(LabelsIn(locked), LabelsIn(run));
  const Settings before = FlatStudy(locked, gone), after = FlatStudy(run, added);
  std::vector<std::string> differences;
  const std::map<std::string, std::string> locked_values = ByKey(before, &differences);
  const std::map<std::string, std::string> run_values = ByKey(after, &differences);
  for (const auto& [path, value] : after) {
    const auto found = locked_values.find(path);
    if (found == locked_values.end()) {
      differences.push_back(fmt::format("{}: {}, of which the lock says nothing", path, value));
    } else if (found->second != value) {
      differences.push_back(fmt::format("{}: {} instead of {}", path, value, found->second));
    }
  }
  for (const auto& [path, value] : before) {
    if (!run_values.contains(path))
      differences.push_back(fmt::format("{}: left out; the lock says {}", path, value));
  }
  for (const std::string& label : added) differences.push_back(fmt::format("estimator {}: was added", label));
  for (const std::string& label : gone)
    differences.push_back(fmt::format("estimator {}: was left out", label));
  // No text of a lock may act on a terminal or begin a further line, whoever wrote the lock.
  for (std::string& difference : differences) difference = Printable(difference);
  return differences;
}

std::string TextToLock(const StudyPlan& plan) {
  Study study = plan.study;
  const bool is_of_real_pairs = FindSetting(study.data, "scene") == kMatchFilesScene;
  std::erase_if(study.data, [](const auto& setting) {
    return setting.first == "folder" || setting.first == kTruthInDoubtKey;
  });
  std::string text = ToYaml(study);
  for (const std::string& line : DigestsIn(plan.identity, is_of_real_pairs)) text += line + "\n";
  return text;
}

std::string Now() {
  const auto now = std::chrono::time_point_cast<std::chrono::seconds>(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(now)));
}

}  // namespace

StudyLock MakeLock(const StudyPlan& plan) {
  StudyLock lock{Now(), ProgramName(), "", TextToLock(plan)};
  lock.sha256 = Sha256(lock.text);
  return lock;
}

std::string ToYaml(const StudyLock& lock) {
  std::string yaml = fmt::format(
      "# Made by `rcme lock`. `rcme run` refuses a study that says something else.\n"
      "format: {}\nlocked_at: {}\nprogram: {}\nsha256: {}\n{}\n",
      kLockFormat, lock.locked_at, lock.program, lock.sha256, kTextLine);
  for (const std::string& line : SplitText(lock.text, '\n')) yaml += line.empty() ? "\n" : "  " + line + "\n";
  return yaml;
}

StudyLock ParseLock(const std::string& yaml, const std::string& path) {
  if (yaml.size() > kMaxLockBytes)
    throw InputError(
        fmt::format("{}: is too long for a lock; at most {} bytes are allowed", path, kMaxLockBytes));
  if (const size_t at = FindNotPlain(yaml); at != std::string::npos)
    throw InputError(fmt::format("{}: a lock is UTF-8 without control characters", path));
  StudyLock lock;
  std::string format;
  const std::map<std::string, std::string*> fields = {{"format", &format},
                                                      {"locked_at", &lock.locked_at},
                                                      {"program", &lock.program},
                                                      {"sha256", &lock.sha256}};
  bool is_in_text = false;
  const std::vector<std::string> lines = SplitText(yaml, '\n');
  for (size_t i = 0; i < lines.size(); ++i) {
    const std::string& line = lines[i];
    const auto field = fields.find(line.substr(0, line.find(": ")));
    if (is_in_text && (line.empty() || line.starts_with("  "))) {
      lock.text += (line.empty() ? "" : line.substr(2)) + "\n";
    } else if (!is_in_text && field != fields.end() && line.size() < kMaxLockLine) {
      if (!field->second->empty())
        throw InputError(fmt::format("{}:{}: {} stands twice", path, i + 1, field->first));
      *field->second = line.substr(std::min(line.size(), field->first.size() + 2));
    } else if (!is_in_text && line == kTextLine) {
      is_in_text = true;
    } else if (is_in_text || !line.starts_with("#")) {
      throw InputError(fmt::format("{}:{}: {} is no line of a lock that `rcme lock` made", path, i + 1,
                                   Quoted(line.substr(0, kMaxLockLine))));
    }
  }
  if (format != kLockFormat)
    throw InputError(
        fmt::format("{}: format: {} is not allowed; this is no lock that `rcme lock` made ('{}')", path,
                    Quoted(format), kLockFormat));
  for (const auto& [key, value] : fields) {
    if (value->empty()) throw InputError(fmt::format("{}: {} is missing", path, key));
  }
  if (lock.text.empty()) throw InputError(fmt::format("{}: text is missing: it locks nothing", path));
  const std::string sha256 = Sha256(lock.text);
  if (sha256 != lock.sha256) {
    throw InputError(
        fmt::format("{}: sha256: its text has the hash {}, not {}: the lock was changed after it was made",
                    path, sha256, Quoted(lock.sha256)));
  }
  return lock;
}

std::string ReadLockFile(const std::string& path) { return ReadInputText(path, LockFileKind()); }

std::string PathOfLockBeside(const std::string& study_path) {
  return std::filesystem::path(study_path).replace_extension(".lock").string();
}

std::string DescribeLock(const std::string& lock_yaml) {
  for (const std::string& line : SplitText(lock_yaml, '\n')) {
    if (line.starts_with("sha256: ")) return "with the lock " + line.substr(8, 8);
  }
  return "without a lock";
}

std::string JoinReasons(const std::string& reasons, const std::string& more) {
  std::vector<std::string> lines;
  std::set<std::string> known;
  for (const std::string& line : SplitText(reasons + "\n" + more, '\n')) {
    if (!line.empty() && known.insert(line).second) lines.push_back(line);
  }
  return fmt::format("{}", fmt::join(lines, "\n"));
}

std::vector<std::string> DeviationsFrom(const StudyLock& lock, const std::string& study_yaml,
                                        const std::string& identity, const std::string& stopping_rule) {
  const YAML::Node locked = ParseYaml(lock.text, "the locked text", LockFileKind());
  const YAML::Node run = ParseYaml(study_yaml, "the study", LockFileKind());
  std::vector<std::string> deviations;
  try {
    deviations = ListStudyDifferences(locked, run);
  } catch (const YAML::Exception&) {
    return {"the study: is not one that this program can compare with the lock"};
  }
  if (DigestsIn(lock.text, HasRealPairs(locked)) != DigestsIn(identity, HasRealPairs(run)))
    deviations.emplace_back("the pairs: are others than those that were locked");
  if (!stopping_rule.empty())
    deviations.push_back(fmt::format("trials: as many as a stopping rule gave ({})", stopping_rule));
  return deviations;
}

WrittenPlan ReadWrittenPlan(const std::string& study_yaml, const std::string& path) {
  const Place place(path);
  const YAML::Node root = ParseYaml(study_yaml, path, LockFileKind());
  WrittenPlan plan;
  StatableNames names;
  try {
    long long trials = 0;
    if (!ParseInteger(root["trials"].Scalar(), &trials) || trials < 1 ||
        trials > std::numeric_limits<int>::max())
      throw InputError(fmt::format("{}: trials: a whole number is needed", path));
    plan.trials = static_cast<int>(trials);
    names.estimators = LabelsIn(root);
    for (const auto& factor : root["factors"])
      names.factors.emplace_back(Line(place, factor.first, "factors"),
                                 factor.second.as<std::vector<std::string>>());
  } catch (const YAML::Exception& error) {
    throw InputError(fmt::format("{}: is no study: {}", path, error.what()));
  }
  if (root["hypotheses"]) plan.hypotheses = ReadHypotheses(place, root["hypotheses"], names);
  return plan;
}

}  // namespace rcme
