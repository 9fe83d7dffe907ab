#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace anchord {

/// A file system in memory, below SQLite, that fails and loses what a machine may: an operation
/// fails at a chosen moment, the disk is full, the power goes. It knows what has been synced. While
/// it lives it is SQLite's default; whoever opened a database then must close it before it goes.
/// One connection to a database at a time.
class FaultVfs {
 public:
  /// What an operation fails with: as Linux says it by errno, and SQLite's own layer tells it.
  enum class Fault { kNone, kNoSpace, kIo };
  /// What survives a loss of power of what was not synced: each 512 bytes by themselves, some only
  /// by their beginning.
  static constexpr std::int64_t kSector = 512;

  FaultVfs();
  ~FaultVfs();
  FaultVfs(const FaultVfs&) = delete;
  FaultVfs& operator=(const FaultVfs&) = delete;

  /// Fails the operation number `at` from now on, counted from 1, and if it `lasts` all after it.
  void fail(std::int64_t at, Fault fault, bool lasts);
  /// All is well from now on.
  void heal() { fail(0, Fault::kNone, false); }
  /// Operations since the last fail() or heal(): reads, writes, syncs, truncations, opening,
  /// deleting, and getting shared memory.
  std::int64_t operations() const;
  /// Bounds the sum of all files' sizes, B; what needs more fails with kNoSpace.
  void set_room(std::int64_t bytes);

  /// What was not synced is lost, but for what the seed chooses of it. All must be closed.
  void lose_power(std::uint32_t seed);

 private:
  struct Methods;
  enum class State { kWaits, kSynced, kInDoubt };
  struct Change {
    std::int64_t offset;
    std::vector<char> data;
    bool truncation;
    State state;
  };
  struct Node {
    std::vector<char> bytes;                              ///< as processes see it
    std::vector<char> durable;                            ///< as it is on the disk,
    std::vector<Change> changes;                          ///< and what has happened since
    bool named = false;                                   ///< its name is on the disk
    std::vector<std::unique_ptr<std::vector<char>>> map;  ///< shared memory
  };
  /// The fault that this operation meets.
  Fault next();
  int write(Node& node, std::int64_t offset, std::string_view data);
  int sync(Node& node);
  int truncate(Node& node, std::int64_t size);
  static void apply(const Change& change, std::vector<char>& bytes);
  void keep_some(Node& node, std::mt19937& random);

  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<Node>> files_;
  std::map<std::string, std::shared_ptr<Node>> deleted_;  ///< whose names are still on the disk
  std::int64_t count_ = 0, fail_at_ = 0;
  Fault fault_ = Fault::kNone;
  bool lasts_ = false;
  std::int64_t room_ = INT64_MAX;
  std::mt19937 salts_{1};  ///< any seed: what SQLite asks randomness for
  sqlite3_vfs vfs_{};
  sqlite3_vfs* before_;
};

}  // namespace anchord
