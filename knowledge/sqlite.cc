#include "knowledge/sqlite.h"

#include <sqlite3.h>

#include <utility>

namespace anchord::sqlite {

namespace {

Error failure_of(sqlite3* handle, const std::string& doing) {
  return {ErrorCode::kIo, "",
          doing + ": " + sqlite3_errmsg(handle) + " (SQLite code " +
              std::to_string(sqlite3_extended_errcode(handle)) + ")"};
}

}  // namespace

void Database::Close::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

Result<Database> Database::open(const std::string& path) {
  return open(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
}

Result<Database> Database::open_reading(const std::string& path) {
  return open(path, SQLITE_OPEN_READONLY);
}

Result<Database> Database::open(const std::string& path, int flags) {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(path.c_str(), &handle, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  if (handle == nullptr) return Error{ErrorCode::kIo, "", "no memory to open " + path};
  Database database(handle);
  if (code != SQLITE_OK) return database.failure("cannot open " + path);
  sqlite3_extended_result_codes(handle, 1);
  return database;
}

Status Database::execute(const std::string& sql) {
  if (sqlite3_exec(handle(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
    return failure("the database refused `" + sql + "`");
  return Done{};
}

Result<std::int64_t> Database::read_integer(const std::string& sql) {
  auto statement = Statement::prepare(*this, sql);
  if (!statement) return statement.error();
  auto row = statement->step();
  if (!row) return row.error();
  if (!*row) return Error{ErrorCode::kIo, "", "the database gave no row for `" + sql + "`"};
  return statement->integer(0);
}

Result<std::string> Database::read_text(const std::string& sql) {
  auto statement = Statement::prepare(*this, sql);
  if (!statement) return statement.error();
  auto row = statement->step();
  if (!row) return row.error();
  if (!*row) return Error{ErrorCode::kIo, "", "the database gave no row for `" + sql + "`"};
  return std::string(statement->text(0));
}

int Database::extended_code() const { return sqlite3_extended_errcode(handle()); }

Error Database::failure(const std::string& doing) const { return failure_of(handle(), doing); }

bool Database::in_transaction() const { return sqlite3_get_autocommit(handle()) == 0; }

bool Database::read_only() const { return sqlite3_db_readonly(handle(), "main") == 1; }

void Statement::Finalize::operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }

Result<Statement> Statement::prepare(const Database& database, const std::string& sql) {
  sqlite3_stmt* handle = nullptr;
  const int code = sqlite3_prepare_v3(database.handle(), sql.c_str(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &handle, nullptr);
  if (code != SQLITE_OK) return database.failure("the database refused `" + sql + "`");
  return Statement(handle);
}

void Statement::note(int code) {
  if (code != SQLITE_OK && bind_code_ == SQLITE_OK) bind_code_ = code;
}

Statement& Statement::bind(int parameter, std::int64_t value) {
  note(sqlite3_bind_int64(handle_.get(), parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, double value) {
  note(sqlite3_bind_double(handle_.get(), parameter, value));
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view text) {
  // A null pointer would bind NULL: an empty view is the empty text.
  const char* data = text.empty() ? "" : text.data();
  note(
      sqlite3_bind_text64(handle_.get(), parameter, data, text.size(), SQLITE_STATIC, SQLITE_UTF8));
  return *this;
}

Statement& Statement::bind(int parameter, std::span<const std::uint8_t> bytes) {
  if (bytes.empty())
    note(sqlite3_bind_zeroblob(handle_.get(), parameter, 0));
  else
    note(sqlite3_bind_blob64(handle_.get(), parameter, bytes.data(), bytes.size(), SQLITE_STATIC));
  return *this;
}

Result<bool> Statement::step() {
  if (bind_code_ != SQLITE_OK)
    return Error{ErrorCode::kIo, "",
                 std::string("a parameter cannot be bound: ") + sqlite3_errstr(bind_code_)};
  const int code = sqlite3_step(handle_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return failure_of(sqlite3_db_handle(handle_.get()), "the database failed");
}

void Statement::reset() {
  sqlite3_reset(handle_.get());  // repeats the code of the last step(), which told it already
  sqlite3_clear_bindings(handle_.get());
  bind_code_ = SQLITE_OK;
}

bool Statement::is_null(int column) const {
  return sqlite3_column_type(handle_.get(), column) == SQLITE_NULL;
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(handle_.get(), column);
}

double Statement::real(int column) const { return sqlite3_column_double(handle_.get(), column); }

std::string_view Statement::text(int column) const {
  const auto* data = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
  if (data == nullptr) return {};
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

std::span<const std::uint8_t> Statement::bytes(int column) const {
  const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(handle_.get(), column));
  if (data == nullptr) return {};
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

Result<Transaction> Transaction::begin(Database& database) {
  auto begun = database.execute("BEGIN IMMEDIATE");
  if (!begun) return begun.error();
  return Transaction(database);
}

Transaction::Transaction(Transaction&& other) noexcept
    : database_(std::exchange(other.database_, nullptr)) {}

Transaction::~Transaction() {
  // A ROLLBACK can fail only where SQLite has rolled back already.
  if (database_ != nullptr && database_->in_transaction())
    sqlite3_exec(database_->handle(), "ROLLBACK", nullptr, nullptr, nullptr);
}

Status Transaction::commit() {
  auto committed = database_->execute("COMMIT");
  if (committed) database_ = nullptr;
  return committed;
}

}  // namespace anchord::sqlite
