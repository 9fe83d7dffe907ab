#include "tests/knowledge/fault_vfs.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace anchord {

/// SQLite's calls.
struct FaultVfs::Methods {
  /// What SQLite makes room for per open file.
  struct File {
    sqlite3_file base;
    FaultVfs* disk;
    std::shared_ptr<Node>* node;
  };
  static File& of(sqlite3_file* file) { return *reinterpret_cast<File*>(file); }
  static FaultVfs& of(sqlite3_vfs* vfs) { return *static_cast<FaultVfs*>(vfs->pAppData); }

  static int close(sqlite3_file* file) {
    delete std::exchange(of(file).node, nullptr);
    return SQLITE_OK;
  }
  static int read(sqlite3_file* file, void* to, int size, sqlite3_int64 offset) {
    std::lock_guard lock(of(file).disk->mutex_);
    if (of(file).disk->next() != Fault::kNone) return SQLITE_IOERR_READ;
    const std::vector<char>& bytes = (*of(file).node)->bytes;
    const auto there = std::clamp<std::int64_t>(std::ssize(bytes) - offset, 0, size);
    std::memset(to, 0, static_cast<std::size_t>(size));
    if (there > 0) std::memcpy(to, bytes.data() + offset, static_cast<std::size_t>(there));
    return there < size ? SQLITE_IOERR_SHORT_READ : SQLITE_OK;
  }
  static int write(sqlite3_file* file, const void* from, int size, sqlite3_int64 offset) {
    std::lock_guard lock(of(file).disk->mutex_);
    return of(file).disk->write(**of(file).node, offset,
                                {static_cast<const char*>(from), static_cast<std::size_t>(size)});
  }
  static int truncate(sqlite3_file* file, sqlite3_int64 size) {
    std::lock_guard lock(of(file).disk->mutex_);
    return of(file).disk->truncate(**of(file).node, size);
  }
  static int sync(sqlite3_file* file, int) {
    std::lock_guard lock(of(file).disk->mutex_);
    return of(file).disk->sync(**of(file).node);
  }
  static int size(sqlite3_file* file, sqlite3_int64* out) {
    std::lock_guard lock(of(file).disk->mutex_);
    *out = std::ssize((*of(file).node)->bytes);
    return SQLITE_OK;
  }
  static int lock(sqlite3_file*, int) { return SQLITE_OK; }
  static int check_lock(sqlite3_file*, int* out) { return *out = 0, SQLITE_OK; }
  static int control(sqlite3_file*, int, void*) { return SQLITE_NOTFOUND; }
  static int sector(sqlite3_file*) { return kSector; }
  static int characteristics(sqlite3_file*) { return SQLITE_IOCAP_POWERSAFE_OVERWRITE; }

  static int map(sqlite3_file* file, int region, int size, int extend, void volatile** out) {
    std::lock_guard lock(of(file).disk->mutex_);
    auto& regions = (*of(file).node)->map;
    *out = nullptr;
    if (region >= std::ssize(regions) && !extend) return SQLITE_OK;
    if (of(file).disk->next() != Fault::kNone) return SQLITE_IOERR_SHMMAP;
    while (region >= std::ssize(regions))
      regions.push_back(std::make_unique<std::vector<char>>(size));
    *out = regions[static_cast<std::size_t>(region)]->data();
    return SQLITE_OK;
  }
  static int lock_map(sqlite3_file*, int, int, int) { return SQLITE_OK; }
  static void barrier(sqlite3_file*) {}
  static int unmap(sqlite3_file* file, int) { return (*of(file).node)->map.clear(), SQLITE_OK; }

  static int open(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* given) {
    static constexpr sqlite3_io_methods kMethods{
        2,     close,      read,    write,  truncate,        sync, size,     lock,
        lock,  check_lock, control, sector, characteristics, map,  lock_map, barrier,
        unmap, nullptr,    nullptr};
    FaultVfs& disk = of(vfs);
    std::lock_guard lock(disk.mutex_);
    file->pMethods = nullptr;
    if (disk.next() != Fault::kNone) return SQLITE_CANTOPEN;
    std::shared_ptr<Node> node;
    if (const auto found = disk.files_.find(name ? name : ""); found != disk.files_.end())
      node = found->second;
    else if ((flags & SQLITE_OPEN_CREATE) == 0)
      return SQLITE_CANTOPEN;
    else
      node = std::make_shared<Node>();
    if (name) disk.files_[name] = node;
    File& opened = of(file);
    opened.disk = &disk;
    opened.node = new std::shared_ptr<Node>(std::move(node));
    opened.base.pMethods = &kMethods;
    if (given) *given = flags;
    return SQLITE_OK;
  }
  static int remove(sqlite3_vfs* vfs, const char* name, int sync_directory) {
    FaultVfs& disk = of(vfs);
    std::lock_guard lock(disk.mutex_);
    const auto found = disk.files_.find(name);
    if (found == disk.files_.end()) return SQLITE_IOERR_DELETE_NOENT;
    if (disk.next() != Fault::kNone) return SQLITE_IOERR_DELETE;
    if (!sync_directory && found->second->named) disk.deleted_[name] = found->second;
    disk.files_.erase(found);
    return SQLITE_OK;
  }
  static int access(sqlite3_vfs* vfs, const char* name, int, int* out) {
    FaultVfs& disk = of(vfs);
    std::lock_guard lock(disk.mutex_);
    *out = disk.files_.contains(name) ? 1 : 0;
    return SQLITE_OK;
  }
  static int full_path(sqlite3_vfs*, const char* name, int size, char* out) {
    sqlite3_snprintf(size, out, "%s", name);
    return SQLITE_OK;
  }
  static int randomness(sqlite3_vfs* vfs, int size, char* out) {
    for (int i = 0; i < size; ++i) out[i] = static_cast<char>(of(vfs).salts_());
    return size;
  }
  static int sleep(sqlite3_vfs*, int microseconds) { return microseconds; }
  static int time(sqlite3_vfs*, double* julian_day) { return *julian_day = 2'460'000, SQLITE_OK; }
  static int last_error(sqlite3_vfs*, int, char*) { return 0; }
};

FaultVfs::FaultVfs() : before_(sqlite3_vfs_find(nullptr)) {
  vfs_.iVersion = 1;
  vfs_.szOsFile = sizeof(Methods::File);
  vfs_.mxPathname = 512;
  vfs_.zName = "fault";
  vfs_.pAppData = this;
  vfs_.xOpen = Methods::open;
  vfs_.xDelete = Methods::remove;
  vfs_.xAccess = Methods::access;
  vfs_.xFullPathname = Methods::full_path;
  vfs_.xRandomness = Methods::randomness;
  vfs_.xSleep = Methods::sleep;
  vfs_.xCurrentTime = Methods::time;
  vfs_.xGetLastError = Methods::last_error;
  sqlite3_vfs_register(&vfs_, 1);
}

FaultVfs::~FaultVfs() {
  sqlite3_vfs_unregister(&vfs_);
  sqlite3_vfs_register(before_, 1);
}

void FaultVfs::fail(std::int64_t at, Fault fault, bool lasts) {
  std::lock_guard lock(mutex_);
  count_ = 0;
  fail_at_ = at;
  fault_ = fault;
  lasts_ = lasts;
}

std::int64_t FaultVfs::operations() const {
  std::lock_guard lock(mutex_);
  return count_;
}

void FaultVfs::set_room(std::int64_t bytes) {
  std::lock_guard lock(mutex_);
  room_ = bytes;
}

FaultVfs::Fault FaultVfs::next() {
  ++count_;
  return fail_at_ > 0 && (lasts_ ? count_ >= fail_at_ : count_ == fail_at_) ? fault_ : Fault::kNone;
}

/// What fails has been written by half.
int FaultVfs::write(Node& node, std::int64_t offset, std::string_view data) {
  Fault fault = next();
  std::int64_t used = 0;
  for (const auto& [name, file] : files_) used += std::ssize(file->bytes);
  const auto growth = offset + std::ssize(data) - std::ssize(node.bytes);
  if (growth > 0 && used + growth > room_) fault = Fault::kNoSpace;
  if (fault != Fault::kNone) data = data.substr(0, data.size() / 2);
  node.changes.push_back({offset, {data.begin(), data.end()}, false, State::kWaits});
  apply(node.changes.back(), node.bytes);
  if (fault == Fault::kNone) return SQLITE_OK;
  return fault == Fault::kNoSpace ? SQLITE_FULL : SQLITE_IOERR_WRITE;
}

int FaultVfs::truncate(Node& node, std::int64_t size) {
  if (next() != Fault::kNone) return SQLITE_IOERR_TRUNCATE;
  node.changes.push_back({size, {}, true, State::kWaits});
  apply(node.changes.back(), node.bytes);
  return SQLITE_OK;
}

/// After a sync that failed the kernel takes its pages for clean: whether they are on the disk
/// nobody knows, and the next sync, which succeeds, does not write them.
int FaultVfs::sync(Node& node) {
  const bool failed = next() != Fault::kNone;
  bool doubt = false;
  for (Change& change : node.changes) {
    if (change.state == State::kWaits) change.state = failed ? State::kInDoubt : State::kSynced;
    doubt = doubt || change.state == State::kInDoubt;
  }
  if (failed) return SQLITE_IOERR_FSYNC;
  node.named = true;
  if (!doubt)
    for (const Change& change : std::exchange(node.changes, {})) apply(change, node.durable);
  return SQLITE_OK;
}

void FaultVfs::apply(const Change& change, std::vector<char>& bytes) {
  const auto end = change.offset + std::ssize(change.data);
  if (change.truncation || end > std::ssize(bytes)) bytes.resize(static_cast<std::size_t>(end));
  std::copy(change.data.begin(), change.data.end(), bytes.begin() + change.offset);
}

void FaultVfs::lose_power(std::uint32_t seed) {
  std::lock_guard lock(mutex_);
  std::mt19937 random(seed);
  for (auto& [name, file] : deleted_)
    if (random() % 2 == 0) files_.try_emplace(name, file);
  deleted_.clear();
  std::erase_if(files_, [&](const auto& file) {
    return !file.second->named && (file.second->changes.empty() || random() % 2 == 0);
  });
  for (auto& [name, file] : files_) keep_some(*file, random);
}

void FaultVfs::keep_some(Node& node, std::mt19937& random) {
  for (const Change& change : std::exchange(node.changes, {})) {
    if (change.state == State::kSynced || (change.truncation && random() % 2 == 0)) {
      apply(change, node.durable);
      continue;
    }
    for (std::int64_t from = 0; from < std::ssize(change.data); from += kSector) {
      const auto size = std::min(kSector, std::ssize(change.data) - from);
      const auto kept = std::array{std::int64_t{0}, size, size / 2}[random() % 3];
      const auto begin = change.data.begin() + from;
      apply({change.offset + from, {begin, begin + kept}, false, State::kSynced}, node.durable);
    }
  }
  node.bytes = node.durable;
  node.map.clear();
  node.named = true;
}

}  // namespace anchord
