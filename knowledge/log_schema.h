#pragma once

#include <cstdint>
#include <string>

#include "core/result.h"
#include "knowledge/sqlite.h"

namespace anchord {

/// Makes a database ready for the frame log: a new one is given its tables, an older version's is
/// brought up to `version`, all of it or nothing. kConflict: it is of a newer version, of another
/// program, or no database at all; nothing in it is changed then. `max_bytes` bounds its size, 0:
/// by the disk alone. `path` goes into the error.
Status prepare_log(sqlite::Database& database, const std::string& path, std::int64_t max_bytes);

/// The version that prepare_log() makes.
inline constexpr int kLogVersion = 5;

}  // namespace anchord
