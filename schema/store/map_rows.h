// Helpers to read the tables of a map: rows, names of their items for messages, and errors.
#pragma once

#include <string>

#include "schema/base/result.h"
#include "schema/store/sqlite.h"

namespace milepost {

// Resets a statement when its rows have been read, also after an error.
class Rows {
 public:
  explicit Rows(sqlite::Statement& statement) : statement_(statement) {}
  ~Rows() { statement_.reset(); }
  Rows(const Rows&) = delete;
  Rows& operator=(const Rows&) = delete;
  Result<bool> next() { return statement_.step(); }
  const sqlite::Statement* operator->() const { return &statement_; }

 private:
  sqlite::Statement& statement_;
};

// Passes each row of a query to `use`, which may stop it with an error.
template <class Use>
Status for_each_row(sqlite::Statement& statement, Use use) {
  Rows row(statement);
  while (true) {
    const Result<bool> more = row.next();
    if (!more) return more.error();
    if (!*more) return ok_status();
    const Status used = use(row);
    if (!used.ok()) return used;
  }
}

template <class Use>
Status for_each_row(const sqlite::Database& map, const char* sql, Use use) {
  Result<sqlite::Statement> statement = map.prepare(sql);
  if (!statement) return statement.error();
  return for_each_row(*statement, use);
}

inline std::string tile_name(const std::string& segment, const std::string& layer,
                             std::int64_t index) {
  return "segment " + segment + ", layer " + layer + ", tile " + std::to_string(index);
}

inline std::string cell_name(const std::string& layer, std::int64_t number) {
  return "layer " + layer + ", cell " + std::to_string(number);
}

inline Error corrupt(const std::string& where, const std::string& what) {
  return {ErrorCode::corrupt, where, what, "replace the file with a good copy, or rebuild it"};
}

}  // namespace milepost
