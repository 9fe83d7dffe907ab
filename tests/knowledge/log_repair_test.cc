// A damaged database is refused, or has all frames; and what is not damaged can be saved.

#include "knowledge/log_repair.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <set>

#include "knowledge/database_pages.h"
#include "knowledge/page_rows.h"
#include "tests/knowledge/frame_log_fixture.h"

namespace anchord {
namespace {

namespace fs = std::filesystem;
using Range = RepairReport::Range;

constexpr std::int64_t kFrames = 150, kInDatabase = 120;  // the rest is in the WAL

/// Every seventh is longer than a page, every fifth an event.
LoggedFrame varied(std::int64_t n) {
  LoggedFrame frame = frame_number(n);
  if (n % 7 == 0) frame.bytes.resize(9'000, static_cast<std::uint8_t>(n));
  if (n % 5 == 0) frame.kind = LoggedFrame::Kind::kEvent;
  if (n % 3 == 0) frame.work = n;
  return frame;
}

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class LogRepairTest : public FrameLogTest {
 protected:
  /// A log as a kill leaves it.
  void SetUp() override {
    FrameLogTest::SetUp();
    auto log = open();
    for (std::int64_t n = 1; n <= kInDatabase; ++n) ASSERT_TRUE(log->append(varied(n)).ok());
    ASSERT_TRUE(log->put_task(7, true, {7, 7}).ok());
    ASSERT_TRUE(log->commit().ok());
    log.reset();  // moves it into the database
    log = open();
    for (std::int64_t n = kInDatabase + 1; n <= kFrames; ++n) {
      ASSERT_TRUE(log->append(varied(n)).ok());
      if (n % 3 != 0) continue;
      ASSERT_TRUE(log->commit().ok());
    }
    ASSERT_TRUE(log->commit().ok());
    fs::create_directory(root_ + "/killed");
    for (const char* part : {"", "-wal", "-mark"})
      fs::copy_file(directory_ + "/anchord.db" + part, root_ + "/killed/anchord.db" + part);
    auto pages = DatabasePages::open(root_ + "/killed/anchord.db");
    ASSERT_TRUE(pages.ok());
    for (std::int64_t i = 0; i < pages->images(); ++i)
      for_each_row(
          *pages->image(i), *pages,
          [&](std::int64_t number, std::span<const StoredValue>) { numbers_[i].insert(number); });
    database_pages_ = static_cast<std::int64_t>(fs::file_size(root_ + "/killed/anchord.db") /
                                                DatabasePages::kSize);
  }

  /// The killed log, or another, in a directory of its own.
  std::string copy() {
    const std::string to = root_ + "/copy-" + std::to_string(++copies_);
    fs::copy(root_ + "/" + source_, to);
    return to;
  }
  static void flip(const std::string& path, std::int64_t offset, char mask) {
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    file.seekg(offset);
    const char byte = static_cast<char>(file.get() ^ mask);
    file.seekp(offset);
    file.put(byte);
  }
  static Result<std::vector<LoggedFrame>> read(const std::string& directory) {
    auto log = FrameLog::open(directory);
    if (!log) return log.error();
    std::vector<LoggedFrame> frames;
    const Status read = (*log)->for_each(1, [&](const LoggedFrame& frame) {
      frames.push_back(frame);
      return true;
    });
    if (!read) return read.error();
    return frames;
  }
  static Result<RepairReport> repair(const std::string& directory) {
    return repair_log(directory, {[](const LoggedFrame&) { return false; }});
  }

  /// Damages a byte; the log must have all frames then, or be refused unchanged and be saved but
  /// for what stands on that page. True: it was refused.
  bool damage(const char* part, std::int64_t offset, char mask) {
    SCOPED_TRACE(testing::Message() << "byte " << offset << " of anchord.db" << part << " xor "
                                    << static_cast<int>(mask));
    const std::string directory = copy(), path = directory + "/anchord.db";
    flip(path + part, offset, mask);
    const std::string before = content(path), wal_before = content(path + "-wal");
    const auto frames = read(directory);
    if (frames) {
      EXPECT_EQ(frames->size(), static_cast<std::size_t>(kFrames));
      for (std::size_t i = 0; i < frames->size(); ++i)
        EXPECT_EQ((*frames)[i], varied(static_cast<std::int64_t>(i) + 1));
      return false;
    }
    EXPECT_NE(frames.error().message.find("anchord.db"), std::string::npos);
    EXPECT_TRUE(content(path) == before) << frames.error().message;
    EXPECT_TRUE(content(path + "-wal") == wal_before) << frames.error().message;

    const auto report = repair(directory);
    EXPECT_TRUE(report.ok()) << frames.error().message << "; " << report.error().message;
    if (!report) return true;
    EXPECT_TRUE(content(report->kept_as) == before);
    EXPECT_TRUE(content(report->kept_as + "-wal") == wal_before);
    expect_saved(directory, *report, image_at(part, offset));
    return true;
  }

  /// Which image of a page has that byte; -1: none.
  std::int64_t image_at(const std::string& part, std::int64_t offset) const {
    if (part.empty()) return offset / DatabasePages::kSize;
    return offset < 32 ? -1 : database_pages_ + (offset - 32) / (24 + DatabasePages::kSize);
  }
  void expect_saved(const std::string& directory, const RepairReport& report, std::int64_t image) {
    const auto numbers = numbers_.find(image);
    std::set<std::int64_t> lost;
    for (const Range& range : report.lost)
      for (std::int64_t n = range.first; n <= range.last; ++n) lost.insert(n);
    if (numbers != numbers_.end())
      EXPECT_TRUE(
          std::includes(numbers->second.begin(), numbers->second.end(), lost.begin(), lost.end()))
          << "of another page: " << *lost.begin() << " to " << *lost.rbegin();
    else
      EXPECT_LE(lost.size(), 1u) << "no page but a leaf holds of two frames";
    EXPECT_EQ(report.saved, kFrames - std::ssize(lost));
    std::vector<LoggedFrame> kept;
    for (std::int64_t n = 1; n <= kFrames; ++n)
      if (!lost.contains(n)) {
        kept.push_back(varied(n));
        kept.back().sequence = std::ssize(kept);
      }
    const auto saved = read(directory);
    ASSERT_TRUE(saved.ok()) << saved.error().message;
    EXPECT_TRUE(*saved == kept);
  }

  std::map<std::int64_t, std::set<std::int64_t>> numbers_;  ///< of the rows on an image
  std::int64_t database_pages_ = 0;
  std::string source_ = "killed";

 private:
  int copies_ = 0;
};

TEST_F(LogRepairTest, UndamagedItHasAllFrames) {
  const auto frames = read(copy());
  ASSERT_TRUE(frames.ok());
  EXPECT_EQ(frames->size(), static_cast<std::size_t>(kFrames));
  const std::string directory = copy();
  const auto report = repair(directory);
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->saved, kFrames);
  EXPECT_EQ(report->tasks, 1);
  EXPECT_TRUE(report->lost.empty());
  EXPECT_TRUE(*read(directory) == *frames);
  EXPECT_EQ(repair(directory)->kept_as, directory + "/anchord.db.corrupt-2");
}

TEST_F(LogRepairTest, AnyByteOfTheHeader) {
  // Without a WAL, which has the newest header.
  fs::copy(root_ + "/killed", root_ + "/closed");
  ASSERT_TRUE(FrameLog::open(root_ + "/closed").ok());
  source_ = "closed";
  int refused = 0;
  for (std::int64_t offset = 0; offset < 108; ++offset) refused += damage("", offset, 0x15);
  EXPECT_GT(refused, 30) << "the magic words, the page size, the versions, the encoding";
}

TEST_F(LogRepairTest, BytesOfEveryPage) {
  std::mt19937 random(7);  // any seed: it spreads the places
  int refused = 0, pages = 0;
  for (std::int64_t page = 0; page < database_pages_; ++page, ++pages) {
    const std::int64_t begin = page * DatabasePages::kSize;
    // The kind of page, the number of cells, a cell's place; anything.
    std::vector<std::int64_t> offsets{0, 3, 4, 8, 11};
    for (int i = 0; i < 2; ++i) offsets.push_back(static_cast<std::int64_t>(random() % 4096));
    for (const std::int64_t offset : offsets)
      refused += damage("", begin + offset, static_cast<char>(1 + random() % 255));
  }
  EXPECT_GT(pages, 50);
  EXPECT_GT(refused, pages) << "most of what is damaged is read at a start";
}

TEST_F(LogRepairTest, BytesOfTheWal) {
  std::mt19937 random(8);  // any seed, as above
  const auto size = static_cast<std::int64_t>(fs::file_size(root_ + "/killed/anchord.db-wal"));
  for (std::int64_t offset = 0; offset < 32; offset += 3)
    EXPECT_TRUE(damage("-wal", offset, 0x21)) << "the header: it would be taken for no WAL";
  // From the last transaction on, too: nothing after it would tell of it but the mark.
  const std::int64_t image = 24 + DatabasePages::kSize;
  for (std::int64_t begin = 32; begin < size; begin += 3 * image)
    for (const std::int64_t offset : {std::int64_t{1}, std::int64_t{9}, std::int64_t{17},
                                      static_cast<std::int64_t>(24 + random() % 4096)})
      EXPECT_TRUE(damage("-wal", begin + offset, 0x40));
  EXPECT_TRUE(damage("-wal", size - 1, 0x40));
}

TEST_F(LogRepairTest, ManyBytesAtOnce) {
  for (unsigned seed = 1; seed <= 40; ++seed) {  // any seeds
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    const std::string directory = copy(), path = directory + "/anchord.db";
    for (const char* part : {"", "-wal", "-mark"}) {
      const auto size = static_cast<std::int64_t>(fs::file_size(path + part));
      // From one byte in a file to one on each page.
      for (std::int64_t n = 0; n <= size / 4096 * seed / 20; ++n)
        flip(path + part, static_cast<std::int64_t>(random()) % size,
             static_cast<char>(1 + random() % 255));
    }
    const auto report = repair(directory);
    if (!report) continue;
    const auto saved = read(directory);
    ASSERT_TRUE(saved.ok()) << saved.error().message;
    EXPECT_EQ(std::ssize(*saved), report->saved);
    std::int64_t n = 0;
    for (LoggedFrame frame : *saved) {  // each is one that was given, in their order
      do {
        frame.sequence = ++n;
      } while (n <= kFrames && frame != varied(n));
      ASSERT_LE(n, kFrames);
    }
  }
}

TEST_F(LogRepairTest, AFileThatEndsEarly) {
  const std::string directory = copy(), path = directory + "/anchord.db";
  fs::resize_file(path, fs::file_size(path) / 2);
  const auto frames = read(directory);
  ASSERT_FALSE(frames.ok());
  EXPECT_NE(frames.error().message.find("anchorctl repair " + directory), std::string::npos)
      << frames.error().message;
  const auto report = repair(directory);
  ASSERT_TRUE(report.ok());
  EXPECT_GT(report->saved, 0);
  EXPECT_FALSE(report->lost.empty());
  const auto saved = read(directory);
  ASSERT_TRUE(saved.ok()) << saved.error().message;
  EXPECT_EQ(std::ssize(*saved), report->saved);
}

TEST_F(LogRepairTest, AWalOrADatabaseThatIsGoneIsMissed) {
  for (const char* part : {"", "-wal"}) {
    const std::string directory = copy();
    fs::remove(directory + "/anchord.db" + part);
    const auto frames = read(directory);
    ASSERT_FALSE(frames.ok());
    EXPECT_NE(frames.error().message.find("150 frames were acknowledged"), std::string::npos)
        << frames.error().message;
  }
}

TEST_F(LogRepairTest, FramesWithoutChecksumsAreAskedFor) {
  const std::string directory = copy();
  {
    auto database = sqlite::Database::open(directory + "/anchord.db");
    ASSERT_TRUE(database->execute("ALTER TABLE frames DROP COLUMN checksum").ok());
  }
  const auto report =
      repair_log(directory, {[](const LoggedFrame& frame) { return frame.sequence != 3; }});
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->lost, (std::vector<Range>{{3, 3}}));
  EXPECT_EQ(report->saved, kFrames - 1);
}

TEST_F(LogRepairTest, LeavesOutWhatIsLaterThanATime) {
  const std::string directory = copy();
  const auto report =
      repair_log(directory, {[](const LoggedFrame&) { return false; }, varied(100).utime});
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->saved, 100);
  EXPECT_EQ(report->left_out, 50);
  EXPECT_TRUE(report->lost.empty());
  EXPECT_EQ(read(directory)->size(), 100u);
}

TEST_F(LogRepairTest, LeavesOutEvents) {
  const std::string directory = copy();
  const auto report = repair_log(directory, {[](const LoggedFrame&) { return false; }, {}, false});
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->left_out, kFrames / 5);
  const auto saved = read(directory);
  ASSERT_TRUE(saved.ok());
  for (const LoggedFrame& frame : *saved) EXPECT_EQ(frame.kind, LoggedFrame::Kind::kFrame);
}

/// A number that an undo names, and names that count births, may be another's behind a loss.
TEST_F(LogRepairTest, LeavesOutEventsBehindALoss) {
  RepairOptions options{[](const LoggedFrame&) { return true; }};
  options.doubtful_events = false;
  options.until = varied(41).utime;
  const std::string directory = copy();
  const auto all = repair_log(directory, options);
  ASSERT_TRUE(all.ok()) << all.error().text();
  EXPECT_EQ(all->doubtful, 0) << "nothing is left out before an event that stays";
  {
    auto database = sqlite::Database::open(directory + "/anchord.db");
    ASSERT_TRUE(database->execute("DELETE FROM frames WHERE sequence = 11").ok());
    ASSERT_TRUE(database->execute("PRAGMA wal_checkpoint(TRUNCATE); VACUUM").ok());
  }
  const auto report = repair_log(directory, options);
  ASSERT_TRUE(report.ok()) << report.error().text();
  EXPECT_EQ(report->lost, (std::vector<Range>{{11, 11}}));
  EXPECT_EQ(report->doubtful, 6) << "numbers 15, 20, ... 40";
  EXPECT_EQ(report->saved, 41 - 1 - 6);
}

TEST_F(LogRepairTest, WhatItCannotDo) {
  EXPECT_EQ(repair(root_ + "/nowhere").error().code, ErrorCode::kUnknown);
  const std::string text(5000, 'x'), directory = root_ + "/text";
  fs::create_directory(directory);
  std::ofstream(directory + "/anchord.db") << text;
  EXPECT_EQ(repair(directory).error().code, ErrorCode::kConflict);
  EXPECT_EQ(content(directory + "/anchord.db"), text);
  const auto log = FrameLog::open(copy());
  ASSERT_TRUE(log.ok());
  EXPECT_EQ(repair(root_ + "/copy-1").error().code, ErrorCode::kUnavailable);
}

}  // namespace
}  // namespace anchord
