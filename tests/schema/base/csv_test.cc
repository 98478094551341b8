#include "schema/base/csv.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

class CsvTest : public ::testing::Test {
 protected:
  Result<CsvTable> read(const std::string& content) {
    std::ofstream(path_, std::ios::binary) << content;
    return CsvTable::read(path_, {"name", "x_m"});
  }

  Error error_of(const std::string& content) {
    const Result<CsvTable> table = read(content);
    EXPECT_FALSE(table.ok());
    return table.ok() ? Error{} : table.error();
  }

  testing::TempFolder folder_;
  std::filesystem::path path_ = folder_ / "table.csv";
};

TEST_F(CsvTest, ReadsRowsAndIgnoresFurtherColumns) {
  const auto table = read("name,x_m,more\na,1.5,z\nb,-2e-3,z\n");
  ASSERT_TRUE(table.ok()) << table.error().line();
  ASSERT_EQ(table->row_count(), 2U);
  EXPECT_EQ(table->text(1, 0), "b");
  EXPECT_DOUBLE_EQ(*table->number(0, 1), 1.5);
  EXPECT_DOUBLE_EQ(*table->number(1, 1), -2e-3);
}

TEST_F(CsvTest, ReadsTheFurtherColumnsThatAreAskedFor) {
  std::ofstream(path_) << "name,x_m,note,sigma_m,sigma_m\na,1.5,z,0.2,9\nb,2,z\n";
  EXPECT_FALSE(CsvTable::read(path_, {"name", "x_m"}, {"sigma_m"}).ok());  // the last row is short
  std::ofstream(path_) << "name,x_m,note,sigma_m,sigma_m\na,1.5,z,0.2,9\nb,2,z,x,9\n";
  const auto table = CsvTable::read(path_, {"name", "x_m"}, {"sigma_m", "absent"});
  ASSERT_TRUE(table.ok()) << table.error().line();
  EXPECT_EQ(table->column("absent"), std::nullopt);
  EXPECT_EQ(table->column("note"), std::nullopt);
  ASSERT_TRUE(table->column("sigma_m"));
  EXPECT_DOUBLE_EQ(*table->number(0, *table->column("sigma_m")), 0.2);
  EXPECT_THAT(table->number(1, *table->column("sigma_m")).error().line(),
              HasSubstr("line 3: sigma_m is 'x', not a finite number"));
}

TEST_F(CsvTest, TakesEveryLineEndAndAByteOrderMark) {
  const auto table = read("\xef\xbb\xbfname,x_m\r\na,1\r\n\r\nb,2");
  ASSERT_TRUE(table.ok()) << table.error().line();
  ASSERT_EQ(table->row_count(), 2U);
  EXPECT_DOUBLE_EQ(*table->number(1, 1), 2);
}

TEST_F(CsvTest, CountsLinesAsAnEditorDoes) {
  const auto table = read("name,x_m\na,1\n\nb,2\n");
  ASSERT_TRUE(table.ok());
  EXPECT_EQ(table->place(0), path_.string() + ", line 2");
  EXPECT_EQ(table->place(1), path_.string() + ", line 4");
}

TEST_F(CsvTest, NamesAWrongColumn) {
  const Error error = error_of("name,y_m\na,1\n");
  EXPECT_EQ(error.code, ErrorCode::invalid_input);
  EXPECT_EQ(error.line(), path_.string() +
                              ", line 1: column 2 is 'y_m', expected 'x_m'; start the header "
                              "with name,x_m");
}

TEST_F(CsvTest, NamesAMissingColumn) {
  EXPECT_THAT(error_of("name\n").line(), HasSubstr("column 2 is missing, expected 'x_m'"));
  EXPECT_THAT(error_of("").line(), HasSubstr("column 1 is '', expected 'name'"));
}

TEST_F(CsvTest, NamesAShortRow) {
  const Error error = error_of("name,x_m\na,1\nb\n");
  EXPECT_EQ(error.code, ErrorCode::invalid_input);
  EXPECT_THAT(error.line(), HasSubstr("line 3: the row has 1 cells, not 2"));
}

TEST_F(CsvTest, TakesOnlyFiniteNumbers) {
  for (const std::string cell : {"nan", "inf", "", "1x", "1 2", "1e999", "++1", "0x10", "abc"}) {
    SCOPED_TRACE(cell);
    const auto table = read("name,x_m\na," + cell + "\n");
    ASSERT_TRUE(table.ok());
    const auto number = table->number(0, 1);
    ASSERT_FALSE(number.ok());
    EXPECT_EQ(number.error().line(), path_.string() + ", line 2: x_m is '" + cell +
                                         "', not a finite number; correct or remove the row");
  }
}

TEST_F(CsvTest, ReadsWhatSpreadsheetsWrite) {
  for (const std::string content : {"\"name\",\"x_m\"\n\"a\",\"1.5\"\n", "name, x_m\na, 1.5\n",
                                    "name;x_m\na;1,5\n", "name;x_m;note\na;+1.5;\"b;c\"\n",
                                    "name\tx_m\na\t1,5\n \n", "\"name\" ;x_m\n \"a\" ; 1,5 \n"}) {
    SCOPED_TRACE(content);
    const auto table = read(content);
    ASSERT_TRUE(table.ok()) << table.error().line();
    ASSERT_EQ(table->row_count(), 1U);
    EXPECT_EQ(table->text(0, 0), "a");
    EXPECT_DOUBLE_EQ(*table->number(0, 1), 1.5);
  }
  const auto quoted = read("name,x_m\n\"a, \"\"b\"\"\",2\n");
  ASSERT_TRUE(quoted.ok()) << quoted.error().line();
  EXPECT_EQ(quoted->text(0, 0), "a, \"b\"");
}

TEST_F(CsvTest, ADecimalCommaNeedsAnotherSeparator) {
  const auto table = read("name,x_m\na,\"1,5\"\n");
  ASSERT_TRUE(table.ok()) << table.error().line();
  EXPECT_FALSE(table->number(0, 1).ok());
  EXPECT_FALSE(read("name;x_m\na;1.000,5\n")->number(0, 1).ok());  // thousands
}

TEST_F(CsvTest, NamesWhatItCannotRead) {
  EXPECT_THAT(error_of("name,x_m\n\"a,1\n").line(), HasSubstr("line 2: a quote is not closed; "));
  EXPECT_THAT(error_of("name,\"x_m\n").line(), HasSubstr("line 1: a quote is not closed; "));
  EXPECT_THAT(error_of("\xff\xfen").line(), HasSubstr("is a table in UTF-16; save it as CSV"));
}

TEST_F(CsvTest, NamesAMissingFile) {
  const auto table = CsvTable::read(folder_ / "none.csv", {"name"});
  ASSERT_FALSE(table.ok());
  EXPECT_EQ(table.error().code, ErrorCode::not_found);
  EXPECT_THAT(table.error().line(), HasSubstr("none.csv: there is no such file"));
}

}  // namespace
}  // namespace milepost
