// Damaged result files as a user meets them: every command refuses, `rcme check` says what is wrong and saves
// the rest, `rcme run` completes it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using testing::Not;

class Check : public testing::Test {
 protected:
  Check() {
    EXPECT_EQ(RunRcme({"run", study_, "--out", run_, "--trials", "40", "--threads", "1"}).exit_code, 0);
    csv_ = Csv(run_);
  }
  static std::string Csv(const std::string& run) {
    return RunRcme({"summarize", run, "--format", "csv"}).out;
  }

  TempFolder folder_;
  std::string study_ = folder_.Write("small.yaml", SmallStudyYaml());
  std::string run_ = folder_.Path("run.sqlite"), saved_ = folder_.Path("saved.sqlite"), csv_;
};

TEST_F(Check, ASoundFileIsSavedAsAWhole) {
  const ProgramResult saved = RunRcme({"check", run_, "--save-good", saved_});
  EXPECT_EQ(saved.exit_code, 0) << saved.err;
  EXPECT_THAT(saved.out, HasSubstr("all 80 trials saved"));
  EXPECT_EQ(Csv(saved_), csv_);
  EXPECT_EQ(RunRcme({"check", run_, "--save-good", run_}).exit_code, 2) << "replaced the file itself";
}

TEST_F(Check, EveryCommandRefusesADamagedFile) {
  std::string bytes = ReadBytes(run_);
  bytes[bytes.size() - 100] = static_cast<char>(bytes[bytes.size() - 100] ^ 1);  // in the last record written
  folder_.Write("run.sqlite", bytes);
  for (std::vector<std::string> command :
       std::vector<std::vector<std::string>>{{"summarize", run_},
                                             {"summarize", run_, "--raw", "csv"},
                                             {"summarize", run_, "--fifths-of", "planarity"},
                                             {"reliability", run_},
                                             {"compare", run_},
                                             {"report", run_, "--out", folder_.Path("page.html")},
                                             // not in the file, or lost
                                             {"replay", run_, "--condition", "0", "--trial", "1000"},
                                             {"run", study_, "--out", run_},
                                             {"run", study_, "--out", run_, "--until", "ci=0.3"},
                                             {"check", run_}}) {
    const ProgramResult result = RunRcme(command);
    EXPECT_EQ(result.exit_code, 2) << command[0] << ": " << result.err;
    EXPECT_THAT(result.err, HasSubstr(run_)) << command[0];
    EXPECT_THAT(result.err, HasSubstr("damaged")) << command[0];
    EXPECT_THAT(result.err, HasSubstr("rcme check")) << command[0];
    if (command[0] != "check") {
      EXPECT_EQ(result.out, "") << command[0];
    }
  }
  EXPECT_EQ(ReadBytes(run_), bytes) << "a refusal changed the file";
  EXPECT_FALSE(std::filesystem::exists(folder_.Path("page.html")));
}

// SQLite reads no page of a file that is shorter than its beginning says.
TEST_F(Check, SaysThatNothingCanBeSavedOfATruncatedFile) {
  const std::string bytes = ReadBytes(run_);
  folder_.Write("run.sqlite", bytes.substr(0, bytes.size() / 2));
  const ProgramResult found = RunRcme({"check", run_});
  EXPECT_EQ(found.exit_code, 2);
  EXPECT_THAT(found.err, HasSubstr("is damaged"));
  EXPECT_THAT(found.err, HasSubstr("no trial can be saved from it"));
  EXPECT_THAT(found.err, Not(HasSubstr("says what can be saved")));
}

TEST_F(Check, SavesWhatIsSoundAndTheRunIsCompleted) {
  {
    const ProgramResult sound = RunRcme({"check", run_});
    EXPECT_EQ(sound.exit_code, 0) << sound.err;
    EXPECT_THAT(sound.out, HasSubstr("sound: 80 trials"));
    EXPECT_THAT(sound.out, HasSubstr("rcme "));
  }
  std::string bytes = ReadBytes(run_);
  const size_t page = bytes.size() - 4096;  // a leaf of the records
  bytes.replace(page, 4096, 4096, '\0');
  folder_.Write("run.sqlite", bytes);
  const ProgramResult found = RunRcme({"check", run_});
  EXPECT_EQ(found.exit_code, 2);
  EXPECT_THAT(found.out, HasSubstr("trials are sound"));
  EXPECT_THAT(found.out, HasSubstr("damaged, lost or not run"));
  EXPECT_THAT(found.out, HasSubstr("--save-good"));
  const ProgramResult saved = RunRcme({"check", run_, "--save-good", saved_});
  EXPECT_EQ(saved.exit_code, 0) << saved.err;
  EXPECT_EQ(RunRcme({"check", run_, "--save-good", saved_}).exit_code, 2) << "replaced a file";
  EXPECT_EQ(RunRcme({"check", saved_}).exit_code, 0);
  const ProgramResult completed = RunRcme({"run", study_, "--out", saved_, "--trials", "40"});
  EXPECT_EQ(completed.exit_code, 0) << completed.err;
  EXPECT_THAT(completed.err, Not(HasSubstr("(0 were there already)")));
  EXPECT_EQ(Csv(saved_), csv_);
}

// The way out is named at once, and every command that is printed reads the study from where it is sound.
TEST_F(Check, ADamagedStudyIsReplacedByItsOwnFile) {
  std::string bytes = ReadBytes(run_);
  for (size_t at = bytes.find("uniform_volume"); at != std::string::npos;
       at = bytes.find("uniform_volume", at + 1)) {
    bytes[at] = static_cast<char>(0x96);
  }
  folder_.Write("run.sqlite", bytes);
  const ProgramResult found = RunRcme({"check", run_});
  EXPECT_EQ(found.exit_code, 2);
  EXPECT_THAT(found.err, HasSubstr("the study stored in it cannot be read"));
  EXPECT_THAT(found.err, HasSubstr("rcme check " + run_ + " --study STUDY.yaml"));
  EXPECT_THAT(found.err, Not(HasSubstr("UTF-8")));
  const ProgramResult read = RunRcme({"check", run_, "--study", study_, "--seed", "3"});
  EXPECT_EQ(read.exit_code, 2);
  const std::string save = "rcme check " + run_ + " --study " + study_ + " --seed 3 --save-good NEW.sqlite";
  EXPECT_THAT(read.out, HasSubstr("80 trials are sound"));
  EXPECT_THAT(read.out, HasSubstr("Next: " + save));
  EXPECT_THAT(read.err, HasSubstr(save));
}

TEST_F(Check, AnotherInstructionSetIsWarnedOf) {
  {
    ResultStore store = ResultStore::OpenForRun(run_, MakePlan(SmallStudy()));
    store.NoteOrigin({ThisProgram().program, "abacus"});
  }
  const ProgramResult more = RunRcme({"run", study_, "--out", run_, "--trials", "41"});
  EXPECT_EQ(more.exit_code, 0) << more.err;
  EXPECT_THAT(more.err, HasSubstr("warning: " + run_));
  EXPECT_THAT(more.err, HasSubstr("abacus"));
  EXPECT_THAT(more.err, HasSubstr(ThisProgram().instruction_set));
  EXPECT_THAT(RunRcme({"check", run_}).out, HasSubstr(ThisProgram().instruction_set + ", abacus"));
  EXPECT_THAT(RunRcme({"run", study_, "--out", run_}).err, Not(HasSubstr("warning"))) << "nothing was run";
}

}  // namespace
}  // namespace rcme
