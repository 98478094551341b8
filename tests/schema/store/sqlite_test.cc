#include "schema/store/sqlite.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_folder.h"

namespace milepost::sqlite {
namespace {

using ::testing::HasSubstr;

class SqliteTest : public ::testing::Test {
 protected:
  Database open() const {
    Result<Database> database = Database::open(file_, Access::read_write);
    EXPECT_TRUE(database.ok()) << database.error().line();
    return std::move(*database);
  }

  milepost::testing::TempFolder folder_;
  std::filesystem::path file_ = folder_ / "a %41?b#c.db";
};

TEST_F(SqliteTest, GivesBackEveryKindOfValue) {
  Database database = open();
  ASSERT_TRUE(database.execute("CREATE TABLE t (i, r, s, b)").ok());
  const Bytes blob = {0, 1, 255};
  const std::string text("a\0b", 3);
  ASSERT_TRUE(database.prepare("INSERT INTO t VALUES (?, ?, ?, ?)")
                  ->bind(1, std::int64_t{1} << 40)
                  .bind(2, 0.1)
                  .bind(3, text)
                  .bind(4, ByteView(blob))
                  .run()
                  .ok());
  EXPECT_EQ(database.changes(), 1);
  Statement select = database.prepare("SELECT i, r, s, b FROM t").value();
  ASSERT_TRUE(*select.step());
  EXPECT_EQ(select.integer(0), std::int64_t{1} << 40);
  EXPECT_EQ(select.real(1), 0.1);
  EXPECT_EQ(select.text(2), text);
  EXPECT_EQ(Bytes(select.blob(3).begin(), select.blob(3).end()), blob);
  EXPECT_FALSE(*select.step());
}

TEST_F(SqliteTest, AnEmptyBlobIsNotNull) {
  Database database = open();
  ASSERT_TRUE(database.execute("CREATE TABLE t (b NOT NULL)").ok());
  EXPECT_TRUE(database.prepare("INSERT INTO t VALUES (?)")->bind(1, ByteView()).run().ok());
}

TEST_F(SqliteTest, AStatementRunsAgainWithItsBindings) {
  Database database = open();
  ASSERT_TRUE(database.execute("CREATE TABLE t (i)").ok());
  Statement insert = database.prepare("INSERT INTO t VALUES (?)").value();
  ASSERT_TRUE(insert.bind(1, std::int64_t{7}).run().ok());
  ASSERT_TRUE(insert.run().ok());
  Statement sum = database.prepare("SELECT sum(i) FROM t").value();
  ASSERT_TRUE(*sum.step());
  EXPECT_EQ(sum.integer(0), 14);
}

TEST_F(SqliteTest, TheFileHasTheNameThatWasGiven) {
  ASSERT_TRUE(open().execute("CREATE TABLE t (i)").ok());
  EXPECT_TRUE(std::filesystem::exists(file_));
}

TEST_F(SqliteTest, ImmutableReadsAndDoesNotWrite) {
  ASSERT_TRUE(open().execute("CREATE TABLE t (i); INSERT INTO t VALUES (3)").ok());
  Result<Database> database = Database::open(file_, Access::immutable);
  ASSERT_TRUE(database.ok()) << database.error().line();
  Statement select = database->prepare("SELECT i FROM t").value();
  ASSERT_TRUE(*select.step());
  EXPECT_EQ(select.integer(0), 3);
  const Status write = database->execute("INSERT INTO t VALUES (4)");
  ASSERT_FALSE(write.ok());
  EXPECT_EQ(write.error().code, ErrorCode::io);
}

TEST_F(SqliteTest, ImmutableDoesNotMakeAFile) {
  const auto database = Database::open(file_, Access::immutable);
  ASSERT_FALSE(database.ok());
  EXPECT_EQ(database.error().code, ErrorCode::not_found);
  EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(SqliteTest, NamesTheFileThatIsNoDatabase) {
  std::ofstream(file_) << std::string(2000, 'x');
  const auto database = Database::open(file_, Access::immutable);
  ASSERT_TRUE(database.ok());  // SQLite reads the file at the first query
  const auto select = database->prepare("SELECT 1 FROM sqlite_schema");
  ASSERT_FALSE(select.ok());
  EXPECT_EQ(select.error().code, ErrorCode::corrupt);
  EXPECT_EQ(select.error().line(), file_.string() +
                                       ": file is not a database; replace the file with "
                                       "a good copy, or rebuild it");
}

TEST_F(SqliteTest, ABrokenConstraintIsTheCallersFault) {
  Database database = open();
  const Status status =
      database.execute("CREATE TABLE t (i UNIQUE); INSERT INTO t VALUES (1), (1)");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::invalid_input);
  EXPECT_THAT(status.error().line(), HasSubstr("UNIQUE constraint failed: t.i"));
}

TEST_F(SqliteTest, ALockOfAnotherIsUnavailable) {
  Database one = open();
  ASSERT_TRUE(one.execute("CREATE TABLE t (i); BEGIN EXCLUSIVE").ok());
  Database other = open();
  ASSERT_TRUE(other.execute("PRAGMA busy_timeout = 1").ok());
  const Status status = other.execute("INSERT INTO t VALUES (1)");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::unavailable);
}

}  // namespace
}  // namespace milepost::sqlite
