// Fields of requests: ranges, codings, origins.
#include <gmock/gmock.h>
#include <zlib.h>
#include <zstd.h>

#include "server/message/byte_range.h"
#include "server/message/content_coding.h"
#include "server/message/cross_origin.h"

namespace milepost::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Kind = RangeRequest::Kind;

void expect_part(std::string_view field, std::uint64_t first, std::uint64_t bytes) {
  const RangeRequest range = parse_range(field, 100);
  EXPECT_EQ(range.kind, Kind::part) << field;
  EXPECT_EQ(range.part.first, first) << field;
  EXPECT_EQ(range.part.bytes, bytes) << field;
}

TEST(ByteRangeTest, PartsOfABody) {
  expect_part("bytes=0-0", 0, 1);
  expect_part("bytes=0-99", 0, 100);
  expect_part("bytes=0-100", 0, 100);
  expect_part("BYTES=10-19", 10, 10);
  expect_part("bytes=99-", 99, 1);
  expect_part("bytes=-1", 99, 1);
  expect_part("bytes=-1000", 0, 100);
  expect_part("bytes=5-99999999999999999999999", 5, 95);
  expect_part("bytes=-99999999999999999999999", 0, 100);
}

TEST(ByteRangeTest, WhatBeginsBeyondTheBody) {
  for (const char* field :
       {"bytes=100-", "bytes=100-200", "bytes=99999999999999999999-", "bytes=-0"}) {
    EXPECT_EQ(parse_range(field, 100).kind, Kind::beyond) << field;
  }
  EXPECT_EQ(parse_range("bytes=0-", 0).kind, Kind::beyond);
  EXPECT_EQ(parse_range("bytes=-5", 0).kind, Kind::beyond);
}

TEST(ByteRangeTest, EverythingElseIsIgnored) {
  for (const char* field :
       {"", "bytes", "bytes=", "bytes=-", "bytes=5-4", "bytes=0-1,3-4", "bytes=a-b", "bytes= 0-1",
        "bytes=0-1 ", "bytes=+0-1", "bytes=0--1", "items=0-1", "bytes=0x0-0x1", "bytes=1"}) {
    EXPECT_EQ(parse_range(field, 100).kind, Kind::whole) << field;
  }
}

TEST(ByteRangeTest, APartIsOfTheBodyThatTheClientKnows) {
  EXPECT_TRUE(allows_part("", "\"a\""));
  EXPECT_TRUE(allows_part("\"a\"", "\"a\""));
  EXPECT_FALSE(allows_part("\"b\"", "\"a\""));
  EXPECT_FALSE(allows_part("W/\"a\"", "\"a\""));
  EXPECT_FALSE(allows_part("Tue, 01 Dec 2026 00:00:00 GMT", "\"a\""));
}

TEST(ContentCodingTest, TheClientsWeightsDecide) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "identity"},
      {"gzip", "gzip"},
      {"gzip, deflate, br, zstd", "zstd"},
      {"GZIP;q=0.5,zstd;q=0.4", "gzip"},
      {"gzip ; q=0.5 , zstd;Q=0.501", "zstd"},
      {"x-gzip", "gzip"},
      {"*", "zstd"},
      {"*;q=0.5, zstd;q=0", "gzip"},
      {"gzip;q=0", "identity"},
      {"identity, gzip;q=0.9", "identity"},
      {"identity;q=0.5, gzip;q=0.5", "gzip"},
      {"identity;q=0, *;q=0", "identity"},
      {"gzip;q=1.000", "gzip"},
      {"gzip;q=1.001", "identity"},
      {"gzip;q=2", "identity"},
      {"gzip;q=", "identity"},
      {"gzip;q=0.1234", "identity"},
      {"gzip;x=1", "identity"},
      {", ,gzip,", "gzip"},
      {"deflate, br", "identity"},
  };
  for (const auto& [field, expected] : cases) {
    EXPECT_EQ(name_of(preferred_coding(field)), expected) << field;
  }
}

std::string from_gzip(const std::string& bytes, std::size_t size) {
  std::string text(size + 1, '\0');
  z_stream stream{};
  EXPECT_EQ(inflateInit2(&stream, 15 + 16), Z_OK);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(text.data());
  stream.avail_out = static_cast<uInt>(text.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  text.resize(stream.total_out);
  inflateEnd(&stream);
  return text;
}

std::string from_zstd(const std::string& bytes, std::size_t size) {
  std::string text(size, '\0');
  EXPECT_EQ(ZSTD_decompress(text.data(), size, bytes.data(), bytes.size()), size);
  return text;
}

TEST(ContentCodingTest, ATextComesBackFromEachCoding) {
  std::string text;
  for (int i = 0; i < 5000; ++i) text += "\"bytes\": " + std::to_string(i * i) + ", ";
  for (const std::string& one : {text, std::string("x"), std::string()}) {
    EXPECT_EQ(from_gzip(*coded(one, ContentCoding::gzip), one.size()), one);
    EXPECT_EQ(from_zstd(*coded(one, ContentCoding::zstd), one.size()), one);
    EXPECT_EQ(*coded(one, ContentCoding::identity), one);
  }
  EXPECT_LT(coded(text, ContentCoding::gzip)->size(), text.size() / 2);
  EXPECT_EQ(*coded(text, ContentCoding::gzip), *coded(text, ContentCoding::gzip));
}

TEST(CrossOriginTest, OnlyAllowedOriginsMayRead) {
  const std::string origin = "https://maps.example.org";
  EXPECT_EQ(cross_origin_lines({}, origin, "GET"), "");
  const std::vector<std::string> allowed = {origin, "http://localhost:3000"};
  EXPECT_THAT(cross_origin_lines(allowed, origin, "GET"),
              HasSubstr("Access-Control-Allow-Origin: https://maps.example.org\r\n"));
  EXPECT_THAT(cross_origin_lines(allowed, origin, "GET"), HasSubstr("ETag"));
  for (const char* other :
       {"", "https://maps.example.org.evil.org", "http://maps.example.org", "null"}) {
    EXPECT_EQ(cross_origin_lines(allowed, other, "GET"), "Vary: Origin\r\n") << other;
  }
  EXPECT_THAT(cross_origin_lines({"*"}, "https://any.org", "GET"),
              HasSubstr("Access-Control-Allow-Origin: *\r\n"));
  EXPECT_THAT(cross_origin_lines({"*"}, "", "GET"), Not(HasSubstr("Vary")));
}

TEST(CrossOriginTest, APreflightIsToldWhatItMaySend) {
  const std::string lines = cross_origin_lines({"*"}, "https://any.org", "OPTIONS");
  EXPECT_THAT(lines, HasSubstr("Access-Control-Allow-Methods: GET, HEAD\r\n"));
  EXPECT_THAT(lines, HasSubstr("Authorization"));
  EXPECT_THAT(lines, HasSubstr("Access-Control-Max-Age: "));
}

TEST(CrossOriginTest, WhatAnOriginIs) {
  for (const char* text : {"*", "https://a.org", "http://localhost:8080", "https://[::1]:80"}) {
    EXPECT_TRUE(is_origin(text)) << text;
  }
  for (const char* text : {"", "a.org", "https://", "https://a.org/", "https://A.org", "ftp://a",
                           "https://a.org\r\nX: y", "null"}) {
    EXPECT_FALSE(is_origin(text)) << text;
  }
}

}  // namespace
}  // namespace milepost::server
