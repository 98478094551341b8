// A thin RAII wrapper of SQLite handles: queries stay explicit, errors are values.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "schema/base/bytes.h"
#include "schema/base/result.h"
#include "schema/store/held_file.h"

struct sqlite3;
struct sqlite3_stmt;

namespace milepost::sqlite {

// For programs with connections to very many files: nothing is counted of all of them together, for
// which their threads would wait for one another, and pages have no memory before they are read.
// Does nothing once a connection was opened.
void expect_many_connections();

// A prepared statement. Parameters and columns count from 1 and 0, as in SQLite.
// Its Database must outlive it.
class Statement {
 public:
  Statement& bind(int parameter, std::int64_t value);
  Statement& bind(int parameter, double value);
  Statement& bind(int parameter, std::optional<double> value);  // none: NULL
  Statement& bind(int parameter, std::string_view value);       // copied
  Statement& bind(int parameter, ByteView value);               // copied

  // True if there is a row to read, false at the end. Errors: io (disk full too), corrupt,
  // invalid_input (violates a constraint), unavailable (locked by another process).
  Result<bool> step();
  // step() for a statement without rows, then reset().
  Status run();
  void reset();  // to run it again; bindings stay

  std::int64_t integer(int column) const;
  double real(int column) const;
  std::string text(int column) const;
  ByteView blob(int column) const;  // until the next step() or reset()

 private:
  friend class Database;
  struct Finalizer {
    void operator()(sqlite3_stmt* statement) const;
  };
  explicit Statement(sqlite3_stmt* statement) : statement_(statement) {}
  std::unique_ptr<sqlite3_stmt, Finalizer> statement_;
};

enum class Access {
  immutable,   // read only; the file never changes under this name (it is replaced by renaming)
  read_write,  // created if it does not exist
};

// One connection. Not safe to use from several threads at once.
class Database {
 public:
  // Errors: not_found (immutable only), io, corrupt.
  static Result<Database> open(const std::filesystem::path& file, Access access);
  // Reads the file that is held, as an immutable one. REQUIRES: it outlives the connection.
  // Errors: io, corrupt.
  static Result<Database> open(const HeldFile& file);

  // An empty database that is kept in memory up to a few megabytes, then in a file of the folder
  // for temporary files (TMPDIR), and gone when it is closed. Errors: io.
  static Result<Database> open_temporary();

  // Runs one or more statements that return no rows. Errors: as Statement::step.
  Status execute(const std::string& sql);
  // Errors: corrupt (the file is not a database, or lacks the table).
  Result<Statement> prepare(std::string_view sql) const;
  // Whether a table has a column, told faster than by preparing a query of it. Errors: corrupt (it
  // has none).
  Status check_column(const char* table, const char* column) const;
  // The first column of the first row, 0 if there is none. Errors: as Statement::step.
  Result<std::int64_t> integer(std::string_view sql) const;
  std::int64_t changes() const;  // rows that the last statement changed
  const std::filesystem::path& file() const { return file_; }

 private:
  struct Closer {
    void operator()(sqlite3* database) const;
  };
  Database(sqlite3* database, std::filesystem::path file)
      : database_(database), file_(std::move(file)) {}
  static Result<Database> opened(const std::filesystem::path& file, const std::string& uri,
                                 int flags, const char* file_system);
  std::unique_ptr<sqlite3, Closer> database_;
  std::filesystem::path file_;
};

}  // namespace milepost::sqlite
