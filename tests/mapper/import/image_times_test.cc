#include "mapper/import/image_times.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temp_folder.h"

namespace milepost {
namespace {

using ::testing::HasSubstr;

TEST(SecondsOfDate, ReadsWhatRecordersWrite) {
  for (const char* text :
       {"2011-09-30 12:40:59.125", "2011-09-30T12:40:59.125Z", "2011:09:30 12:40:59.125000000"}) {
    ASSERT_TRUE(seconds_of_date(text)) << text;
    EXPECT_NEAR(*seconds_of_date(text), 1317386459.125, 1e-6) << text;
  }
  for (const char* text : {"", "12", "2011-09-30", "2011-13-30 12:40:59", "2011-09-31T12:40:59",
                           "2011-09-30T24:40:59", "2011-09-30T12:40:59+02:00", "x"}) {
    EXPECT_FALSE(seconds_of_date(text)) << text;
  }
}

class TimedImages : public ::testing::Test {
 protected:
  void touch(const std::string& name) const { std::ofstream(folder_ / name) << "image"; }
  std::filesystem::path times(const std::string& text) const {
    std::ofstream(folder_ / "times") << text;
    return folder_ / "times";
  }
  std::vector<std::pair<std::string, double>> read(const std::filesystem::path& file) const {
    const auto images = timed_images(folder_.path(), file);
    EXPECT_TRUE(images.ok()) << images.error().line();
    std::vector<std::pair<std::string, double>> named;
    for (const RecordedImage& image : *images)
      named.emplace_back(image.file.filename().string(), image.timestamp_s);
    return named;
  }

  testing::TempFolder folder_;
};

TEST_F(TimedImages, InEachForm) {
  touch("b.PNG");
  touch("a.jpg");
  touch("notes.txt");
  const std::vector<std::pair<std::string, double>> both = {{"a.jpg", 1.5}, {"b.PNG", 2.25}};
  EXPECT_EQ(read(times("1.5\n2.25\n")), both);
  EXPECT_EQ(read(times("# times\n1.5 rgb/a.jpg\r\n2.25 rgb/b.PNG\n")), both);
  EXPECT_EQ(read(times("a.jpg 1.5\nb.PNG 2.25\n")), both);
  EXPECT_EQ(read(times("filename,timestamp_s\na.jpg,1.5\nb.PNG,2.25\n")), both);
  EXPECT_EQ(read(times("1970-01-01 00:00:01.5\n1970-01-01T00:00:02.25Z\n")), both);
}

TEST_F(TimedImages, FromTheirNames) {
  for (const char* name : {"1700000000.5.png", "1700000001500.png", "1700000002500000000.png"})
    touch(name);
  const auto images = read({});
  ASSERT_EQ(images.size(), 3U);
  EXPECT_DOUBLE_EQ(images[0].second, 1700000000.5);
  EXPECT_DOUBLE_EQ(images[1].second, 1700000001.5);
  EXPECT_DOUBLE_EQ(images[2].second, 1700000002.5);
}

TEST_F(TimedImages, NamesWhatIsWrong) {
  const auto refusal = [&](const std::filesystem::path& file) {
    const auto images = timed_images(folder_.path(), file);
    return images ? "accepted" : images.error().line();
  };
  EXPECT_THAT(refusal({}), HasSubstr("holds no images"));
  touch("a.jpg");
  touch("b.jpg");
  EXPECT_THAT(refusal({}), HasSubstr("a.jpg: its name is no time; name the images' times"));
  EXPECT_THAT(refusal(times("1\n2\n3\n")), HasSubstr("has 3 times for 2 images"));
  EXPECT_THAT(refusal(times("1\nyesterday\n")), HasSubstr("line 2: 'yesterday' holds no time"));
  EXPECT_THAT(refusal(times("1 a.jpg\n2\n")), HasSubstr("line 2: has no name of an image"));
  EXPECT_THAT(refusal(folder_ / "none"), HasSubstr("none: there is no such file"));
}

TEST(SpreadWholeSeconds, EvenlyWithinEach) {
  std::vector<RecordedImage> images;
  for (const double second : {7, 8, 8, 8, 8, 9, 9, 9, 9, 10, 10}) images.push_back({"", second});
  spread_whole_seconds(images);
  const std::vector<double> expected = {7.75, 8, 8.25, 8.5, 8.75, 9, 9.25, 9.5, 9.75, 10, 10.25};
  for (std::size_t i = 0; i < images.size(); ++i)
    EXPECT_DOUBLE_EQ(images[i].timestamp_s, expected[i]);
}

}  // namespace
}  // namespace milepost
