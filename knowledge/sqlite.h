#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/result.h"

struct sqlite3;
struct sqlite3_stmt;

namespace anchord::sqlite {

/// A thin layer over SQLite's C API: handles that close themselves, failures as Error (kIo) with
/// SQLite's own message and extended result code. Nothing throws. One thread at a time.

/// A connection to one database file.
class Database {
 public:
  /// Opens the file for reading and writing, and creates it if it is missing.
  static Result<Database> open(const std::string& path);
  /// Opens what is there for reading only, beside whoever writes it. It never moves a WAL's pages.
  static Result<Database> open_reading(const std::string& path);

  /// Runs statements that give no rows.
  Status execute(const std::string& sql);
  /// The first column of the first row: `PRAGMA user_version` and the like. No row is an error.
  Result<std::int64_t> read_integer(const std::string& sql);
  Result<std::string> read_text(const std::string& sql);

  /// The extended result code of the last call that failed, e.g. SQLITE_IOERR_WRITE.
  int extended_code() const;
  /// The last failure as an Error: "<doing>: <message> (SQLite code <n>)".
  Error failure(const std::string& doing) const;
  /// Whether a transaction is open. SQLite itself ends one after some failures (disk full).
  bool in_transaction() const;
  bool read_only() const;

  sqlite3* handle() const { return handle_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  explicit Database(sqlite3* handle) : handle_(handle) {}
  static Result<Database> open(const std::string& path, int flags);
  std::unique_ptr<sqlite3, Close> handle_;
};

/// A compiled statement, kept and run again. Its database must outlive it. Parameters count from 1
/// and columns from 0, as in SQLite.
class Statement {
 public:
  static Result<Statement> prepare(const Database& database, const std::string& sql);

  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);
  /// What is bound is not copied: it must live until the next reset().
  Statement& bind(int parameter, std::string_view text);
  Statement& bind(int parameter, std::span<const std::uint8_t> bytes);

  /// True: there is a row to read. False: done. An Error may come from an earlier bind.
  Result<bool> step();
  /// Makes it ready to run again and forgets what was bound.
  void reset();

  bool is_null(int column) const;
  std::int64_t integer(int column) const;
  double real(int column) const;
  /// Views of the row, until the next step() or reset().
  std::string_view text(int column) const;
  std::span<const std::uint8_t> bytes(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* handle) const;
  };
  explicit Statement(sqlite3_stmt* handle) : handle_(handle) {}
  void note(int code);
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
  int bind_code_ = 0;  ///< the first bind that failed
};

/// Resets a statement at the end of its use, so that no read stays open.
class ResetAtEnd {
 public:
  explicit ResetAtEnd(Statement& statement) : statement_(statement) {}
  ~ResetAtEnd() { statement_.reset(); }
  ResetAtEnd(const ResetAtEnd&) = delete;
  ResetAtEnd& operator=(const ResetAtEnd&) = delete;

 private:
  Statement& statement_;
};

/// A write transaction; rolled back when it goes without commit(). Its database must outlive it.
class Transaction {
 public:
  static Result<Transaction> begin(Database& database);
  Transaction(Transaction&& other) noexcept;
  Transaction& operator=(Transaction&&) = delete;
  ~Transaction();

  /// On an Error nothing is committed; the transaction stays open until it is destroyed, or SQLite
  /// has ended it already.
  Status commit();

 private:
  explicit Transaction(Database& database) : database_(&database) {}
  Database* database_;  ///< null once committed or moved from
};

}  // namespace anchord::sqlite
