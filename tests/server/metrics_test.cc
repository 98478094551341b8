#include "server/metrics/metrics.h"

#include <gmock/gmock.h>

#include <fstream>
#include <thread>

#include "server/routes/handle.h"
#include "tests/server/responses.h"
#include "tests/server/test_map.h"

namespace milepost::server {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class MetricsTest : public ::testing::Test {
 protected:
  MetricsTest() { write_town(folder_.path() / "town.map"); }

  std::string text() const { return metrics_.text(*open_catalog(folder_.path())); }

  TemporaryFolder folder_;
  Metrics metrics_{path_patterns()};
};

TEST_F(MetricsTest, CountsByRouteStatusAndMap) {
  metrics_.count({"/v1/maps", "", 200, 40, 0, 200us, false});
  metrics_.count({"/v1/maps", "", 200, 40, 0, 2ms, false});
  metrics_.count({"/v1/maps", "", 304, 0, 0, 60s, true});
  metrics_.count({"/v1/maps/{map}/builds/{build}/areas/{layer}", "town", 200, 3000, 3, 1ms, false});
  metrics_.count({"", "", 404, 100, 0, 1ms, false});
  EXPECT_THAT(
      text(),
      AllOf(HasSubstr("milepost_http_requests_total{route=\"/v1/maps\",status=\"200\"} 2\n"),
            HasSubstr("milepost_http_requests_total{route=\"/v1/maps\",status=\"304\"} 1\n"),
            HasSubstr("milepost_http_requests_total{route=\"other\",status=\"404\"} 1\n"),
            HasSubstr("milepost_http_response_bytes_total{route=\"/v1/maps\"} 80\n"),
            HasSubstr("milepost_http_responses_aborted_total 1\n"),
            HasSubstr("milepost_map_tiles_total{map=\"town\"} 3\n"),
            HasSubstr("milepost_map_tile_bytes_total{map=\"town\"} 3000\n"),
            Not(HasSubstr("/healthz"))));
  EXPECT_THAT(text(),
              AllOf(HasSubstr("duration_seconds_bucket{route=\"/v1/maps\",le=\"0.0001\"} 0\n"),
                    HasSubstr("duration_seconds_bucket{route=\"/v1/maps\",le=\"0.0003\"} 1\n"),
                    HasSubstr("duration_seconds_bucket{route=\"/v1/maps\",le=\"0.003\"} 2\n"),
                    HasSubstr("duration_seconds_bucket{route=\"/v1/maps\",le=\"30\"} 2\n"),
                    HasSubstr("duration_seconds_bucket{route=\"/v1/maps\",le=\"+Inf\"} 3\n"),
                    HasSubstr("duration_seconds_count{route=\"/v1/maps\"} 3\n")));
}

TEST_F(MetricsTest, TellsOfTheCatalogAndTheProcess) {
  std::ofstream(folder_.path() / "half.map") << "";
  metrics_.add("milepost_reloads_total", "Looks.", Metrics::Kind::counter, [] { return 7.0; });
  EXPECT_THAT(text(), AllOf(HasSubstr("# TYPE milepost_maps gauge\nmilepost_maps 1\n"),
                            HasSubstr("milepost_maps_left_out 1\n"),
                            HasSubstr("# TYPE milepost_reloads_total counter\n"),
                            HasSubstr("milepost_reloads_total 7\n"),
                            HasSubstr("process_resident_memory_bytes "),
                            HasSubstr("milepost_build_info{version=\"")));
}

TEST_F(MetricsTest, CountsFromSeveralThreads) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([this] {
      for (int k = 0; k < 1000; ++k) metrics_.count({"/v1/maps", "town", 200, 1, 1, 1ms, false});
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(text(), AllOf(HasSubstr("status=\"200\"} 4000\n"),
                            HasSubstr("milepost_map_tiles_total{map=\"town\"} 4000\n")));
}

TEST_F(MetricsTest, ResponsesTellTheirRouteAndMap) {
  const auto catalog = open_catalog(folder_.path());
  const Response map = handle({"GET", "/v1/maps/town", ""}, *catalog);
  EXPECT_EQ(map.route, "/v1/maps/{map}");
  EXPECT_EQ(map.map, "town");
  EXPECT_EQ(handle({"GET", "/v1/maps/town", std::string(map.header("ETag"))}, *catalog).route,
            "/v1/maps/{map}");
  EXPECT_EQ(handle({"GET", "/nothing", ""}, *catalog).route, "");
  EXPECT_THAT(text_of(handle({"GET", "/metrics", ""}, *catalog)), HasSubstr("milepost_maps 1\n"));
}

}  // namespace
}  // namespace milepost::server
