#include "schema/store/sqlite.h"

#include <sqlite3.h>

#include "schema/store/held_database.h"

namespace milepost::sqlite {
namespace {

ErrorCode code_of(int sqlite_code) {
  switch (sqlite_code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return ErrorCode::unavailable;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
    case SQLITE_ERROR:  // a table or column is missing
      return ErrorCode::corrupt;
    case SQLITE_CONSTRAINT:  // a value that the table rejects
      return ErrorCode::invalid_input;
    default:
      return ErrorCode::io;
  }
}

std::string hint_for(ErrorCode code) {
  switch (code) {
    case ErrorCode::unavailable:
      return "close the other program that uses it";
    case ErrorCode::corrupt:
      return "replace the file with a good copy, or rebuild it";
    case ErrorCode::invalid_input:
      return "";
    default:
      return "check the disk's space and the permissions";
  }
}

Error error_of(sqlite3* database, int sqlite_code) {
  const char* file = sqlite3_db_filename(database, "main");
  const ErrorCode code = code_of(sqlite_code);
  const bool is_named = file != nullptr && *file != '\0';
  return {code, is_named ? file : "a temporary file in TMPDIR", sqlite3_errmsg(database),
          hint_for(code)};
}

// A file: URI for a path. All characters of URI syntax are escaped.
std::string uri_for(const std::filesystem::path& file, std::string_view query) {
  static constexpr std::string_view kHexadecimal = "0123456789ABCDEF";
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string()) {
    if (c == '%' || c == '?' || c == '#') {
      const auto byte = static_cast<unsigned char>(c);
      uri += {'%', kHexadecimal[byte >> 4U], kHexadecimal[byte & 15U]};
    } else {
      uri += c;
    }
  }
  return uri.append(query);
}

}  // namespace

void expect_many_connections() {
  sqlite3_config(SQLITE_CONFIG_MEMSTATUS, 0);
  sqlite3_config(SQLITE_CONFIG_PAGECACHE, nullptr, 0, 0);
}

void Statement::Finalizer::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}
void Database::Closer::operator()(sqlite3* database) const { sqlite3_close_v2(database); }

Statement& Statement::bind(int parameter, std::int64_t value) {
  sqlite3_bind_int64(statement_.get(), parameter, value);
  return *this;
}

Statement& Statement::bind(int parameter, double value) {
  sqlite3_bind_double(statement_.get(), parameter, value);
  return *this;
}

Statement& Statement::bind(int parameter, std::optional<double> value) {
  if (value) return bind(parameter, *value);
  sqlite3_bind_null(statement_.get(), parameter);
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view value) {
  sqlite3_bind_text64(statement_.get(), parameter, value.data(), value.size(), SQLITE_TRANSIENT,
                      SQLITE_UTF8);
  return *this;
}

Statement& Statement::bind(int parameter, ByteView value) {
  // A null pointer would be stored as NULL instead of an empty blob.
  const void* data = value.empty() ? static_cast<const void*>("") : value.data();
  sqlite3_bind_blob64(statement_.get(), parameter, data, value.size(), SQLITE_TRANSIENT);
  return *this;
}

Result<bool> Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return error_of(sqlite3_db_handle(statement_.get()), code);
}

Status Statement::run() {
  const Result<bool> stepped = step();
  reset();
  return stepped.ok() ? ok_status() : Status(stepped.error());
}

void Statement::reset() { sqlite3_reset(statement_.get()); }

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

double Statement::real(int column) const { return sqlite3_column_double(statement_.get(), column); }

std::string Statement::text(int column) const { return std::string(as_text(blob(column))); }

ByteView Statement::blob(int column) const {
  const auto* data =
      static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_.get(), column));
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

Result<Database> Database::open(const std::filesystem::path& file, Access access) {
  const bool reading = access == Access::immutable;
  std::error_code ignored;
  if (reading && !std::filesystem::exists(file, ignored)) {
    return Error{ErrorCode::not_found, file.string(), "there is no such file", "check the path"};
  }
  const int flags = reading ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  return opened(file, uri_for(file, reading ? "?immutable=1" : ""), flags, nullptr);
}

Result<Database> Database::open(const HeldFile& file) {
  const std::string query = "?immutable=1&fd=" + std::to_string(file.descriptor());
  return opened(file.path(), uri_for(file.path(), query), SQLITE_OPEN_READONLY, held_file_system());
}

Result<Database> Database::opened(const std::filesystem::path& file, const std::string& uri,
                                  int flags, const char* file_system) {
  sqlite3* handle = nullptr;
  const int code = sqlite3_open_v2(uri.c_str(), &handle,
                                   flags | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, file_system);
  Database database(handle, file);  // owns the handle, which exists even after an error
  if (code != SQLITE_OK) {
    Error error = error_of(handle, code);
    error.where = file.string();
    return error;
  }
  sqlite3_busy_timeout(handle, 5000);
  return database;
}

Result<Database> Database::open_temporary() {
  sqlite3* handle = nullptr;
  constexpr int kFlags = SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  const int code = sqlite3_open_v2("", &handle, kFlags, nullptr);
  Database database(handle, {});
  if (code != SQLITE_OK) return error_of(handle, code);
  return database;
}

Status Database::execute(const std::string& sql) {
  const int code = sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr);
  return code == SQLITE_OK ? ok_status() : Status(error_of(database_.get(), code));
}

Result<Statement> Database::prepare(std::string_view sql) const {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(database_.get(), sql.data(), static_cast<int>(sql.size()),
                                      &statement, nullptr);
  if (code != SQLITE_OK) return error_of(database_.get(), code);
  return Statement(statement);
}

Status Database::check_column(const char* table, const char* column) const {
  const int code = sqlite3_table_column_metadata(database_.get(), "main", table, column, nullptr,
                                                 nullptr, nullptr, nullptr, nullptr);
  return code == SQLITE_OK ? ok_status() : Status(error_of(database_.get(), code));
}

Result<std::int64_t> Database::integer(std::string_view sql) const {
  auto statement = prepare(sql);
  if (!statement.ok()) return statement.error();
  const Result<bool> row = statement->step();
  if (!row.ok()) return row.error();
  return *row ? statement->integer(0) : 0;
}

std::int64_t Database::changes() const { return sqlite3_changes64(database_.get()); }

}  // namespace milepost::sqlite
