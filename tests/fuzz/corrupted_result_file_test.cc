// Result files of which bytes were changed: cut off, pages lost, journals left over, random hits. The seeds
// of everything random are 1 and 2.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>

#include "tests/fuzz/damaged_result_file.h"

namespace rcme {
namespace {

using CorruptedResultFile = DamagedResultFile;

// The last page may be cut where nothing stands in it.
TEST_F(CorruptedResultFile, CutOffAnywhere) {
  int num_refused = 0, num_same = 0;
  for (size_t size = 300; size < bytes_->size(); size += 509) {
    const std::string what = fmt::format("{} of {} bytes", size, bytes_->size());
    Write(bytes_->substr(0, size));
    const FileOutcome outcome = Read(what);
    EXPECT_EQ(Resume(what), outcome) << what;
    EXPECT_TRUE(outcome == FileOutcome::kRefused || size + kPage > bytes_->size()) << what;
    (outcome == FileOutcome::kRefused ? num_refused : num_same) += 1;
  }
  fmt::print("{} lengths: {} refused, {} cut unused space\n", num_refused + num_same, num_refused, num_same);
}

TEST_F(CorruptedResultFile, PagesZeroedAndSwapped) {
  const size_t num_pages = bytes_->size() / kPage;
  ASSERT_EQ(bytes_->size() % kPage, 0u);
  for (size_t page = 0; page < num_pages; ++page) {
    std::string zeroed = *bytes_, doubled = *bytes_;
    std::fill_n(zeroed.begin() + static_cast<std::ptrdiff_t>(page * kPage), kPage, '\0');
    Write(zeroed);
    ExpectRefused(fmt::format("page {} zeroed", page));
    doubled.replace(page * kPage, kPage, *bytes_, (page + 1) % num_pages * kPage, kPage);
    if (doubled == *bytes_) continue;  // two tables without a row
    Write(doubled);
    ExpectRefused(fmt::format("page {} is a copy of the next", page));
  }
  for (const char* size : {"\x10\x00", "\x20\x00", "\x00\x01", "\x10\x01", "\x00\x00"}) {
    std::string other = *bytes_;
    other.replace(16, 2, size, 2);  // the page size in SQLite's header
    Write(other);
    ExpectRefused(fmt::format("page size {:02x}{:02x}", size[0], size[1]));
  }
}

// A journal is what a run leaves that was killed within a commit: SQLite plays it back.
TEST_F(CorruptedResultFile, JournalsLeftOver) {
  for (const std::string& journal :
       {std::string(), std::string("x"), std::string(5000, '\0'), std::string(5000, '\xd9')}) {
    Write(*bytes_);
    folder_->Write("run.sqlite-journal", journal);
    EXPECT_EQ(Read("a journal of nonsense"), FileOutcome::kSame);
  }
  // The journal of a transaction that changes everything, taken before its end, with the file as it was then.
  const std::string other = folder_->Path("other.sqlite");
  folder_->Write("other.sqlite", *bytes_);
  sqlite3* database = nullptr;
  sqlite3_open(other.c_str(), &database);
  sqlite3_exec(database,
               "PRAGMA cache_size = 1; BEGIN; UPDATE trials SET seconds = 7; UPDATE run SET value = 'x'",
               nullptr, nullptr, nullptr);
  const std::string half_way = ReadBytes(other), journal = ReadBytes(other + "-journal");
  sqlite3_close(database);
  ASSERT_GT(journal.size(), kPage);
  ASSERT_NE(half_way, *bytes_);
  Write(half_way);
  ExpectRefused("half-way through a transaction, its journal lost");
  Write(half_way);
  folder_->Write("run.sqlite-journal", journal);
  EXPECT_EQ(Read("half-way through a transaction"), FileOutcome::kSame);
  Write(half_way);
  folder_->Write("run.sqlite-journal", journal.substr(0, journal.size() / 2));
  Read("half of its journal");
}

// Bytes hit at random places: one bit, one byte, or a run of up to 64.
class Hits {
 public:
  explicit Hits(unsigned seed) : rng_(seed) {}

  std::string Damage(std::string bytes, std::string* what) {
    const size_t place = rng_() % bytes.size(), kind = rng_() % 3;
    const size_t length = kind < 2 ? 1 : std::min<size_t>(1 + rng_() % 64, bytes.size() - place);
    *what = fmt::format("{} bytes from {} hit", length, place);
    for (size_t i = place; i < place + length; ++i) {
      const auto flips = static_cast<char>(kind == 0 ? 1u << rng_() % 8 : rng_() % 256);
      bytes[i] = static_cast<char>(bytes[i] ^ flips);
    }
    return bytes;
  }

 private:
  std::mt19937 rng_;
};

// RCME_DAMAGES sets how many hits there are.
TEST_F(CorruptedResultFile, HitsChangeNothingInSilence) {
  Hits hits(1);
  const char* text = std::getenv("RCME_DAMAGES");
  const int num_hits = text ? std::atoi(text) : 300;
  int num_refused = 0, num_same = 0, num_refused_by_run = 0;
  for (int i = 0; i < num_hits; ++i) {
    std::string what;
    const std::string damaged = hits.Damage(*bytes_, &what);
    Write(damaged);
    const FileOutcome read = Read(what);
    (read == FileOutcome::kRefused ? num_refused : num_same) += 1;
    Write(damaged);
    const FileOutcome run = Resume(what);
    num_refused_by_run += run == FileOutcome::kRefused;
    EXPECT_FALSE(run == FileOutcome::kSame && read == FileOutcome::kRefused) << what << ": done, but not readable";
  }
  fmt::print("{} hits: {} refused, {} in unused space; run refuses {}\n", num_hits, num_refused, num_same,
             num_refused_by_run);
  EXPECT_GT(num_refused, num_hits * 3 / 10);
  EXPECT_GE(num_refused_by_run, num_refused);
}

// Several hits at once; what is sound is saved, and a run of the rest gives the summary of the sound file.
TEST_F(CorruptedResultFile, WhatIsSavedAndCompletedIsAsBefore) {
  Hits hits(2);
  std::int64_t num_files = 0, num_saved = 0, num_hopeless = 0;
  for (int i = 0; i < 60; ++i) {
    std::string what, damaged = *bytes_;
    for (int hit = 0; hit < 1 + i % 5; ++hit) damaged = hits.Damage(damaged, &what);
    Write(damaged);
    try {
      num_saved += SaveAndComplete(what);
      ++num_files;
    } catch (const InputError&) {
      ++num_hopeless;  // the beginning of the file, or its list of tables
    }
  }
  fmt::print("{} damaged files: {:.1f} of {} trials saved on average; of {} more nothing\n", num_files,
             static_cast<double>(num_saved) / static_cast<double>(num_files), 2 * kTrials, num_hopeless);
  EXPECT_GT(num_files, 40);
  EXPECT_GT(num_saved, num_files * kTrials);
}

}  // namespace
}  // namespace rcme
